//! The voltage of a motor comes late by computing and PWM: against the loop by hand.

use std::f64::consts::PI;

use axis_sim::{Axis, ClosedLoop, Cycle, Sensors};
use compensator::{Compensator, Correction, Drive, Plan, PlanSettings, Reference, Sample, Target};
use trajectories::Motion;

use crate::{Dwell, changed};

const PERIOD: f64 = 1e-4;
/// k_p T/L of 90 V/A and 18 mH.
const GAIN: f64 = 90.0 * PERIOD / 0.018;

/// The linear motor without resistance and an integral in its current controllers, its slide so
/// heavy that it does not move.
fn stuck(delay: &str) -> Axis {
    changed(
        "linear-motor.toml",
        &[
            ("slide_mass_kg = 40", "slide_mass_kg = 1e6"),
            ("resistance_ohm = 2.5", "resistance_ohm = 0"),
            (
                "current_d_integral_v_per_a_s = 12500",
                "current_d_integral_v_per_a_s = 0",
            ),
            (
                "current_q_integral_v_per_a_s = 12500",
                "current_q_integral_v_per_a_s = 0",
            ),
            ("current_delay_periods = 0", delay),
            ("coulomb_n = 25", "coulomb_n = 0"),
            ("viscous_n_s_per_m = 50", "viscous_n_s_per_m = 0"),
            ("kv_m_per_min_per_mm = 5", "kv_m_per_min_per_mm = 1e-6"),
            (
                "speed_proportional_a_s_per_m = 180",
                "speed_proportional_a_s_per_m = 1e-6",
            ),
            ("step_us = 50", "step_us = 25"),
        ],
    )
}

/// What the command is in each cycle.
struct Asked<F>(F, u32);

impl<F: FnMut(u32) -> f64> Compensator for Asked<F> {
    fn reset(&mut self) {
        self.1 = 0;
    }

    fn correct(&mut self, _: &Sample) -> Correction {
        self.1 += 1;
        Correction {
            position: 0.0,
            command: (self.0)(self.1 - 1),
        }
    }
}

fn run(axis: &Axis, cycles: usize, asked: impl FnMut(u32) -> f64) -> Vec<Cycle> {
    let rest = Dwell {
        at: axis.stroke.start,
        duration: cycles as f64 * axis.period,
    };
    let mut all = Vec::new();
    ClosedLoop::new(axis)
        .unwrap()
        .run(&rest, &mut Asked(asked, 0), |c| all.push(*c))
        .completed()
        .unwrap();
    all
}

/// A step of the current by hand: the winding integrates a voltage that is made of a sample and
/// acts for one period from `late` periods after it on.
fn by_hand(late: f64, cycles: usize) -> Vec<f64> {
    let steps = 1000;
    let wait = (late * f64::from(steps)).round() as usize;
    let mut under_way = std::collections::VecDeque::from(vec![0.0; wait]);
    let (mut current, mut seen) = (0.0_f64, Vec::new());
    for _ in 0..cycles {
        seen.push(current);
        let voltage = 1.0 - current;
        for _ in 0..steps {
            under_way.push_back(voltage);
            current += GAIN / f64::from(steps) * under_way.pop_front().unwrap();
        }
    }
    seen
}

#[test]
fn a_step_of_the_current_is_that_of_a_late_voltage() {
    for (key, late) in [
        ("current_delay_periods = 0", 0.0),
        ("current_delay_periods = 1", 0.5),
        ("current_delay_periods = 1.1", 0.6),
        ("current_delay_periods = 1.5", 1.0),
        ("current_delay_periods = 2.25", 1.75),
        // The usual one, where the file says nothing.
        ("", 1.0),
    ] {
        let cycles = run(&stuck(key), 40, |_| 1.0);
        for (c, by_hand) in cycles.iter().zip(by_hand(late, 40)) {
            let off = c.current.q - by_hand;
            assert!(off.abs() < 1e-6, "{key}, {} s: {off:e} A", c.time);
        }
    }
}

/// With the voltage 1.5 periods late, |L| = 1 at ω T = 2 asin(κ/2) and L has the phase
/// −90° − 1.5 ω T there, so that the closed loop has the gain 1/(2 sin(φ/2)) of its phase margin
/// φ = 90° − 1.5 ω T. Late by the hold alone it is 90° − 0.5 ω T.
#[test]
fn phase_margin_is_that_of_the_delay() {
    let angle = 2.0 * (0.5 * GAIN).asin();
    for (key, delay) in [
        ("current_delay_periods = 0", 0.5),
        ("current_delay_periods = 1.5", 1.5),
        ("current_delay_periods = 2.5", 2.5),
    ] {
        let cycles = run(&stuck(key), 4000, |k| (angle * f64::from(k)).sin());
        let mut sums = [0.0; 2];
        let late = &cycles[2000..];
        for (k, c) in late.iter().enumerate() {
            let (sin, cos) = (angle * (k + 2000) as f64).sin_cos();
            sums[0] += 2.0 * c.current.q * sin / late.len() as f64;
            sums[1] += 2.0 * c.current.q * cos / late.len() as f64;
        }
        let margin = 0.5 * PI - delay * angle;
        let (gain, expected) = (sums[0].hypot(sums[1]), 0.5 / (0.5 * margin).sin());
        println!("{key}: {gain} of {expected}, {} deg", margin.to_degrees());
        assert!(
            (gain / expected - 1.0).abs() < 2e-3,
            "{key}: {gain} {expected}"
        );
    }
}

/// Half a period is the hold's own.
#[test]
fn none_is_a_voltage_that_is_held_from_its_sample_on() {
    let moves = |key| {
        let axis = changed("linear-motor.toml", &[("current_delay_periods = 0", key)]);
        crate::follow(&ClosedLoop::new(&axis).unwrap(), 2)
    };
    let position = |cycles: Vec<Cycle>| cycles.iter().map(|c| c.position).collect::<Vec<_>>();
    let none = position(moves("current_delay_periods = 0"));
    assert_eq!(none, position(moves("current_delay_periods = 0.5")));
    assert_ne!(none, position(moves("current_delay_periods = 1.5")));
}

fn refused(from: &str, to: &str) -> String {
    let text = crate::text("linear-motor.toml").replace(from, to);
    match Axis::parse("linear-motor.toml", &text) {
        Err(error) => error.to_string(),
        Ok(axis) => ClosedLoop::new(&axis).unwrap_err().to_string(),
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let error = refused("current_delay_periods = 0 ", "current_delay_periods = 0.3 ");
    assert!(error.contains("current_delay_periods"), "{error}");
    // At 4 kHz the gain of 800 Hz is beyond what one period of computing leaves, and within what
    // none does.
    let slow = |delay: &str| {
        crate::text("linear-motor.toml")
            .replace("frequency_khz = 10", "frequency_khz = 4")
            .replace("current_delay_periods = 0 ", delay)
    };
    let loops = |text: &str| {
        Axis::parse("slow.toml", text)
            .map_err(|e| e.to_string())
            .and_then(|axis| ClosedLoop::new(&axis).map(drop).map_err(|e| e.to_string()))
    };
    assert!(loops(&slow("current_delay_periods = 0 ")).is_ok());
    let error = loops(&slow("")).unwrap_err();
    println!("{error}");
    assert!(error.contains("current_d_proportional"), "{error}");
}

/// The rotor turns by a quarter of an electrical period in the 1.5 periods; the drive's currents
/// stay as they are without a delay, since it turns its voltage ahead.
#[test]
fn the_angle_is_compensated() {
    let at = |key| {
        let axis = changed("rotary-table.toml", &[("current_delay_periods = 0", key)]);
        let cycles = crate::follow(&ClosedLoop::new(&axis).unwrap(), 1);
        // In even motion.
        let middle = cycles.iter().filter(|c| c.reference.acceleration == 0.0);
        let middle: Vec<&Cycle> = middle.filter(|c| c.reference.velocity > 3.0).collect();
        assert!(middle.len() > 100, "{}", middle.len());
        let mean =
            |of: fn(&Cycle) -> f64| middle.iter().map(|c| of(c)).sum::<f64>() / middle.len() as f64;
        [mean(|c| c.current.d), mean(|c| c.current.q)]
    };
    let (none, late) = (
        at("current_delay_periods = 0"),
        at("current_delay_periods = 1.5"),
    );
    println!("{none:?} A, {late:?} A");
    assert!((none[0] - late[0]).abs() < 1e-3 && (none[1] - late[1]).abs() < 1e-3);
}

/// Peak error of a plan in which the axis is as assumed but for what the voltage is late, µm, its
/// sensors perfect.
fn planned(delay: &str, assumed_late: f64) -> f64 {
    let mut axis = changed("linear-motor.toml", &[("current_delay_periods = 0", delay)]);
    axis.sensors = Sensors::default();
    let mut model = axis.drive_model().unwrap();
    if let Drive::FieldOriented { late, .. } = &mut model.drive {
        *late = assumed_late;
    }
    let motion = axis.plan(&axis.trajectories[1]).unwrap();
    let targets = |k: usize| {
        let s = motion.at(k as f64 * axis.period);
        Target::of(Reference {
            position: s.position,
            velocity: s.velocity,
            acceleration: s.acceleration,
        })
    };
    let mut plan = Plan::new(&model, &PlanSettings::default(), targets).unwrap();
    let mut most = 0.0_f64;
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut plan, |c| {
            most = most.max(1e6 * c.error().abs())
        })
        .completed()
        .unwrap();
    most
}

/// A plan asks for each voltage as much earlier as it comes late.
#[test]
fn plans_count_it() {
    let none = planned("current_delay_periods = 0", 0.0);
    for (delay, late) in [
        ("current_delay_periods = 1.5", 1.0),
        ("current_delay_periods = 2.25", 1.75),
    ] {
        let [counted, not] = [late, 0.0].map(|late| planned(delay, late));
        println!("{delay}: {counted:.4} µm, {not:.4} not counted, {none:.4} without a delay");
        assert!(counted < 0.4 * not, "{counted} {not} {none}");
    }
}
