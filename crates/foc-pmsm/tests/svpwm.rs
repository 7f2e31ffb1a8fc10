//! Duty cycles: linear range, hexagon, overmodulation, six-step.

use crate::axis::{DC_VOLTAGE, drawn_dc_voltage};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm, sector};
use foc_pmsm::{AlphaBeta, FocError};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_3, PI, TAU};

const MODES: [Overmodulation; 2] = [
    Overmodulation::MinimumPhaseError,
    Overmodulation::MinimumMagnitudeError,
];

pub fn modulator(mode: Overmodulation) -> Svpwm {
    Svpwm::new(DC_VOLTAGE, mode).unwrap()
}

pub fn vector(length: f64, angle: f64) -> AlphaBeta {
    AlphaBeta {
        alpha: length * angle.cos(),
        beta: length * angle.sin(),
    }
}

pub fn distance(a: AlphaBeta, b: AlphaBeta) -> f64 {
    (a.alpha - b.alpha).hypot(a.beta - b.beta)
}

/// The classical recipe: dwell times of the two active vectors of the
/// sector by the law of sines, the rest halved between the zero vectors.
fn by_dwell_times(u: AlphaBeta, dc_voltage: f64) -> [f64; 3] {
    let length = u.alpha.hypot(u.beta);
    let angle = u.beta.atan2(u.alpha).rem_euclid(TAU);
    let n = (angle / FRAC_PI_3).floor();
    let within = angle - n * FRAC_PI_3;
    let gain = 3f64.sqrt() * length / dc_voltage;
    let first = gain * (FRAC_PI_3 - within).sin();
    let second = gain * within.sin();
    let zero = 0.5 * (1.0 - first - second);
    let (high, low) = (1.0 - zero, zero);
    // In odd sectors the first vector has one leg up, in even ones two.
    match n as u8 {
        0 => [high, zero + second, low],
        1 => [zero + first, high, low],
        2 => [low, high, zero + second],
        3 => [low, zero + first, high],
        4 => [zero + second, low, high],
        _ => [high, low, zero + first],
    }
}

/// The fundamental of the voltage made from a vector of constant length in
/// steady rotation.
fn fundamental(length: f64, make: impl Fn(AlphaBeta) -> AlphaBeta) -> f64 {
    let n = 60_000;
    let sum: f64 = (0..n)
        .map(|k| {
            let angle = TAU * (f64::from(k) + 0.5) / f64::from(n);
            make(vector(length, angle)).park(angle).d
        })
        .sum();
    sum / f64::from(n)
}

#[test]
fn sectors_are_sixty_degrees_each() {
    for k in 0..3600 {
        let angle = (f64::from(k) + 0.5) * TAU / 3600.0;
        assert_eq!(sector(vector(100.0, angle)), 1 + (k / 600) as u8, "{angle}");
    }
    assert_eq!(sector(AlphaBeta::<f64>::default()), 1);
    assert_eq!(sector(vector(1.0, 0.0)), 1);
}

#[test]
fn zero_voltage_is_half_duty() {
    let half = Duties::new(0.5, 0.5, 0.5).unwrap();
    assert_eq!(modulator(MODES[0]).duties(AlphaBeta::default()), half);
}

/// U_dc/√3 is the largest circle: it is made at every angle, and 0.01 %
/// more is not made at 30°, where it touches the hexagon.
#[test]
fn the_linear_circle_has_radius_u_over_root_three() {
    let m = modulator(MODES[0]);
    assert!((m.linear_limit() - DC_VOLTAGE / 3f64.sqrt()).abs() < 2e-13);
    for k in 0..3600 {
        let u = vector(m.linear_limit(), f64::from(k) * TAU / 3600.0);
        assert!(distance(m.voltage(m.duties(u)), u) < 1e-12); // 1.3e-13 V measured
    }
    for mode in MODES {
        let more = vector(m.linear_limit() * 1.0001, PI / 6.0);
        let made = modulator(mode).voltage(modulator(mode).duties(more));
        // 4.6e-14 V measured.
        assert!((distance(made, more) - m.linear_limit() * 1e-4).abs() < 4e-13);
    }
}

#[test]
fn six_step_fundamental_is_two_over_pi() {
    let m = modulator(MODES[0]);
    let made = fundamental(1.0, |u| m.voltage(m.six_step(u)));
    // The midpoint sum over 60 000 angles errs by 4.6e-10 relative.
    assert!((made / m.six_step_limit() - 1.0).abs() < 4e-9);
    assert!((m.six_step_limit() / DC_VOLTAGE - 2.0 / PI).abs() < 1e-15);
}

/// Along the hexagon's edge the mean of (U/√3)/cos over ±30° is
/// √3 ln 3/π U = 0.6057 U, the most that keeping the angle can give.
#[test]
fn minimum_phase_error_ends_on_the_hexagon() {
    let m = modulator(Overmodulation::MinimumPhaseError);
    let expected = 3f64.sqrt() * 3f64.ln() / PI * DC_VOLTAGE;
    let made = fundamental(10.0 * DC_VOLTAGE, |u| m.voltage(m.duties(u)));
    assert!((made / expected - 1.0).abs() < 4e-9); // 5.5e-10 measured
}

/// With a reference of length m the nearest-point rule stays off a corner
/// only within about (edge/2)/m of the sector's middle, so that it loses
/// O(1/m²) against the six-step fundamental.
#[test]
fn minimum_magnitude_error_tends_to_six_step() {
    let m = modulator(Overmodulation::MinimumMagnitudeError);
    let lost = |length: f64| {
        let made = fundamental(length * DC_VOLTAGE, |u| m.voltage(m.duties(u)));
        1.0 - made / m.six_step_limit()
    };
    let (near, far) = (lost(5.0), lost(50.0));
    // 7.4e-4 and 7.4e-6 measured.
    assert!(near < 5e-3 && far < 5e-5, "{near} {far}");
    let ratio = near / far;
    assert!(
        (95.0..105.0).contains(&ratio),
        "second order in 1/length: {ratio}"
    );
}

#[test]
fn validation_and_nan() {
    for bad in [0.0, -540.0, f64::NAN, f64::INFINITY] {
        let error = Svpwm::new(bad, MODES[0]).unwrap_err();
        assert!(matches!(
            error,
            FocError::OutOfRange {
                field: "dc_voltage",
                ..
            }
        ));
    }
    let m = modulator(MODES[0]);
    assert!(
        m.duties(AlphaBeta {
            alpha: f64::NAN,
            beta: 0.0
        })
        .a()
        .is_nan()
    );
}

fn duties_in_range(d: Duties) -> bool {
    [d.a(), d.b(), d.c()]
        .iter()
        .all(|x| (0.0..=1.0).contains(x))
}

proptest! {
    #[test]
    fn linear_range_is_exact(
        voltage in drawn_dc_voltage(), fraction in 0.0..1.0, angle in -PI..PI, which in 0..2usize,
    ) {
        let m = Svpwm::new(voltage, MODES[which]).unwrap();
        let u = vector(fraction * m.linear_limit(), angle);
        let d = m.duties(u);
        prop_assert!(duties_in_range(d));
        // Rounding of duties near 1: 2.2e-16 measured.
        prop_assert!(distance(m.voltage(d), u) < 2e-15 * voltage);
        // The two zero vectors share their time: that is what makes it SVPWM.
        let legs = [d.a(), d.b(), d.c()];
        let high = legs.into_iter().fold(0.0, f64::max);
        let low = legs.into_iter().fold(1.0, f64::min);
        prop_assert!((1.0 - high - low).abs() < 5e-16); // 5.6e-17 measured
        // atan2, sin and a difference of angles: 1.6e-15 measured.
        for (leg, slow) in legs.into_iter().zip(by_dwell_times(u, voltage)) {
            prop_assert!((leg - slow).abs() < 1e-14);
        }
    }

    #[test]
    fn overmodulation_keeps_the_angle_or_the_distance(
        voltage in drawn_dc_voltage(), length in 0.0..5.0, angle in -PI..PI,
        corner in 0.0..TAU, share in 0.0..1.0,
    ) {
        let u = vector(length * voltage, angle);
        let phase = Svpwm::new(voltage, Overmodulation::MinimumPhaseError).unwrap();
        let made = phase.voltage(phase.duties(u));
        prop_assert!(duties_in_range(phase.duties(u)));
        // Same direction: no component across u, none backwards.
        let across = (made.alpha * u.beta - made.beta * u.alpha) / (voltage * voltage);
        prop_assert!(across.abs() < 5e-15); // 7.0e-16 measured
        prop_assert!(made.alpha * u.alpha + made.beta * u.beta >= 0.0);

        let nearest = Svpwm::new(voltage, Overmodulation::MinimumMagnitudeError).unwrap();
        prop_assert!(duties_in_range(nearest.duties(u)));
        let best = distance(nearest.voltage(nearest.duties(u)), u);
        // No other vector of the hexagon is nearer.
        let other = phase.voltage(phase.duties(vector(5.0 * voltage, corner)));
        let other = AlphaBeta { alpha: share * other.alpha, beta: share * other.beta };
        let rounding = 4e-15 * voltage;
        prop_assert!(best <= distance(other, u) + rounding);
        prop_assert!(best <= distance(made, u) + rounding);
    }
}
