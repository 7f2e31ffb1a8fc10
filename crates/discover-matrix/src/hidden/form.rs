//! Forms of laws: the same friction, stiffness or frame as in the model, in another law.
//!
//! A form is no effect that is missing: it is how the truth differs from any model of it.
//! Three of them are sums of the library's own effects, one of them taken away again; names
//! that say so are neither right nor wrong ([`Form::said_by`]).

use axis_sim::Axis;
use axis_sim::SetupError;
use axis_sim::effects::{
    ActiveEffect, Changes, Effect, EffectChannel, EffectParameter, EffectVariable, Measure, Nature,
    Scales, Steepness,
};
use serde::{Deserialize, Serialize};

/// A law in which the truth differs from the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// None.
    Same,
    /// Dry friction F tanh(v / v₀) in place of a bristle.
    Onset,
    /// Stribeck's fall e^(−(|v| / v_s)^δ) with δ from 1 to 1.6 in place of 2.
    Exponent,
    /// Four Maxwell-slip elements in place of one bristle.
    Slip,
    /// A transmission that hardens a little with its force.
    Hardening,
    /// A frame that swings under the reaction of the drive.
    Frame,
}

impl Form {
    /// Those that differ.
    pub const ALL: [Self; 5] = [
        Self::Onset,
        Self::Exponent,
        Self::Slip,
        Self::Hardening,
        Self::Frame,
    ];

    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Same => "as the model",
            Self::Onset => "tanh onset",
            Self::Exponent => "Stribeck exponent",
            Self::Slip => "Maxwell slip",
            Self::Hardening => "hardening",
            Self::Frame => "frame mode",
        }
    }

    /// Effects of the library that the form is a sum of: to name one of them is neither right
    /// nor wrong.
    pub fn said_by(self) -> &'static [&'static str] {
        match self {
            Self::Slip => &["maxwell-slip-hysteresis", "coulomb-friction"],
            Self::Hardening => &["hardening-stiffness"],
            Self::Frame => &["structural-resonance", "payload-mass"],
            Self::Same | Self::Onset | Self::Exponent => &[],
        }
    }

    /// What makes the truth of this form out of the model's law, `at` three numbers from 0 to
    /// 1 that choose its sizes; `hidden` is what acts beside. `None` where the axis has
    /// nothing that could have this form.
    pub fn on(
        self,
        axis: &Axis,
        hidden: &[ActiveEffect],
        at: [f64; 3],
    ) -> Option<Vec<ActiveEffect>> {
        let scales = Scales::of(axis);
        let between = |low: f64, high: f64, share: f64| low * (high / low).powf(share);
        let (speed, way) = (
            scales.ratio(Measure::Speed),
            scales.ratio(Measure::Displacement),
        );
        let dry = dry_friction(axis, hidden);
        let active = |effect, values| ActiveEffect { effect, values };
        match self {
            Self::Same => Some(Vec::new()),
            Self::Onset => (dry > 0.0).then(|| {
                let at_speed = speed * between(2e-4, 2e-3, at[0]);
                vec![active(&ONSET, vec![dry, at_speed])]
            }),
            Self::Exponent => {
                let [fall, velocity] = stribeck(axis, hidden)?;
                // Half of them 1, Tustin's law.
                let exponent = 1.0 + 0.6 * (2.0 * at[0] - 1.0).max(0.0);
                Some(vec![active(&EXPONENT, vec![fall, velocity, exponent])])
            }
            Self::Slip => (dry > 0.0).then(|| {
                let distance = way * between(2e-5, 1.5e-4, at[0]);
                let slip = library("maxwell-slip-hysteresis", vec![dry, distance]);
                let bristle = library("coulomb-friction", vec![-dry]);
                [slip, bristle].into_iter().flatten().collect()
            }),
            Self::Hardening => {
                axis.mechanism.stiffness()?;
                let harder = library("hardening-stiffness", vec![between(0.05, 0.4, at[0])]);
                Some(harder.into_iter().collect())
            }
            Self::Frame => {
                // Of a frame of 10 to 50 times the load's mass m the reaction's part is
                // m² / M, and slow motion does not feel it.
                let mass = axis.mechanism.load_inertia() / between(10.0, 50.0, at[0]);
                let swings = [mass, between(15.0, 60.0, at[1]), between(0.01, 0.05, at[2])];
                let body = library("structural-resonance", swings.to_vec());
                let slow = library("payload-mass", vec![-mass]);
                Some([body, slow].into_iter().flatten().collect())
            }
        }
    }
}

fn library(name: &str, values: Vec<f64>) -> Option<ActiveEffect> {
    Effect::named(name).map(|effect| ActiveEffect { effect, values })
}

/// Level of the dry friction that slides, the axis' own and hidden one, N or N·m.
fn dry_friction(axis: &Axis, hidden: &[ActiveEffect]) -> f64 {
    let own = axis.friction.law.parameters().coulomb / lever(axis);
    own + value_of(hidden, "coulomb-friction", 0).unwrap_or(0.0)
}

/// Fall from break-away to sliding, N or N·m, and its speed, of what is hidden or else the
/// axis' own.
fn stribeck(axis: &Axis, hidden: &[ActiveEffect]) -> Option<[f64; 2]> {
    let of_hidden = |index| value_of(hidden, "stribeck-friction", index);
    if let (Some(force), Some(velocity)) = (of_hidden(0), of_hidden(1)) {
        return Some([force, velocity]);
    }
    let p = axis.friction.law.parameters();
    let fall = (p.stiction - p.coulomb) / lever(axis);
    (fall > 0.0).then_some([fall, p.stribeck_speed * lever(axis)])
}

fn lever(axis: &Axis) -> f64 {
    axis.friction.lever(axis.travel_per_radian())
}

fn value_of(hidden: &[ActiveEffect], name: &str, index: usize) -> Option<f64> {
    let active = hidden.iter().find(|a| a.effect.name == name)?;
    active.values.get(index).copied()
}

const fn number(name: &'static str, measure: Measure) -> EffectParameter {
    EffectParameter {
        name,
        measure,
        nature: Nature::Held,
        typical: 0.0,
        bounds: [f64::MIN, f64::MAX],
    }
}

const fn form(
    name: &'static str,
    summary: &'static str,
    parameters: &'static [EffectParameter],
    install: fn(&[f64], &mut Changes<'_>) -> Result<(), SetupError>,
) -> Effect {
    Effect {
        name,
        summary,
        channel: EffectChannel::Torque,
        depends_on: "low speed",
        shown_over: EffectVariable::Speed,
        parameters,
        needs: &[],
        install,
    }
}

/// F (tanh(v / v₀) − u), u the unit bristle.
static ONSET: Effect = form(
    "tanh-onset",
    "dry friction that comes on with speed",
    &[
        number("force", Measure::Force),
        number("speed", Measure::Speed),
    ],
    |v, to| {
        let (force, speed) = (v[0], v[1]);
        let steepness = Steepness {
            speed: (force / speed).abs(),
            bristle: force.abs(),
            ..Steepness::default()
        };
        to.load_within(steepness, move |t| {
            force * ((t.speed / speed).tanh() - t.bristle)
        });
        Ok(())
    },
);

/// F (e^(−(|v| / v_s)^δ) − e^(−(v / v_s)²)) u.
static EXPONENT: Effect = form(
    "stribeck-exponent",
    "dry friction that falls with speed by another law",
    &[
        number("force", Measure::Force),
        number("velocity", Measure::Speed),
        number("exponent", Measure::Ratio),
    ],
    |v, to| {
        let (force, velocity, exponent) = (v[0], v[1], v[2]);
        let steepness = Steepness {
            // Slopes of both falls are at most 1 / v_s.
            speed: 2.0 * (force / velocity).abs(),
            bristle: force.abs(),
            ..Steepness::default()
        };
        to.load_within(steepness, move |t| {
            let ratio = (t.speed / velocity).abs();
            force * ((-ratio.powf(exponent)).exp() - (-ratio * ratio).exp()) * t.bristle
        });
        Ok(())
    },
);
