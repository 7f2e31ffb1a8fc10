//! Duty cycles: linear range, hexagon, overmodulation, six-step.

mod axis;

use axis::DC_VOLTAGE;
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm, sector};
use foc_pmsm::{AlphaBeta, FocError};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_3, PI, TAU};

const MODES: [Overmodulation; 2] = [
    Overmodulation::MinimumPhaseError,
    Overmodulation::MinimumMagnitudeError,
];

fn modulator(mode: Overmodulation) -> Svpwm {
    Svpwm::new(DC_VOLTAGE, mode).unwrap()
}

fn vector(length: f64, angle: f64) -> AlphaBeta {
    AlphaBeta {
        alpha: length * angle.cos(),
        beta: length * angle.sin(),
    }
}

fn distance(a: AlphaBeta, b: AlphaBeta) -> f64 {
    (a.alpha - b.alpha).hypot(a.beta - b.beta)
}

/// The classical recipe: dwell times of the two active vectors of the
/// sector by the law of sines, the rest halved between the zero vectors.
fn by_dwell_times(u: AlphaBeta) -> Duties {
    let length = u.alpha.hypot(u.beta);
    let angle = u.beta.atan2(u.alpha).rem_euclid(TAU);
    let n = (angle / FRAC_PI_3).floor();
    let within = angle - n * FRAC_PI_3;
    let gain = 3f64.sqrt() * length / DC_VOLTAGE;
    let first = gain * (FRAC_PI_3 - within).sin();
    let second = gain * within.sin();
    let zero = 0.5 * (1.0 - first - second);
    let (high, low) = (1.0 - zero, zero);
    // In odd sectors the first vector has one leg up, in even ones two.
    let (a, b, c) = match n as u8 {
        0 => (high, zero + second, low),
        1 => (zero + first, high, low),
        2 => (low, high, zero + second),
        3 => (low, zero + first, high),
        4 => (zero + second, low, high),
        _ => (high, low, zero + first),
    };
    Duties { a, b, c }
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
    assert_eq!(sector(AlphaBeta::default()), 1);
    assert_eq!(sector(vector(1.0, 0.0)), 1);
}

#[test]
fn zero_voltage_is_half_duty() {
    let half = Duties {
        a: 0.5,
        b: 0.5,
        c: 0.5,
    };
    assert_eq!(modulator(MODES[0]).duties(AlphaBeta::default()), half);
}

/// U_dc/√3 is the largest circle: it is made at every angle, and 0.01 %
/// more is not made at 30°, where it touches the hexagon.
#[test]
fn the_linear_circle_has_radius_u_over_root_three() {
    let m = modulator(MODES[0]);
    assert!((m.linear_limit() - DC_VOLTAGE / 3f64.sqrt()).abs() < 1e-12);
    for k in 0..3600 {
        let u = vector(m.linear_limit(), f64::from(k) * TAU / 3600.0);
        assert!(distance(m.voltage(m.duties(u)), u) < 1e-12 * DC_VOLTAGE);
    }
    for mode in MODES {
        let more = vector(m.linear_limit() * 1.0001, PI / 6.0);
        let made = modulator(mode).voltage(modulator(mode).duties(more));
        assert!((distance(made, more) - m.linear_limit() * 1e-4).abs() < 1e-9);
    }
}

#[test]
fn six_step_fundamental_is_two_over_pi() {
    let m = modulator(MODES[0]);
    let made = fundamental(1.0, |u| m.voltage(m.six_step(u)));
    // The midpoint sum over 60 000 angles errs by about 1e-9 relative.
    assert!((made / m.six_step_limit() - 1.0).abs() < 1e-8);
    assert!((m.six_step_limit() / DC_VOLTAGE - 2.0 / PI).abs() < 1e-15);
}

/// Along the hexagon's edge the mean of (U/√3)/cos over ±30° is
/// √3 ln 3/π U = 0.6057 U, the most that keeping the angle can give.
#[test]
fn minimum_phase_error_ends_on_the_hexagon() {
    let m = modulator(Overmodulation::MinimumPhaseError);
    let expected = 3f64.sqrt() * 3f64.ln() / PI * DC_VOLTAGE;
    let made = fundamental(10.0 * DC_VOLTAGE, |u| m.voltage(m.duties(u)));
    assert!((made / expected - 1.0).abs() < 1e-8);
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
    assert!(near < 5e-3 && far < 5e-5, "{near} {far}");
    assert!(near > 50.0 * far, "second order in 1/length: {near} {far}");
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
        .a
        .is_nan()
    );
}

fn duties_in_range(d: Duties) -> bool {
    [d.a, d.b, d.c].iter().all(|x| (0.0..=1.0).contains(x))
}

proptest! {
    #[test]
    fn linear_range_is_exact(fraction in 0.0..1.0, angle in -PI..PI, which in 0..2usize) {
        let m = modulator(MODES[which]);
        let u = vector(fraction * m.linear_limit(), angle);
        let d = m.duties(u);
        prop_assert!(duties_in_range(d));
        // Rounding of duties near 1 times 540 V.
        prop_assert!(distance(m.voltage(d), u) < 1e-12 * DC_VOLTAGE);
        // The two zero vectors share their time: that is what makes it SVPWM.
        let high = d.a.max(d.b).max(d.c);
        let low = d.a.min(d.b).min(d.c);
        prop_assert!((1.0 - high - low).abs() < 1e-15 * 4.0);
        let slow = by_dwell_times(u);
        // atan2, sin and a difference of angles: some 1e-15 each.
        prop_assert!((d.a - slow.a).abs() < 1e-14);
        prop_assert!((d.b - slow.b).abs() < 1e-14);
        prop_assert!((d.c - slow.c).abs() < 1e-14);
    }

    #[test]
    fn overmodulation_keeps_the_angle_or_the_distance(
        length in 0.0..5.0, angle in -PI..PI, corner in 0.0..TAU, share in 0.0..1.0,
    ) {
        let u = vector(length * DC_VOLTAGE, angle);
        let phase = modulator(Overmodulation::MinimumPhaseError);
        let made = phase.voltage(phase.duties(u));
        prop_assert!(duties_in_range(phase.duties(u)));
        // Same direction: no component across u, none backwards.
        let across = (made.alpha * u.beta - made.beta * u.alpha) / DC_VOLTAGE;
        prop_assert!(across.abs() < 1e-12 * u.alpha.hypot(u.beta).max(1.0));
        prop_assert!(made.alpha * u.alpha + made.beta * u.beta >= 0.0);

        let nearest = modulator(Overmodulation::MinimumMagnitudeError);
        prop_assert!(duties_in_range(nearest.duties(u)));
        let best = distance(nearest.voltage(nearest.duties(u)), u);
        // No other vector of the hexagon is nearer.
        let other = phase.voltage(phase.duties(vector(5.0 * DC_VOLTAGE, corner)));
        let other = AlphaBeta { alpha: share * other.alpha, beta: share * other.beta };
        prop_assert!(best <= distance(other, u) + 1e-10);
        prop_assert!(best <= distance(made, u) + 1e-10);
    }
}
