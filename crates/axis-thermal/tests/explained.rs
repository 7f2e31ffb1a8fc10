//! What growth and warming friction explain of hours of a machine that follows other laws than the network's, and of
//! machines on which one of them, or both, or something else acts.

use axis_thermal::{GrowthLog, GrowthStretch, HeatExplained, HeldLog, ThermalModel};
use independent_axis::{HeatHours, HeatLaws, HeatNumbers, HeatedScrew, Parameters, Random};

use crate::brute_force::duty;
use crate::identify::assumed;

const FIVE_MINUTES: f64 = 300.0;
/// Noise of a probe, m, and of the friction's power, as a share.
const NOISE: [f64; 2] = [0.5e-6, 0.005];

/// A machine with so much of the growth, and friction that falls or does not, 6 % above what the model knows.
fn machine(growth: f64, laws: HeatLaws, cold: f64) -> HeatedScrew {
    let mut axis = Parameters::paper_with_measured_viscosity();
    axis.coulomb *= 1.06;
    axis.stiction *= 1.06;
    axis.viscous *= 0.95;
    let numbers = HeatNumbers {
        expansion: growth * HeatNumbers::OTHER.expansion,
        ..HeatNumbers::OTHER
    };
    HeatedScrew::at(axis, numbers, laws, cold)
}

const STEADY: HeatLaws = HeatLaws {
    viscosity: independent_axis::Viscosity::Exponential(0.0),
    dry: 0.0,
    preload: [0.0, 1.0],
    free_convection: true,
};

/// Hours of a machine, probed at two places each ten minutes. `besides`: growth (m) by time (s) and place (m), and a
/// factor on the friction's power.
fn log(
    of: &HeatHours,
    mut machine: HeatedScrew,
    besides: impl Fn(f64, f64) -> [f64; 2],
    stream: u64,
) -> GrowthLog {
    let (air, cold) = (of.air, (of.air)(0.0));
    let model = ThermalModel::new(assumed()).unwrap();
    let mut random = Random::new(17, stream);
    let mut log = GrowthLog::default();
    for (motion, count) in &of.duties {
        let duty = duty(&model, motion.as_ref());
        for _ in 0..*count {
            let (from, spent) = (machine.time, machine.friction_heat);
            machine.run(motion.as_ref(), FIVE_MINUTES, air);
            let power = (machine.friction_heat - spent) / FIVE_MINUTES;
            let t = machine.time;
            let probe = |x: f64| {
                let noise = NOISE[0] * random.normal();
                [x, machine.growth(cold, x) + besides(t, x)[0] + noise]
            };
            let found = match log.stretches.len() % 2 {
                1 => [0.5, 1.1].map(probe).to_vec(),
                _ => Vec::new(),
            };
            let noise = 1.0 + NOISE[1] * random.normal();
            log.stretches.push(GrowthStretch {
                duty: duty.clone(),
                duration: FIVE_MINUTES,
                air: [air(from), air(t)],
                found,
                friction: Some(power * besides(t, 0.0)[1] * noise),
                temperatures: Vec::new(),
            });
        }
    }
    log
}

fn explained(log: &GrowthLog) -> HeatExplained {
    let held = HeldLog {
        fitted: log.stretches.len() * 3 / 4,
        log: log.clone(),
    };
    let found = assumed().explain(&[held]).unwrap();
    for effect in [&found.growth, &found.warming].into_iter().flatten() {
        println!("{effect:?}");
    }
    println!("falls {:?} levels {:?}", found.falls, found.levels);
    found
}

fn named(found: &HeatExplained) -> [bool; 2] {
    [&found.growth, &found.warming].map(|effect| effect.as_ref().unwrap().named)
}

const NOTHING: fn(f64, f64) -> [f64; 2] = |_, _| [0.0, 1.0];

#[test]
fn each_of_the_two_is_named_where_it_acts_and_nowhere_else() {
    let hours = HeatHours::to_fit();
    let cold = (hours.air)(0.0);
    for (growth, laws, acts) in [
        (1.0, HeatLaws::OTHER, [true, true]),
        (1.0, STEADY, [true, false]),
        (0.0, HeatLaws::OTHER, [false, true]),
        (0.0, STEADY, [false, false]),
    ] {
        for stream in 0..2 {
            println!("--- {growth} {acts:?} {stream}");
            let begun = std::time::Instant::now();
            let log = log(&hours, machine(growth, laws, cold), NOTHING, stream);
            let found = explained(&log);
            println!("{:?}", begun.elapsed());
            println!("==> {:?}", named(&found));
        }
    }
}

#[test]
fn what_is_no_heat_is_not_named() {
    let hours = HeatHours::to_fit();
    let cold = (hours.air)(0.0);
    let slip = |t: f64, _: f64| [4e-9 * t, 1.0];
    let jump = |t: f64, _: f64| [if t > 6000.0 { 20e-6 } else { 0.0 }, 1.0];
    let rises = |t: f64, _: f64| [0.0, 1.0 - 1e-5 * t];
    let sways = |t: f64, x: f64| [20e-6 * x * (t / 1500.0).sin(), 1.0 + 0.05 * (t / 1500.0).sin()];
    let besides: [fn(f64, f64) -> [f64; 2]; 4] = [slip, jump, rises, sways];
    for (number, besides) in besides.into_iter().enumerate() {
        println!("--- {number}");
        let log = log(&hours, machine(0.0, STEADY, cold), besides, 5);
        let found = explained(&log);
        println!("==> {:?}", named(&found));
    }
}
