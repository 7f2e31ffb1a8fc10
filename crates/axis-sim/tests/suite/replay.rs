//! Replays: limits of what is replayed, and references that a feed-forward is made of.

use axis_log::{Channel, Log};
use axis_sim::{
    Axis, ClosedLoop, Cycle, LoggedReference, Replay, ReplayError, RunStopped, Sensors, StopReason,
};
use trajectories::Motion;

use crate::{PRINTED, RIGID, changed, follow, text};

/// A reference that runs at 0.1 m/s, every millisecond.
fn moving() -> Log {
    let t: Vec<f64> = (0..500).map(|k| f64::from(k) * 1e-3).collect();
    let position: Vec<f64> = t.iter().map(|t| 0.1 * t).collect();
    Log::new(vec![
        Channel::new("t_s", t).unwrap(),
        Channel::new("position_ref_m", position.clone()).unwrap(),
        Channel::new("position_m", position).unwrap(),
    ])
    .unwrap()
}

#[test]
fn a_rigid_mass_has_its_own_following_error_limit() {
    let replay = Replay::new(&moving(), 1e-3).unwrap();
    let with = |limit: &str| {
        let content = text(RIGID).replace("following_error_limit_m = 10 ", limit);
        replay.run(&Axis::parse("emps.toml", &content).unwrap(), &[], None)
    };
    // A P–P loop lags by about v / K_p = 0.62 mm.
    assert!(with("").is_ok());
    assert!(with("following_error_limit_mm = 1").is_ok());
    let error = with("following_error_limit_mm = 0.5").unwrap_err();
    assert!(matches!(
        error,
        ReplayError::Stopped(RunStopped {
            reason: StopReason::FollowingError(5e-4, _),
            ..
        })
    ));
    assert!(
        error.to_string().contains("following_error_limit"),
        "{error}"
    );
}

#[test]
fn a_log_too_long_to_be_held_is_refused() {
    for file in [PRINTED, RIGID] {
        let axis = Axis::parse(file, &text(file)).unwrap();
        // Two rows, 10⁹ s apart.
        let ends = |name, last| Channel::new(name, vec![0.0, last]).unwrap();
        let log = Log::new(vec![
            ends("t_s", 1e9),
            ends("position_ref_m", 0.0),
            ends("position_m", 0.0),
        ])
        .unwrap();
        let error = Replay::new(&log, 1e9)
            .unwrap()
            .run(&axis, &[], None)
            .unwrap_err();
        assert!(matches!(error, ReplayError::TooLong { .. }), "{error}");
        assert!(
            error.to_string().contains("more than 1e8 cycles"),
            "{error}"
        );
    }
}

#[test]
fn a_period_that_is_none_is_refused() {
    for period in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let error = Replay::new(&moving(), period).unwrap_err();
        assert!(matches!(error, ReplayError::Period { .. }), "{error}");
    }
}

/// The rack with perfect sensors, a loop of 10 kHz, and this much torque (N·m) fed forward
/// per m/s².
fn fed(torque: f64) -> Axis {
    let more = format!("position_rate_khz = 5\nacceleration_feedforward_n_m_s2_per_m = {torque}");
    let changes = [
        ("frequency_khz = 8", "frequency_khz = 10"),
        ("position_rate_khz = 4", more.as_str()),
    ];
    let mut axis = changed("rack.toml", &changes);
    axis.sensors = Sensors::default();
    axis
}

/// A channel of a cycle, by its name in a log.
type Channels = &'static [(&'static str, fn(&Cycle) -> f64)];

const POSITION: Channels = &[
    ("t_s", |c| c.time),
    ("position_ref_m", |c| c.reference.position),
    ("position_m", |c| c.position),
];
const VELOCITY: Channels = &[("velocity_ref_m_s", |c| c.reference.velocity)];
const ACCELERATION: Channels = &[("acceleration_ref_m_s2", |c| c.reference.acceleration)];

/// These channels of every `every`-th cycle, the references in steps of `resolution`.
fn logged(cycles: &[Cycle], channels: &[Channels], every: usize, resolution: f64) -> Log {
    let stepped = |name: &str, value: f64| match name.contains("_ref_") && resolution > 0.0 {
        true => resolution * (value / resolution).round(),
        false => value,
    };
    let channel = |(name, read): &(&'static str, fn(&Cycle) -> f64)| {
        let samples = cycles.iter().step_by(every).map(|c| stepped(name, read(c)));
        Channel::new(*name, samples.collect()).unwrap()
    };
    Log::new(channels.iter().copied().flatten().map(channel).collect()).unwrap()
}

/// Greatest distance of a replay's position from the log's, m.
fn residual(axis: &Axis, log: &Log, period: f64) -> f64 {
    let trace = Replay::new(log, period).unwrap().run(axis, &[], None);
    let trace = trace.unwrap();
    let logged = log.channel("position_m").unwrap();
    let apart = trace.position().iter().zip(logged);
    apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What a file says is fed forward is fed forward in a replay: the torque for 300 kg on this
/// travel, left out, is a gap of tenths of a millimetre.
#[test]
fn a_replay_feeds_the_acceleration_forward() {
    let axis = fed(2.2);
    let cycles = follow(&ClosedLoop::new(&axis).unwrap(), 2);
    let log = |channels: &[Channels], every| logged(&cycles, channels, every, 0.0);
    let left_out = residual(&fed(0.0), &log(&[POSITION, VELOCITY], 1), 1e-4);
    assert!(left_out > 2e-5, "{left_out:e}");
    let all = [POSITION, VELOCITY, ACCELERATION];
    for (channels, every, most) in [
        // In the loop's own rate nothing is between samples.
        (&all[..], 1, 1e-14),
        (&all[..], 10, 1e-3 * left_out),
        // The acceleration derived.
        (&all[..2], 1, 1e-3 * left_out),
        (&all[..2], 10, 1e-2 * left_out),
        (&all[..1], 1, 1e-3 * left_out),
        (&all[..1], 10, 1e-2 * left_out),
    ] {
        let apart = residual(&axis, &log(channels, every), 1e-4 * every as f64);
        println!(
            "{} channels, every {every}: {apart:e} of {left_out:e} m",
            channels.len()
        );
        assert!(
            apart < most,
            "{} channels, every {every}: {apart:e}",
            channels.len()
        );
    }
}

/// Steps of a micrometre at 1 kHz are 1 m/s² in a second difference, more than the motion's
/// own acceleration.
#[test]
fn the_steps_of_a_reference_are_not_its_acceleration() {
    let axis = fed(2.2);
    let cycles = follow(&ClosedLoop::new(&axis).unwrap(), 2);
    let exact: Vec<f64> = cycles
        .iter()
        .step_by(10)
        .map(|c| c.reference.acceleration)
        .collect();
    for (channels, resolution) in [
        (&[POSITION][..], 1e-6),
        (&[POSITION][..], 1e-5),
        (&[POSITION, VELOCITY][..], 1e-6),
        (&[POSITION, VELOCITY][..], 1e-4),
    ] {
        let log = logged(&cycles, channels, 10, resolution);
        let reference = LoggedReference::new(&log, 1e-3).unwrap();
        let squares = exact.iter().enumerate().map(|(k, exact)| {
            let off = reference.at(1e-3 * k as f64).acceleration - exact;
            off * off
        });
        let off = (squares.sum::<f64>() / exact.len() as f64).sqrt();
        println!("{} channels in {resolution}: {off} m/s²", channels.len());
        // Of 1 m/s².
        assert!(
            off < 0.05,
            "{} channels in {resolution}: {off}",
            channels.len()
        );
        // Steps of 0.1 mm/s are in the speed that is fed forward, whatever is done here.
        if resolution == 1e-4 {
            continue;
        }
        let apart = residual(&axis, &log, 1e-3);
        let left_out = residual(&fed(0.0), &log, 1e-3);
        println!("    {apart:e} of {left_out:e} m");
        assert!(apart < 0.2 * left_out, "{apart:e} of {left_out:e}");
    }
}

/// A run whose command was excited, replayed from its log alone: the same motion. Found: the same bits;
/// without the channel of the excitation 1.4 µm apart.
#[test]
fn an_excited_run_is_replayed_with_its_excitation() {
    let axis = Axis::parse(PRINTED, &text(PRINTED)).unwrap();
    let plan = axis.plan(&axis.trajectories[0]).unwrap();
    let count = (plan.duration() / axis.period) as usize;
    let samples: Vec<f64> = (0..count)
        .map(|k| if (k / 37) % 2 == 0 { 0.5 } else { -0.5 })
        .collect();
    let closed = ClosedLoop::new(&axis).unwrap().with_excitation(samples);
    let mut recorder = axis_sim::Recorder::new(&axis).with(axis_sim::excitation_channel(&axis));
    let none = &mut compensator::NoCompensation;
    let outcome = closed.run(&plan, none, |cycle| recorder.push(cycle));
    outcome.completed().unwrap();
    let log = recorder.log().unwrap();
    assert!(axis_sim::known_channels().any(|name| name == "excitation_a"));
    assert_eq!(axis_sim::excitation_in(&log).unwrap()[0], 0.5);
    // What a compensation adds is another channel.
    assert!(
        log.channel("iq_feedforward_a")
            .unwrap()
            .iter()
            .all(|x| *x == 0.0)
    );
    let apart = |log: &Log| {
        let trace = Replay::new(log, axis.period)
            .unwrap()
            .run(&axis, &[], None)
            .unwrap();
        let of = trace.channel("position_m").unwrap();
        let pairs = of.iter().zip(log.channel("position_m").unwrap());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let names = [
        "t_s",
        "position_ref_m",
        "velocity_ref_m_s",
        "acceleration_ref_m_s2",
        "position_m",
    ];
    let kept = log
        .channels()
        .iter()
        .filter(|c| names.contains(&c.name.as_str()));
    let without = Log::new(kept.cloned().collect()).unwrap();
    let [with, without] = [apart(&log), apart(&without)];
    assert!(with < 1e-15, "{with:e}");
    assert!(without > 1e-7, "{without:e}");
}
