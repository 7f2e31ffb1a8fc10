//! Every public function of the law takes every number: none panics, none
//! hangs, and finite inputs of ordinary size give finite outputs.

use lugre::{LuGre, Parameters};
use proptest::prelude::*;

/// NaN, infinities, zeros of either sign, subnormal and huge numbers as often
/// as ordinary ones.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => prop::num::f64::ANY,
        3 => -1e3..1e3,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e308, -1e308,
            f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, 1.0, -1.0, 1e154,
        ]),
    ]
}

/// Positive numbers of any size, and 0.
fn size() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => (-300.0f64..300.0).prop_map(|x| 10f64.powf(x)),
        3 => (-3.0f64..3.0).prop_map(|x| 10f64.powf(x)),
        1 => prop::sample::select(vec![0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX]),
    ]
}

fn parameters() -> impl Strategy<Value = Parameters> {
    (size(), 0.0..2.0, prop::array::uniform4(size())).prop_map(
        |(coulomb, rise, [stribeck_speed, stiffness, damping, viscous])| Parameters {
            coulomb,
            stiction: coulomb * (1.0 + rise),
            stribeck_speed,
            stiffness,
            damping,
            viscous,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn validation([a, b, c, d, e, f] in prop::array::uniform6(any_number())) {
        let p = Parameters {
            coulomb: a, stiction: b, stribeck_speed: c, stiffness: d, damping: e, viscous: f,
        };
        prop_assert_eq!(LuGre::new(p).is_ok(), p.validate().is_ok());
    }

    #[test]
    fn laws(p in parameters(), [z, w0, w1, h] in prop::array::uniform4(any_number())) {
        let Ok(law) = LuGre::new(p) else { return Ok(()); };
        let _ = (law.steady_state(w0), law.steady_bristle(w0), law.rate(z, w0), law.torque(z, w0));
        let _ = (law.step(z, w0, w1, h), law.step_torque(z, w0, w1, h));
        let _ = (law.step_impulse(z, w0, w1, h), law.stored_energy(z));
        let _ = (law.passivity_margin(), law.is_passive(), law.passive_below());
        let _ = (law.vibration_damping(w0, w1), law.flat_above());
        prop_assert!(w0.is_nan() || (p.coulomb..=p.stiction).contains(&law.level(w0)));
    }

    /// At rest nothing moves, whatever the law; in motion the deflection keeps
    /// its bound.
    #[test]
    fn steps_keep_their_bound(p in parameters(), share in -1.0..1.0, w in -1e3..1e3, h in 0.0..1e3) {
        let Ok(law) = LuGre::new(p) else { return Ok(()); };
        let bound = law.bristle_limit();
        prop_assert!(bound.is_finite());
        let z = share * bound;
        prop_assert_eq!(law.step(z, 0.0, 0.0, h), z);
        prop_assert_eq!(law.rate(z, 0.0), 0.0);
        prop_assert!(law.step(z, w, w, h).abs() <= bound);
        prop_assert!(law.step(z, w, -w, h).abs() <= bound);
    }

    /// The same in `f32`, with what its range leaves of such numbers.
    #[test]
    fn single_precision_keeps_its_bound(
        p in parameters(), [z, w0, w1, h] in prop::array::uniform4(any_number()),
        share in -1.0f32..1.0, w in -1e3f32..1e3, step in 0.0f32..1e3,
    ) {
        let Ok(law) = LuGre::new(p.cast::<f32>()) else { return Ok(()); };
        let [z, w0, w1, h] = [z, w0, w1, h].map(|x| x as f32);
        let _ = (law.step_torque(z, w0, w1, h), law.step_impulse(z, w0, w1, h));
        let _ = (law.passive_below(), law.vibration_damping(w0, w1));
        let p = law.parameters();
        prop_assert!(w0.is_nan() || (p.coulomb..=p.stiction).contains(&law.level(w0)));
        let bound = law.bristle_limit();
        prop_assert!(bound.is_finite());
        prop_assert_eq!(law.step(share * bound, 0.0, 0.0, step), share * bound);
        prop_assert!(law.step(share * bound, w, w, step).abs() <= bound);
        prop_assert!(law.step(share * bound, w, -w, step).abs() <= bound);
    }
}
