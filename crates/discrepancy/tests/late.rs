//! A reference that its log shows late, and samples that lie off their stamps.

use axis_log::{Channel, Log};
use axis_sim::{Axis, ClosedLoop, Recorder, Sensors};
use compensator::NoCompensation;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trajectories::{Limits, Motion, Program, Step};

/// Cycles of the control in a sample of the log.
const EVERY: usize = 8;

fn machine() -> Axis {
    let file = format!("{}/../../data/axes/rack.toml", env!("CARGO_MANIFEST_DIR"));
    let mut axis = Axis::read(file.as_ref()).unwrap();
    axis.sensors = Sensors::default();
    let rate = 1.0 / axis.period;
    axis.control
        .change(|v| v.set("position_rate", rate))
        .unwrap();
    axis
}

/// There and back at two speeds, m/s.
fn program(speeds: [f64; 2]) -> Program {
    let rest = Step::Dwell { duration: 0.3 };
    let moves = speeds.iter().flat_map(|&speed| {
        let limits = Limits::new(speed, 2.0, 80.0).unwrap();
        [0.62, 0.5]
            .into_iter()
            .flat_map(move |to| [Step::Move { to, limits }, rest])
    });
    Program::new(0.5, std::iter::once(rest).chain(moves).collect()).unwrap()
}

/// What is off in a log.
#[derive(Clone, Copy)]
struct Off {
    /// Time by which the reference is late, s.
    late: f64,
    /// Deviation of the instants at which a row is taken, s.
    jitter: f64,
}

/// The log of a program with what is off in it, and with noise of 0.1 µm and 5 mN·m.
fn log(name: &str, axis: &Axis, program: &Program, off: Off, seed: u64) -> NamedLog {
    let mut recorder = Recorder::new(axis);
    let closed_loop = ClosedLoop::new(axis).unwrap();
    let run = closed_loop.run(program, &mut NoCompensation, |c| recorder.push(c));
    run.completed().unwrap();
    let all = recorder.log().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let count = all.len() / EVERY;
    let stamps: Vec<f64> = (0..count)
        .map(|k| (k * EVERY) as f64 * axis.period)
        .collect();
    let taken: Vec<f64> = stamps
        .iter()
        .map(|t| (t + off.jitter * normal()).max(0.0))
        .collect();
    let mut between = |name: &str, noise: f64| -> Channel {
        let samples = all.channel(name).unwrap();
        let at = |t: &f64| {
            let along = (t / axis.period).min((samples.len() - 1) as f64);
            let k = (along as usize).min(samples.len() - 2);
            samples[k] + (along - k as f64) * (samples[k + 1] - samples[k]) + noise * normal()
        };
        Channel::new(name, taken.iter().map(at).collect()).unwrap()
    };
    let (position, torque) = (between("position_m", 1e-7), between("torque_ref_n_m", 5e-3));
    let reference = taken
        .iter()
        .map(|t| program.at((t - off.late).max(0.0)).position);
    let log = Log::new(vec![
        Channel::new("t_s", stamps.clone()).unwrap(),
        Channel::new("position_ref_m", reference.collect()).unwrap(),
        position,
        torque,
    ]);
    (name.to_owned(), log.unwrap(), EVERY as f64 * axis.period)
}

fn discover(off: Off) -> Discovery {
    let axis = machine();
    let logs = |name: &str, speeds, seed| vec![log(name, &axis, &program(speeds), off, seed)];
    let fit = logs("fit", [0.2, 0.08], 1);
    let check = logs("check", [0.15, 0.06], 2);
    let evidence = Evidence::new(&axis, fit, check, Vec::new()).unwrap();
    let (_, discovered) = evidence
        .discover(&axis, &Settings::default(), |_| ())
        .unwrap();
    let discovery = discovered.discovery;
    println!(
        "{}\n{:#?}\n{:?}",
        discovery.sentence, discovery.notes, discovery.gap
    );
    for known in discovery
        .recalibrated
        .iter()
        .filter(|k| k.share.abs() > 0.3 * k.tolerance)
    {
        println!(
            "{} {:.4} of {:.4}",
            known.name, known.share, known.tolerance
        );
    }
    discovery
}

/// 1.5 ms are 2.5 % of velocity feed-forward, and 0.3 mm at 0.2 m/s.
#[test]
fn a_reference_that_is_late_is_told_with_its_time_and_is_no_effect() {
    let discovery = discover(Off {
        late: 1.5e-3,
        jitter: 0.0,
    });
    let note = discovery
        .notes
        .iter()
        .find(|note| note.contains("the reference is late"));
    let note = note.expect("a note on the reference");
    assert!(
        note.contains("1.50") && note.contains("delay_ms = 1.5"),
        "{note}"
    );
    assert_eq!(discovery.verdict, Verdict::NothingMissing);
    let gap = &discovery.gap.check.channels;
    assert!(gap.iter().all(|c| c.after < 1.2 * c.floor), "{gap:?}");
}

#[test]
fn of_a_sound_log_nothing_is_told() {
    let discovery = discover(Off {
        late: 0.0,
        jitter: 0.0,
    });
    assert_eq!(discovery.verdict, Verdict::NothingMissing);
    let about = |note: &&String| note.contains("reference") || note.contains("stamps");
    assert_eq!(discovery.notes.iter().find(about), None);
}

/// 3 % of a period: 6 µm at 0.2 m/s, where a sensor has 0.1 µm.
#[test]
fn samples_off_their_stamps_are_told_and_are_noise() {
    let discovery = discover(Off {
        late: 0.0,
        jitter: 3e-5,
    });
    let note = discovery
        .notes
        .iter()
        .find(|note| note.contains("stamps are even"));
    let note = note.expect("a note on the stamps");
    let share = note.split(" % of a period").next().unwrap();
    let share: f64 = share.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((share / 3.0 - 1.0).abs() < 0.15, "{note}");
    assert_eq!(discovery.verdict, Verdict::NothingMissing);
    // What such instants make, of the reference through the loop too, is the floor.
    let gap = &discovery.gap.check.channels;
    let is_floor = gap
        .iter()
        .all(|c| (0.8..1.2).contains(&(c.after / c.floor)));
    assert!(is_floor && gap[0].floor > 1e-6, "{gap:?}");
}
