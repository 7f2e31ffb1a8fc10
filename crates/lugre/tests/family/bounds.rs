//! Any number: nothing panics or stays NaN, and nothing leaves its bounds.

use super::*;
use lugre::{Exponential, FrictionLaw, LuGre};
use proptest::prelude::*;

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => prop::num::f64::ANY,
        3 => -1e3..1e3,
        3 => -0.1..0.1,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, f64::MAX, f64::MIN, 5e-324,
        ]),
    ]
}

fn level() -> impl Strategy<Value = FrictionLevel> {
    (-12.0..12.0f64, 0.0..3.0f64).prop_map(|(size, rise)| {
        let coulomb = 10_f64.powf(size);
        FrictionLevel {
            coulomb,
            stiction: coulomb * (1.0 + rise),
        }
    })
}

fn curve() -> impl Strategy<Value = SteadyState> {
    let size = -6.0..3.0f64;
    (level(), level(), 0.1..10.0f64, prop::array::uniform4(size)).prop_map(
        |(forward, backward, stribeck_exponent, exponents)| {
            let [stribeck_speed, viscous, viscous_quadratic, viscous_cubic] =
                exponents.map(|e| 10_f64.powf(e));
            SteadyState {
                forward,
                backward,
                stribeck_speed,
                stribeck_exponent,
                viscous,
                viscous_quadratic,
                viscous_cubic,
            }
        },
    )
}

/// From any state by any step, and on from there.
fn bounded<T: Exponential, L: FrictionLaw<T>>(
    law: &L,
    state: L::State,
    steps: [[T; 3]; 4],
) -> Result<(), TestCaseError> {
    let [least, greatest] = law.spring_limits();
    // Sum of the elements: each within its own bound, their sum rounded.
    let room = T::of(8.0) * T::EPSILON * (greatest - least);
    let mut state = state;
    for [v0, v1, h] in steps {
        state = law.step(state, v0, v1, h);
        let force = law.spring_force(&state);
        let inside = force >= least - room && force <= greatest + room;
        let numbers = [v0, v1, h].iter().all(|x| x.is_finite());
        prop_assert!(
            inside || (force.is_nan() && !numbers),
            "{force} {v0} {v1} {h}"
        );
        let _ = (law.force_at_load(&state, v1, h), law.stored_energy(&state));
    }
    // Whatever came before: numbers make it a number again, and sliding settles.
    // Several times, as the first goes down from another direction's level by rounding.
    let v = T::of(0.5);
    for _ in 0..8 {
        state = law.step(state, v, v, T::of(1e30));
    }
    let (found, steady) = (law.force(&state, v), law.steady_state(v));
    let close = (found - steady).abs() <= T::of(64.0) * T::EPSILON * steady.abs();
    prop_assert!(close, "{found} {steady}");
    let settled = law.settled(v);
    let off = (law.spring_force(&settled) - law.spring_force(&state)).abs();
    prop_assert!(off <= T::of(64.0) * T::EPSILON * greatest);
    // At rest nothing moves.
    prop_assert_eq!(
        law.spring_force(&law.step(state, T::ZERO, T::ZERO, v)),
        law.spring_force(&state)
    );
    prop_assert!(
        law.force(&law.step(state, T::NAN, v, v), v).is_nan() || law.stiffness() == T::ZERO
    );
    Ok(())
}

fn narrow(steps: [[f64; 3]; 4]) -> [[f32; 3]; 4] {
    steps.map(|step| step.map(|x| x as f32))
}

fn one_state<O: Onset<f64>, P: Onset<f32>>(
    steady: SteadyState,
    onsets: (O, P),
    [stiffness, damping, z]: [f64; 3],
    steps: [[f64; 3]; 4],
) -> Result<(), TestCaseError> {
    let wide = BristleParameters {
        steady,
        stiffness,
        damping,
        onset: onsets.0,
    };
    if let Ok(law) = Bristle::new(wide) {
        bounded(&law, z, steps)?;
    }
    let single = BristleParameters {
        steady: steady.cast::<f32>(),
        stiffness: stiffness as f32,
        damping: damping as f32,
        onset: onsets.1,
    };
    if let Ok(law) = Bristle::new(single) {
        bounded(&law, z as f32, narrow(steps))?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn bristles_keep_their_bounds(
        steady in curve(), (stiffness, damping) in (-3.0..12.0f64, -3.0..4.0f64), z in any_number(),
        steps in prop::array::uniform4(prop::array::uniform3(any_number())),
        (i, elastic, n, loading) in (0.0..10.0f64, 0.0..0.99f64, 1.0..16.0f64, 0.5..10.0f64),
        whole in prop::bool::ANY,
    ) {
        let numbers = [10_f64.powf(stiffness), 10_f64.powf(damping), z];
        let (i, n) = if whole { (i.floor(), n.floor()) } else { (i, n) };
        one_state(steady, (LinearOnset {}, LinearOnset {}), numbers, steps)?;
        let onsets = (DahlOnset { exponent: i }, DahlOnset { exponent: i as f32 });
        // i > 1 comes to its steady state as a power of the way only.
        if i <= 1.0 {
            one_state(steady, onsets, numbers, steps)?;
        }
        let onsets = (
            ElastoPlasticOnset { elastic_share: elastic },
            ElastoPlasticOnset { elastic_share: elastic as f32 },
        );
        one_state(steady, onsets, numbers, steps)?;
        let onsets = (
            BoucWenOnset { exponent: n, loading_share: loading },
            BoucWenOnset { exponent: n as f32, loading_share: loading as f32 },
        );
        one_state(steady, onsets, numbers, steps)?;
    }

    #[test]
    fn other_laws_keep_their_bounds(
        steady in curve(), springs in prop::array::uniform3(-3.0..12.0f64), z in any_number(),
        steps in prop::array::uniform4(prop::array::uniform3(any_number())),
        attraction in -3.0..12.0f64, slips in prop::bool::ANY,
    ) {
        let shares = [0.25, 0.25, 0.5];
        let maxwell = MaxwellSlip::new(MaxwellSlipParameters {
            steady, shares,
            stiffness: springs.map(|e| 10_f64.powf(e)),
            attraction: 10_f64.powf(attraction),
        }).unwrap();
        let state = lugre::MaxwellState { force: [z, 1.0, -z], slips: [slips, !slips, slips] };
        bounded(&maxwell, state, steps)?;
        let single = MaxwellSlip::new(MaxwellSlipParameters {
            steady: steady.cast::<f32>(),
            shares: shares.map(|x| x as f32),
            stiffness: springs.map(|e| 10_f64.powf(e) as f32),
            attraction: 10_f64.powf(attraction) as f32,
        }).unwrap();
        let z = z as f32;
        let state = lugre::MaxwellState { force: [z, 1.0, -z], slips: [slips, !slips, slips] };
        bounded(&single, state, narrow(steps))?;
        let lugre = LuGre::new(lugre::Parameters::LIU_2025).unwrap();
        bounded(&lugre, f64::from(z), steps)?;
    }

    /// Parameters of any kind make a law or an error.
    #[test]
    fn parameters_of_any_kind(numbers in prop::array::uniform14(any_number())) {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = numbers;
        let steady = SteadyState {
            forward: FrictionLevel { coulomb: a, stiction: b },
            backward: FrictionLevel { coulomb: c, stiction: d },
            stribeck_speed: e, stribeck_exponent: f,
            viscous: g, viscous_quadratic: h, viscous_cubic: i,
        };
        for steady in [steady, CURVE] {
            let _ = Bristle::new(BristleParameters {
                steady, stiffness: j, damping: k, onset: DahlOnset { exponent: l },
            });
            let _ = Bristle::new(BristleParameters {
                steady, stiffness: j, damping: k, onset: ElastoPlasticOnset { elastic_share: l },
            });
            let onset = BoucWenOnset { exponent: l, loading_share: m };
            let _ = Bristle::new(BristleParameters { steady, stiffness: j, damping: k, onset });
            let _ = MaxwellSlip::new(MaxwellSlipParameters {
                steady, shares: [j, k], stiffness: [l, m], attraction: n,
            });
            let regularisation = Regularisation::Arctan;
            let _ = StaticFriction::new(StaticFrictionParameters {
                steady, transition_speed: j, regularisation,
            });
        }
        let classic = lugre::ClassicBoucWen { scale: j, a: k, beta: l, gamma: m, exponent: n };
        let _ = classic.bristle();
    }
}

#[test]
fn errors_say_what_would_be_valid() {
    let mut steady = CURVE;
    steady.backward.stiction = 10.0;
    let error = steady.validate().unwrap_err().to_string();
    assert_eq!(
        error,
        "friction parameter `backward.stiction` is 10, but must be at least \
         `backward.coulomb` = 70"
    );
    let none = MaxwellSlip::<f64, 0>::new(MaxwellSlipParameters {
        steady: CURVE,
        shares: [],
        stiffness: [],
        attraction: 1.0,
    });
    assert_eq!(
        none.unwrap_err().to_string(),
        "friction parameter `sum of shares` is 0, but must be 1"
    );
}

/// Friction that is none in one direction or in both: the deflection goes as soon as it moves.
#[test]
fn levels_of_zero_carry_nothing() {
    let mut steady = FLAT;
    steady.backward = FrictionLevel {
        coulomb: 0.0,
        stiction: 0.0,
    };
    let law = general(steady, 100.0);
    let z = law.step(0.0, 0.01, 0.01, 1.0);
    assert_eq!(law.step(z, 0.0, 0.0, 1.0), z);
    assert_eq!(law.step(z, -1e-9, -1e-9, 1e-6), 0.0);
    assert_eq!(law.force(&0.0, -0.01), CURVE.viscous_force(-0.01));
    let maxwell = maxwell(SteadyState::coulomb(0.0));
    let state = maxwell.step(Default::default(), 1.0, -2.0, 1.0);
    assert_eq!(maxwell.force(&state, 3.0), 0.0);
}

/// A run in `f32` against one in `f64` of the same `f32` numbers, in ε of 85 N. Measured:
/// 5.1, 10.5, 7.3, 4.9.
#[test]
fn single_precision_follows_double() {
    fn deviation<A, B>(wide: &A, narrow: &B) -> f64
    where
        A: FrictionLaw<f64>,
        B: FrictionLaw<f32>,
    {
        let (mut a, mut b) = (A::State::default(), B::State::default());
        let mut worst = 0.0_f64;
        for k in 0..20_000 {
            let speed = |k: i32| (super::truth::motion(f64::from(k) * 1e-4)) as f32;
            let h = 1e-4_f32;
            a = wide.step(
                a,
                f64::from(speed(k)),
                f64::from(speed(k + 1)),
                f64::from(h),
            );
            b = narrow.step(b, speed(k), speed(k + 1), h);
            worst = worst.max((wide.spring_force(&a) - f64::from(narrow.spring_force(&b))).abs());
        }
        worst / (85.0 * f64::from(f32::EPSILON))
    }
    let steady = CURVE.cast::<f32>();
    let stiffness = STIFFNESS as f32;
    macro_rules! one {
        ($onset:expr, $same:expr) => {{
            let onset = $onset;
            let narrow = BristleParameters {
                steady,
                stiffness,
                damping: 0.0,
                onset,
            };
            let onset = $same;
            let steady = steady.cast::<f64>();
            let wide = BristleParameters {
                steady,
                stiffness: STIFFNESS,
                damping: 0.0,
                onset,
            };
            deviation(&Bristle::new(wide).unwrap(), &Bristle::new(narrow).unwrap())
        }};
    }
    let found = [
        one!(LinearOnset {}, LinearOnset {}),
        one!(DahlOnset { exponent: 2.0 }, DahlOnset { exponent: 2.0 }),
        one!(
            ElastoPlasticOnset { elastic_share: 0.5 },
            ElastoPlasticOnset { elastic_share: 0.5 }
        ),
        one!(
            BoucWenOnset {
                exponent: 3.0,
                loading_share: 0.75
            },
            BoucWenOnset {
                exponent: 3.0,
                loading_share: 0.75
            }
        ),
    ];
    assert!(found.iter().all(|units| *units < 30.0), "{found:?}");
}
