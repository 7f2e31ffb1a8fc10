//! Energy: where the law is passive it takes it, and where it is not, a
//! motion can be shown that draws some.

use lugre::{LuGre, Parameters};
use proptest::prelude::*;

/// Work put in over pieces of constant speed (speed, duration); exact, because
/// the impulse is.
fn work(law: &LuGre, z0: f64, pieces: &[(f64, f64)]) -> (f64, f64) {
    pieces.iter().fold((z0, 0.0), |(z, work), &(w, h)| {
        let (z1, impulse) = law.step_impulse(z, w, w, h);
        (z1, work + w * impulse)
    })
}

proptest! {
    /// Work in ≥ gain of stored energy, for every motion, where
    /// σ2 ≥ σ1 (T_S − T_C)/T_C.
    #[test]
    fn passive_where_the_condition_holds(
        rise in 0.0f64..1.0, stiffness in 1.0f64..1e4, damping in 0.0f64..10.0,
        surplus in 0.0f64..0.1, share in -1.0f64..1.0,
        pieces in prop::collection::vec((-200.0f64..200.0, 1e-6f64..1e-1), 1..40),
    ) {
        let coulomb = 0.7;
        let law = LuGre::new(Parameters {
            coulomb, stiction: coulomb * (1.0 + rise), stribeck_speed: 2.0,
            stiffness, damping, viscous: damping * rise + surplus,
        }).expect("valid");
        // The margin itself may be −1e-16 by rounding where surplus is 0.
        prop_assert!(law.passivity_margin() > -1e-13);
        let z0 = share * law.bristle_limit();
        let (z1, input) = work(&law, z0, &pieces);
        let gain = law.stored_energy(z1) - law.stored_energy(z0);
        let turnover: f64 = pieces.iter().map(|&(w, h)| (w * h).abs() * 2.0 + w * w * h * 20.0).sum();
        prop_assert!(input >= gain - 1e-12 * (1.0 + turnover), "{input} {gain}");
    }

    /// Below `passive_below` every law is passive.
    #[test]
    fn slow_motion_is_always_passive(
        damping in 0.0f64..10.0, share in -1.0f64..1.0,
        pieces in prop::collection::vec((-1.0f64..1.0, 1e-6f64..1e-1), 1..40),
    ) {
        let law = LuGre::new(Parameters {
            coulomb: 0.7, stiction: 1.1, stribeck_speed: 2.0,
            stiffness: 100.0, damping, viscous: 0.0,
        }).expect("valid");
        let fastest = law.passive_below().min(200.0);
        let slow: Vec<_> = pieces.iter().map(|&(w, h)| (w * fastest, h)).collect();
        let z0 = share * law.bristle_limit();
        let (z1, input) = work(&law, z0, &slow);
        let gain = law.stored_energy(z1) - law.stored_energy(z0);
        prop_assert!(input >= gain - 1e-10 * (1.0 + input.abs()));
    }
}

#[test]
fn the_papers_law_is_not_passive() {
    let law = LuGre::new(Parameters::LIU_2025).expect("valid");
    // 0.002865 − 1.521203 · 0.0896/0.6757
    assert!((law.passivity_margin() + 0.198853).abs() < 1e-5);
    assert!(!law.is_passive());
    // Slowly to the break-away deflection, then a fast jerk of half a
    // relaxation: σ1 dz/dt pulls along while the bristles spring back. The
    // cycle ends where it began, at the slow steady deflection.
    let slow = 1e-3;
    let cycle = [(100.0, 2e-4), (slow, 0.2 / slow)];
    let (z0, _) = work(&law, 0.0, &[(slow, 1.0 / slow)]);
    let (z1, input) = work(&law, z0, &cycle);
    // 0.2 rad are four relaxations: the deflection is back to e^−4 of 0.002.
    assert!((z1 - z0).abs() < 1e-4, "{z0} {z1}");
    // −0.305 J from the jerk, +0.153 J for the slow way.
    assert!((-0.17..-0.13).contains(&input), "{input} J");
}
