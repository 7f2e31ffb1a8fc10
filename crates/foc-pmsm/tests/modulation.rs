//! Discontinuous modulation, and overmodulation up to six steps.

use crate::axis::{DC_VOLTAGE, drawn_dc_voltage};
use crate::svpwm::{distance, modulator, vector};
use foc_pmsm::AlphaBeta;
use foc_pmsm::svpwm::{DiscontinuousPwm, Duties, Overmodulation, Svpwm};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_6, PI, TAU};

const MODES: [Overmodulation; 3] = [
    Overmodulation::MinimumPhaseError,
    Overmodulation::MinimumMagnitudeError,
    Overmodulation::SixStep,
];
const PWMS: [DiscontinuousPwm; 5] = [
    DiscontinuousPwm::Dpwm0,
    DiscontinuousPwm::Dpwm1,
    DiscontinuousPwm::Dpwm2,
    DiscontinuousPwm::Max,
    DiscontinuousPwm::Min,
];

fn legs(d: Duties) -> [f64; 3] {
    [d.a(), d.b(), d.c()]
}

proptest! {
    /// The voltage is that of the centred duties, and one leg stands.
    #[test]
    fn a_standing_leg_changes_no_voltage(
        dc in drawn_dc_voltage(), length in 0.0..1.0, angle in -10.0..10.0,
        mode in 0..3usize, pwm in 0..5usize,
    ) {
        let modulator = Svpwm::new(dc, MODES[mode]).unwrap();
        let u = vector(length * dc, angle);
        let centred = modulator.duties(u);
        let duties = modulator.discontinuous_duties(u, PWMS[pwm]);
        // 2.3e-16 measured.
        let apart = distance(modulator.voltage(centred), modulator.voltage(duties)) / dc;
        prop_assert!(apart < 2e-15, "{}", apart);
        let legs = legs(duties);
        prop_assert!(legs.iter().all(|d| (0.0..=1.0).contains(d)));
        prop_assert!(legs.iter().any(|&d| d == 0.0 || d == 1.0), "{:?}", legs);
    }

    /// Beyond the hexagon the held vector has its length and is on the edge, or is the
    /// corner; within, nothing changes.
    #[test]
    fn six_step_keeps_the_length(length in 0.0..0.9_f64, angle in -10.0..10.0) {
        let u = vector(length * DC_VOLTAGE, angle);
        let six = modulator(Overmodulation::SixStep);
        let plain = modulator(Overmodulation::MinimumPhaseError).duties(u);
        let phases = u.inverse_clarke();
        let all = [phases.a, phases.b, phases.c];
        let range = all.iter().copied().fold(f64::MIN, f64::max)
            - all.iter().copied().fold(f64::MAX, f64::min);
        let duties = six.duties(u);
        if range <= DC_VOLTAGE {
            prop_assert_eq!(duties, plain);
        } else {
            let made = six.voltage(duties);
            let size = made.alpha.hypot(made.beta);
            let wanted = (length * DC_VOLTAGE).min(DC_VOLTAGE * 2.0 / 3.0);
            // 2.1e-16 measured.
            prop_assert!((size - wanted).abs() < 2e-15 * DC_VOLTAGE, "{} {}", size, wanted);
            prop_assert!(legs(duties).contains(&0.0) && legs(duties).contains(&1.0));
            // Never by more than half an edge.
            let cos = (made.alpha * u.alpha + made.beta * u.beta)
                / (size * length * DC_VOLTAGE);
            prop_assert!(cos > FRAC_PI_6.cos() - 1e-9, "{}", cos);
        }
    }
}

/// The fundamental over a turn, V.
fn fundamental(length: f64) -> f64 {
    let six = modulator(Overmodulation::SixStep);
    let n = 60_000;
    let sum: f64 = (0..n)
        .map(|k| {
            let angle = TAU * (f64::from(k) + 0.5) / f64::from(n);
            let u = six.voltage(six.duties(vector(length, angle)));
            u.alpha * angle.cos() + u.beta * angle.sin()
        })
        .sum();
    sum / f64::from(n)
}

/// The closed form of the documentation, from the linear range to six steps.
#[test]
fn the_fundamental_reaches_six_steps() {
    let linear = DC_VOLTAGE / 3f64.sqrt();
    let corner = DC_VOLTAGE * 2.0 / 3.0;
    for share in [0.0, 0.1, 0.5, 0.9, 1.0] {
        let r = linear + share * (corner - linear);
        let alpha = (linear / r).min(1.0).acos();
        let closed = 6.0 / PI * r * (FRAC_PI_6 - alpha + alpha.sin());
        let error = (fundamental(r) - closed).abs() / DC_VOLTAGE;
        // 2.9e-10 measured, of the sum.
        assert!(error < 2e-9, "{share}: {error:e}");
    }
    let six = modulator(Overmodulation::SixStep);
    assert!((fundamental(corner) - six.six_step_limit()).abs() < 1e-5);
    assert!((fundamental(10.0 * corner) - six.six_step_limit()).abs() < 1e-5);
    // At and beyond the corner every vector is one of the six.
    for k in 0..360 {
        let angle = 0.1 + f64::from(k) * PI / 180.0;
        let u = vector(corner * (1.0 + 1e-12), angle);
        let (held, steps) = (legs(six.duties(u)), legs(six.six_step(u)));
        for (held, step) in held.iter().zip(steps) {
            assert!((held - step).abs() < 1e-5, "{k}");
        }
    }
}

/// Where each leg stands over a turn: two stretches of 60° (one of 120° for the two
/// simple ones), about the peaks of its voltage, 30° before, or 30° after.
#[test]
fn legs_stand_where_they_should() {
    let linear = modulator(Overmodulation::default());
    for (pwm, middle) in [
        (DiscontinuousPwm::Dpwm0, -30.0),
        (DiscontinuousPwm::Dpwm1, 0.0),
        (DiscontinuousPwm::Dpwm2, 30.0),
    ] {
        for k in 0..720 {
            // Never just on a boundary.
            let degrees = 0.25 + 0.5 * f64::from(k);
            let u = vector(150.0, degrees.to_radians());
            let duties = legs(linear.discontinuous_duties(u, pwm));
            for (leg, axis) in duties.iter().zip([0.0, 120.0, 240.0]) {
                let from = |peak: f64| (degrees - peak - middle + 540.0).rem_euclid(360.0) - 180.0;
                assert_eq!(
                    *leg == 1.0,
                    from(axis).abs() < 30.0,
                    "{pwm:?} {degrees} {axis}"
                );
                assert_eq!(*leg == 0.0, from(axis + 180.0).abs() < 30.0);
            }
        }
    }
    for k in 0..720 {
        let u = vector(150.0, (0.25 + 0.5 * f64::from(k)).to_radians());
        let high = legs(linear.discontinuous_duties(u, DiscontinuousPwm::Max));
        let low = legs(linear.discontinuous_duties(u, DiscontinuousPwm::Min));
        assert!(high.contains(&1.0) && !high.contains(&0.0));
        assert!(low.contains(&0.0) && !low.contains(&1.0));
    }
}

/// Vectors that are no numbers make duties that are none; the largest ones are made.
#[test]
fn every_number() {
    for mode in MODES {
        let m = modulator(mode);
        for pwm in PWMS {
            let lost = AlphaBeta {
                alpha: f64::NAN,
                beta: 1.0,
            };
            assert!(m.duties(lost).a().is_nan());
            assert!(m.discontinuous_duties(lost, pwm).a().is_nan());
            let large = AlphaBeta {
                alpha: 1.7e308,
                beta: -1e300,
            };
            let duties = legs(m.discontinuous_duties(large, pwm));
            assert!(duties.iter().all(|d| (0.0..=1.0).contains(d)), "{duties:?}");
        }
    }
    let endless = AlphaBeta {
        alpha: f64::INFINITY,
        beta: 1.0,
    };
    let duties = modulator(Overmodulation::SixStep).duties(endless);
    assert!(legs(duties).iter().all(|d| d.is_nan()));
}
