//! Any onset of a dry friction, by knots of speed.
//!
//! With the same friction at another bristle,
//!
//! ```text
//! u' = u + p (s(v) − u) + sign(v) Σ c_j h_j(|v|)
//! ```
//!
//! s(v) a saturation at the first knot and h_j hats between the knots of speed, all of it
//! nothing at the last, so that the level of the sliding friction stays that of the effect:
//! a bristle for p = c = 0, tanh(v / v₀) near p = 1.

use super::super::changes;
use super::{ActiveEffect, EffectParameter, Family, HELD, Measure, OWN, begun, held, hooks_of};
use crate::effects::{
    Changes, Effect, EffectChannel, EffectVariable, Steepness, TableState, signed,
};
use crate::error::SetupError;
use crate::part::PartError;

/// Knots of speed.
const ONSET_KNOTS: usize = 8;

/// As shares of the greatest speed: of the onset, then of the fall after break-away. What is not over at a tenth of it is a law over
/// all speeds, and no form of dry friction.
const KNOTS: [f64; ONSET_KNOTS] = [1e-4, 4e-4, 1.6e-3, 5e-3, 1.2e-2, 2.5e-2, 5e-2, 0.1];

/// First of the knots, and of the numbers that are fitted, among the values.
const KNOTS_AT: usize = OWN;
const FORM_AT: usize = KNOTS_AT + ONSET_KNOTS;

const KNOT: EffectParameter = held("knot", Measure::Speed);
const SHARE: EffectParameter = signed("share", Measure::Ratio, 0.5, 5.0);

/// In what form a dry friction comes on with speed.
static ONSET_FORM: Effect = Effect {
    name: "onset-form",
    summary: "onset of a dry friction that differs from a bristle\u{2019}s",
    channel: EffectChannel::Torque,
    depends_on: "low speed",
    shown_over: EffectVariable::Speed,
    // Place of the effect and its values; knots; p and c_1 to c_7.
    parameters: &[
        HELD, HELD, HELD, HELD, HELD, HELD, HELD, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT, KNOT,
        SHARE, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE, SHARE,
    ],
    needs: &[],
    install,
};

pub(super) const FAMILY: Family = Family {
    effect: &ONSET_FORM,
    differs_in: "onset",
    begins: |of| {
        let knots = KNOTS.map(|share| share * of.fastest);
        let rising = knots.windows(2).all(|w| 0.0 < w[0] && w[0] < w[1]);
        let form = begun(&of.friction).filter(|_| rising).map(|mut values| {
            values.extend(knots);
            values.resize(ONSET_FORM.parameters.len(), 0.0);
            ActiveEffect {
                effect: &ONSET_FORM,
                values,
            }
        });
        form.into_iter().collect()
    },
    at: |active, speed| Curve::new(&active.values).bristle(1.0, speed),
    with_speed: |active| Curve::new(&active.values).share,
    whole: |_| None,
    speeds: |active| {
        let knots = Curve::new(&active.values).knots;
        [knots[0], knots[ONSET_KNOTS - 1]]
    },
};

/// u' of the module's text.
#[derive(Clone, Copy)]
struct Curve {
    knots: [f64; ONSET_KNOTS],
    share: f64,
    hats: [f64; ONSET_KNOTS - 1],
}

impl Curve {
    fn new(values: &[f64]) -> Self {
        let numbers: [f64; FORM_AT + ONSET_KNOTS] = changes::array(values);
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

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let curve = Curve::new(values);
    if curve.knots[0].is_nan() || curve.knots[0] <= 0.0 {
        return Err(PartError::of("knot", "is not above 0", "knots of speed that rise").into());
    }
    let hooks = hooks_of(values, to)?;
    let of_base = hooks.steepness();
    let steepness = Steepness {
        position: 4.0 * of_base.position,
        speed: 4.0 * of_base.speed + of_base.bristle * curve.steepest(),
        bristle: of_base.bristle * (2.0 + curve.share.abs()),
        ..of_base
    };
    to.load_within(steepness, move |t| {
        let formed = TableState {
            bristle: curve.bristle(t.bristle, t.speed),
            ..*t
        };
        hooks.loads_at(&formed) - hooks.loads_at(t)
    });
    Ok(())
}
