//! The PI law: order of operations, limit, recovery from saturation.

use crate::axis::log_uniform;
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
    assert!((2.0 * 4.0 + state.integral - 10.0).abs() < 2e-15);
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
    assert!(
        (wound.integral - 200.0).abs() < 1e-12,
        "the test's own premise"
    );
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
        assert!((y - 9.0).abs() < 1e-6, "settled at {y}"); // 1.1e-7 measured
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
    // 0.12 and 0.14 of it.
    assert!(with < 0.5 * without, "{with} against {without}");
    assert!(with_back < 0.5 * without, "{with_back} against {without}");
}

/// One sample that is no number, or infinite, in any argument and with any
/// anti-windup: it is seen in its own period, and the next ones are those of a law
/// that has passed over that period.
#[test]
fn a_bad_sample_is_seen_and_does_not_stay() {
    for law in [conditional(), tracking(0.05), tracking(1e-2)] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut state = PiState { integral: 1.5 };
            let out = law.update(&mut state, bad, NONE);
            assert!(out.value.is_nan() == bad.is_nan(), "{bad}: {out:?}");
            assert_eq!(state.integral, 1.5, "{bad}");
            // 2·0.25 + 1.5 + 50·0.25·0.01.
            assert_eq!(law.update(&mut state, 0.25, NONE).value, 2.125);
            let mut state = PiState { integral: 1.5 };
            let out = law.update_with_feed_forward(&mut state, 0.0, bad, NONE);
            assert!(out.value.is_nan() == bad.is_nan(), "{bad}: {out:?}");
            assert_eq!(law.update(&mut state, 0.0, NONE).value, 1.5, "{bad}");
        }
    }
}

/// A proportional law has no integral for back-calculation to move: the output is
/// kp e within the limit, whatever was before.
#[test]
fn without_an_integral_the_output_follows_the_error_alone() {
    let proportional = Pi::new(PiParameters {
        kp: 1.0,
        ki: 0.0,
        limit: 5.0,
        period: 1e-2,
    })
    .unwrap();
    for periods in [1.0, 3.0, 50.0] {
        let kind = AntiWindup::BackCalculation {
            tracking_time: periods * 1e-2,
        };
        let law = proportional.with_anti_windup(kind).unwrap();
        let mut state = PiState::default();
        for (error, output) in [(6.0, 5.0), (0.0, 0.0), (-40.0, -5.0), (3.0, 3.0)] {
            assert_eq!(law.update(&mut state, error, NONE).value, output);
        }
        assert_eq!(state, PiState::default());
    }
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

/// Any constants, each gain possibly 0, with either anti-windup.
fn drawn_law() -> impl Strategy<Value = Pi> {
    let gain = || prop_oneof![9 => log_uniform(1e-3, 1e3), 1 => Just(0.0)];
    let tracking = prop::option::of(1.0..50.0);
    (
        gain(),
        gain(),
        log_uniform(1e-2, 1e3),
        log_uniform(1e-5, 1.0),
        tracking,
    )
        .prop_map(|(kp, ki, limit, period, tracking)| {
            let law = Pi::new(PiParameters {
                kp,
                ki,
                limit,
                period,
            })
            .unwrap();
            let kind = tracking.map_or(AntiWindup::Conditional, |periods| {
                AntiWindup::BackCalculation {
                    tracking_time: periods * period,
                }
            });
            law.with_anti_windup(kind).unwrap()
        })
}

proptest! {
    /// Whatever happens, the output keeps the lower of the two limits, and
    /// the integral never grows while conditional integration saturates.
    #[test]
    fn limits_hold(
        law in drawn_law(), start in -3.0..3.0, feed in -2.0..2.0, share in -0.1f64..2.0,
        errors in prop::collection::vec(-20.0..20.0, 1..50),
    ) {
        let own = law.parameters().limit;
        let limit = share * own;
        let bound = limit.min(own).max(0.0);
        let mut state = PiState { integral: start * own };
        for e in errors {
            let before = state.integral;
            let out = law.update_with_feed_forward(&mut state, e, feed * own, limit);
            prop_assert!(out.value.abs() <= bound);
            if out.saturated && law.anti_windup() == AntiWindup::Conditional {
                prop_assert!(state.integral == before || e * out.value <= 0.0);
            }
        }
    }

    /// Below the limit both kinds are the same plain PI.
    #[test]
    fn anti_windup_is_silent_below_the_limit(
        law in drawn_law(), shares in prop::collection::vec(-1.0..1.0, 1..50),
    ) {
        let p = *law.parameters();
        let conditional = law.with_anti_windup(AntiWindup::Conditional).unwrap();
        let kind = AntiWindup::BackCalculation { tracking_time: 2.0 * p.period };
        let tracking = law.with_anti_windup(kind).unwrap();
        // The largest error whose sum over all periods leaves the limit alone.
        let most = 0.9 * p.limit / (p.kp + p.ki * p.period * shares.len() as f64 + 1e-9);
        let (mut a, mut b, mut sum) = (PiState::default(), PiState::default(), 0.0);
        for share in shares {
            let e = share * most;
            let one = conditional.update(&mut a, e, NONE);
            let two = tracking.update(&mut b, e, NONE);
            sum += e;
            prop_assert_eq!(one, two);
            let plain = p.kp * e + p.ki * sum * p.period;
            prop_assert!((one.value - plain).abs() < 1e-15 * p.limit); // 1.8e-16 measured
        }
    }
}
