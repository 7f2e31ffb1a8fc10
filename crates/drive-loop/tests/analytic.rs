//! A loop that can be written down: a mass with viscous friction, its force held over each cycle.
//!
//! ```text
//! G_v = (1/c)(1 − p)/(z − p)      G_x = (1/c)(T/(z − 1) − (m/c)(1 − p)/(z − p))      p = e^(−cT/m)
//! L = (k_p + k_i T z/(z − 1)) (G_v + k_v G_x)
//! ```

use std::f64::consts::{PI, TAU};

use axis_sim::control::CascadeGains;
use axis_sim::{Axis, ClosedLoop, Outcome};
use compensator::NoCompensation;
use drive_loop::{LoopAnalysis, LoopError, LoopSet};
use nalgebra::Complex;

use crate::support::{GAINS, MASS, PERIOD, VISCOUS, example, slide, slide_late};

type Number = Complex<f64>;

/// L, and L_p with the speed loop closed.
fn open(frequency: f64) -> [Number; 2] {
    let z = Number::from_polar(1.0, frequency * PERIOD);
    let pole = (-VISCOUS * PERIOD / MASS).exp();
    let speed = Number::from(1.0 - pole) / (z - pole) / VISCOUS;
    let position = (Number::from(PERIOD) / (z - 1.0)
        - (z - pole).inv() * (MASS / VISCOUS * (1.0 - pole)))
        / VISCOUS;
    let [kp, ki, kv] = GAINS;
    let c = z / (z - 1.0) * (ki * PERIOD) + kp;
    let outer = c * position * kv;
    [c * speed + outer, outer / (c * speed + 1.0)]
}

fn frequencies() -> impl Iterator<Item = f64> {
    let top = PI / PERIOD;
    (0..=400_000).map(move |i| top * 1e-5_f64.powf(1.0 - f64::from(i) / 400_000.0))
}

#[test]
fn margins_of_a_mass_are_those_of_its_formula() {
    let found = LoopAnalysis::of(&slide(), &LoopSet::nominal()).unwrap();
    let own = found.own();
    assert!(own.stable && !own.at.stuck && own.radius < 1.0);
    for (place, cut) in [&own.command, &own.position].into_iter().enumerate() {
        let of = |w: f64| open(w)[place];
        let peak = frequencies()
            .map(|w| 1.0 / (of(w) + 1.0).norm())
            .fold(0.0, f64::max);
        // The source is late by its time constant, 0.16 µs.
        assert!(
            (cut.sensitivity.unwrap() - peak).abs() < 1e-3,
            "{cut:?} {peak}"
        );
        let late = frequencies()
            .map(|w| {
                let l = open(w).map(|l| l * Number::from_polar(1.0, -w * PERIOD));
                // The cycle of delay is within the speed loop, too.
                let inner = (open(w)[0] + 1.0) / (open(w)[1] + 1.0) - 1.0;
                let delayed = inner * Number::from_polar(1.0, -w * PERIOD);
                let outer = l[0] - delayed;
                let cut = [l[0], outer / (delayed + 1.0)][place];
                1.0 / (cut + 1.0).norm()
            })
            .fold(0.0, f64::max);
        assert!(
            (cut.sensitivity_late.unwrap() - late).abs() < 2e-3,
            "{cut:?} {late}"
        );
        let crossings: Vec<f64> = frequencies()
            .collect::<Vec<_>>()
            .windows(2)
            .filter(|w| (of(w[0]).norm() - 1.0) * (of(w[1]).norm() - 1.0) <= 0.0)
            .map(|w| w[0])
            .collect();
        let last = crossings.last().unwrap();
        assert!((cut.crossover_hz.unwrap() / (last / TAU) - 1.0).abs() < 1e-3);
        let phase = |w: &f64| PI + of(*w).arg();
        let delay = crossings
            .iter()
            .map(|w| phase(w) / w)
            .fold(f64::MAX, f64::min);
        assert!(
            (cut.delay_s.unwrap() / delay - 1.0).abs() < 2e-3,
            "{cut:?} {delay}"
        );
        let least = crossings
            .iter()
            .map(phase)
            .fold(f64::MAX, f64::min)
            .to_degrees();
        assert!(
            (cut.phase_deg.unwrap() - least).abs() < 0.05,
            "{cut:?} {least}"
        );
    }
}

/// y/F = 2πf/(k_i k_v) at low frequencies.
#[test]
fn the_integral_holds_a_slow_force() {
    let found = LoopAnalysis::of(&slide(), &LoopSet::nominal()).unwrap();
    let curves = &found.curves[0];
    let at = curves.frequency_hz.iter().position(|f| *f > 0.2).unwrap();
    let [re, im] = curves.compliance[at];
    let [_, ki, kv] = GAINS;
    let expected = TAU * curves.frequency_hz[at] / (ki * kv);
    assert!(
        (re.hypot(im) / expected - 1.0).abs() < 0.01,
        "{} {expected}",
        re.hypot(im)
    );
}

/// Delay of the force where the edge is looked for, µs: it puts the edge far below the frequencies at
/// which the simulation's steps show.
const DELAY: u32 = 1000;

fn with_speed_gain(factor: f64) -> Axis {
    let mut axis = slide_late(DELAY);
    let [kp, ki, kv] = GAINS;
    let gains = CascadeGains {
        position: kv,
        speed: factor * kp,
        speed_integral: factor * ki,
        acceleration_feedforward: None,
        notch: None,
    };
    let values = axis
        .control
        .retuned(axis.control.values(), &gains, 1.0)
        .unwrap();
    axis.control.change(|own| *own = values).unwrap();
    axis
}

/// Deviation of the command over the second half of a standstill, N.
fn ringing(axis: &Axis) -> f64 {
    let closed = ClosedLoop::new(axis).unwrap();
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let mut most = 0.0_f64;
    let outcome = closed.run(&motion, &mut NoCompensation, |cycle| {
        if (0.4..0.8).contains(&cycle.time) {
            most = most.max(cycle.command.effort.abs());
        }
    });
    match outcome {
        Outcome::Completed => most,
        _ => f64::INFINITY,
    }
}

/// The gain margin is where the simulated axis begins to swing, which reads nothing of the analysis.
#[test]
fn the_gain_margin_is_the_edge_of_the_simulated_axis() {
    let found = LoopAnalysis::of(&slide_late(DELAY), &LoopSet::nominal()).unwrap();
    let most = found.own().command.gain_up.unwrap();
    let [below, above] = [0.93, 1.07].map(|by| with_speed_gain(by * most));
    // Cruising takes 30 N of friction and little more.
    assert!(ringing(&below) < 200.0, "{}", ringing(&below));
    assert!(ringing(&above) > 1900.0, "{}", ringing(&above));
    let stable = |axis: &Axis| {
        let found = LoopAnalysis::of(axis, &LoopSet::nominal()).unwrap();
        (found.own().stable, found.own().radius < 1.0)
    };
    assert_eq!(stable(&below), (true, true));
    assert_eq!(stable(&above), (false, false));
}

#[test]
fn what_is_wrong_is_said() {
    let said = |set: LoopSet| match LoopAnalysis::of(&slide(), &set) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{set:?}"),
    };
    let masses = |masses| LoopSet {
        masses,
        ..LoopSet::default()
    };
    assert!(said(masses(vec![0.0])).contains("mass is 0; valid: from 0.001 to 1000"));
    assert!(said(masses(Vec::new())).contains("one share at least"));
    let late = LoopSet {
        delay: -1.0,
        ..LoopSet::default()
    };
    assert!(said(late).contains("delay is -1; valid: from 0 to 16"));
    let nowhere = LoopSet {
        positions: vec![f64::NAN],
        ..LoopSet::default()
    };
    assert!(said(nowhere).contains("position NaN is outside"));
    let far = LoopSet {
        positions: vec![7.0],
        ..LoopSet::nominal()
    };
    let error = LoopAnalysis::of(&example("liu2025"), &far).unwrap_err();
    assert!(matches!(error, LoopError::OutsideStroke { .. }), "{error}");
}
