//! The PI law: order of operations, limit, recovery from saturation.

use foc_pmsm::{AntiWindup, FocError, Pi, PiParameters, PiState};
use proptest::prelude::*;

const NONE: f64 = f64::INFINITY;

fn parameters() -> PiParameters {
    PiParameters {
        kp: 2.0,
        ki: 50.0,
        limit: 10.0,
        period: 1e-2,
    }
}

fn conditional() -> Pi {
    Pi::new(parameters()).unwrap()
}

fn tracking(time: f64) -> Pi {
    let kind = AntiWindup::BackCalculation {
        tracking_time: time,
    };
    conditional().with_anti_windup(kind).unwrap()
}

#[test]
fn integrates_before_it_outputs() {
    let mut state = PiState { integral: 1.0 };
    let out = conditional().update(&mut state, 0.5, NONE);
    // I = 1 + 50·0.5·0.01 = 1.25, y = 2·0.5 + 1.25, exact in binary but for 0.01.
    assert!((state.integral - 1.25).abs() < 1e-15);
    assert!((out.value - 2.25).abs() < 1e-15);
    assert!(!out.saturated);
}

#[test]
fn conditional_integration_stops_only_what_makes_it_worse() {
    let mut state = PiState { integral: 9.0 };
    let out = conditional().update(&mut state, 4.0, NONE);
    assert_eq!(
        (out.value, out.saturated, state.integral),
        (10.0, true, 9.0)
    );
    // Still saturated (14 − 2 − 0.5), but the error leads back: advance.
    let mut state = PiState { integral: 14.0 };
    let out = conditional().update(&mut state, -1.0, NONE);
    assert_eq!(
        (out.value, out.saturated, state.integral),
        (10.0, true, 13.5)
    );
}

#[test]
fn back_calculation_with_one_period_lands_on_the_limit() {
    let mut state = PiState { integral: 9.0 };
    let law = tracking(1e-2);
    let out = law.update(&mut state, 4.0, NONE);
    assert_eq!(out.value, 10.0);
    // I moved so that kp e + I is the limit.
    assert!((2.0 * 4.0 + state.integral - 10.0).abs() < 1e-14);
}

/// A motor that cannot reach its speed for a second: y = 10 holds, the
/// integral must not grow, and when the demand drops the output leaves the
/// limit at once. The plain integral would need 1 s·50·4/(50·1) = 4 s.
#[test]
fn recovers_from_long_saturation() {
    for law in [conditional(), tracking(0.05)] {
        let mut state = PiState::default();
        for _ in 0..100 {
            assert_eq!(law.update(&mut state, 4.0, NONE).value, 10.0);
        }
        assert!(state.integral.abs() <= 10.0);
        // y = 2·(−1) + I − 0.5 with |I| ≤ 10 is below the limit.
        let first = law.update(&mut state, -1.0, NONE);
        assert!(!first.saturated && first.value < 8.0);
    }
    let plain = Pi::new(PiParameters {
        limit: NONE,
        ..parameters()
    })
    .unwrap();
    let mut wound = PiState::default();
    for _ in 0..100 {
        plain.update(&mut wound, 4.0, NONE);
    }
    assert!(wound.integral > 190.0, "the test's own premise");
}

/// First-order plant y' = (u − y)/0.5 s to a demand of 9 (limit 10): with
/// anti-windup the overshoot is small, without it is not.
#[test]
fn anti_windup_limits_overshoot() {
    let overshoot = |update: &dyn Fn(&mut PiState, f64) -> f64| {
        let (mut state, mut y, mut peak) = (PiState::default(), 0.0, 0.0_f64);
        for _ in 0..1000 {
            let u = update(&mut state, 9.0 - y);
            y += (u - y) * (1.0 - (-1e-2_f64 / 0.5).exp());
            peak = peak.max(y - 9.0);
        }
        assert!((y - 9.0).abs() < 1e-3, "settled at {y}");
        peak
    };
    let law = conditional();
    let with = overshoot(&|s, e| law.update(s, e, NONE).value);
    let back = tracking(0.05);
    let with_back = overshoot(&|s, e| back.update(s, e, NONE).value);
    let plain = Pi::new(PiParameters {
        limit: NONE,
        ..parameters()
    })
    .unwrap();
    let without = overshoot(&|s, e| plain.update(s, e, NONE).value.clamp(-10.0, 10.0));
    assert!(with < 0.5 * without, "{with} against {without}");
    assert!(with_back < 0.5 * without, "{with_back} against {without}");
}

#[test]
fn nan_passes_through() {
    let mut state = PiState::default();
    assert!(
        conditional()
            .update(&mut state, f64::NAN, NONE)
            .value
            .is_nan()
    );
}

#[test]
fn validation_names_the_field() {
    let field = |p: PiParameters| match Pi::new(p) {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    let good = parameters();
    assert_eq!(field(PiParameters { kp: -1.0, ..good }), "kp");
    assert_eq!(field(PiParameters { ki: NONE, ..good }), "ki");
    assert_eq!(field(PiParameters { limit: 0.0, ..good }), "limit");
    assert_eq!(
        field(PiParameters {
            limit: f64::NAN,
            ..good
        }),
        "limit"
    );
    assert_eq!(
        field(PiParameters {
            period: 0.0,
            ..good
        }),
        "period"
    );
    let short = AntiWindup::BackCalculation {
        tracking_time: 9e-3,
    };
    assert!(conditional().with_anti_windup(short).is_err());
}

proptest! {
    /// Whatever happens, the output keeps the lower of the two limits, and
    /// the integral never grows while conditional integration saturates.
    #[test]
    fn limits_hold(
        start in -30.0..30.0, errors in prop::collection::vec(-20.0..20.0, 1..50),
        feed in -20.0..20.0, limit in -1.0..20.0, back in any::<bool>(),
    ) {
        let law = if back { tracking(0.03) } else { conditional() };
        let bound = f64::min(limit, 10.0).max(0.0);
        let mut state = PiState { integral: start };
        for e in errors {
            let before = state.integral;
            let out = law.update_with_feed_forward(&mut state, e, feed, limit);
            prop_assert!(out.value.abs() <= bound);
            if out.saturated && !back {
                prop_assert!(state.integral == before || e * out.value <= 0.0);
            }
        }
    }

    /// Below the limit both kinds are the same plain PI.
    #[test]
    fn anti_windup_is_silent_below_the_limit(errors in prop::collection::vec(-0.05..0.05, 1..50)) {
        let (mut a, mut b, mut sum) = (PiState::default(), PiState::default(), 0.0);
        for e in errors {
            let one = conditional().update(&mut a, e, NONE);
            let two = tracking(0.02).update(&mut b, e, NONE);
            sum += 50.0 * e * 1e-2;
            prop_assert_eq!(one, two);
            prop_assert!((one.value - (2.0 * e + sum)).abs() < 1e-13);
        }
    }
}
