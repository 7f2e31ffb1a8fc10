//! Cost of step and force of each law of the family: 1000 of them over two reversals, each
//! waiting for the one before.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use lugre::{
    BoucWenOnset, Bristle, BristleParameters, DahlOnset, ElastoPlasticOnset, FrictionLaw,
    FrictionLevel, LinearOnset, LuGre, MaxwellSlip, MaxwellSlipParameters, Onset, Parameters,
    Regularisation, StaticFriction, StaticFrictionParameters, SteadyState,
};

const LEVEL: FrictionLevel = FrictionLevel {
    coulomb: 60.0,
    stiction: 85.0,
};

fn guide() -> SteadyState {
    SteadyState {
        forward: LEVEL,
        backward: LEVEL,
        stribeck_speed: 4e-3,
        viscous: 300.0,
        ..SteadyState::coulomb(60.0)
    }
}

/// Of up to 5 mm/s (m/s), with steps of 0.1 ms: 0.5 µm, a thirtieth of a deflection.
fn run<L: FrictionLaw<f64>>(c: &mut Criterion, name: &str, law: &L) {
    let speeds: Vec<f64> = (0..=1000)
        .map(|k| 5e-3 * (2e-3 * std::f64::consts::PI * f64::from(k)).cos())
        .collect();
    c.bench_function(&format!("1000 steps and forces, {name}"), |b| {
        b.iter(|| {
            let (mut state, mut sum) = (L::State::default(), 0.0);
            for v in black_box(&speeds).windows(2) {
                state = law.step(state, v[0], v[1], 1e-4);
                sum += law.force(&state, v[1]);
            }
            sum
        });
    });
}

fn bristle<O: Onset<f64>>(onset: O) -> Bristle<f64, O> {
    Bristle::new(BristleParameters {
        steady: black_box(guide()),
        stiffness: 4e6,
        damping: 400.0,
        onset,
    })
    .expect("valid")
}

fn laws(c: &mut Criterion) {
    let lugre = LuGre::new(black_box(Parameters {
        coulomb: 60.0,
        stiction: 85.0,
        stribeck_speed: 4e-3,
        stiffness: 4e6,
        damping: 400.0,
        viscous: 300.0,
    }));
    run(c, "LuGre", &lugre.expect("valid"));
    run(c, "GeneralLuGre", &bristle(LinearOnset {}));
    run(c, "Dahl", &bristle(DahlOnset { exponent: 1.5 }));
    let onset = ElastoPlasticOnset { elastic_share: 0.5 };
    run(c, "ElastoPlastic", &bristle(onset));
    let onset = BoucWenOnset {
        exponent: 2.5,
        loading_share: 0.8,
    };
    run(c, "BoucWen", &bristle(onset));
    let maxwell = MaxwellSlip::new(MaxwellSlipParameters {
        steady: black_box(guide()),
        shares: [0.1, 0.2, 0.3, 0.4],
        stiffness: [2e6, 1e6, 0.5e6, 0.25e6],
        attraction: 4e4,
    });
    run(c, "MaxwellSlip<4>", &maxwell.expect("valid"));
    let without_memory = StaticFriction::new(StaticFrictionParameters {
        steady: black_box(guide()),
        transition_speed: 1e-3,
        regularisation: Regularisation::Tanh,
    });
    run(c, "StaticFriction", &without_memory.expect("valid"));
}

criterion_group!(benches, laws);
criterion_main!(benches);
