//! Clarke and Park: definitions, round trips, power.

use foc_pmsm::{AlphaBeta, Dq, Phases};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// A few roundings of numbers up to 1000; 3.4e-13 measured.
const ROUNDING: f64 = 1e-12;

fn value() -> impl Strategy<Value = f64> {
    -1000.0..1000.0
}

fn balanced(amplitude: f64, angle: f64) -> Phases {
    Phases {
        a: amplitude * angle.cos(),
        b: amplitude * (angle - TAU / 3.0).cos(),
        c: amplitude * (angle + TAU / 3.0).cos(),
    }
}

#[test]
fn axes_point_where_they_are_defined() {
    let a = Phases {
        a: 1.0,
        b: -0.5,
        c: -0.5,
    }
    .clarke();
    assert_eq!((a.alpha, a.beta), (1.0, 0.0));
    // At an electrical angle of 90° the d axis lies on β, q on −α.
    let quarter = AlphaBeta {
        alpha: 1.0,
        beta: 2.0,
    }
    .park(TAU / 4.0);
    assert!((quarter.d - 2.0).abs() < 1e-15 && (quarter.q + 1.0).abs() < 1e-15);
}

proptest! {
    /// A balanced set of amplitude X, ahead of the d axis by δ, is the
    /// constant vector X (cos δ, sin δ), whatever the angle.
    #[test]
    fn balanced_set_is_constant_in_dq(x in 0.1..1000.0, angle in -TAU..TAU, delta in -TAU..TAU) {
        let dq = balanced(x, angle + delta).clarke().park(angle);
        // 1.5e-15 measured.
        prop_assert!((dq.d - x * delta.cos()).abs() < 1e-14 * x.max(1.0));
        prop_assert!((dq.q - x * delta.sin()).abs() < 1e-14 * x.max(1.0));
    }

    #[test]
    fn clarke_round_trip(a in value(), b in value(), c in value()) {
        let p = Phases { a, b, c };
        let zero = p.zero_sequence();
        let back = p.clarke().inverse_clarke();
        prop_assert!((back.a + zero - a).abs() < ROUNDING);
        prop_assert!((back.b + zero - b).abs() < ROUNDING);
        prop_assert!((back.c + zero - c).abs() < ROUNDING);
        // The inverse adds no zero sequence of its own.
        prop_assert!(back.zero_sequence().abs() < 5e-13); // 7.6e-14 measured
    }

    #[test]
    fn park_round_trip(alpha in value(), beta in value(), angle in -100.0..100.0) {
        let back = AlphaBeta { alpha, beta }.park(angle).inverse_park(angle);
        prop_assert!((back.alpha - alpha).abs() < ROUNDING);
        prop_assert!((back.beta - beta).abs() < ROUNDING);
    }

    /// Σ u i over the phases = 1.5 (u_d i_d + u_q i_q) without zero sequence.
    #[test]
    fn power_is_three_halves_of_the_dot_product(
        ud in value(), uq in value(), id in value(), iq in value(), angle in -TAU..TAU,
    ) {
        let (u, i) = (Dq { d: ud, q: uq }, Dq { d: id, q: iq });
        let (up, ip) = (u.inverse_park(angle).inverse_clarke(), i.inverse_park(angle).inverse_clarke());
        let phases = up.a * ip.a + up.b * ip.b + up.c * ip.c;
        // Products reach 1e6: 1.4e-9, a few roundings, measured.
        prop_assert!((phases - 1.5 * u.dot(i)).abs() < 3e-9);
    }
}
