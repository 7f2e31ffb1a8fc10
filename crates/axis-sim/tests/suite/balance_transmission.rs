//! Torque balance where load and motor are measured: what lies between them.

use axis_log::{Channel, Log};
use axis_sim::effects::ActiveEffect;
use axis_sim::{Axis, Balance, ClosedLoop, Recorder, Sensors, TRANSMISSION_ERROR};
use compensator::NoCompensation;

use crate::axis;
use crate::balance::{active, back_and_forth, rms};

/// The machine on a motion there and back, sensors without errors, at about 1 kHz.
fn simulated(machine: &Axis) -> (Log, f64) {
    let mut recorder = Recorder::new(machine);
    ClosedLoop::new(machine)
        .unwrap()
        .without_noise()
        .run(&back_and_forth(machine), &mut NoCompensation, |c| {
            recorder.push(c);
        })
        .completed()
        .unwrap();
    let every = (1e-3 / machine.period).round() as usize;
    let log = recorder.log().unwrap().decimate(every).unwrap();
    (log, every as f64 * machine.period)
}

fn about_the_mean(series: &[f64]) -> Vec<f64> {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    series.iter().map(|v| v - mean).collect()
}

/// Transmission error as measured, and what a model leaves of it, RMS.
fn left(machine: &Axis, effects: &[ActiveEffect], log: &(Log, f64)) -> [f64; 2] {
    let balance = Balance::new(&log.0, log.1, machine).unwrap();
    let name = *TRANSMISSION_ERROR
        .iter()
        .find(|name| balance.channels().contains(name))
        .unwrap();
    let trace = balance.run(machine, effects, None).unwrap();
    let measured = balance.compared().channel(name).unwrap();
    let pairs = measured.iter().zip(trace.channel(name).unwrap());
    let rest: Vec<f64> = pairs.map(|(m, s)| m - s).collect();
    [measured, &rest].map(|series| rms(&about_the_mean(series)))
}

/// A machine without errors of its sensors, and what is put into it.
fn machine(name: &str, effects: &[ActiveEffect]) -> [Axis; 2] {
    let mut bare = axis(name);
    bare.sensors = Sensors::default();
    bare.balance.slowest = Some(0.05 * bare.trajectories[0].limits.velocity());
    let mut with = bare.clone();
    with.effects.extend_from_slice(effects);
    [bare, with]
}

/// A model knows the transmission error of its own log. Measured: 2.4e-4 of it at most.
#[test]
fn a_model_knows_its_own_transmission_error() {
    for name in [
        "liu2025.toml",
        "screw-datasheet.toml",
        "rack.toml",
        "belt.toml",
        "joint.toml",
    ] {
        let [bare, _] = machine(name, &[]);
        let [measured, left] = left(&bare, &[], &simulated(&bare));
        println!("{name}: {left:.2e} of {measured:.2e}");
        assert!(left < 1e-3 * measured, "{name}: {left} of {measured}");
    }
}

/// What is put between motor and load, or into the motor's encoder, shows by its law, and in no
/// model without it. A gap of 50 µm takes a rack's carriage some milliseconds to cross, and is taken to be
/// crossed at once: 5.8 % of it is left, else 1 % at most.
#[test]
fn what_lies_between_motor_and_load_is_in_the_transmission_error() {
    let cases = [
        ("liu2025.toml", active("backlash", &[10e-6])),
        ("rack.toml", active("backlash", &[50e-6])),
        ("liu2025.toml", active("periodic-lead-error", &[3e-6, 0.7])),
        (
            "liu2025.toml",
            active("kinematic-error-harmonic", &[2e-6, 3.0, 0.2]),
        ),
        ("joint.toml", active("encoder-eccentricity", &[5e-3, 1.1])),
        ("liu2025.toml", active("thermal-expansion", &[6e-5, 4.0])),
        ("rack.toml", active("lead-error", &[1e-4])),
        ("rack.toml", active("transmission-stiffness", &[-0.3])),
    ];
    for (name, effect) in cases {
        let [bare, with] = machine(name, std::slice::from_ref(&effect));
        let log = simulated(&with);
        let what = effect.effect.name;
        let [without, known] = [Vec::new(), vec![effect]].map(|e| left(&bare, &e, &log)[1]);
        println!("{name}, {what}: {known:.2e} of {without:.2e}");
        let most = if name == "rack.toml" && what == "backlash" {
            0.1
        } else {
            0.03
        };
        assert!(
            known < most * without,
            "{name}, {what}: {known} of {without}"
        );
    }
}

/// A load's encoder that is read 0.4 ms late: what a clock that is off makes of it.
#[test]
fn a_position_that_is_read_late_is_in_the_transmission_error() {
    const LATE: f64 = 4e-4;
    let [bare, _] = machine("rack.toml", &[]);
    let (log, period) = simulated(&bare);
    let late = |c: &Channel| {
        let mut samples = c.samples.clone();
        if c.name == "position_m" {
            let share = LATE / period;
            let shifted = c.samples.windows(2).map(|w| w[1] - share * (w[1] - w[0]));
            samples.splice(1.., shifted);
        }
        Channel::new(c.name.clone(), samples).unwrap()
    };
    let log = Log::new(log.channels().iter().map(late).collect()).unwrap();
    let log = (log, period);
    let [_, without] = left(&bare, &[], &log);
    let [_, known] = left(&bare, &[active("clock-offset", &[LATE])], &log);
    println!("{known:.2e} of {without:.2e}");
    assert!(known < 0.01 * without, "{known} of {without}");
}

/// At 10 kHz without noise the low-pass lies so high that a load goes less than friction's pre-sliding
/// displacement within its period: what has slid since the load last turned slides yet.
#[test]
fn a_fast_log_of_a_short_move_is_balanced() {
    let [bare, _] = machine("screw-datasheet.toml", &[]);
    let mut recorder = Recorder::new(&bare);
    let motion = bare.plan(&bare.trajectories[0]).unwrap();
    ClosedLoop::new(&bare)
        .unwrap()
        .without_noise()
        .run(&motion, &mut NoCompensation, |c| recorder.push(c))
        .completed()
        .unwrap();
    let log = recorder.log().unwrap();
    let balance = Balance::new(&log, bare.period, &bare).unwrap();
    let [kept, all] = balance.quality().samples;
    println!("{kept} of {all} at {} Hz", balance.quality().cutoff);
    assert!(2 * kept > all, "{kept} of {all}");
}
