//! `onset-form`: how the onset of a dry friction differs from that of a bristle.
//!
//! Dry friction that is added to an axis acts through a unit bristle u, as the law of the
//! axis does. On a real machine it may come on with speed instead, or fall with it in
//! another way. With the same friction at another bristle,
//!
//! ```text
//! u' = u + p (s(v) − u) + sign(v) Σ c_j h_j(|v|)
//! ```
//!
//! s(v) a saturation at the first knot and h_j hats between the knots of speed, all of it
//! nothing at the last, so that the level of the sliding friction stays that of the effect:
//! a bristle for p = c = 0, tanh(v / v₀) near p = 1.
//!
//! It is no effect by itself and not in [`EFFECTS`]: it says in which form one is there.

use super::changes::Hooks;
use super::{
    ActiveEffect, EFFECTS, Effect, EffectChannel, EffectParameter, EffectVariable, Measure, Nature,
};
use crate::error::SetupError;
use crate::part::PartError;

/// Knots of speed.
pub const ONSET_KNOTS: usize = 9;

/// Numbers of an effect that can have a form.
const MOST_NUMBERS: usize = 6;

/// First of the knots, and of the numbers that are fitted, among the values.
const KNOTS_AT: usize = 1 + MOST_NUMBERS;
const FORM_AT: usize = KNOTS_AT + ONSET_KNOTS;

const HELD: EffectParameter = held("value", Measure::Ratio);
const KNOT: EffectParameter = held("knot", Measure::Speed);
const SHARE: EffectParameter = super::signed("share", Measure::Ratio, 0.5, 5.0);

const fn held(name: &'static str, measure: Measure) -> EffectParameter {
    super::shape(name, measure, Nature::Held, 0.0, [f64::MIN, f64::MAX])
}

/// In what form a dry friction comes on with speed; made by [`OnsetForm::none`].
pub static ONSET_FORM: Effect = Effect {
    name: "onset-form",
    summary: "onset of a dry friction that differs from a bristle\u{2019}s",
    channel: EffectChannel::Torque,
    depends_on: "low speed",
    shown_over: EffectVariable::Speed,
    // Place of the effect and its values; knots; p and c_1 to c_8.
    parameters: &[
        HELD, HELD, HELD, HELD, HELD, HELD, HELD, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT,
        KNOT, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE,
    ],
    needs: &[],
    install,
};

/// A form of a friction effect.
#[derive(Clone, Copy, Debug)]
pub struct OnsetForm<'a>(&'a ActiveEffect);

impl<'a> OnsetForm<'a> {
    /// The form that an active effect stands for, if it is one.
    pub fn of(active: &'a ActiveEffect) -> Option<Self> {
        (active.effect.name == ONSET_FORM.name).then_some(Self(active))
    }

    /// No difference of form of this effect: a bristle, with the knots of speed given (m/s
    /// or rad/s, rising). `None` of an effect that no bristle moves.
    pub fn none(of: &ActiveEffect, knots: [f64; ONSET_KNOTS]) -> Option<ActiveEffect> {
        let place = EFFECTS.iter().position(|e| e.name == of.effect.name)?;
        let acts = acts_through_bristle(of.effect);
        let rising = knots.windows(2).all(|w| 0.0 < w[0] && w[0] < w[1]);
        if !acts || !rising || of.values.len() > MOST_NUMBERS {
            return None;
        }
        let mut values = vec![0.0; ONSET_FORM.parameters.len()];
        values[0] = place as f64;
        values[1..=of.values.len()].copy_from_slice(&of.values);
        values[KNOTS_AT..FORM_AT].copy_from_slice(&knots);
        Some(ActiveEffect {
            effect: &ONSET_FORM,
            values,
        })
    }

    /// The effect whose form it is, as it was when the form was made.
    pub fn base(&self) -> Option<ActiveEffect> {
        let effect = *EFFECTS.get(*self.0.values.first()? as usize)?;
        let values = self.0.values.get(1..=effect.parameters.len())?.to_vec();
        Some(ActiveEffect { effect, values })
    }

    /// Knots of speed.
    pub fn knots(&self) -> &'a [f64] {
        self.0.values.get(KNOTS_AT..FORM_AT).unwrap_or_default()
    }

    /// Steady friction at a speed above 0, over that of sliding.
    pub fn at(&self, speed: f64) -> f64 {
        Curve::new(&self.0.values).bristle(1.0, speed)
    }

    /// Share of the onset that comes with speed instead of displacement.
    pub fn with_speed(&self) -> f64 {
        self.0.values.get(FORM_AT).copied().unwrap_or(0.0)
    }
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

/// u' of the module's text.
#[derive(Clone, Copy)]
struct Curve {
    knots: [f64; ONSET_KNOTS],
    share: f64,
    hats: [f64; ONSET_KNOTS - 1],
}

impl Curve {
    fn new(values: &[f64]) -> Self {
        let numbers: [f64; FORM_AT + ONSET_KNOTS] = super::changes::array(values);
        Self {
            knots: std::array::from_fn(|i| numbers[KNOTS_AT + i]),
            share: numbers[FORM_AT],
            hats: std::array::from_fn(|i| numbers[FORM_AT + 1 + i]),
        }
    }

    fn bristle(&self, u: f64, speed: f64) -> f64 {
        let saturated = (speed / self.knots[0]).clamp(-1.0, 1.0);
        u + self.share * (saturated - u) + self.between(speed.abs()) * speed.signum()
    }

    /// Linear between the knots, 0 at rest and from the last on.
    fn between(&self, speed: f64) -> f64 {
        let [mut from, mut value] = [0.0; 2];
        for (i, &to) in self.knots.iter().enumerate() {
            let next = self.hats.get(i).copied().unwrap_or(0.0);
            if speed < to {
                return value + (next - value) * (speed - from) / (to - from);
            }
            (from, value) = (to, next);
        }
        0.0
    }

    /// Most by which u' changes with the speed.
    fn steepest(&self) -> f64 {
        let [mut from, mut value, mut steepest] = [0.0_f64; 3];
        for (i, &to) in self.knots.iter().enumerate() {
            let next = self.hats.get(i).copied().unwrap_or(0.0);
            steepest = steepest.max(((next - value) / (to - from)).abs());
            (from, value) = (to, next);
        }
        steepest + (self.share / self.knots[0]).abs()
    }
}

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let active = ActiveEffect {
        effect: &ONSET_FORM,
        values: values.to_vec(),
    };
    let curve = Curve::new(values);
    if curve.knots[0].is_nan() || curve.knots[0] <= 0.0 {
        return Err(PartError::of("knot", "is not above 0", "knots of speed that rise").into());
    }
    let Some(base) = OnsetForm(&active).base() else {
        return Err(PartError::of("value", "names no effect", "the place of an effect").into());
    };
    // The same friction with another bristle, less it with the bristle as it is.
    let mut hooks = Hooks::default();
    let mut axis = to.axis.clone();
    (base.effect.install)(
        &base.values,
        &mut super::Changes {
            axis: &mut axis,
            hooks: &mut hooks,
        },
    )?;
    let of_base = hooks.steepness();
    let steepness = super::Steepness {
        position: 4.0 * of_base.position,
        speed: 4.0 * of_base.speed + of_base.bristle * curve.steepest(),
        bristle: of_base.bristle * (2.0 + curve.share.abs()),
        ..of_base
    };
    to.load_within(steepness, move |t| {
        let formed = super::TableState {
            bristle: curve.bristle(t.bristle, t.speed),
            ..*t
        };
        hooks.loads_at(&formed) - hooks.loads_at(t)
    });
    Ok(())
}
