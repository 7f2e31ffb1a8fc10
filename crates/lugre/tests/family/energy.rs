//! Passivity, pointwise: what goes in is not less than what is stored.

use super::*;
use lugre::FrictionLaw;
use proptest::prelude::*;

fn draws_no_energy<O: Onset<f64>>(law: &Bristle<f64, O>, share: f64, v: f64) -> bool {
    if !law.is_passive() {
        return true;
    }
    // Of the states that motion in one direction reaches.
    let [least, greatest] = law.deflection_limits();
    let z = if share < 0.0 {
        -share * least
    } else {
        share * greatest
    };
    let stored = law.stiffness() * z * law.rate(z, v);
    let taken = law.force(&z, v) * v - stored;
    // Rounding of terms that cancel at the steady state.
    taken >= -1e-12 * (stored.abs() + 1e-3)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn one_state_laws_take_energy(
        share in -1.0..1.0f64, v in -0.05..0.05f64, damping in 0.0..3e3f64, rise in 0.0..1.5f64,
        (i, elastic, n, loading) in (0.0..4.0f64, 0.0..0.99f64, 1.0..12.0f64, 0.5..6.0f64),
    ) {
        let mut steady = CURVE;
        steady.forward.stiction = steady.forward.coulomb * (1.0 + rise);
        let laws = [
            draws_no_energy(&bristle(steady, damping, LinearOnset {}), share, v),
            draws_no_energy(&bristle(steady, damping, DahlOnset { exponent: i }), share, v),
            draws_no_energy(&elasto_plastic(steady, damping, elastic), share, v),
            draws_no_energy(
                &bristle(steady, damping, BoucWenOnset { exponent: n, loading_share: loading }),
                share, v,
            ),
        ];
        prop_assert_eq!(laws, [true; 4]);
    }

    /// Of one level, over any chain of constant speeds. Work by the trapezoidal rule of parts:
    /// between the corners of the force it is exact, and at them it errs by less than
    /// Σ k_i (way of a part)²/4.
    #[test]
    fn maxwell_slip_takes_energy(ways in prop::collection::vec(-2e-5..2e-5f64, 1..30)) {
        let law = maxwell(SteadyState::coulomb(60.0));
        prop_assert!(law.is_passive() && !maxwell(CURVE).is_passive());
        let (mut state, mut work, mut error) = (Default::default(), 0.0, 0.0);
        for way in ways {
            for _ in 0..100 {
                let by = way / 100.0;
                let before = law.spring_force(&state);
                state = law.step(state, by / 1e-4, by / 1e-4, 1e-4);
                work += 0.5 * (before + law.spring_force(&state)) * by;
                error += 0.25 * law.stiffness() * by * by;
            }
            prop_assert!(work >= law.stored_energy(&state) - error);
        }
    }
}

/// Where the condition fails there is a state that gives energy: it is not too careful by much.
#[test]
fn damping_beyond_the_condition_gives_energy() {
    // k₁ = σ1 (F_S/F_C − 1): 300 = σ1 · 25/60.
    assert!(general(CURVE, 719.0).is_passive());
    let law = general(CURVE, 800.0);
    assert!(!law.is_passive());
    // At high speed and with the bristles at F_S: viscous terms of higher order left out.
    let plain = SteadyState {
        viscous_quadratic: 0.0,
        viscous_cubic: 0.0,
        ..CURVE
    };
    let law = general(SteadyState { ..plain }, 800.0);
    let (z, v) = (law.deflection_limits()[1], 20.0);
    assert!(law.force(&z, v) * v - STIFFNESS * z * law.rate(z, v) < 0.0);
}
