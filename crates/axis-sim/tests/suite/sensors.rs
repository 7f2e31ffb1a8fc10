//! Sensors against the same done by hand on the true position.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use axis_sim::{Axis, ClosedLoop, Cycle, Measured, Sensors};
use compensator::NoCompensation;
use trajectories::{Limits, SCurve};

use crate::{OTHERS, bits, changed, follow};

fn motion(axis: &Axis) -> SCurve {
    let limits = Limits::new(0.2, 2.0, 50.0).unwrap();
    let start = axis.stroke.start;
    SCurve::plan(start, start + 0.03, &limits).unwrap()
}

fn run(axis: &Axis, seed: u64, sense: impl FnMut(&mut Measured)) -> Vec<Cycle> {
    let mut cycles = Vec::new();
    ClosedLoop::new(axis)
        .unwrap()
        .with_seed(seed)
        .run_sensed(&motion(axis), &mut NoCompensation, sense, |c| {
            cycles.push(*c)
        })
        .completed()
        .unwrap();
    cycles
}

/// The rack's file with other keys of its scale, and perfect but for that.
fn with_scale(keys: &str) -> Axis {
    let mut axis = changed(
        "rack.toml",
        &[(
            "resolution_um = 0.1\nsignal_period_um = 40\nperiodic_error_um = 0.2",
            keys,
        )],
    );
    axis.sensors.motor = None;
    axis
}

fn perfect(axis: &Axis) -> Axis {
    Axis {
        sensors: Sensors::default(),
        ..axis.clone()
    }
}

/// Greatest distance of two runs' positions, true and measured.
fn apart(a: &[Cycle], b: &[Cycle]) -> f64 {
    assert_eq!(a.len(), b.len());
    let far = |a: &Cycle, b: &Cycle| {
        let measured = (a.measured.position - b.measured.position).abs();
        measured.max((a.position - b.position).abs())
    };
    a.iter().zip(b).map(|(a, b)| far(a, b)).fold(0.0, f64::max)
}

#[test]
fn a_scale_with_steps_and_a_periodic_error() {
    let axis = with_scale(
        "resolution_um = 0.5\nsignal_period_um = 20\nperiodic_error_um = 3\nphase_deg = 30",
    );
    let by_hand = run(&perfect(&axis), 0, |m| {
        let error = 3e-6 * (TAU * m.position / 20e-6 + 30f64.to_radians()).sin();
        m.position = 0.5e-6 * ((m.position + error) / 0.5e-6).round();
    });
    let cycles = run(&axis, 0, |_| ());
    // Measured 0, of positions of half a metre: neither falls on the other side of a step.
    let far = apart(&cycles, &by_hand);
    println!("steps and period: {far:e} m");
    assert!(far < 1e-15, "{far:e}");
    for c in &cycles {
        let steps = c.measured.position / 0.5e-6;
        assert!((steps - steps.round()).abs() < 1e-6);
        assert!((c.measured.position - c.position).abs() <= 3.25e-6 + 1e-12);
    }
    // It is felt: the loop follows the error of the scale.
    let without = run(&perfect(&axis), 0, |_| ());
    assert!(apart(&cycles, &without) > 2e-6);
}

#[test]
fn a_scale_that_is_late() {
    // 2.4 cycles of 125 µs.
    let axis = with_scale("delay_us = 300");
    let mut past: VecDeque<f64> = VecDeque::new();
    let by_hand = run(&perfect(&axis), 0, |m| {
        past.push_front(m.position);
        past.truncate(4);
        let at = |k: usize| past[k.min(past.len() - 1)];
        m.position = 0.6 * at(2) + 0.4 * at(3);
    });
    let cycles = run(&axis, 0, |_| ());
    let far = apart(&cycles, &by_hand);
    println!("late: {far:e} m");
    // Measured 0.
    assert!(far < 1e-15, "{far:e}");
    // At a steady speed it lags by v · 300 µs.
    let cruise = cycles
        .iter()
        .map(|c| (c.load_speed, c.position - c.measured.position));
    let most = cruise.fold((0.0, 0.0), |a: (f64, f64), b| if b.0 > a.0 { b } else { a });
    assert!((most.1 / (300e-6 * most.0) - 1.0).abs() < 1e-3, "{most:?}");
}

#[test]
fn noise_has_its_size_and_its_seed() {
    let axis = with_scale("noise_um = 2");
    let (first, again, other) = (
        run(&axis, 3, |_| ()),
        run(&axis, 3, |_| ()),
        run(&axis, 4, |_| ()),
    );
    let all = |cycles: &[Cycle]| cycles.iter().flat_map(bits).collect::<Vec<u64>>();
    assert!(all(&first) == all(&again));
    assert!(all(&first) != all(&other));
    let noise: Vec<f64> = first
        .iter()
        .map(|c| 1e6 * (c.measured.position - c.position))
        .collect();
    let n = noise.len() as f64;
    let mean = noise.iter().sum::<f64>() / n;
    let deviation = (noise.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt();
    let next = noise.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n / deviation.powi(2);
    println!("{n} samples: mean {mean:.4}, deviation {deviation:.4} µm, correlation {next:.4}");
    // Four standard errors of a white noise of 2 µm.
    let error = 1.0 / n.sqrt();
    assert!(mean.abs() < 4.0 * 2.0 * error, "{mean}");
    assert!(
        (deviation / 2.0 - 1.0).abs() < 4.0 * error / 2f64.sqrt(),
        "{deviation}"
    );
    assert!(next.abs() < 4.0 * error, "{next}");
    // Motor and load sensor have streams of their own.
    let mut both = axis.clone();
    both.sensors.motor = changed(
        "joint.toml",
        &[("resolution_arcsec = 10", "noise_arcsec = 60")],
    )
    .sensors
    .motor;
    let cycles = run(&both, 3, |_| ());
    let pairs = cycles.iter().map(|c| {
        let load = 1e6 * (c.measured.position - c.position) / 2.0;
        let motor = (c.measured.motor_angle - c.motor_angle) / (60.0 / 3600f64).to_radians();
        load * motor
    });
    let together = pairs.sum::<f64>() / cycles.len() as f64;
    assert!(together.abs() < 4.0 * error, "{together}");
}

/// An encoder's angle and the speed that a drive makes of it; a cycle before the start it
/// showed the same, so that the first difference is no speed.
#[test]
fn an_encoder_at_the_motor_gives_angle_and_speed() {
    let mut axis = changed(
        "rack.toml",
        &[(
            "resolution_arcsec = 0.3",
            "resolution_arcmin = 1\nperiodic_error_arcsec = 90",
        )],
    );
    axis.sensors.load = axis_sim::LoadSensor::Perfect;
    let minute = TAU / 360.0 / 60.0;
    let shown = |angle: f64| {
        let error = 1.5 * minute * (2048.0 * angle).sin();
        minute * ((angle + error) / minute).round()
    };
    let mut last = shown(axis.stroke.start / axis.travel_per_radian());
    let by_hand = run(&perfect(&axis), 0, |m| {
        m.motor_angle = shown(m.motor_angle);
        m.motor_speed = (m.motor_angle - last) / (1.0 / 8000.0);
        last = m.motor_angle;
    });
    let cycles = run(&axis, 0, |_| ());
    let far = apart(&cycles, &by_hand);
    let speed = cycles.iter().zip(&by_hand);
    let speed = speed.map(|(a, b)| (a.measured.motor_speed - b.measured.motor_speed).abs());
    let speed = speed.fold(0.0, f64::max);
    println!("encoder: {far:e} m, {speed:e} rad/s");
    // Measured 0 and 0.
    assert!(far < 1e-15 && speed < 1e-12, "{far:e} {speed:e}");
    assert_eq!(cycles[0].measured.motor_speed, 0.0);
    // Steps of a minute in a cycle.
    let step = minute * 8000.0;
    assert!(
        cycles
            .iter()
            .any(|c| c.measured.motor_speed.abs() > 0.9 * step)
    );
}

/// A resolver's error repeats twice in each of its periods.
#[test]
fn a_resolver_is_off_twice_a_period() {
    let axis = changed("belt.toml", &[]);
    let closed_loop = ClosedLoop::new(&axis).unwrap();
    let cycles = follow(&closed_loop, 2);
    let step = TAU / 3.0 / f64::from(1 << 14);
    let error = 8.0 / 60.0 * TAU / 360.0;
    for c in &cycles {
        let by_hand = c.motor_angle + error * (6.0 * c.motor_angle).sin();
        let off = (c.measured.motor_angle - by_hand).abs();
        assert!(off <= 0.5 * step + 1e-9, "{off}");
    }
    let mut far = 0.0_f64;
    // Without a sensor at the load, its position is the motor's from the start's on.
    for c in &cycles {
        let turned = c.measured.motor_angle - cycles[0].measured.motor_angle;
        let position = cycles[0].position + axis.travel_per_radian() * turned;
        far = far.max((c.measured.position - position).abs());
    }
    println!("homed: {far:e} m");
    // Measured 5.6e-17.
    assert!(far < 5e-16, "{far:e}");
}

/// Where motor and load are one, what the load's sensor shows is what the speed is made of.
#[test]
fn a_direct_drive_knows_its_speed_from_the_load() {
    for file in OTHERS {
        let axis = crate::axis(file);
        if axis.mechanism.has_motor_encoder() {
            continue;
        }
        let cycles = follow(&ClosedLoop::new(&axis).unwrap(), 2);
        assert_eq!(cycles[0].measured.motor_speed, 0.0, "{file}");
        let mut off = 0.0_f64;
        for pair in cycles.windows(2) {
            let way = pair[1].measured.position - pair[0].measured.position;
            let speed = way / axis.period;
            off = off.max((pair[1].measured.motor_speed - speed).abs());
        }
        println!("{file}: {off:e}");
        // Measured 0.
        assert!(off < 1e-12, "{file}: {off:e}");
    }
}
