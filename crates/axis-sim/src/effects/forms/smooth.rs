//! Dry friction that comes on with speed along a smooth curve of one speed.
//!
//! ```text
//! u' = u + p (s(v / v₀) − u)
//! ```
//!
//! p is the share that comes on with speed. Simulations use s(x) = 2/π arctan x and s(x) = tanh x in the place of a
//! jump (Pennestrì, Rossi, Salvini, Valentini, Nonlinear Dyn. 83 (2016) 1785, doi:10.1007/s11071-015-2485-3); what
//! is logged of a machine on a film of oil looks like them. Two numbers carry over to other motion better than
//! the knots of `onset-form` do.

use std::f64::consts::FRAC_2_PI;

use super::super::changes;
use super::{ActiveEffect, Family, HELD, Measure, Nature, OWN, begun, held, hooks_of};
use crate::effects::{
    Changes, Effect, EffectChannel, EffectParameter, EffectVariable, Hooks, Steepness, TableState,
    positive, shape,
};
use crate::error::SetupError;
use crate::part::PartError;

/// Speeds v₀ from which a search begins, as shares of the greatest speed.
const BEGINS: [f64; 4] = [2e-4, 8e-4, 3e-3, 1.2e-2];

/// Speeds between which a curve is shown, as shares of v₀: arctan is within 2 % of its end at the last.
const SHOWN: [f64; 2] = [0.1, 30.0];

// Place of the effect and its values; fall of the friction and its speed; p and v₀.
const PARAMETERS: [EffectParameter; OWN + 4] = [
    HELD,
    HELD,
    HELD,
    HELD,
    HELD,
    HELD,
    HELD,
    held("fall", Measure::Force),
    held("fall_velocity", Measure::Speed),
    positive("share", Measure::Ratio, 0.5, 1.0),
    shape(
        "velocity",
        Measure::Speed,
        Nature::Speed([1e-4, 1e-3, 1e-2], [1e-4, 1e-2]),
        1e-3,
        // A fiftieth of the reference machine's speed: above that it is no onset, but a curve over all speeds, which makes up for
        // viscous friction and moves the level.
        [1e-8, 2.4e-3],
    ),
];

const fn effect(
    name: &'static str,
    summary: &'static str,
    install: fn(&[f64], &mut Changes<'_>) -> Result<(), SetupError>,
) -> Effect {
    Effect {
        name,
        summary,
        channel: EffectChannel::Torque,
        depends_on: "low speed",
        shown_over: EffectVariable::Speed,
        parameters: &PARAMETERS,
        needs: &[],
        install,
    }
}

static ARCTAN_FORM: Effect = effect(
    "arctan-form",
    "dry friction that comes on with speed as an arctangent",
    |values, to| install(values, to, arctan),
);

static TANH_FORM: Effect = effect(
    "tanh-form",
    "dry friction that comes on with speed as a hyperbolic tangent",
    |values, to| install(values, to, f64::tanh),
);

fn arctan(x: f64) -> f64 {
    FRAC_2_PI * x.atan()
}

/// A family that differs in its curve alone.
const fn family(
    effect: &'static Effect,
    begins: fn(&super::Formed) -> Vec<ActiveEffect>,
    at: fn(&ActiveEffect, f64) -> f64,
) -> Family {
    Family {
        effect,
        differs_in: "onset",
        begins,
        at,
        with_speed: |active| Onset::new(&active.values).share,
        whole,
        speeds: |active| SHOWN.map(|by| by * Onset::new(&active.values).velocity),
    }
}

pub(super) const ARCTAN: Family = family(
    &ARCTAN_FORM,
    |of| begins(of, &ARCTAN_FORM),
    |active, speed| Onset::new(&active.values).at(speed, arctan),
);

pub(super) const TANH: Family = family(
    &TANH_FORM,
    |of| begins(of, &TANH_FORM),
    |active, speed| Onset::new(&active.values).at(speed, f64::tanh),
);

fn begins(of: &super::Formed, effect: &'static Effect) -> Vec<ActiveEffect> {
    let [fall, velocity] = of.fall.unwrap_or([0.0, 1.0]);
    let speeds = BEGINS.map(|share| share * of.fastest).into_iter();
    let speeds = speeds.filter(|v| v.is_finite() && *v > 0.0);
    let form = |v| {
        let mut values = begun(&of.friction)?;
        values.extend([fall, velocity, 0.0, v]);
        Some(ActiveEffect { effect, values })
    };
    speeds.filter_map(form).collect()
}

/// With a share of 1; the area between curve and sliding friction is p v₀ times a number of the curve.
fn whole(active: &ActiveEffect) -> Option<ActiveEffect> {
    let mut whole = active.clone();
    let [share, velocity] = whole.values.last_chunk_mut()?;
    if !(*share > 0.0 && *share < 1.0) {
        return None;
    }
    *velocity *= *share;
    *share = 1.0;
    Some(whole)
}

/// The module's text in numbers.
#[derive(Clone, Copy)]
struct Onset {
    /// Of a friction that falls: that of sliding.
    level: f64,
    fall: f64,
    fall_velocity: f64,
    share: f64,
    velocity: f64,
}

impl Onset {
    fn new(values: &[f64]) -> Self {
        let numbers: [f64; OWN + 4] = changes::array(values);
        Self {
            level: numbers[1],
            fall: numbers[OWN],
            fall_velocity: numbers[OWN + 1],
            share: numbers[OWN + 2],
            velocity: numbers[OWN + 3],
        }
    }

    /// Steady friction over that of sliding: what falls comes on along the curve too.
    fn at(self, speed: f64, curve: impl Fn(f64) -> f64) -> f64 {
        let onset = self.bristle(1.0, speed, curve);
        match self.fall == 0.0 {
            true => onset,
            false => onset + self.falling(speed) / self.level * (onset - 1.0),
        }
    }

    /// u' of u.
    fn bristle(self, u: f64, speed: f64, curve: impl Fn(f64) -> f64) -> f64 {
        u + self.share * (curve(speed / self.velocity) - u)
    }

    /// What the friction has beyond its sliding level, N or N·m.
    fn falling(self, speed: f64) -> f64 {
        self.fall * (-(speed / self.fall_velocity).powi(2)).exp()
    }
}

fn install(values: &[f64], to: &mut Changes<'_>, curve: fn(f64) -> f64) -> Result<(), SetupError> {
    let onset = Onset::new(values);
    let is_above = |v: f64| v.is_finite() && v > 0.0;
    if !is_above(onset.velocity) || !is_above(onset.fall_velocity) {
        return Err(PartError::of("velocity", "is not above 0", "numbers above 0").into());
    }
    let hooks: Hooks = hooks_of(values, to)?;
    let of_base = hooks.steepness();
    let most = of_base.bristle + onset.fall.abs();
    let steepness = Steepness {
        position: 2.0 * of_base.position,
        // Both curves are steepest at rest, by 1/v₀ at most; the fall by less than 1/v_s.
        speed: 2.0 * of_base.speed
            + most * (onset.share / onset.velocity).abs()
            + 2.0 * (onset.fall / onset.fall_velocity).abs(),
        bristle: most * onset.share.abs(),
        ..of_base
    };
    to.load_within(steepness, move |t| {
        let bristle = onset.bristle(t.bristle, t.speed, curve);
        let formed = TableState { bristle, ..*t };
        let falling = onset.falling(t.speed) * (bristle - t.bristle);
        hooks.loads_at(&formed) - hooks.loads_at(t) + falling
    });
    Ok(())
}
