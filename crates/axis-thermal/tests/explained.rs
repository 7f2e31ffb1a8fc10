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

/// Growth (m) at a place after so many seconds, and the share of the friction's power that is lost over the five minutes
/// before.
fn truth(of: &HeatHours, mut machine: HeatedScrew, [time, place]: [f64; 2]) -> [f64; 2] {
    let cold = (of.air)(0.0);
    for (motion, count) in &of.duties {
        for _ in 0..*count {
            let begun = machine.clone();
            machine.run(motion.as_ref(), FIVE_MINUTES, of.air);
            if machine.time >= time - 1.0 {
                let mut steady = HeatedScrew::at(begun.axis(), HeatNumbers::OTHER, STEADY, cold);
                steady.time = begun.time;
                steady.run(motion.as_ref(), FIVE_MINUTES, of.air);
                let spent = machine.friction_heat - begun.friction_heat;
                return [
                    machine.growth(cold, place),
                    1.0 - spent / steady.friction_heat,
                ];
            }
        }
    }
    [0.0; 2]
}

/// Both, one or none; sizes within their intervals.
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
        let machine = machine(growth, laws, cold);
        let found = explained(&log(&hours, machine.clone(), NOTHING, 0));
        assert_eq!(named(&found), acts);
        for (i, effect) in [found.growth, found.warming]
            .into_iter()
            .flatten()
            .enumerate()
        {
            let truth = truth(&hours, machine.clone(), effect.at)[i];
            let [from, to] = effect.size.interval;
            println!("{truth} in {from} to {to}");
            assert!((from..=to).contains(&truth), "{truth} {effect:?}");
            assert!(!acts[i] || effect.gaps[1].reduction() > 0.95);
        }
    }
}

/// What is below the detection limits is not named; what is half as much again is.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn detection_limits_hold() {
    let hours = HeatHours::to_fit();
    let cold = (hours.air)(0.0);
    let falls = |per_kelvin: f64| HeatLaws {
        viscosity: independent_axis::Viscosity::Exponential(per_kelvin),
        ..STEADY
    };
    for (k, are_named) in [(0.003, false), (0.016, true)] {
        let machine = machine(k, falls(0.3 * k), cold);
        let found = explained(&log(&hours, machine.clone(), NOTHING, 3));
        assert_eq!(named(&found), [are_named; 2]);
        for (i, effect) in [found.growth, found.warming]
            .into_iter()
            .flatten()
            .enumerate()
        {
            let share = truth(&hours, machine.clone(), effect.at)[i] / effect.limit;
            println!("{share} of {}", effect.limit);
            let expected = if are_named { 1.5..5.0 } else { 0.3..0.95 };
            assert!(expected.contains(&share), "{share} {effect:?}");
        }
    }
}

/// Drifts, jumps and sways that no heat makes.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn what_is_no_heat_is_not_named() {
    let hours = HeatHours::to_fit();
    let cold = (hours.air)(0.0);
    let slip: fn(f64, f64) -> [f64; 2] = |t, _| [4e-9 * t, 1.0];
    let jump: fn(f64, f64) -> [f64; 2] = |t, _| [if t > 6000.0 { 20e-6 } else { 0.0 }, 1.0];
    let falls: fn(f64, f64) -> [f64; 2] = |t, _| [0.0, 1.0 - 1e-5 * t];
    let sways: fn(f64, f64) -> [f64; 2] = |t, x| {
        let sway = (t / 1500.0).sin();
        [20e-6 * x * sway, 1.0 + 0.05 * sway]
    };
    for (besides, drifts) in [
        (slip, [true, false]),
        (jump, [false, false]),
        (falls, [false, true]),
        (sways, [false, false]),
    ] {
        let found = explained(&log(&hours, machine(0.0, STEADY, cold), besides, 5));
        assert_eq!(named(&found), [false, false]);
        let both = [&found.growth, &found.warming].map(|effect| effect.as_ref().unwrap());
        assert_eq!(both.map(|effect| effect.is_a_drift), drifts);
        // It is seen that something is there.
        assert!(both.iter().any(|effect| effect.gaps[1].stands_out()));
    }
}
