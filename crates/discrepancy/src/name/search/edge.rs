//! A known parameter at the edge of its tolerance is no explanation.
//!
//! Where a parameter would go farther than it may be off, it was fitted to something else. So models with and
//! without something are compared with each parameter that ends at its edge in one of them alone held at what
//! it is in the other. What a thing brings is by how much D falls then:
//!
//! ```text
//! D(without, θ_edge = θ_with) − D(with),   not   D(without, θ_edge = ± tolerance) − D(with)
//! ```
//!
//! and the other way round. A parameter that is known better than to two per cent does little on its way to the
//! edge, and is left where it is.

use axis_sim::effects::ActiveEffect;

use super::state::{Search, WIDE};
use super::types::AtEdge;
use crate::answers::State;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::{pinned, tolerances};

/// Share of a tolerance by which a parameter must be off its edge to be another value.
const OFF_EDGE: f64 = 0.1;

/// What a search leaves of both sets of logs, to be compared with more.
pub(super) struct Beside {
    pub(super) fit: Fit,
    pub(super) check: Fit,
}

impl Search<'_> {
    /// This search's fits, with the parameters that end at their edge held at what they are `with`
    /// something else.
    pub(super) fn beside(&self, with: &State) -> Beside {
        let own = || Beside {
            fit: self.fit.clone(),
            check: self.check.clone(),
        };
        self.held_at(with).unwrap_or_else(own)
    }

    fn held_at(&self, with: &State) -> Option<Beside> {
        let fit = self.held(&self.fit, &with.shares)?;
        let check = self.checker().at(fit.state.clone()).ok()?;
        Some(Beside { fit, check })
    }

    /// A fit with more than this search's, with the parameters that end at their edge there held at what they
    /// are here; `None` where none does.
    pub(super) fn inside(&self, with: &Fit) -> Option<Fit> {
        self.held(with, &self.fit.state.shares)
    }

    /// A fit with those parameters at other shares that are at their edge in it alone.
    fn held(&self, fit: &Fit, others: &[f64]) -> Option<Fit> {
        let shares = &fit.state.shares;
        let places = self.off_edge(shares, others);
        let mut held = vec![false; shares.len()];
        let mut state = fit.state.clone();
        for place in &places {
            (held[*place], state.shares[*place]) = (true, others[*place]);
        }
        let start = (!places.is_empty())
            .then(|| self.fitter().at(state))?
            .ok()?;
        Some((self.fitter()).refine_holding(start, &self.known, 4, &held))
    }

    /// Places of the parameters that are at their edge with the one shares, and not with the others.
    fn off_edge(&self, shares: &[f64], others: &[f64]) -> Vec<usize> {
        let tolerances = tolerances(self.machine);
        let at_edge = pinned(self.machine, shares);
        let is_off = |i: &usize| {
            let off = (shares[*i] - others[*i]).abs() > OFF_EDGE * tolerances[*i];
            at_edge[*i] && off && tolerances[*i] > WIDE
        };
        (0..shares.len()).filter(is_off).collect()
    }

    /// The parameters that are at their edge here, and are not `with` something else.
    pub(super) fn left_their_edge(&self, with: &State) -> Vec<AtEdge> {
        let shares = &self.fit.state.shares;
        let (names, tolerances) = (self.machine.known(), tolerances(self.machine));
        let left = self.off_edge(shares, &with.shares).into_iter();
        left.map(|i| AtEdge {
            name: names[i],
            share: shares[i],
            tolerance: tolerances[i],
        })
        .collect()
    }

    /// By how much D of the fitted logs falls from this search to a fit with these effects more.
    pub(super) fn fall_to(&self, with: &Fit, added: &[ActiveEffect]) -> f64 {
        let (held, inside) = (self.held_at(&with.state), self.inside(with));
        let without = held.as_ref().map_or(&self.fit, |beside| &beside.fit);
        let with = inside.as_ref().unwrap_or(with);
        fall_beside(&self.fitter(), [without, with], added)
    }
}

/// By how much D falls from one fit to another with these effects more; where any of them acts in time, beside
/// all that repeats with the drive.
pub(super) fn fall_beside(
    fitter: &Fitter<'_>,
    [without, with]: [&Fit; 2],
    added: &[ActiveEffect],
) -> f64 {
    let in_time = added.iter().any(|active| active.effect.acts_in_time());
    let deviance = |fit: &Fit| match in_time {
        true => fitter.deviance_apart(fit),
        false => fit.deviance,
    };
    deviance(without) - deviance(with)
}
