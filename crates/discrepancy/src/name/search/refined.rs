//! Candidates after refinement by simulation.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect, Nature};

use super::types::RunnerUp;
use crate::estimate::fit::Fit;
use crate::name::screen::Screened;

/// Share of what the best explains from which on a candidate is compared with it where both end.
pub(super) const NEAR: f64 = 0.8;

/// One effect, or two, after refinement by simulation.
pub(super) struct Refined {
    pub(super) parts: Vec<Screened>,
    pub(super) fit: Fit,
    pub(super) gain: f64,
}

/// What became of candidates.
pub(super) struct Refinement {
    /// Those that may be named, the simplest of the best first.
    pub(super) kept: Vec<Refined>,
    /// Effects that ended, alone, where nothing of them is to be seen but what a simpler one does: a body
    /// that swings faster than logs show is a mass.
    pub(super) unseen: Vec<&'static str>,
}

impl Refinement {
    /// Whether an effect ended, wherever it began, as a simpler one.
    pub(super) fn ended_unseen(&self, name: &str) -> bool {
        let is_it = |r: &Refined| r.parts.len() == 1 && r.parts[0].effect.name == name;
        self.unseen.contains(&name) && !self.kept.iter().any(is_it)
    }
}

impl Refined {
    /// The effects that it adds, one for each of its parts.
    pub(super) fn added(&self) -> &[ActiveEffect] {
        let effects = &self.fit.state.effects;
        &effects[effects.len().saturating_sub(self.parts.len())..]
    }

    /// Numbers that were fitted.
    pub(super) fn parameters(&self) -> usize {
        let all = self.parts.iter().flat_map(|p| p.effect.parameters);
        all.filter(|p| p.nature != Nature::Held).count()
    }

    /// Whether a size is as large as it may be.
    fn ends_at_bound(&self) -> bool {
        self.reaches_bound(1.0, |_| true)
    }

    /// Whether a size of one of these effects reaches that share of its bound.
    fn reaches_bound(&self, share: f64, of: impl Fn(&Effect) -> bool) -> bool {
        let mut pairs = self.added().iter().zip(&self.parts);
        pairs.any(|(active, part)| {
            let mut sizes = active.effect.parameters.iter().zip(&active.values);
            of(active.effect)
                && sizes.any(|(p, value)| {
                    // Some sizes cannot be negative; nothing of them is no bound.
                    let is_near = |edge: &f64| *edge != 0.0 && value / edge >= share;
                    p.is_size() && p.bounds(&part.scales).iter().any(is_near)
                })
        })
    }

    pub(super) fn runner_up(&self) -> RunnerUp {
        RunnerUp {
            name: self.parts[0].effect.name,
            gain: self.gain,
        }
    }
}

/// Effects that no axis file has a parameter for, and of which there cannot be less than none:
/// a mass that swings, a friction that remembers or grows with the load.
const NEVER_BELOW_NONE: [&str; 3] = [
    "structural-resonance",
    "maxwell-slip-hysteresis",
    "load-dependent-friction",
];

/// Share of the bound of what an effect may change a parameter of the axis by that is taken for the
/// bound: derivatives are of no use there, and a fit may end a little inside.
const NEAR_BOUND: f64 = 0.95;

impl Refined {
    /// Whether it is less than none of something, or changes a parameter of this machine to the
    /// bound of what is plausible: then it stands for something else. Of a parameter that is not
    /// known the tolerance is a bound downward already, to which noise of the acceleration draws an
    /// inertia.
    pub(super) fn is_below_none(&self, machine: &Axis) -> bool {
        if self.reaches_bound(NEAR_BOUND, |effect| effect.roles().next().is_some()) {
            return true;
        }
        let is_unknown = |a: &&ActiveEffect| a.effect.roles().any(|role| machine.is_unknown(role));
        if self
            .added()
            .iter()
            .filter(is_unknown)
            .any(|a| a.values[0] < 0.0)
        {
            return true;
        }
        let mut never = self
            .added()
            .iter()
            .filter(|a| NEVER_BELOW_NONE.contains(&a.effect.name));
        never.any(|a| a.values[0] < 0.0)
    }
}

/// Keeps the first of those that were begun with one effect in several shapes.
pub(super) fn best_of_each(refined: &mut Vec<Refined>) {
    let mut seen: Vec<&str> = Vec::new();
    refined.retain(|r| match r.parts.as_slice() {
        [one] if !r.is_form() => {
            let new = !seen.contains(&one.effect.name);
            seen.push(one.effect.name);
            new
        }
        _ => true,
    });
}

/// Share of what an effect with a size at its bound explains that a simpler one must explain to be
/// taken first: what asks for more than there can be was fitted to something else, as friction of
/// a way back that was not run is to noise at rest.
const INSIDE: f64 = 0.5;

/// Simpler effects before one that ends at a bound.
pub(super) fn inside_before_bound(refined: &mut [Refined]) {
    let is_at_bound = |r: &&Refined| !r.has_form() && r.ends_at_bound();
    let Some(first) = refined.first().filter(is_at_bound) else {
        return;
    };
    let (least, most) = (INSIDE * first.gain, first.parameters());
    let is_simpler = |r: &Refined| {
        !r.is_form() && r.parameters() < most && r.gain >= least && !r.ends_at_bound()
    };
    if let Some(at) = refined.iter().position(is_simpler) {
        refined[..=at].rotate_right(1);
    }
}

/// Share of what two effects explain together that one must explain to be taken first: the
/// other then follows, or what is there does. Pairs are for what nearly cancels.
const ALONE: f64 = 0.5;

/// An effect that explains much alone before two that explain more together.
pub(super) fn single_before_pair(refined: &mut [Refined]) {
    let is_pair = |r: &&Refined| r.parts.len() > 1 && !r.has_form();
    let Some(first) = refined.first().filter(is_pair) else {
        return;
    };
    let least = ALONE * first.gain;
    let single = refined
        .iter()
        .position(|r| r.parts.len() == 1 && !r.is_form() && r.gain >= least);
    if let Some(at) = single {
        refined[..=at].rotate_right(1);
    }
}
