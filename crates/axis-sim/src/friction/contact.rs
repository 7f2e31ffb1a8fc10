//! Friction laws beside LuGre, as the simulated machine steps them.

use std::sync::Arc;

use lugre::{
    BoucWen, Bristle, BristleParameters, Dahl, ElastoPlastic, FrictionError, FrictionLaw,
    MaxwellSlip, MaxwellState, Onset, Parameters,
};

use super::keys::steady;
use super::{Friction, FrictionPlace};
use crate::mechanism::Freedom;
use crate::part::{PartError, Values};

/// How many elements a Maxwell-slip friction has.
pub(super) const ELEMENTS: usize = 4;

/// A law that is not LuGre.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Contact {
    Dahl(Dahl),
    ElastoPlastic(ElastoPlastic),
    BoucWen(BoucWen),
    MaxwellSlip(MaxwellSlip<f64, ELEMENTS>),
}

/// What it remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ContactState {
    /// A deflection, m or rad.
    Bristle(f64),
    Elements(MaxwellState<f64, ELEMENTS>),
}

/// Deflection of a bristle in settled motion, or at standstill under a share of its Coulomb level.
fn bristle<O: Onset<f64>>(law: &Bristle<f64, O>, speed: f64, share: f64) -> ContactState {
    ContactState::Bristle(if speed == 0.0 {
        share * law.parameters().steady.forward.coulomb / law.stiffness()
    } else {
        law.settled(speed)
    })
}

impl Contact {
    /// The state of settled motion at a speed; at 0 under that share of the Coulomb level.
    pub(crate) fn settled(&self, speed: f64, share: f64) -> ContactState {
        match self {
            Self::Dahl(law) => bristle(law, speed, share),
            Self::ElastoPlastic(law) => bristle(law, speed, share),
            Self::BoucWen(law) => bristle(law, speed, share),
            Self::MaxwellSlip(law) if speed == 0.0 => {
                let level = share * law.parameters().steady.forward.coulomb;
                ContactState::Elements(MaxwellState {
                    force: law.parameters().shares.map(|part| part * level),
                    slips: [false; ELEMENTS],
                })
            }
            Self::MaxwellSlip(law) => ContactState::Elements(law.settled(speed)),
        }
    }

    /// State and force at the end of a step of `h` seconds between two speeds.
    pub(crate) fn step(
        &self,
        state: ContactState,
        speeds: [f64; 2],
        h: f64,
    ) -> (ContactState, f64) {
        let [v0, v1] = speeds;
        let next = match (self, state) {
            (Self::Dahl(law), ContactState::Bristle(z)) => {
                ContactState::Bristle(law.step(z, v0, v1, h))
            }
            (Self::ElastoPlastic(law), ContactState::Bristle(z)) => {
                ContactState::Bristle(law.step(z, v0, v1, h))
            }
            (Self::BoucWen(law), ContactState::Bristle(z)) => {
                ContactState::Bristle(law.step(z, v0, v1, h))
            }
            (Self::MaxwellSlip(law), ContactState::Elements(elements)) => {
                ContactState::Elements(law.step(elements, v0, v1, h))
            }
            // A state comes from the law's own `settled`.
            (_, state) => state,
        };
        (next, self.force(&next, v1))
    }

    /// The force at a speed, in the law's coordinate.
    pub(crate) fn force(&self, state: &ContactState, speed: f64) -> f64 {
        match (self, state) {
            (Self::Dahl(law), ContactState::Bristle(z)) => law.force(z, speed),
            (Self::ElastoPlastic(law), ContactState::Bristle(z)) => law.force(z, speed),
            (Self::BoucWen(law), ContactState::Bristle(z)) => law.force(z, speed),
            (Self::MaxwellSlip(law), ContactState::Elements(elements)) => {
                law.force(elements, speed)
            }
            _ => 0.0,
        }
    }

    /// The springs' force over the Coulomb level.
    pub(crate) fn share(&self, state: &ContactState) -> f64 {
        let [force, level] = match (self, state) {
            (Self::Dahl(law), ContactState::Bristle(z)) => share(law, z),
            (Self::ElastoPlastic(law), ContactState::Bristle(z)) => share(law, z),
            (Self::BoucWen(law), ContactState::Bristle(z)) => share(law, z),
            (Self::MaxwellSlip(law), ContactState::Elements(elements)) => [
                law.spring_force(elements),
                law.parameters().steady.forward.coulomb,
            ],
            _ => [0.0, 1.0],
        };
        force / level
    }
}

fn share<O: Onset<f64>>(law: &Bristle<f64, O>, z: &f64) -> [f64; 2] {
    [law.spring_force(z), law.parameters().steady.forward.coulomb]
}

/// Friction of one bristle with that onset.
pub(super) fn of_bristle<O: Onset<f64>>(
    v: &Values,
    freedom: Freedom,
    onset: O,
    contact: impl Fn(Bristle<f64, O>) -> Contact,
) -> Result<Arc<Friction>, PartError> {
    let stiffness = v.number("bristle_stiffness")?;
    let damping = v.or("bristle_damping", 0.0);
    let law = Bristle::new(BristleParameters {
        steady: steady(v)?,
        stiffness,
        damping,
        onset,
    });
    with_contact(v, freedom, [stiffness, damping], law.map(contact))
}

/// Friction with that law, and the LuGre law beside it.
pub(super) fn with_contact(
    v: &Values,
    freedom: Freedom,
    [stiffness, damping]: [f64; 2],
    contact: Result<Contact, FrictionError>,
) -> Result<Arc<Friction>, PartError> {
    let contact =
        contact.map_err(|e| PartError::together(e, "the other parameters smaller or larger"))?;
    let curve = steady(v)?;
    let parameters = Parameters {
        coulomb: curve.forward.coulomb,
        stiction: curve.forward.stiction,
        stribeck_speed: curve.stribeck_speed,
        stiffness,
        damping,
        viscous: curve.viscous,
    };
    let place = FrictionPlace::Load(freedom);
    let mut friction = Friction::new(parameters, stiffness / parameters.coulomb, place)?;
    friction.contact = Some(contact);
    Ok(Arc::new(friction))
}

#[cfg(test)]
mod tests {
    use super::super::{FRICTIONS, Friction};
    use crate::part::{Part, Values, named};

    fn friction(kind: &str, numbers: &[(&'static str, f64)]) -> Part<Friction> {
        let mut values = Values::default();
        let shared = [
            ("coulomb", 60.0),
            ("stiction", 85.0),
            ("stribeck_speed", 4e-3),
            ("viscous", 300.0),
        ];
        for (key, to) in shared.iter().chain(numbers) {
            values.set(key, *to);
        }
        Part::new(named(FRICTIONS, kind).unwrap(), values).unwrap()
    }

    /// At standstill the share of the Coulomb level that holds, and in motion the Stribeck curve.
    #[test]
    fn settled_motion_has_the_curve() {
        let bristle = ("bristle_stiffness", 2e6);
        let elastic = [bristle, ("bristle_damping", 1e3), ("elastic_share", 0.9)];
        for friction in [
            friction("dahl", &[bristle, ("exponent", 1.0)]),
            friction("elasto-plastic-rotary", &elastic),
            friction(
                "bouc-wen",
                &[bristle, ("exponent", 3.0), ("loading_share", 0.5)],
            ),
            friction(
                "maxwell-slip-rotary",
                &[("presliding", 1e-5), ("lag", 1e-3)],
            ),
        ] {
            let contact = friction.contact.unwrap();
            for (speed, share) in [(0.0, 0.5), (0.0, -1.0), (0.02, 0.0), (-4e-3, 0.0)] {
                let state = contact.settled(speed, share);
                let expected: f64 = match speed {
                    0.0 => 60.0 * share,
                    v => (60.0 + 25.0 * (-(v / 4e-3_f64).powi(2)).exp()).copysign(v) + 300.0 * v,
                };
                let force = contact.force(&state, speed);
                assert!((force - expected).abs() < 1e-10, "{force} {expected}");
                // A step at that speed changes nothing.
                let (next, after) = contact.step(state, [speed; 2], 1e-4);
                assert!((after - expected).abs() < 1e-10, "{after}");
                let own = (expected - 300.0 * speed) / 60.0;
                assert!((contact.share(&next) - own).abs() < 1e-12);
            }
        }
    }
}
