//! Every public function of the law takes every number: none panics, none
//! hangs, finite inputs of ordinary size give finite outputs, and a NaN in any
//! argument gives a NaN out. (Identification: `identify_total.rs`.)

use lugre::{Exponential, LuGre, Parameters};
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

const FRICTIONLESS: Parameters = Parameters {
    coulomb: 0.0,
    stiction: 0.0,
    stribeck_speed: 1.0,
    stiffness: 0.0,
    damping: 0.0,
    viscous: 0.0,
};

const VISCOUS: Parameters = Parameters {
    viscous: 0.1,
    ..FRICTIONLESS
};

/// Every function of the law that is asked a question, with its answer; the name
/// begins with the arguments that it has.
fn answers<T: Exponential>(law: &LuGre<T>, z: T, w0: T, w1: T, h: T) -> Vec<(&'static str, T)> {
    let (z1, torque) = law.step_torque(z, w0, w1, h);
    let (z2, impulse) = law.step_impulse(z, w0, w1, h);
    vec![
        ("w level", law.level(w0)),
        ("w steady_state", law.steady_state(w0)),
        ("w steady_bristle", law.steady_bristle(w0)),
        ("z coulomb_share", law.coulomb_share(z)),
        ("zw rate", law.rate(z, w0)),
        ("zw torque", law.torque(z, w0)),
        ("zwvh step", law.step(z, w0, w1, h)),
        ("zwvh step_torque, z", z1),
        ("zwvh step_torque", torque),
        ("zwvh step_impulse, z", z2),
        ("zwvh step_impulse", impulse),
        ("h steepness", law.steepness(h)),
        ("wv vibration_damping", law.vibration_damping(w0, w1)),
        ("z stored_energy", law.stored_energy(z)),
    ]
}

/// Every number that a law has without being asked.
fn constants<T: Exponential>(law: &LuGre<T>) -> Vec<(&'static str, T)> {
    let c = law.constants();
    let _ = (law.is_passive(), law.parameters());
    vec![
        ("flat_above", law.flat_above()),
        ("bristle_limit", law.bristle_limit()),
        ("passivity_margin", law.passivity_margin()),
        ("passive_below", law.passive_below()),
        ("coulomb", c.coulomb),
        ("stiction", c.stiction),
        ("damping", c.damping),
        ("viscous", c.viscous),
        ("stiffness", c.stiffness),
        ("compliance", c.compliance),
        ("rise", c.rise),
        ("per_stribeck_speed", c.per_stribeck_speed),
        ("constant flat_above", c.flat_above),
        ("coulomb_bristle", c.coulomb_bristle),
        ("coulomb_decay", c.coulomb_decay),
    ]
}

/// That each answer with a NaN among its arguments is NaN.
fn all_nan<T: Exponential>(law: &LuGre<T>, numbers: [T; 4]) -> Result<(), TestCaseError> {
    for (place, letter) in ['z', 'w', 'v', 'h'].into_iter().enumerate() {
        let mut numbers = numbers;
        numbers[place] = T::NAN;
        let [z, w0, w1, h] = numbers;
        for (name, answer) in answers(law, z, w0, w1, h) {
            let asked = name
                .split(' ')
                .next()
                .is_some_and(|arguments| arguments.contains(letter));
            prop_assert!(
                !asked || answer.is_nan(),
                "{name}, {letter} NaN: {answer} of {numbers:?}"
            );
        }
    }
    Ok(())
}

/// What the functions promise of `x ≥ 0`, and of a NaN.
fn decay<T: Exponential>(x: T) -> Result<(), TestCaseError> {
    let answers = [x.exp_minus(), x.one_minus_exp(), x.mean_decay()];
    let inside = |a: &T| *a >= T::ZERO && *a <= T::ONE;
    prop_assert!(
        !x.is_nan() || answers.iter().all(|a| a.is_nan()),
        "{x}: {answers:?}"
    );
    prop_assert!(
        x.is_nan() || x < T::ZERO || answers.iter().all(inside),
        "{x}: {answers:?}"
    );
    Ok(())
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
        let _ = (answers(&law, z, w0, w1, h), answers(&law, z, w0, w0, h));
        prop_assert!(w0.is_nan() || (p.coulomb..=p.stiction).contains(&law.level(w0)));
        let narrow = p.cast::<f32>();
        let _ = (narrow.validate(), narrow.cast::<f64>());
    }

    /// Levels of 1 mN·m to 1 kN·m, bristles as stiff as 0.1 to 1e6 times that, speeds of
    /// any machine.
    #[test]
    fn ordinary_numbers_give_finite_ones(
        levels in (-3.0..3.0f64, 0.0..2.0), [stribeck, stiff, damping, viscous] in
        prop::array::uniform4(-1.0..3.0f64), share in -1.0..1.0f64,
        [w0, w1] in prop::array::uniform2(-1e3..1e3f64), h in 0.0..1.0f64,
    ) {
        let size = |exponent: f64| 10_f64.powf(exponent);
        let coulomb = size(levels.0);
        let law = LuGre::new(Parameters {
            coulomb,
            stiction: coulomb * (1.0 + levels.1),
            stribeck_speed: size(stribeck - 2.0),
            stiffness: coulomb * size(2.0 * stiff),
            damping: size(damping - 2.0),
            viscous: size(viscous - 3.0),
        }).unwrap();
        let z = share * law.bristle_limit();
        for (name, answer) in answers(&law, z, w0, w1, h).into_iter().chain(constants(&law)) {
            prop_assert!(answer.is_finite(), "{name}: {answer}");
        }
        let narrow = LuGre::new(law.parameters().cast::<f32>()).unwrap();
        let numbers = [z, w0, w1, h].map(|x| x as f32);
        let [z, w0, w1, h] = numbers;
        for (name, answer) in answers(&narrow, z, w0, w1, h).into_iter().chain(constants(&narrow)) {
            prop_assert!(answer.is_finite(), "{name} in f32: {answer}");
        }
    }

    /// In each argument in turn, of laws with and without friction, at rest and in motion.
    #[test]
    fn nan_in_gives_nan_out(
        p in prop_oneof![parameters(), Just(FRICTIONLESS), Just(VISCOUS), Just(Parameters::LIU_2025)],
        [z, w0, w1] in prop::array::uniform3(prop_oneof![-10.0..10.0f64, Just(0.0), Just(1e6)]),
        h in prop_oneof![0.0..1.0f64, Just(0.0)],
    ) {
        let Ok(law) = LuGre::new(p) else { return Ok(()); };
        all_nan(&law, [z, w0, w1, h])?;
        if let Ok(narrow) = LuGre::new(p.cast::<f32>()) {
            all_nan(&narrow, [z, w0, w1, h].map(|x| x as f32))?;
        }
    }

    #[test]
    fn decays(x in any_number()) {
        decay(x)?;
        decay(x as f32)?;
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
        let _ = (answers(&law, z, w0, w1, h), constants(&law));
        let p = law.parameters();
        prop_assert!(w0.is_nan() || (p.coulomb..=p.stiction).contains(&law.level(w0)));
        let bound = law.bristle_limit();
        prop_assert!(bound.is_finite());
        prop_assert_eq!(law.step(share * bound, 0.0, 0.0, step), share * bound);
        prop_assert!(law.step(share * bound, w, w, step).abs() <= bound);
        prop_assert!(law.step(share * bound, w, -w, step).abs() <= bound);
    }
}
