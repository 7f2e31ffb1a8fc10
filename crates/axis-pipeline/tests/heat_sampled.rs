//! A log of hours whose reference is sampled once a second, from a second simulator that shares no code.

use axis_log::Log;
use axis_pipeline::heat::{SlowLog, SlowLogOptions, explain, is_slow};
use axis_thermal::{GrowthOf, GrowthZero};
use independent_axis::{HeatedScrew, Motion, Parameters, Random, there_and_back};

use crate::heat::{axis, log};

/// A row each second: reference and its speed, scale, motor angle with wind-up, torque with that of
/// inertia, the nut's temperature.
fn each_second(stretches: &[(Option<&Motion>, f64)]) -> Log {
    let p = Parameters::paper_with_measured_viscosity();
    let mut machine = HeatedScrew::other(20.0);
    let mut random = Random::new(9, 3);
    let mut rows: [Vec<f64>; 7] = Default::default();
    for (motion, seconds) in stretches {
        for _ in 0..*seconds as u32 {
            machine.run(*motion, 1.0, |_| 20.0);
            let t = machine.time;
            let at = |t: f64| motion.map(|m| m.at(t.rem_euclid(m.duration())));
            let [x, v] = at(t).map_or([0.45, 0.0], |at| [at.position, at.velocity]);
            let ahead = at(t + 1e-4).map_or(0.0, |at| at.velocity);
            let a = 1e4 * (ahead - v);
            let w = v / p.travel();
            let dry =
                p.coulomb + (p.stiction - p.coulomb) * (-(w / p.stribeck_speed).powi(2)).exp();
            let [of_dry, of_viscous] = machine.friction_factors(x);
            let friction = if v == 0.0 {
                0.0
            } else {
                w.signum() * of_dry * dry + of_viscous * p.viscous * w
            };
            let torque = p.inertia() * a / p.travel() + friction;
            let grown = machine.growth(20.0, x);
            let angle = (x - grown + 2e-7 * torque) / p.travel();
            let row = [
                t,
                x,
                v,
                x + 1e-7 * random.normal(),
                angle,
                torque + 0.05 * random.normal(),
                machine.bodies[4] + 0.2 * random.normal(),
            ];
            for (column, value) in rows.iter_mut().zip(row) {
                column.push(value);
            }
        }
    }
    let names = [
        "t_s",
        "position_ref_m",
        "velocity_ref_m_s",
        "position_m",
        "motor_angle_rad",
        "torque_n_m",
        "nut_degc",
    ];
    log(names.into_iter().zip(rows).collect())
}

/// Such a log is one of hours, shows growth by scale and encoder and friction by the torque, and both effects are named.
#[test]
fn a_row_each_second_shows_growth_and_warming_friction() {
    let axis = axis();
    let a = there_and_back(0.45, 0.95, 0.2, 1.0);
    let b = there_and_back(0.1, 1.4, 0.15, 1.0);
    let log = each_second(&[
        (Some(&a), 3600.0),
        (None, 1200.0),
        (Some(&b), 2400.0),
        (Some(&a), 1800.0),
    ]);
    assert!(is_slow(&log));
    let slow = SlowLog::new(&axis, &log, &SlowLogOptions::default()).unwrap();
    assert_eq!(
        slow.reads(),
        (GrowthOf::ScrewLessScale, GrowthZero::FirstAtPlace)
    );
    let found = explain(&axis, &[slow], &[]).unwrap();
    for effect in [&found.growth, &found.warming] {
        let effect = effect.as_ref().unwrap();
        println!("{effect:?}");
        assert!(effect.named && effect.gaps[1].reduction() > 0.9);
    }
}
