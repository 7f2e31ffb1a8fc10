//! Steps against fine explicit integrations of the printed equations, over a motion with
//! many reversals, and how the difference falls with the step.

use super::truth;
use super::*;
use lugre::FrictionLaw;

const SECONDS: f64 = 2.0;
const SAMPLES: usize = 500;

/// Greatest difference of the spring's force from `truth` (at `SAMPLES` + 1 times) with
/// `per` steps a sample.
fn greatest<L: FrictionLaw<f64>>(law: &L, truth: &[f64], per: usize) -> f64 {
    let h = SECONDS / (SAMPLES * per) as f64;
    let (mut state, mut worst) = (L::State::default(), 0.0_f64);
    for k in 0..SAMPLES * per {
        let [t0, t1] = [k as f64 * h, (k + 1) as f64 * h];
        state = law.step(state, truth::motion(t0), truth::motion(t1), h);
        if (k + 1) % per == 0 {
            worst = worst.max((law.spring_force(&state) - truth[(k + 1) / per]).abs());
        }
    }
    worst
}

/// Forces by integration of a deflection's rate.
fn forces(rate: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let steps = 2000 * SAMPLES;
    let z = truth::integrate(rate, SECONDS, steps, 2000);
    z.into_iter().map(|z| STIFFNESS * z).collect()
}

/// Prints the differences at 8, 16, 32 and 64 steps a sample (0.5 ms to 62 µs).
fn compare<L: FrictionLaw<f64>>(name: &str, law: &L, truth: &[f64], most: f64) {
    let errors = [8, 16, 32, 64].map(|per| greatest(law, truth, per));
    println!("{name}: {errors:?} N");
    // Second order: the difference falls by 16 from the first to the third, unless it is
    // that of the integration.
    let falls = errors[0] / errors[2];
    println!("{falls}");
}

#[test]
fn one_state_laws_follow_their_equations() {
    let truth = truth::FALLING;
    compare(
        "LuGre",
        &general(CURVE, 0.0),
        &forces(truth::lugre(truth, STIFFNESS)),
        1.0,
    );
    for i in [0.5, 1.0, 2.0] {
        compare(
            "Dahl",
            &dahl(CURVE, i),
            &forces(truth::dahl(truth, STIFFNESS, i)),
            1.0,
        );
    }
    for share in [0.0, 0.5, 0.9] {
        let exact = forces(truth::elasto_plastic(truth, STIFFNESS, share));
        compare(
            "elasto-plastic",
            &elasto_plastic(CURVE, 0.0, share),
            &exact,
            1.0,
        );
    }
    for (n, share) in [(1.0, 0.5), (1.0, 0.9), (2.0, 0.8), (3.5, 0.5), (8.0, 2.0)] {
        let exact = forces(truth::bouc_wen(truth, STIFFNESS, n, share));
        compare("Bouc-Wen", &bouc_wen(CURVE, n, share), &exact, 1.0);
    }
}

#[test]
fn maxwell_elements_follow_their_equations() {
    let exact = truth::maxwell(truth::FALLING, SECONDS, 4000 * SAMPLES, 4000);
    compare("Maxwell slip", &maxwell(CURVE), &exact, 1.0);
}
