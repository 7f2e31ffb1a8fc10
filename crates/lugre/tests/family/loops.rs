//! Hysteresis: what happens at reversals.

use super::*;
use lugre::FrictionLaw;

/// Moves by a displacement in steps of at most 20 nm, and gives the force and the work.
fn along<L: FrictionLaw<f64>>(law: &L, state: &mut L::State, displacement: f64) -> [f64; 2] {
    let steps = (displacement.abs() / 2e-8).ceil();
    let (h, speed) = (1e-5, displacement / steps / 1e-5);
    let mut force = law.spring_force(state);
    let mut work = 0.0;
    for _ in 0..steps as usize {
        *state = law.step(*state, speed, speed, h);
        let next = law.spring_force(state);
        work += 0.5 * (force + next) * speed * h;
        force = next;
    }
    [force, work]
}

/// Force of elements of one level drawn from unloaded: Σ min(k_i x, α_i F_C).
fn drawn(level: f64, x: f64) -> f64 {
    let elements = SHARES.into_iter().zip(SPRINGS);
    elements.map(|(share, k)| (k * x).min(share * level)).sum()
}

/// The first curve, Masing's rule after reversals and a closed inner loop, of elements of one
/// level; all by the closed form above.
#[test]
fn maxwell_slip_remembers_its_reversals() {
    let law = maxwell(SteadyState::coulomb(60.0));
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-10, "{a} {b}");
    let mut state = Default::default();
    close(along(&law, &mut state, 30e-6)[0], drawn(60.0, 30e-6));
    let peak = along(&law, &mut state, 20e-6)[0];
    close(peak, drawn(60.0, 50e-6));
    // Masing: the branch after a reversal is the first curve, doubled.
    let inner = along(&law, &mut state, -24e-6)[0];
    close(inner, peak - 2.0 * drawn(60.0, 12e-6));
    close(
        along(&law, &mut state, 10e-6)[0],
        inner + 2.0 * drawn(60.0, 5e-6),
    );
    // Back to where the inner loop began: it closes, and the outer branch goes on.
    close(along(&law, &mut state, -10e-6)[0], inner);
    close(
        along(&law, &mut state, -40e-6)[0],
        peak - 2.0 * drawn(60.0, 32e-6),
    );
}

/// Area of a loop between two slidings: each element gives its level over the way less the
/// 2 d in which it turns over.
#[test]
fn a_loop_of_maxwell_slip_takes_its_area() {
    let law = maxwell(SteadyState::coulomb(60.0));
    let mut state = law.settled(1.0);
    let way = 1e-3;
    let there = along(&law, &mut state, -way)[1];
    let back = along(&law, &mut state, way)[1];
    let lost: f64 = SHARES
        .into_iter()
        .zip(SPRINGS)
        .map(|(share, k)| 60.0 * share * (way - 2.0 * 60.0 * share / k))
        .sum();
    for work in [there, back] {
        assert!((work - lost).abs() < 1e-5 * lost, "{work} {lost}");
    }
}

/// Within the elastic range nothing creeps: the force is that of a spring, whatever the number
/// of cycles. LuGre creeps under the same motion about the same load.
#[test]
fn elasto_plastic_does_not_drift_where_lugre_does() {
    let (elastic, linear) = (elasto_plastic(CURVE, 0.0, 0.8), general(CURVE, 0.0));
    let mut states = [[0.0; 2]; 2];
    let force = |states: [f64; 2]| {
        [
            elastic.force(&states[0], 0.0),
            linear.force(&states[1], 0.0),
        ]
    };
    for (cycle, kept) in [(1, 0), (1000, 1)] {
        for _ in 0..cycle {
            for travel in [8e-6, -4e-6, -4e-6] {
                let speed = travel / 1e-3;
                let [a, b] = states[0];
                states[0] = [
                    elastic.step(a, speed, speed, 1e-3),
                    linear.step(b, speed, speed, 1e-3),
                ];
            }
        }
        states[1][kept] = force(states[0])[0];
    }
    // Rounding: 3000 additions to 32 N.
    assert!(states[1][0].abs() < 1e-12 && states[1][1].abs() < 1e-11);
    // LuGre's loop settles about another force: it has moved by newtons.
    assert!(force(states[0])[1].abs() > 1.0);
}

/// A heavy load rubs harder, and no load not at all; viscous friction stays.
#[test]
fn dry_friction_is_proportional_to_load() {
    fn check<L: FrictionLaw<f64>>(law: &L) {
        let state = law.settled(0.01);
        let viscous = CURVE.viscous_force(0.01);
        let dry = law.force(&state, 0.01) - viscous;
        assert!(dry > 59.0);
        for (load, times) in [(0.0, 0.0), (-3.0, 0.0), (2.5, 2.5)] {
            let force = law.force_at_load(&state, 0.01, load);
            assert!((force - viscous - times * dry).abs() < 1e-10, "{force}");
        }
        assert!(law.force_at_load(&state, 0.01, f64::NAN).is_nan());
    }
    check(&general(CURVE, 500.0));
    check(&dahl(CURVE, 1.5));
    check(&elasto_plastic(CURVE, 500.0, 0.3));
    check(&bouc_wen(CURVE, 2.0, 0.7));
    check(&maxwell(CURVE));
    check(&without_memory(Regularisation::Tanh));
}
