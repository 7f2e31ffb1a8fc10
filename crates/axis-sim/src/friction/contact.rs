//! Friction laws beside LuGre, as the simulated machine steps them.

use std::fmt::Debug;
use std::sync::Arc;

use lugre::{
    Bristle, BristleParameters, FrictionError, FrictionLaw, MaxwellSlip, MaxwellState, Onset,
    Parameters, SteadyState,
};

use super::keys::steady;
use super::{Friction, FrictionPlace};
use crate::part::{PartError, Values};

/// How many elements a Maxwell-slip friction has.
pub(super) const ELEMENTS: usize = 4;

/// What a law remembers, as numbers: a deflection, m or rad, or the elements' forces and whether each slips.
pub(crate) type ContactState = [f64; 2 * ELEMENTS];

/// A law that is not LuGre, in its own coordinate.
pub(crate) trait Contact: Debug + Send + Sync {
    /// The state of settled motion at a speed; at 0 under that share of the Coulomb level.
    fn settled(&self, speed: f64, share: f64) -> ContactState;

    /// State and force at the end of a step of `h` seconds between two speeds.
    fn step(&self, state: &ContactState, speeds: [f64; 2], h: f64) -> (ContactState, f64);

    /// The force at a speed.
    fn force(&self, state: &ContactState, speed: f64) -> f64;

    /// The springs' force over the Coulomb level.
    fn share(&self, state: &ContactState) -> f64;
}

/// A law whose state goes into numbers and back, to the bit.
trait Remembers: FrictionLaw<f64> {
    fn kept(state: &Self::State) -> ContactState;

    fn recalled(state: &ContactState) -> Self::State;

    /// At standstill, its springs under that force.
    fn held(&self, force: f64) -> Self::State;

    /// The Coulomb level against a force of the springs of that sign.
    fn level(&self, force: f64) -> f64;
}

/// The Coulomb level of the direction in which a motion has a force of that sign.
fn level_of(curve: &SteadyState, force: f64) -> f64 {
    match force < 0.0 {
        true => curve.backward.coulomb,
        false => curve.forward.coulomb,
    }
}

impl<O: Onset<f64>> Remembers for Bristle<f64, O> {
    fn kept(state: &f64) -> ContactState {
        let mut kept = ContactState::default();
        kept[0] = *state;
        kept
    }

    fn recalled(state: &ContactState) -> f64 {
        state[0]
    }

    fn held(&self, force: f64) -> f64 {
        force / self.stiffness()
    }

    fn level(&self, force: f64) -> f64 {
        level_of(&self.parameters().steady, force)
    }
}

impl Remembers for MaxwellSlip<f64, ELEMENTS> {
    fn kept(state: &Self::State) -> ContactState {
        std::array::from_fn(|i| match i.checked_sub(ELEMENTS) {
            Some(element) => f64::from(u8::from(state.slips[element])),
            None => state.force[i],
        })
    }

    fn recalled(state: &ContactState) -> Self::State {
        MaxwellState {
            force: std::array::from_fn(|i| state[i]),
            slips: std::array::from_fn(|i| state[ELEMENTS + i] != 0.0),
        }
    }

    fn held(&self, force: f64) -> Self::State {
        MaxwellState {
            force: self.parameters().shares.map(|part| part * force),
            slips: [false; ELEMENTS],
        }
    }

    fn level(&self, force: f64) -> f64 {
        level_of(&self.parameters().steady, force)
    }
}

impl<L: Remembers + Debug + Send + Sync> Contact for L {
    fn settled(&self, speed: f64, share: f64) -> ContactState {
        L::kept(&match speed == 0.0 {
            true => self.held(share * self.level(share)),
            false => FrictionLaw::settled(self, speed),
        })
    }

    fn step(&self, state: &ContactState, [v0, v1]: [f64; 2], h: f64) -> (ContactState, f64) {
        let next = FrictionLaw::step(self, L::recalled(state), v0, v1, h);
        (L::kept(&next), FrictionLaw::force(self, &next, v1))
    }

    fn force(&self, state: &ContactState, speed: f64) -> f64 {
        FrictionLaw::force(self, &L::recalled(state), speed)
    }

    fn share(&self, state: &ContactState) -> f64 {
        let force = self.spring_force(&L::recalled(state));
        force / self.level(force)
    }
}

/// Friction of one bristle with that onset.
pub(super) fn of_bristle<O: Onset<f64> + Debug + Send + Sync + 'static>(
    v: &Values,
    at: FrictionPlace,
    onset: O,
) -> Result<Arc<Friction>, PartError> {
    let stiffness = v.number("bristle_stiffness")?;
    let damping = v.or("bristle_damping", 0.0);
    let law = Bristle::new(BristleParameters {
        steady: steady(v)?,
        stiffness,
        damping,
        onset,
    });
    with_contact(v, at, [stiffness, damping], law)
}

/// Friction with that law, and the LuGre law beside it, which has the mean of the levels of both
/// directions.
pub(super) fn with_contact(
    v: &Values,
    at: FrictionPlace,
    [stiffness, damping]: [f64; 2],
    law: Result<impl Contact + 'static, FrictionError>,
) -> Result<Arc<Friction>, PartError> {
    let contact =
        law.map_err(|e| PartError::together(e, "the other parameters smaller or larger"))?;
    let curve = steady(v)?;
    let parameters = Parameters {
        coulomb: 0.5 * (curve.forward.coulomb + curve.backward.coulomb),
        stiction: 0.5 * (curve.forward.stiction + curve.backward.stiction),
        stribeck_speed: curve.stribeck_speed,
        stiffness,
        damping,
        viscous: curve.viscous,
    };
    let mut friction = Friction::new(parameters, stiffness / parameters.coulomb, at)?;
    friction.contact = Some(Arc::new(contact));
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

    /// Each key of the curve in each kind that takes it, in both directions of settled motion, against
    /// the curve written out; the levels of a direction hold at standstill too.
    #[test]
    fn every_kind_takes_every_key_of_the_curve() {
        let bristle = [("bristle_stiffness", 2e6), ("bristle_damping", 1e3)];
        let more = [
            ("elastic_share", 0.9),
            ("exponent", 1.5),
            ("loading_share", 0.5),
            ("presliding", 1e-5),
            ("lag", 1e-3),
        ];
        let keys = [
            ("coulomb_backward", 70.0),
            ("stiction_backward", 99.0),
            ("stribeck_exponent", 0.8),
            ("viscous_quadratic", 5e3),
            ("viscous_cubic", 4e5),
        ];
        let kinds = FRICTIONS.iter().map(|kind| kind.name);
        for kind in kinds.filter(|kind| !kind.starts_with("coulomb")) {
            for (key, to) in keys {
                let takes = named(FRICTIONS, kind).unwrap().keys;
                let mut numbers = [&bristle[..], &more, &[(key, to)]].concat();
                numbers.retain(|(key, _)| takes.iter().any(|k| k.name() == *key));
                assert!(numbers.contains(&(key, to)), "{kind} does not take {key}");
                let friction = friction(kind, &numbers);
                let contact = friction.contact.as_ref().unwrap();
                let of = |name, otherwise| if name == key { to } else { otherwise };
                for v in [0.02, -0.02, 3e-3, -3e-3_f64] {
                    let [coulomb, stiction] = match v < 0.0 {
                        true => [of("coulomb_backward", 60.0), of("stiction_backward", 85.0)],
                        false => [60.0, 85.0],
                    };
                    let fall = (v.abs() / 4e-3).powf(of("stribeck_exponent", 2.0));
                    let dry = coulomb + (stiction - coulomb) * (-fall).exp();
                    let viscous = 300.0 * v
                        + of("viscous_quadratic", 0.0) * v * v.abs()
                        + of("viscous_cubic", 0.0) * v * v * v;
                    let expected = dry.copysign(v) + viscous;
                    let force = contact.force(&contact.settled(v, 0.0), v);
                    assert!(
                        (force - expected).abs() < 1e-9,
                        "{kind} {key}: {force} {expected}"
                    );
                    let held = contact.force(&contact.settled(0.0, v.signum()), 0.0);
                    assert!(
                        (held - coulomb.copysign(v)).abs() < 1e-9,
                        "{kind} {key}: {held}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_break_away_below_its_level_is_refused() {
        let mut values = Values::default();
        for (key, to) in [
            ("coulomb", 60.0),
            ("stiction", 85.0),
            ("coulomb_backward", 90.0),
            ("stribeck_speed", 4e-3),
            ("bristle_stiffness", 2e6),
            ("bristle_damping", 0.0),
            ("viscous", 300.0),
        ] {
            values.set(key, to);
        }
        let refused = Part::new(named(FRICTIONS, "lugre").unwrap(), values).unwrap_err();
        let message = format!("{refused:?}");
        assert!(
            message.contains("at least as great as coulomb_backward"),
            "{message}"
        );
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
            let contact = friction.contact.as_ref().unwrap();
            for (speed, share) in [(0.0, 0.5), (0.0, -1.0), (0.02, 0.0), (-4e-3, 0.0)] {
                let state = contact.settled(speed, share);
                let expected: f64 = match speed {
                    0.0 => 60.0 * share,
                    v => (60.0 + 25.0 * (-(v / 4e-3_f64).powi(2)).exp()).copysign(v) + 300.0 * v,
                };
                let force = contact.force(&state, speed);
                assert!((force - expected).abs() < 1e-10, "{force} {expected}");
                // A step at that speed changes nothing.
                let (next, after) = contact.step(&state, [speed; 2], 1e-4);
                assert!((after - expected).abs() < 1e-10, "{after}");
                let own = (expected - 300.0 * speed) / 60.0;
                assert!((contact.share(&next) - own).abs() < 1e-12);
            }
        }
    }

    /// Keys with a default are in the values of every file, and a LuGre friction without them is the law LuGre.
    #[test]
    fn a_file_without_keys_of_the_curve_has_the_law_lugre() {
        let file = include_str!("../../../../data/axes/linear-stage.toml");
        let read = |file: &str| crate::Axis::parse("linear-stage.toml", file).unwrap();
        assert!(read(file).friction.contact.is_none());
        let bent = file.replace("coulomb_n = 4\n", "coulomb_n = 4\nstribeck_exponent = 1\n");
        assert!(read(&bent).friction.contact.is_some());
    }
}
