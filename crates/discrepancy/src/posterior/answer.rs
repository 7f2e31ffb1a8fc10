//! The posterior, and what of it is named.

use std::collections::BTreeMap;

use axis_sim::effects::{ActiveEffect, Effect, FrictionForm, Scales};
use axis_sim::{Axis, ReplayError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::base::{BY_DIRECTION, Base, PLAIN, friction_of, size_over_typical, together};
use super::evidence::CHOICE;
use super::hypotheses::{Explanation, Key, Space};
use super::prior::Odds;
use super::nuisance::onset_of;
use super::process::LENGTHS;
use super::relinearised::{Begun, Solution};
use crate::answers::{LogSet, State};
use crate::estimate::columns::is_free;
use crate::estimate::fit::Fitter;
use crate::name::library::{Library, values_at};
use crate::name::search::{RunnerUp, Settings};
use crate::spectrum::Amplitudes;

/// Probability from which a name is given.
pub const LEVEL: f64 = 0.99;

/// The same that the dry friction has another form.
const FORM_LEVEL: f64 = 0.999;

/// ln of the evidence by which logs must tell two effects apart.
pub const TELLS_APART: f64 = 4.6;

/// Share of a channel's noise power that must go with an effect for it to be named.
const MATERIAL: f64 = 0.02;

/// Single effects, and other sets, that are looked at about their own solution.
const RELINEARISED: usize = 6;

/// ln by which a set may be behind the best and is still looked at.
const BEHIND: f64 = 30.0;
const SHARE_BEHIND: f64 = 0.3;

/// One explanation of the ten best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Explained {
    /// Names of effects.
    pub effects: Vec<String>,
    /// On what a law outside the library depends.
    pub law: Option<String>,
    /// Probability.
    pub probability: f64,
    /// ln of its probability over that of nothing.
    pub ln_odds: f64,
}

/// What is probable.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Posterior {
    /// That nothing is missing, but for the form of the own friction.
    pub nothing: f64,
    /// That a law outside the library is there.
    pub law: f64,
    /// That the axis' own friction has another form.
    pub form: f64,
    /// That an effect is there, the most probable first.
    pub effects: Vec<(String, f64)>,
    /// The best ten.
    pub best: Vec<Explained>,
    /// ln of the odds, over nothing, of the sets of [`Settings::supposed`](crate::Settings).
    pub supposed: Vec<f64>,
}

/// An effect that is named, with those that these logs cannot tell from it.
#[derive(Clone, Debug)]
pub struct NamedClass {
    pub name: &'static str,
    pub alike: Vec<ActiveEffect>,
    /// Of the class.
    pub probability: f64,
}

/// A law outside the library.
#[derive(Clone, Debug)]
pub struct LawFound {
    /// Its place among the curves.
    pub law: usize,
    /// Values at the knots, and their deviations.
    pub values: Vec<[f64; 2]>,
}

/// What is said.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Of the first round, before anything was named.
    pub posterior: Posterior,
    /// With the effects that are accepted, then those that are named.
    pub state: State,
    pub named: Vec<NamedClass>,
    pub law: Option<LawFound>,
    /// Whether the dry friction has another form.
    pub other_form: bool,
    /// Whether something is there, and it cannot be said what.
    pub undecided: bool,
}

/// What one round says.
struct Round {
    posterior: Posterior,
    /// The dry friction that the file does not have, where these logs ask for it.
    friction: Option<NamedClass>,
    new: Vec<(ActiveEffect, NamedClass)>,
    law: Option<LawFound>,
    undecided: bool,
    /// Whether the form of the most probable explanation is a course of dry friction over speed.
    form_is_a_course: bool,
}

/// Rounds in which effects are named beside those that are.
const ROUNDS: usize = 3;

/// Weighs all explanations of these logs from a state on, whose effects are there in all of them; what is
/// named is there in those of the next round, about its own solution and with its own friction.
///
/// # Errors
/// [`ReplayError`] where the machine does not run as its file says.
pub fn answer(
    machine: &Axis,
    logs: [&LogSet; 2],
    mut state: State,
    settings: &Settings,
) -> Result<(Answer, Library), ReplayError> {
    let both = || together(logs[0], logs[1]);
    let mut answer = Answer {
        posterior: Posterior::default(),
        state: state.clone(),
        named: Vec::new(),
        law: None,
        other_form: false,
        undecided: false,
    };
    let mut begun = None;
    if let Some(friction) = friction_missing(machine, &both(), &state, settings)? {
        let mut with = state.clone();
        with.effects.push(friction);
        let base = Base::new(machine, both(), &with, settings, None)?;
        let mut round = base.round();
        if let Some(class) = round.friction.take() {
            answer.named.push(class);
            begun = Some((base, round));
        }
    }
    let (mut base, mut round) = match begun {
        Some(begun) => begun,
        None => {
            let base = Base::new(machine, both(), &state, settings, None)?;
            let round = base.round();
            (base, round)
        }
    };
    answer.posterior = round.posterior.clone();
    answer.other_form = round.posterior.form >= FORM_LEVEL;
    if round.posterior.form >= PROBABLE && round.form_is_a_course {
        (base, round) = formed(machine, logs, base, settings)?;
    }
    for left in (0..ROUNDS).rev() {
        state = base.fit.state.clone();
        answer.law = round.law.take();
        answer.undecided = round.undecided && answer.named.is_empty();
        let room = settings.most_effects.saturating_sub(state.effects.len());
        let new: Vec<_> = round.new.into_iter().take(room).collect();
        let is_last = new.is_empty() || left == 0;
        for (active, class) in new {
            answer.add(&mut state, active, class);
        }
        tie(machine, &mut state);
        if is_last {
            break;
        }
        // What does not run together is left as it was.
        let library = Some(base.library.clone());
        let Ok(next) = Base::new(machine, both(), &state, settings, library) else {
            break;
        };
        base = next;
        round = base.round();
    }
    answer.state = state;
    Ok((answer, base.library))
}

/// The same with a form of the own friction in the state: level and form multiply, so that neither is right
/// as long as the other is not, and both are fitted in turn until the level stands.
fn formed<'a>(
    machine: &'a Axis,
    logs: [&LogSet; 2],
    base: Base<'a>,
    settings: &'a Settings,
) -> Result<(Base<'a>, Round), ReplayError> {
    let mut state = base.fit.state.clone();
    let form = friction_of(machine, &state).and_then(|own| onset_of(&own, base.fastest()));
    state.effects.extend(form);
    let mut base = base;
    for _ in 0..TURNS {
        base = Base::new(machine, together(logs[0], logs[1]), &state, settings, None)?;
        state = base.fit.state.clone();
        tracing::debug!(effects = ?state.effects.iter().map(|e| (e.effect.name, e.values.clone())).collect::<Vec<_>>(), deviance = base.fit.deviance, "with a form in the base");
        if tie(machine, &mut state) < STANDS {
            break;
        }
    }
    let round = base.round();
    Ok((base, round))
}

/// Sets the friction of which a state's form is one to the one that is there, and the form's numbers so that
/// it does what it did; by how much the level moved, as a share.
fn tie(machine: &Axis, state: &mut State) -> f64 {
    let own = friction_of(machine, state);
    let mut moved = 0.0_f64;
    for active in &mut state.effects {
        let before = FrictionForm::of(active).and_then(|form| form.base());
        let (Some(before), Some(own)) = (before, &own) else {
            continue;
        };
        let level = |a: &ActiveEffect| a.values.iter().sum::<f64>() / a.values.len() as f64;
        let by = level(&before) / level(own);
        moved = moved.max((by - 1.0).abs());
        if let Some(tied) = FrictionForm::of(active).and_then(|form| form.tied(own, by)) {
            *active = tied;
        }
    }
    moved
}

/// Turns of a fit of level and form, and the share by which the level then moves.
const TURNS: usize = 4;
const STANDS: f64 = 0.02;

/// Probability of another form from which all else is weighed beside it.
const PROBABLE: f64 = 0.5;

/// Dry friction of a machine whose file has none, about as large as these logs ask for. Its form is weighed
/// with all that may be missing beside it; without it, what else is named would only stand for that form.
fn friction_missing(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    settings: &Settings,
) -> Result<Option<ActiveEffect>, ReplayError> {
    let effect = Effect::named(PLAIN).filter(|e| e.applies_to(machine).is_ok());
    let is_rejected = settings.rejected.iter().any(|name| name == PLAIN);
    let is_there = friction_of(machine, state).is_some();
    let Some(effect) = effect.filter(|_| !is_rejected && !is_there) else {
        return Ok(None);
    };
    let mut with = state.clone();
    with.effects.push(ActiveEffect {
        effect,
        values: effect.typical(&Scales::of(machine)),
    });
    let fitter = Fitter { machine, set };
    let mut fit = fitter.best_size(fitter.at(with)?, 1);
    Ok(fit.state.effects.pop())
}

impl Answer {
    /// Names an effect beside those of a state. Dry friction by direction takes the place of the plain one.
    fn add(&mut self, state: &mut State, mut active: ActiveEffect, class: NamedClass) {
        let is_plain = |name: &str| name == PLAIN;
        let plain = state.effects.iter().position(|a| is_plain(a.effect.name));
        let named = self.named.iter().position(|n| is_plain(n.name));
        if let (BY_DIRECTION, Some(place), Some(named)) = (active.effect.name, plain, named) {
            let level = state.effects[place].values[0];
            active.values.iter_mut().for_each(|v| *v += level);
            state.effects[place] = active;
            self.named[named] = class;
            return;
        }
        state.effects.push(active);
        self.named.push(class);
    }
}

struct Weighed<'a> {
    key: Key,
    ln: f64,
    best: &'a Explanation,
    solution: Option<Solution>,
}

fn ln_sum(values: impl IntoIterator<Item = f64>) -> f64 {
    let all: Vec<f64> = values.into_iter().collect();
    let most = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + all.iter().map(|v| (v - most).exp()).sum::<f64>().ln()
}

impl Posterior {
    /// In words: what is how probable.
    pub fn sentence(&self) -> String {
        const SHOWN: usize = 4;
        let of = |e: &Explained| {
            let mut parts = e.effects.clone();
            if let Some(law) = &e.law {
                parts.push(format!("a law outside the library over {law}"));
            }
            let what = match parts.is_empty() {
                true => "nothing".to_owned(),
                false => parts.join(" with "),
            };
            format!("{what} ({:.2})", e.probability)
        };
        let shown: Vec<String> = self.best.iter().take(SHOWN).map(of).collect();
        format!(
            "these logs do not tell which of these is missing (probability): {}",
            shown.join(", ")
        )
    }

    /// The most probable effects, with the evidence of the best set of each.
    pub fn runners_up(&self) -> Vec<RunnerUp> {
        let of = |(name, _): &(String, f64)| {
            let best = self.best.iter().find(|e| e.effects.contains(name))?;
            Some(RunnerUp {
                name: Effect::named(name)?.name,
                gain: 2.0 * best.ln_odds,
            })
        };
        self.effects.iter().filter_map(of).collect()
    }
}

impl Base<'_> {
    /// All explanations weighed, and what is said.
    fn round(&self) -> Round {
        let (all, spectra, space) = self.explanations();
        let mut by_key: BTreeMap<Key, Vec<&Explanation>> = BTreeMap::new();
        for explanation in &all {
            by_key
                .entry(explanation.key())
                .or_default()
                .push(explanation);
        }
        let mut sets: Vec<Weighed> = Vec::new();
        for (key, of) in by_key {
            let Some(best) = of.iter().max_by(|a, b| a.ln.total_cmp(&b.ln)) else {
                continue;
            };
            sets.push(Weighed {
                ln: ln_sum(of.iter().map(|e| e.ln)),
                best,
                key,
                solution: None,
            });
        }
        let by_ln = |a: &Weighed, b: &Weighed| b.ln.total_cmp(&a.ln);
        sets.sort_by(by_ln);
        let top = sets.first().map_or(0.0, |s| s.ln);
        let nothing = sets
            .iter()
            .find(|s| s.key.0.is_empty() && s.key.1.is_none());
        let behind = BEHIND + SHARE_BEHIND * (top - nothing.map_or(top, |n| n.ln));
        // Single effects among themselves: shapes off their grid hide behind curves.
        let mut singles = 0;
        let mut others = 0;
        let near = sets
            .iter_mut()
            .filter(|s| !s.key.0.is_empty() && s.ln > top - behind);
        let near = near.filter(|s| {
            let count = match s.key.0.len() == 1 && s.key.1.is_none() {
                true => &mut singles,
                false => &mut others,
            };
            *count += 1;
            *count <= RELINEARISED
        });
        for set in near {
            set.solution = self.relinearised(self.begun(set.best, &space), &spectra, &space);
            if let Some(solution) = &set.solution {
                tracing::debug!(set = ?set.key, linear = set.ln, own = solution.ln, effects = ?solution.state.effects.iter().map(|e| (e.effect.name, e.values.clone())).collect::<Vec<_>>(), "about its own solution");
                set.ln = set.ln.max(solution.ln);
            }
        }
        sets.sort_by(by_ln);
        let mut answer = self.said(&sets, &all, &space);
        answer.friction = self.friction_there(&sets, &space);
        let supposed = self.settings.supposed.iter();
        let nothing = sets
            .iter()
            .find(|s| s.key.0.is_empty() && s.key.1.is_none());
        let nothing = nothing.map_or(0.0, |n| n.ln);
        let best_of = |effects: &Vec<ActiveEffect>| {
            let best = sets.first().and_then(|s| s.best.form);
            let forms = [None, best]
                .into_iter()
                .take(1 + usize::from(best.is_some()));
            let with = |form: Option<usize>| {
                let begun = self.supposed(effects, form, &space);
                Some(self.relinearised(begun, &spectra, &space)?.ln - nothing)
            };
            forms.filter_map(with).fold(f64::NEG_INFINITY, f64::max)
        };
        answer.posterior.supposed = supposed.map(best_of).collect();
        answer
    }

    /// A set with these values, whatever was found.
    fn supposed(&self, effects: &[ActiveEffect], form: Option<usize>, space: &Space) -> Begun {
        let scales = Scales::of(self.machine);
        Begun {
            state: State {
                shares: self.fit.state.shares.clone(),
                effects: [&self.fit.state.effects[..], effects].concat(),
            },
            law: None,
            form,
            deviations: (effects.iter().map(|e| size_over_typical(e, &scales))).collect(),
            ln_prior: space.odds().ln(effects.len(), false)
                + Odds::ln_form(space.forms.len(), form.is_none()),
        }
    }

    fn said(&self, sets: &[Weighed<'_>], all: &[Explanation], space: &Space) -> Round {
        let total = ln_sum(sets.iter().map(|s| s.ln));
        let share = |s: &Weighed| (s.ln - total).exp();
        let sum = |of: &dyn Fn(&Weighed) -> bool| -> f64 {
            sets.iter().filter(|s| of(s)).map(share).sum()
        };
        let is_nothing = |s: &Weighed| s.key.0.is_empty() && s.key.1.is_none();
        let nothing = sets.iter().find(|s| is_nothing(s));
        let law = sum(&|s| s.key.1.is_some());
        let mut effects: Vec<(String, f64)> = (space.effects.iter())
            .map(|t| {
                (
                    t.effect.name.to_owned(),
                    sum(&|s| s.key.0.contains(&t.effect.name)),
                )
            })
            .collect();
        effects.sort_by(|a, b| b.1.total_cmp(&a.1));
        // Of the form: within the most probable set, as others hardly count.
        let best_set = sets.first().map(|s| s.key.clone());
        let of_best = all.iter().filter(|e| Some(e.key()) == best_set);
        let forms: Vec<(bool, f64)> = of_best.map(|e| (e.form.is_some(), e.ln)).collect();
        let with_form = {
            let all_forms = ln_sum(forms.iter().map(|f| f.1));
            let other = forms.iter().filter(|f| f.0).map(|f| f.1);
            (ln_sum(other.chain([-1e300])) - all_forms).exp()
        };
        let z0 = nothing.map_or(0.0, |n| n.ln);
        let explained = |s: &Weighed| Explained {
            effects: s.key.0.iter().map(|n| (*n).to_owned()).collect(),
            law: (s.key.1).map(|law| self.library.curves.shapes[law].0.depends_on()),
            probability: share(s),
            ln_odds: s.ln - z0,
        };
        let posterior = Posterior {
            nothing: nothing.map_or(0.0, share),
            law,
            form: with_form,
            effects,
            best: sets.iter().take(10).map(explained).collect(),
            supposed: Vec::new(),
        };
        for e in &posterior.best {
            tracing::debug!(?e, "explanation");
        }
        let mut new = Vec::new();
        let first = sets.iter().find(|s| !s.key.0.is_empty());
        if let Some(first) = first {
            for &name in &first.key.0 {
                let (class, alike) = self.class(first, name, sets);
                let probability = sum(&|s| s.key.0.iter().any(|n| class.contains(n)));
                let material = self.material(first, name, sets);
                tracing::debug!(name, probability, material, ?class, "effect");
                if probability >= LEVEL && material >= MATERIAL {
                    let (active, alike) = self.simplest(self.active(first, name), alike);
                    let class = NamedClass {
                        name: active.effect.name,
                        alike: alike.into_iter().map(|(active, _)| active).collect(),
                        probability,
                    };
                    new.push((active, class));
                }
            }
        }
        let law_found = (law >= 0.5).then(|| self.law_found(sets, all)).flatten();
        let nothing_or_form = posterior.nothing >= 0.5;
        let form = sets.first().and_then(|s| s.best.form);
        Round {
            form_is_a_course: form.is_some_and(|f| space.forms[f].instead_of.is_empty()),
            friction: None,
            undecided: new.is_empty() && law_found.is_none() && !nothing_or_form,
            new,
            law: law_found,
            posterior,
        }
    }

    /// The plain dry friction of the state, if these logs are better explained with it than without any.
    fn friction_there(&self, sets: &[Weighed<'_>], space: &Space) -> Option<NamedClass> {
        let best = sets.first()?;
        let explained = best.best;
        let place = self.fit.state.shares.len() + self.kept_place(PLAIN)?;
        let kept = *space.always.get(place)?;
        let free = space.again(explained, None);
        let formed = space.again(explained, explained.form);
        let none = space.without(explained, kept);
        let with = ln_sum([free.ln, formed.ln]) - CHOICE;
        let probability = 1.0 / (1.0 + (none.ln - with).exp());
        tracing::debug!(probability, with, none = none.ln, "dry friction");
        (probability >= LEVEL).then(|| {
            let by_direction = sets
                .iter()
                .find(|s| s.key.0.contains(&BY_DIRECTION) && s.ln >= best.ln - TELLS_APART);
            let alike = by_direction.map(|set| {
                let mut active = self.active(set, BY_DIRECTION);
                let plain = friction_of(self.machine, &self.fit.state);
                let level = plain.map_or(0.0, |plain| plain.values[0]);
                active.values.iter_mut().for_each(|v| *v += level);
                active
            });
            NamedClass {
                name: PLAIN,
                alike: alike.into_iter().collect(),
                probability,
            }
        })
    }

    /// The state with all of these effects, each in the shape that promises most.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run with them.
    pub fn with_all(&self, names: &[String]) -> Result<State, ReplayError> {
        let (_, spectra, mut space) = self.explanations();
        let all = space.with_all(names);
        let begun = self.begun(&all, &space);
        let state = begun.state.clone();
        let solution = self.relinearised(begun, &spectra, &space);
        Ok(solution.map_or(state, |s| s.state))
    }

    /// The effect of a set, with its values.
    fn active(&self, of: &Weighed<'_>, name: &str) -> ActiveEffect {
        let solved = of.solution.as_ref().map(|s| s.state.effects.iter());
        if let Some(active) = solved.and_then(|mut all| all.find(|a| a.effect.name == name)) {
            return active.clone();
        }
        let scales = Scales::of(self.machine);
        let sizes: usize = of.best.effects.iter().map(|e| e.columns.len()).sum();
        let law = of
            .best
            .law
            .map_or(0, |(law, length)| self.numbers_of_law(law, length));
        let x = of.best.evidence.x.as_slice();
        let mut at = x.len() - law - sizes;
        for shaped in &of.best.effects {
            let own = &x[at..at + shaped.columns.len()];
            at += shaped.columns.len();
            if shaped.effect.name == name {
                return ActiveEffect {
                    effect: shaped.effect,
                    values: values_at(shaped.effect, &shaped.values, own, &scales),
                };
            }
        }
        let shaped = &of.best.effects[0];
        ActiveEffect {
            effect: shaped.effect,
            values: shaped.values.clone(),
        }
    }

    /// Effects that do as much in the place of one in a set: names, and the others with their values.
    fn class(
        &self,
        of: &Weighed<'_>,
        name: &'static str,
        sets: &[Weighed<'_>],
    ) -> (Vec<&'static str>, Vec<(ActiveEffect, f64)>) {
        let beside = |key: &Key, taken: &str| -> Vec<&'static str> {
            key.0.iter().copied().filter(|n| *n != taken).collect()
        };
        let others = beside(&of.key, name);
        let mut class = vec![name];
        let mut alike = Vec::new();
        for other in sets.iter().filter(|s| s.ln >= of.ln - TELLS_APART) {
            let same_law = other.key.1 == of.key.1 && other.key.0.len() == of.key.0.len();
            let swapped = other.key.0.iter().find(|n| !of.key.0.contains(n));
            if let Some(&swapped) = swapped.filter(|_| same_law)
                && beside(&other.key, swapped) == others
            {
                class.push(swapped);
                alike.push((self.active(other, swapped), of.ln - other.ln));
            }
        }
        (class, alike)
    }

    /// Of effects about as probable, the one with the fewest numbers first: it is what others with more
    /// shrink to.
    fn simplest(
        &self,
        active: ActiveEffect,
        mut alike: Vec<(ActiveEffect, f64)>,
    ) -> (ActiveEffect, Vec<(ActiveEffect, f64)>) {
        let numbers = |a: &ActiveEffect| a.effect.parameters.iter().filter(|p| is_free(p)).count();
        let own = numbers(&active);
        let simpler = (0..alike.len())
            .filter(|&i| alike[i].1 < 0.5 * TELLS_APART && numbers(&alike[i].0) < own)
            .min_by_key(|&i| numbers(&alike[i].0));
        match simpler {
            Some(i) => {
                let behind = alike[i].1;
                let other = std::mem::replace(&mut alike[i], (active, -behind));
                (other.0, alike)
            }
            None => (active, alike),
        }
    }

    fn left(&self, of: &Explanation) -> Amplitudes {
        let mut left = self.fit.rest.clone();
        for (column, x) in self.columns_of(of).iter().zip(of.evidence.x.iter()) {
            let pairs = left.iter_mut().flatten().zip(column.iter().flatten());
            pairs.for_each(|(a, c)| *a -= c * *x);
        }
        left
    }

    /// Share of the noise's power that goes with an effect, in the channel where it is most.
    fn material(&self, of: &Weighed<'_>, name: &str, sets: &[Weighed<'_>]) -> f64 {
        let without: Vec<&str> = of.key.0.iter().copied().filter(|n| *n != name).collect();
        let same = sets
            .iter()
            .find(|s| s.key.0 == without && s.key.1 == of.key.1);
        let nothing = || {
            sets.iter()
                .find(|s| s.key.0.is_empty() && s.key.1.is_none())
        };
        let Some(other) = same.or_else(nothing) else {
            return f64::INFINITY;
        };
        let left = |w: &Weighed<'_>| match &w.solution {
            Some(solution) => solution.left.clone(),
            None => self.left(w.best),
        };
        let power = |w: &Weighed<'_>| self.set.layout.power(&[left(w)]);
        let pairs = power(other).into_iter().zip(power(of));
        pairs
            .map(|(a, b)| (a - b) / b)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The curve over the most probable variable.
    fn law_found(&self, sets: &[Weighed<'_>], all: &[Explanation]) -> Option<LawFound> {
        let shapes = &self.library.curves.shapes;
        let mut by_variable: BTreeMap<String, f64> = BTreeMap::new();
        let top = sets.first()?.ln;
        for set in sets {
            if let Some(law) = set.key.1 {
                *by_variable.entry(shapes[law].0.depends_on()).or_default() += (set.ln - top).exp();
            }
        }
        let most = by_variable.iter().max_by(|a, b| a.1.total_cmp(b.1))?.0;
        let of = sets
            .iter()
            .find(|s| (s.key.1).is_some_and(|law| shapes[law].0.depends_on() == *most))?;
        // Of a short term, the curve that comes next.
        let curves = all.iter().filter(|e| {
            e.key() == of.key && e.law.is_some_and(|(_, length)| length < LENGTHS.len())
        });
        let best = curves.max_by(|a, b| a.ln.total_cmp(&b.ln))?;
        let (law, length) = best.law?;
        let factor = self.law_values(law, length);
        let n = factor.ncols();
        let at = best.evidence.x.len() - n;
        let values = &factor * best.evidence.x.rows(at, n);
        let covariance = best.evidence.covariance.view((at, at), (n, n));
        let covariance = &factor * covariance * factor.transpose();
        let value = |i: usize| [values[i], covariance[(i, i)].max(0.0).sqrt()];
        Some(LawFound {
            law,
            values: (0..values.len()).map(value).collect(),
        })
    }
}
