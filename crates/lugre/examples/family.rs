//! One motion through all laws of the family, as CSV: law, step (s), time (s), speed (m/s),
//! force (N).
//!
//! `cargo run -p lugre --example family`; `docs/peers/lugre/run` compares it with SciPy.

use lugre::{
    BoucWenOnset, Bristle, BristleParameters, DahlOnset, ElastoPlasticOnset, FrictionError,
    FrictionLaw, FrictionLevel, LinearOnset, MaxwellSlip, MaxwellSlipParameters, Onset,
    Regularisation, StaticFriction, StaticFrictionParameters, SteadyState,
};

/// A linear guide.
const GUIDE: SteadyState = SteadyState {
    forward: FrictionLevel {
        coulomb: 60.0,
        stiction: 85.0,
    },
    backward: FrictionLevel {
        coulomb: 70.0,
        stiction: 80.0,
    },
    stribeck_speed: 4e-3,
    stribeck_exponent: 1.4,
    viscous: 300.0,
    viscous_quadratic: 200.0,
    viscous_cubic: 50.0,
};

/// Speed over time, linear in between: starts, constant speeds, reversals, a standstill.
const MOTION: [[f64; 2]; 13] = [
    [0.0, 0.0],
    [0.05, 0.02],
    [0.15, 0.02],
    [0.2, -0.01],
    [0.3, -0.01],
    [0.35, 0.0],
    [0.4, 0.0],
    [0.45, 0.003],
    [0.55, 0.003],
    [0.6, -0.002],
    [0.7, 0.001],
    [0.8, 0.05],
    [1.0, -0.03],
];

/// Steps of 1 and 0.1 ms in a sample of 5 ms.
const STEPS: [usize; 2] = [5, 50];
const SAMPLE: f64 = 5e-3;

fn speed(t: f64) -> f64 {
    let after = MOTION.iter().position(|knot| knot[0] >= t);
    let k = after.unwrap_or(MOTION.len() - 1).max(1);
    let [[t0, v0], [t1, v1]] = [MOTION[k - 1], MOTION[k]];
    v0 + (v1 - v0) * (t - t0) / (t1 - t0)
}

fn print<L: FrictionLaw<f64>>(name: &str, law: &L) {
    for per in STEPS {
        let h = SAMPLE / per as f64;
        let mut state = L::State::default();
        for k in 0..200 * per {
            let [v0, v1] = [k, k + 1].map(|k| speed(k as f64 * h));
            state = law.step(state, v0, v1, h);
            if (k + 1) % per == 0 {
                let t = (k + 1) as f64 * h;
                println!("{name},{h},{t:.3},{v1:.6},{}", law.force(&state, v1));
            }
        }
    }
}

fn bristle<O: Onset<f64>>(damping: f64, onset: O) -> Result<Bristle<f64, O>, FrictionError> {
    Bristle::new(BristleParameters {
        steady: GUIDE,
        stiffness: 4e6,
        damping,
        onset,
    })
}

fn main() -> Result<(), FrictionError> {
    println!("law,step,time,speed,force");
    for (name, regularisation) in [
        ("static tanh", Regularisation::Tanh),
        ("static arctan", Regularisation::Arctan),
    ] {
        let law = StaticFriction::new(StaticFrictionParameters {
            steady: GUIDE,
            transition_speed: 1e-3,
            regularisation,
        })?;
        print(name, &law);
    }
    print("LuGre", &bristle(400.0, LinearOnset {})?);
    print("Dahl", &bristle(0.0, DahlOnset { exponent: 1.5 })?);
    let onset = ElastoPlasticOnset { elastic_share: 0.5 };
    print("elasto-plastic", &bristle(400.0, onset)?);
    let onset = BoucWenOnset {
        exponent: 2.5,
        loading_share: 0.8,
    };
    print("Bouc-Wen", &bristle(0.0, onset)?);
    let law = MaxwellSlip::new(MaxwellSlipParameters {
        steady: GUIDE,
        shares: [0.1, 0.2, 0.3, 0.4],
        stiffness: [2e6, 1e6, 0.5e6, 0.25e6],
        attraction: 4e4,
    })?;
    print("Maxwell slip", &law);
    Ok(())
}
