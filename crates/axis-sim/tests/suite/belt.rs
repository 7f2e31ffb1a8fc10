//! The belt's stiffness over the carriage's position, as the loop shows it.

use std::f64::consts::TAU;

use axis_sim::ClosedLoop;
use axis_sim::actuator::ACTUATORS;
use axis_sim::part::{Part, Values, named};
use compensator::{Compensator, Correction, Sample};

use crate::{Dwell, change, changed};

/// A kick of the command in the first cycle, small enough that the carriage stays there.
struct Kick(bool);

impl Compensator for Kick {
    fn reset(&mut self) {
        self.0 = true;
    }
    fn correct(&mut self, _: &Sample) -> Correction {
        let command = if std::mem::take(&mut self.0) {
            0.1
        } else {
            0.0
        };
        Correction {
            command,
            ..Correction::default()
        }
    }
}

/// Frequency of what rings after the kick with the carriage at `x`, Hz, and of the
/// mechanism's mode there.
fn rings(x: f64) -> [f64; 2] {
    let mut axis = changed(
        "belt.toml",
        &[
            ("stiffness_damping_ms = 0.1", "stiffness_damping_ms = 0.002"),
            ("viscous_n_s_per_m = 30", "viscous_n_s_per_m = 0"),
            ("coulomb_n = 25", "coulomb_n = 1e-6"),
            ("stiction_n = 30", "stiction_n = 1e-6"),
            (
                "bristle_stiffness_n_per_um = 1",
                "bristle_stiffness_n_per_m = 0.1",
            ),
            (
                "bristle_damping_n_s_per_m = 1000",
                "bristle_damping_n_s_per_m = 0",
            ),
            ("step_us = 62.5", "step_us = 12.5"),
        ],
    );
    axis.sensors = axis_sim::Sensors::default();
    // A motor under current control answers to its own speed: a torque does not.
    let mut source = Values::default();
    source.set("torque_limit", 100.0);
    source.set("bandwidth", 1e4);
    axis.actuator = Part::new(named(ACTUATORS, "torque-source").unwrap(), source).unwrap();
    // A loop that hardly acts, so that motor and carriage swing freely.
    change(
        &mut axis.control,
        &[("speed_proportional", 1e-6), ("kv", 1e-3)],
    );
    let travel = axis.travel_per_radian();
    let motion = Dwell {
        at: x,
        duration: 0.3,
    };
    let mut swing = Vec::new();
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut Kick(true), |c| {
            if c.time > 0.05 {
                swing.push((c.time, travel * c.motor_speed - c.load_speed));
            }
        })
        .completed()
        .unwrap();
    let ups: Vec<f64> = swing
        .windows(2)
        .filter(|w| w[0].1 < 0.0 && w[1].1 >= 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
        .collect();
    assert!(ups.len() > 5, "it does not ring");
    let frequency = (ups.len() - 1) as f64 / (ups[ups.len() - 1] - ups[0]);
    [frequency, axis.mechanism.modes(x).unwrap()[0] / TAU]
}

#[test]
fn the_resonance_follows_the_carriage() {
    // Both strands: k = 632 500 N (1/(0.3 + x) + 1/(2.3 − x)), symmetric about 1 m.
    let carriage = 12.0;
    let motor: f64 = 1.8e-4 + 6e-4 / 25.0;
    let travel: f64 = 0.063662 / 2.0 / 5.0;
    let mut lowest = f64::MAX;
    for x in [0.01, 0.4, 1.0, 1.6, 1.99] {
        let [rings, mode] = rings(x);
        let stiffness = 632_500.0 * (1.0 / (0.3 + x) + 1.0 / (2.3 - x));
        let by_hand = (stiffness * (1.0 / carriage + travel * travel / motor)).sqrt() / TAU;
        println!("x = {x} m: {rings:.3} Hz, mode {mode:.3} Hz, by hand {by_hand:.3} Hz");
        // Measured 4e-16.
        assert!((mode / by_hand - 1.0).abs() < 4e-15);
        // Measured 3.5e-5: the carriage drifts while it rings.
        let off = (rings / by_hand - 1.0).abs();
        assert!(off < 2e-4, "{x}: {rings} {by_hand}");
        lowest = rings.min(lowest);
    }
    // From end to middle it falls by a third.
    assert!((rings(0.01)[0] / lowest - 1.5429).abs() < 1e-3);
}
