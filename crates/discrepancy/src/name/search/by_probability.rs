//! What the posterior names, fitted to the logs of the fit alone.

use std::sync::Arc;

use axis_sim::ReplayError;
use axis_sim::effects::ActiveEffect;

use super::form::is_form;
use super::intervals::Intervals;
use super::state::Search;
use super::types::{Alike, Found, Named};
use crate::answers::{LogSet, State};
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::Fit;
use crate::name::curves::Curves;
use crate::name::library::Library;
use crate::posterior::{Answer, Base, answer, friction_of, onset_of, together};

/// Rounds of a fit of all that is named.
const ROUNDS: usize = 12;

impl Search<'_> {
    /// Names what is probable given the logs to fit and to check together; sizes are fitted to the
    /// former, so that the latter show how far the model carries.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run.
    pub(super) fn by_probability(
        mut self,
        base: Fit,
        as_filed: &LogSet,
    ) -> Result<Found, ReplayError> {
        let begun = self.with_accepted()?;
        let logs = [&self.fit_logs, &self.check_logs];
        let (answer, library) = answer(self.machine, logs, begun, self.settings)?;
        self.library = Arc::new(library.of_first_logs(self.fit_logs.logs.len()));
        self.leftover = answer.posterior.runners_up();
        let mut effects = answer.state.effects.clone();
        let without = self.clone();
        let (mut search, mut intervals) = loop {
            // Each must run without the others as well: an inertia below zero beside one above is no
            // machine.
            while !self.runs_without_each(&effects) {
                effects.pop();
            }
            let mut search = without.clone();
            search.take(&effects, &answer)?;
            let intervals = search.intervals()?;
            // Of what the fitted logs alone give no size, there is nothing to say.
            match search.without_size(&intervals) {
                Some(place) if place < effects.len() => drop(effects.remove(place)),
                _ => break (search, intervals),
            }
        };
        // Sizes of the fitted logs must hold on the check logs.
        if let Some(refused) = search.refused(as_filed, &without)? {
            search = without.with_refused(refused);
            intervals = search.intervals()?;
        }
        let mut found = search.finish(base, intervals);
        found.answer = Some(answer);
        Ok(found)
    }

    /// The state with the effects that the engineer takes as there.
    fn with_accepted(&self) -> Result<State, ReplayError> {
        let state = State {
            shares: self.fit.state.shares.clone(),
            effects: Vec::new(),
        };
        if self.settings.accepted.is_empty() {
            return Ok(state);
        }
        let logs = together(&self.fit_logs, &self.check_logs);
        let base = Base::new(self.machine, logs, &state, self.settings, None)?;
        base.with_all(&self.settings.accepted)
    }

    /// Whether the machine runs without any one of these effects.
    fn runs_without_each(&self, effects: &[ActiveEffect]) -> bool {
        let without = |place: usize| {
            let mut state = State {
                shares: self.fit.state.shares.clone(),
                effects: effects.to_vec(),
            };
            state.remove(place);
            self.fitter().at(state).is_ok()
        };
        (0..effects.len()).all(without)
    }

    /// The place of an effect that is not accepted, of which the 95 % intervals of all sizes hold zero.
    fn without_size(&self, intervals: &Intervals) -> Option<usize> {
        let state = &self.fit.state;
        let free = free_parameters(state).into_iter().enumerate();
        let free: Vec<(usize, (usize, usize))> = free.collect();
        // How many times its size the interval of the best known size reaches.
        let unsure = |place: usize| {
            let sizes = free.iter().filter(|(_, (effect, parameter))| {
                *effect == place && state.effects[place].effect.parameters[*parameter].is_size()
            });
            let reach = sizes.map(|(at, (_, parameter))| {
                let value = state.effects[place].values[*parameter];
                let half = intervals.half_width(state.shares.len() + at, value);
                half / value.abs().max(f64::MIN_POSITIVE)
            });
            reach.reduce(f64::min).unwrap_or(0.0)
        };
        let accepted = |name: &str| self.settings.accepted.iter().any(|a| a == name);
        let named = self.named.iter().enumerate();
        let named = named.filter(|(_, n)| !n.is_form() && !accepted(n.name));
        let unsure = named.map(|(place, _)| (place, unsure(place)));
        let unsure = unsure.filter(|(_, reach)| *reach >= 1.0);
        unsure
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(place, _)| place)
    }

    /// Fits these effects, and what each brings.
    fn take(&mut self, effects: &[ActiveEffect], answer: &Answer) -> Result<(), ReplayError> {
        let mut state = State {
            shares: self.fit.state.shares.clone(),
            effects: effects.to_vec(),
        };
        let has_form = state.effects.iter().any(is_form);
        if answer.other_form && !has_form {
            state.effects.extend(self.form(&state));
        }
        if state.effects.is_empty() {
            return Ok(());
        }
        let begun = state.effects.clone();
        let fitter = self.fitter();
        let near = fitter.at(state)?;
        let known = fitter.known_columns(&near);
        let fit = fitter.refine(near, &known, ROUNDS);
        let (fit, known) = fitter.calibrated(fit, known);
        let check = self.checker().at(fit.state.clone())?;
        for (place, active) in begun.iter().enumerate() {
            let mut other = fit.state.clone();
            other.remove(place);
            let fitted = self.fitter().at(other.clone())?;
            let fitted = self.fitter().refine(fitted, &known, ROUNDS);
            let mut classes = answer.named.iter();
            let class = classes.find(|n| n.name == active.effect.name);
            let alike = class.map_or(&[][..], |n| &n.alike).iter();
            let alike = alike.map(|fitted| Alike {
                fitted: fitted.clone(),
            });
            self.named.push(Named {
                name: active.effect.name,
                evidence: fitted.deviance - fit.deviance,
                held_out: self.checker().at(other)?.deviance - check.deviance,
                alike: alike.collect(),
                when_named: active.values.clone(),
                runners_up: Vec::new(),
            });
        }
        self.fit = fit;
        self.known = known;
        self.check = check;
        Ok(())
    }

    /// The form of the dry friction that is there in a state, as in the model.
    fn form(&self, state: &State) -> Option<ActiveEffect> {
        let speeds = self.fit.traces.iter().flat_map(|t| &t.speed);
        let fastest = speeds.fold(0.0_f64, |most, v| most.max(v.abs()));
        onset_of(&friction_of(self.machine, state)?, fastest)
    }
}

impl Library {
    /// The same on the first logs alone.
    fn of_first_logs(&self, count: usize) -> Self {
        let first = |columns: &Columns| columns.iter().map(|c| c[..count].to_vec()).collect();
        let mut candidates = self.candidates.clone();
        for candidate in &mut candidates {
            candidate.columns = first(&candidate.columns);
        }
        let shapes = self.curves.shapes.iter();
        let shapes = shapes.map(|(shape, columns)| (shape.clone(), first(columns)));
        Self {
            candidates,
            curves: Curves {
                shapes: shapes.collect(),
            },
            known: first(&self.known),
        }
    }
}
