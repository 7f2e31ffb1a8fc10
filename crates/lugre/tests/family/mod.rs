//! The family of laws: closed forms, integrations of their own, bounds, energy.

mod bounds;
mod closed;
mod energy;
mod integrated;
mod loops;
mod truth;

use lugre::{
    BoucWen, BoucWenOnset, Bristle, BristleParameters, Dahl, DahlOnset, ElastoPlastic,
    ElastoPlasticOnset, FrictionLevel, GeneralLuGre, LinearOnset, MaxwellSlip,
    MaxwellSlipParameters, Onset, Regularisation, StaticFriction, StaticFrictionParameters,
    SteadyState,
};

/// A linear guide, other levels in either direction.
pub const CURVE: SteadyState = SteadyState {
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

/// The same without a fall.
pub const FLAT: SteadyState = SteadyState {
    forward: FrictionLevel {
        coulomb: 60.0,
        stiction: 60.0,
    },
    backward: FrictionLevel {
        coulomb: 70.0,
        stiction: 70.0,
    },
    ..CURVE
};

pub const STIFFNESS: f64 = 4e6;

fn bristle<O: Onset<f64>>(steady: SteadyState, damping: f64, onset: O) -> Bristle<f64, O> {
    Bristle::new(BristleParameters {
        steady,
        stiffness: STIFFNESS,
        damping,
        onset,
    })
    .unwrap()
}

pub fn general(steady: SteadyState, damping: f64) -> GeneralLuGre {
    bristle(steady, damping, LinearOnset {})
}

pub fn dahl(steady: SteadyState, exponent: f64) -> Dahl {
    bristle(steady, 0.0, DahlOnset { exponent })
}

pub fn elasto_plastic(steady: SteadyState, damping: f64, elastic_share: f64) -> ElastoPlastic {
    bristle(steady, damping, ElastoPlasticOnset { elastic_share })
}

pub fn bouc_wen(steady: SteadyState, exponent: f64, loading_share: f64) -> BoucWen {
    let onset = BoucWenOnset {
        exponent,
        loading_share,
    };
    bristle(steady, 0.0, onset)
}

pub const SHARES: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
pub const SPRINGS: [f64; 4] = [2e6, 1e6, 0.5e6, 0.25e6];
pub const ATTRACTION: f64 = 4e4;

pub fn maxwell(steady: SteadyState) -> MaxwellSlip<f64, 4> {
    MaxwellSlip::new(MaxwellSlipParameters {
        steady,
        shares: SHARES,
        stiffness: SPRINGS,
        attraction: ATTRACTION,
    })
    .unwrap()
}

pub fn without_memory(regularisation: Regularisation) -> StaticFriction {
    StaticFriction::new(StaticFrictionParameters {
        steady: CURVE,
        transition_speed: 1e-3,
        regularisation,
    })
    .unwrap()
}
