//! Forms of a dry friction: how its law differs from that of the library, with the same level.
//!
//! Dry friction that is added to an axis acts through a unit bristle u, as the law of the axis does. On a
//! real machine it may come on with speed instead, or fall with it in another way. A form is no effect by
//! itself and not in [`EFFECTS`](super::EFFECTS): it says in which form one is there, and is made by
//! [`FrictionForm::all`].
//!
//! | form | family |
//! |---|---|
//! | `onset-form` | [`onset`]: any onset, by knots of speed |
//! | `arctan-form`, `tanh-form` | [`smooth`]: an onset along a smooth curve of one speed |
//! | `exponent-form` | [`exponent`]: it falls as e^(−(v / v_s)^δ) |

mod exponent;
mod onset;
mod smooth;

use super::hooks::Hooks;
use super::{ActiveEffect, Changes, EFFECTS, Effect, EffectParameter, Measure, Nature};
use crate::error::SetupError;
use crate::part::PartError;

/// A family of forms: one file each, and one line in [`FAMILIES`].
struct Family {
    effect: &'static Effect,
    /// What of the law differs, in words.
    differs_in: &'static str,
    /// Forms from which a search begins, with each start of a shape; none of a friction that cannot have it.
    begins: fn(&Formed) -> Vec<ActiveEffect>,
    /// Steady friction at a speed above 0, over that of sliding.
    at: fn(&ActiveEffect, f64) -> f64,
    /// Share of the onset that comes with speed instead of displacement.
    with_speed: fn(&ActiveEffect) -> f64,
    /// See [`FrictionForm::whole`]; `None` of a family without such a form.
    whole: fn(&ActiveEffect) -> Option<ActiveEffect>,
    /// Speeds between which it differs from the law of the library.
    speeds: fn(&ActiveEffect) -> [f64; 2],
}

static FAMILIES: [Family; 4] = [
    onset::FAMILY,
    smooth::ARCTAN,
    smooth::TANH,
    exponent::FAMILY,
];

/// A friction of which the form may be another.
#[derive(Clone, Debug)]
pub struct Formed {
    /// The effect, or the axis' own friction as one.
    pub friction: ActiveEffect,
    /// Its fall from break-away to sliding, and the speed of that fall; `None` of one that does not fall.
    pub fall: Option<[f64; 2]>,
    /// The greatest speed of the motions.
    pub fastest: f64,
}

/// Numbers of an effect that can have a form.
const MOST_NUMBERS: usize = 6;

/// Where a form's own values begin: the place of its effect and that effect's values stand before them.
const OWN: usize = 1 + MOST_NUMBERS;

const HELD: EffectParameter = held("value", Measure::Ratio);

const fn held(name: &'static str, measure: Measure) -> EffectParameter {
    super::shape(name, measure, Nature::Held, 0.0, [f64::MIN, f64::MAX])
}

/// A form of a friction effect.
#[derive(Clone, Copy)]
pub struct FrictionForm<'a> {
    active: &'a ActiveEffect,
    family: &'static Family,
}

impl<'a> FrictionForm<'a> {
    /// The form that an active effect stands for, if it is one.
    pub fn of(active: &'a ActiveEffect) -> Option<Self> {
        let family = family_of(active.effect.name)?;
        Some(Self { active, family })
    }

    /// Whether an effect of this name is a form.
    pub fn is_one(name: &str) -> bool {
        family_of(name).is_some()
    }

    /// All forms that a friction can have, as a search may begin with them: with sizes of 0 they change
    /// nothing. Those of one family follow each other.
    pub fn all(of: &Formed) -> Vec<ActiveEffect> {
        let families = FAMILIES.iter();
        families.flat_map(|family| (family.begins)(of)).collect()
    }

    /// The effect whose form it is, as it was when the form was made.
    pub fn base(&self) -> Option<ActiveEffect> {
        base(&self.active.values)
    }

    /// What of the law differs, in words: its onset, or its fall with speed.
    pub fn differs_in(&self) -> &'static str {
        self.family.differs_in
    }

    /// Speeds between which it differs from the law of the library, m/s or rad/s.
    pub fn speeds(&self) -> [f64; 2] {
        (self.family.speeds)(self.active)
    }

    /// Steady friction at a speed above 0, over that of sliding.
    pub fn at(&self, speed: f64) -> f64 {
        (self.family.at)(self.active, speed)
    }

    /// Another start of a search: the form of its family that comes on with speed alone and has the same ∫(1 − u') dv. Logs determine
    /// this integral well, but share and speed separately only if they show the slowest motion.
    pub fn whole(&self) -> Option<ActiveEffect> {
        (self.family.whole)(self.active)
    }

    /// Share of the onset that comes with speed instead of displacement.
    pub fn with_speed(&self) -> f64 {
        (self.family.with_speed)(self.active)
    }
}

fn family_of(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().find(|family| family.effect.name == name)
}

/// The effect whose form these values are of.
fn base(values: &[f64]) -> Option<ActiveEffect> {
    let effect = *EFFECTS.get(*values.first()? as usize)?;
    let values = values.get(1..=effect.parameters.len())?.to_vec();
    Some(ActiveEffect { effect, values })
}

/// What the effect does whose form these values are of: the form is it at another bristle, less it as it is.
fn hooks_of(values: &[f64], to: &Changes<'_>) -> Result<Hooks, SetupError> {
    let Some(base) = base(values) else {
        return Err(PartError::of("value", "names no effect", "the place of an effect").into());
    };
    let mut hooks = Hooks::default();
    let mut axis = to.axis.copy();
    let mut changes = Changes {
        axis: &mut *axis,
        hooks: &mut hooks,
    };
    (base.effect.install)(&base.values, &mut changes)?;
    Ok(hooks)
}

/// Values of a form of an effect, but for its own; `None` of an effect that no bristle moves.
fn begun(of: &ActiveEffect) -> Option<Vec<f64>> {
    let place = EFFECTS.iter().position(|e| e.name == of.effect.name)?;
    let acts = acts_through_bristle(of.effect) && of.values.len() <= MOST_NUMBERS;
    acts.then(|| {
        let mut values = vec![0.0; OWN];
        values[0] = place as f64;
        values[1..=of.values.len()].copy_from_slice(&of.values);
        values
    })
}

/// Whether an effect changes with the unit bristle.
fn acts_through_bristle(effect: &Effect) -> bool {
    let friction = [
        "coulomb-friction",
        "asymmetric-friction",
        "position-dependent-friction",
        "stribeck-friction",
    ];
    friction.contains(&effect.name)
}

#[cfg(test)]
mod tests {
    use super::{ActiveEffect, Changes, Formed, FrictionForm, Hooks};
    use crate::effects::{Effect, TableState};

    fn forms(name: &str, values: &[f64], fall: Option<[f64; 2]>) -> Vec<ActiveEffect> {
        FrictionForm::all(&Formed {
            friction: ActiveEffect {
                effect: Effect::named(name).unwrap(),
                values: values.to_vec(),
            },
            fall,
            fastest: 0.5,
        })
    }

    #[test]
    fn a_form_begins_as_the_law_of_the_library_and_knows_its_friction() {
        let all = forms("coulomb-friction", &[40.0], Some([15.0, 0.01]));
        // Knots, four speeds of each smooth curve, an exponent.
        assert_eq!(all.len(), 1 + 4 + 4 + 1);
        for active in &all {
            let form = FrictionForm::of(active).unwrap();
            assert_eq!(form.base().unwrap().values, [40.0]);
            let [from, to] = form.speeds();
            assert!(0.0 < from && from < to);
            for share in [0.01, 0.1, 1.0] {
                assert!((form.at(share * to) - 1.0).abs() < 1e-12);
            }
        }
        // A friction that does not fall has no exponent, and a load no form at all.
        assert_eq!(forms("asymmetric-friction", &[40.0, 30.0], None).len(), 9);
        assert!(forms("constant-load", &[40.0], None).is_empty());
    }

    /// Tustin's law, an exponent of 1, by its formula.
    #[test]
    fn an_exponent_of_one_is_tustins_law() {
        let (level, fall, velocity) = (40.0, 15.0, 0.01);
        let mut all = forms("coulomb-friction", &[level], Some([fall, velocity]));
        let mut active = all.pop().unwrap();
        *active.values.last_mut().unwrap() = 1.0;
        let form = FrictionForm::of(&active).unwrap();
        for ratio in [0.1_f64, 0.5, 1.0, 2.5] {
            let law = level + fall * (-ratio).exp();
            let of_library = level + fall * (-ratio * ratio).exp();
            let expected = 1.0 + (law - of_library) / level;
            assert!((form.at(ratio * velocity) - expected).abs() < 1e-12);
        }
    }

    /// By their formulas: a bristle of the shares that are left, beside the curve.
    #[test]
    fn smooth_onsets_are_their_curves() {
        let curves = [
            |x: f64| 2.0 * x.atan() / std::f64::consts::PI,
            |x: f64| x.tanh(),
        ];
        for (name, curve) in ["arctan-form", "tanh-form"].into_iter().zip(curves) {
            let all = forms("coulomb-friction", &[40.0], None);
            let mut active = all.into_iter().find(|a| a.effect.name == name).unwrap();
            let [share, velocity] = active.values.last_chunk_mut().unwrap();
            (*share, *velocity) = (0.7, 3e-3);
            let form = FrictionForm::of(&active).unwrap();
            for speed in [1e-4, 3e-3, 0.05] {
                let expected = 0.3 + 0.7 * curve(speed / 3e-3);
                assert!((form.at(speed) - expected).abs() < 1e-12);
            }
            assert!((form.with_speed() - 0.7).abs() < 1e-15);
            let whole = form.whole().unwrap();
            let end = (whole.values.len() - 2..whole.values.len()).map(|i| whole.values[i]);
            assert_eq!(end.collect::<Vec<_>>(), [1.0, 0.7 * 3e-3]);
        }
    }

    /// What a smooth onset installs, and what is reported of it, at constant speed under a full bristle: friction that
    /// falls comes on with the speed as a whole.
    #[test]
    fn a_smooth_onset_carries_what_falls() {
        let (level, fall, velocity) = (40.0, 15.0, 0.01);
        let all = forms("coulomb-friction", &[level], Some([fall, velocity]));
        let mut active = (all.into_iter())
            .find(|a| a.effect.name == "tanh-form")
            .unwrap();
        *active.values.last_chunk_mut().unwrap() = [1.0, 3e-3];
        let file = include_str!("../../../../../data/axes/linear-motor.toml");
        let mut axis = crate::Axis::parse("linear-motor.toml", file).unwrap();
        let mut hooks = Hooks::default();
        let mut changes = Changes {
            axis: &mut axis,
            hooks: &mut hooks,
        };
        (active.effect.install)(&active.values, &mut changes).unwrap();
        for speed in [2e-4_f64, 3e-3, 0.05] {
            let own = level + fall * (-(speed / velocity).powi(2)).exp();
            let now = own * (speed / 3e-3).tanh();
            let state = TableState {
                speed,
                bristle: 1.0,
                ..TableState::default()
            };
            assert!((own + hooks.loads_at(&state) - now).abs() < 1e-9);
            let form = FrictionForm::of(&active).unwrap();
            assert!((own + level * (form.at(speed) - 1.0) - now).abs() < 1e-9);
        }
    }
}
