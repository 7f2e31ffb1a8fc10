//! All that may explain a rest, and what of it is worth an integral.
//!
//! A hypothesis is a set of effects, each with a shape (period, place, order …), a law outside the
//! library or none, and a form of the own friction. There are far too many sets; those of one
//! effect more than a probable set are tried, from nothing on.

use std::collections::HashSet;

use axis_sim::effects::{Effect, Nature};
use rayon::prelude::*;

use super::evidence::{Block, Evidence, Prior, evidence};
use super::likelihood::Likelihood;
use super::prior::{MOST_BESIDE_LAW, MOST_EFFECTS, Odds};
use super::process::MIDDLE;
use super::products::Products;
use crate::estimate::bounded::inverse_of;

/// An effect in one of its shapes.
#[derive(Clone, Debug)]
pub struct Shaped {
    pub effect: &'static Effect,
    /// Values, sizes typical.
    pub values: Vec<f64>,
    /// What its sizes do.
    pub columns: Vec<usize>,
    /// Bounds of its sizes over their typical values; none of one with a phase.
    pub bounds: Vec<[f64; 2]>,
}

/// An effect with all shapes in which it is tried.
pub struct Tried {
    pub effect: &'static Effect,
    pub shapes: Vec<Shaped>,
}

/// A law outside the library: columns of unit variance, for each length over which it may change.
pub struct LawTried {
    pub lengths: Vec<Vec<usize>>,
}

/// A form of the own friction.
pub struct FormTried {
    pub priors: Vec<Prior>,
    /// Name of the effect that it is the same as.
    pub instead_of: &'static str,
}

/// What is tried, and how.
pub struct Space {
    pub products: Products,
    pub likelihood: Likelihood,
    /// Known parameters, and small laws that are always there.
    pub always: Vec<Prior>,
    pub forms: Vec<FormTried>,
    pub effects: Vec<Tried>,
    pub laws: Vec<LawTried>,
}

/// A law, and its length, by their places.
pub type Law = (usize, usize);

/// A hypothesis with its evidence.
#[derive(Clone, Debug)]
pub struct Explanation {
    pub effects: Vec<Shaped>,
    pub law: Option<Law>,
    /// Place of the form.
    pub form: Option<usize>,
    pub evidence: Evidence,
    /// ln of prior probability times evidence.
    pub ln: f64,
    /// Number of shapes that were tried.
    shapes: f64,
}

/// What hypotheses are about: names of effects in order, and the law.
pub type Key = (Vec<&'static str>, Option<usize>);

impl Explanation {
    /// What the choice of its shapes costs.
    pub fn ln_shapes(&self) -> f64 {
        self.shapes.ln()
    }

    pub fn key(&self) -> Key {
        let mut names: Vec<&'static str> = self.effects.iter().map(|e| e.effect.name).collect();
        names.sort_unstable();
        (names, self.law.map(|(law, _)| law))
    }
}

/// Shapes of an effect, and forms, that are integrated.
const SHAPES: usize = 2;
const FORMS: usize = 2;

/// Sets that one effect more is tried beside, by their number of effects.
const BEAM: [usize; MOST_EFFECTS] = [1, 4, 2];

/// Sets beside one that are integrated over forms and lengths.
const CLOSER: usize = 8;

/// Gain, linearised, below which one effect more is not integrated.
const WORTH: f64 = 4.0;

/// Precision of a number that does not move.
const PINNED: f64 = 1e12;

/// An effect in a shape, with what it promises and how many shapes there are.
struct Promise {
    shaped: Shaped,
    gain: f64,
    shapes: f64,
}

impl Space {
    pub fn odds(&self) -> Odds {
        Odds {
            effects: self.effects.len(),
            laws: self.laws.len(),
        }
    }

    /// Integrates one; `shapes` is the number of its shapes that were tried.
    fn integrate(
        &self,
        effects: Vec<Shaped>,
        law: Option<Law>,
        form: Option<usize>,
        shapes: f64,
    ) -> Explanation {
        self.integrate_beside(self.always.clone(), effects, law, form, shapes)
    }

    /// The same explanation in another form of the friction.
    pub fn again(&self, of: &Explanation, form: Option<usize>) -> Explanation {
        self.integrate(of.effects.clone(), of.law, form, of.shapes)
    }

    /// The same explanation where a number that is always there is at its mean, and the friction has no
    /// other form.
    pub fn without(&self, of: &Explanation, kept: Prior) -> Explanation {
        let pin = |prior: &Prior| match prior.column == kept.column {
            true => Prior {
                precision: PINNED,
                room: None,
                ..*prior
            },
            false => *prior,
        };
        let always = self.always.iter().map(pin).collect();
        self.integrate_beside(always, of.effects.clone(), of.law, None, of.shapes)
    }

    /// Integrates one beside these numbers, which are always there.
    fn integrate_beside(
        &self,
        mut priors: Vec<Prior>,
        effects: Vec<Shaped>,
        law: Option<Law>,
        form: Option<usize>,
        shapes: f64,
    ) -> Explanation {
        if let Some(form) = form {
            priors.extend(&self.forms[form].priors);
        }
        let block = |e: &Shaped| Block {
            columns: e.columns.clone(),
            bounds: e.bounds.clone(),
        };
        let mut blocks: Vec<Block> = effects.iter().map(block).collect();
        if let Some((law, length)) = law {
            blocks.push(Block {
                columns: self.laws[law].lengths[length].clone(),
                bounds: Vec::new(),
            });
        }
        let evidence = evidence(&self.products, self.likelihood, &priors, &blocks);
        let lengths = law.map_or(1.0, |(law, _)| self.laws[law].lengths.len() as f64);
        let ln_prior = self.odds().ln(effects.len(), law.is_some())
            + Odds::ln_form(self.forms.len(), form.is_none())
            - shapes.ln()
            - lengths.ln();
        Explanation {
            ln: evidence.ln_z + ln_prior,
            effects,
            law,
            form,
            evidence,
            shapes,
        }
    }

    /// Whether a form says what an effect of a set says.
    fn contradicts(&self, form: Option<usize>, effects: &[Shaped]) -> bool {
        let other = form.map_or("", |f| self.forms[f].instead_of);
        effects.iter().any(|e| e.effect.name == other)
    }

    /// Nothing, in all forms of the friction.
    pub fn of_forms(&self) -> Vec<Explanation> {
        let none = std::iter::once(None).chain((0..self.forms.len()).map(Some));
        let forms: Vec<Option<usize>> = none.collect();
        let one = |form: &Option<usize>| self.integrate(Vec::new(), None, *form, 1.0);
        forms.par_iter().map(one).collect()
    }

    /// All that is worth it, up to so many effects.
    pub fn explanations(&mut self, most: usize) -> Vec<Explanation> {
        let mut all = self.of_forms();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| all[b].ln.total_cmp(&all[a].ln));
        // The best first, and none among them.
        let mut kept: Vec<Option<usize>> = order.iter().map(|&i| all[i].form).collect();
        let none = kept.iter().position(Option::is_none).unwrap_or(0);
        if none >= FORMS {
            kept.swap(none, FORMS);
        }
        kept.truncate(FORMS + 1);
        let mut seen: HashSet<Key> = all.iter().map(Explanation::key).collect();
        for (effects, &beam) in BEAM.iter().enumerate().take(most) {
            let parents = most_probable(&all, effects, beam);
            for parent in parents {
                let forms = match effects {
                    0 => kept.clone(),
                    _ => vec![parent.form],
                };
                all.extend(self.beside(&parent, &forms, &mut seen));
            }
        }
        all
    }

    /// All of these effects, each in the shape that promises most beside those before it.
    pub fn with_all(&mut self, names: &[String]) -> Explanation {
        let mut all = self.integrate(Vec::new(), None, None, 1.0);
        for name in names {
            let promises = self.promising(&all, 1);
            let own = promises
                .into_iter()
                .filter(|p| p.shaped.effect.name == *name);
            let Some(best) = own.max_by(|a, b| a.gain.total_cmp(&b.gain)) else {
                continue;
            };
            let effects = [all.effects.clone(), vec![best.shaped]].concat();
            all = self.integrate(effects, None, None, all.shapes * best.shapes);
        }
        all
    }

    /// A set with one effect more, or with a law.
    fn beside(
        &mut self,
        parent: &Explanation,
        forms: &[Option<usize>],
        seen: &mut HashSet<Key>,
    ) -> Vec<Explanation> {
        let mut todo: Vec<(Vec<Shaped>, Option<Law>, f64)> = Vec::new();
        let names = |effects: &[Shaped]| -> Vec<&'static str> {
            let mut names: Vec<&'static str> = effects.iter().map(|e| e.effect.name).collect();
            names.sort_unstable();
            names
        };
        if parent.effects.len() < MOST_EFFECTS {
            let first = parent.effects.is_empty();
            let promises = self.promising(parent, if first { SHAPES } else { 1 });
            let mut new = HashSet::new();
            for promise in promises {
                let mut effects = parent.effects.clone();
                effects.push(promise.shaped);
                let key = (names(&effects), None);
                if seen.contains(&key) || !first && promise.gain < WORTH {
                    continue;
                }
                new.insert(key);
                todo.push((effects, None, parent.shapes * promise.shapes));
            }
            seen.extend(new);
        }
        if parent.effects.len() <= MOST_BESIDE_LAW {
            for law in 0..self.laws.len() {
                if seen.insert((names(&parent.effects), Some(law))) {
                    let law = Some((law, MIDDLE));
                    todo.push((parent.effects.clone(), law, parent.shapes));
                }
            }
        }
        let this = &*self;
        let mut all: Vec<Explanation> = todo
            .into_par_iter()
            .map(|(effects, law, shapes)| {
                let mut fitting = forms.iter().filter(|f| !this.contradicts(**f, &effects));
                let form = fitting.next().copied().flatten();
                this.integrate(effects, law, form, shapes)
            })
            .collect();
        all.sort_by(|a, b| b.ln.total_cmp(&a.ln));
        // The best of these in the other forms, and with laws of other lengths.
        let others = |e: &Explanation| -> Vec<(Option<Law>, Option<usize>)> {
            let lengths: Vec<Option<Law>> = match e.law {
                Some((law, _)) => (0..this.laws[law].lengths.len())
                    .map(|l| Some((law, l)))
                    .collect(),
                None => vec![None],
            };
            let pairs = lengths.iter().flat_map(|l| forms.iter().map(|f| (*l, *f)));
            let new = pairs.filter(|p| *p != (e.law, e.form));
            new.filter(|(_, f)| !this.contradicts(*f, &e.effects))
                .collect()
        };
        let of_best = all.iter().take(CLOSER);
        let more: Vec<(&Explanation, (Option<Law>, Option<usize>))> = of_best
            .flat_map(|e| others(e).into_iter().map(move |o| (e, o)))
            .collect();
        let more: Vec<Explanation> = more
            .into_par_iter()
            .map(|(e, (law, form))| this.integrate(e.effects.clone(), law, form, e.shapes))
            .collect();
        all.extend(more);
        all
    }

    /// What promises most beside an explanation: as what that leaves weighs the bands, and as the
    /// reference spectrum does. Where much is left, the one looks away from it, the other at nothing
    /// else.
    fn promising(&mut self, parent: &Explanation, best: usize) -> Vec<Promise> {
        let counts = self.products.counts.iter().zip(&parent.evidence.squares);
        let left: Vec<f64> = counts
            .map(|(n, r)| self.likelihood.weight(*n, *r))
            .collect();
        let counts = self.products.counts.iter();
        let reference: Vec<f64> = counts.map(|n| self.likelihood.weight(*n, *n)).collect();
        let mut all = self.promises(parent, best, &left);
        for other in self.promises(parent, best, &reference) {
            let is_same = |p: &Promise| {
                p.shaped.effect.name == other.shaped.effect.name
                    && p.shaped.values == other.shaped.values
            };
            match all.iter_mut().find(|p| is_same(p)) {
                Some(same) => same.gain = same.gain.max(other.gain),
                None => all.push(other),
            }
        }
        all
    }

    /// What each effect promises beside an explanation, its best shapes, as the linearised rest has
    /// it with these weights of bands.
    fn promises(&mut self, parent: &Explanation, best: usize, weights: &[f64]) -> Vec<Promise> {
        let all = self.products.weighed(weights);
        let own = &parent.evidence.columns;
        // As a product of two matrices, which is far faster than `tr_mul`.
        let cross = all.select_columns(own).transpose() * &all;
        let mut normal = cross.select_columns(own);
        // The prior's part of the covariance's inverse, as it was integrated.
        let precision = self.precisions(parent);
        let mut pull = cross.column(0).into_owned();
        for (i, (precision, mean)) in precision.into_iter().enumerate() {
            normal[(i, i)] += precision;
            pull[i] += precision * mean;
        }
        let inverse = inverse_of(&normal);
        let through = &inverse * &cross;
        let x = &inverse * &pull;
        // What the parent leaves of some columns, as products with each other and with the rest.
        let beside = |columns: &[usize]| {
            let own = all.select_columns(columns);
            let turned = own.transpose();
            let of_parent = cross.select_columns(columns).transpose();
            let normal = &turned * &own - &of_parent * through.select_columns(columns);
            let right = turned * all.column(0) - of_parent * &x;
            (normal, right)
        };
        let named: Vec<&str> = parent.effects.iter().map(|e| e.effect.name).collect();
        let mut out = Vec::new();
        let mut windows = Vec::new();
        for tried in self
            .effects
            .iter()
            .filter(|t| !named.contains(&t.effect.name))
        {
            if let Some([begin, end]) = instants(tried.effect) {
                windows.push((tried, begin, end));
                continue;
            }
            let shapes = tried.shapes.len() as f64;
            let gain = |shaped: &Shaped| {
                let (normal, right) = beside(&shaped.columns);
                0.5 * right.dot(&(inverse_of(&normal) * &right))
            };
            let mut all: Vec<Promise> = tried
                .shapes
                .iter()
                .map(|shaped| Promise {
                    gain: gain(shaped),
                    shaped: shaped.clone(),
                    shapes,
                })
                .collect();
            all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
            all.truncate(best);
            out.extend(all);
        }
        // A force in time: the best of all windows of its slots.
        let mut sums = Vec::new();
        let mut of_sums = Vec::new();
        for (tried, begin, end) in windows {
            let slots: Vec<&Shaped> = tried.shapes.iter().collect();
            let columns: Vec<usize> = slots.iter().map(|s| s.columns[0]).collect();
            let mut all: Vec<(f64, usize, usize)> = Vec::new();
            let (between, pulls) = beside(&columns);
            for from in 0..slots.len() {
                let (mut normal, mut right) = (0.0, 0.0);
                for to in from..slots.len() {
                    let cross = (from..to).map(|k| between[(k, to)]);
                    normal += between[(to, to)] + 2.0 * cross.sum::<f64>();
                    right += pulls[to];
                    if normal > 0.0 && to - from + 1 < slots.len() {
                        all.push((0.5 * right * right / normal, from, to));
                    }
                }
            }
            let shapes = all.len().max(1) as f64;
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            for &(gain, from, to) in all.iter().take(best) {
                let mut shaped = slots[from].clone();
                shaped.values[begin] = slots[from].values[begin];
                shaped.values[end] = slots[to].values[end];
                sums.push(columns[from..=to].iter().map(|&c| (c, 1.0)).collect());
                of_sums.push(Promise {
                    gain,
                    shaped,
                    shapes,
                });
            }
        }
        let new = self.products.with(&sums);
        for (column, mut promise) in new.zip(of_sums) {
            promise.shaped.columns = vec![column];
            out.push(promise);
        }
        out
    }

    /// Precision and mean of each coefficient of an explanation.
    fn precisions(&self, of: &Explanation) -> Vec<(f64, f64)> {
        let mut priors: Vec<Prior> = self.always.clone();
        if let Some(form) = of.form {
            priors.extend(&self.forms[form].priors);
        }
        let mut all: Vec<(f64, f64)> = priors.iter().map(|p| (p.precision, p.mean)).collect();
        let law = of
            .law
            .map(|(law, length)| self.laws[law].lengths[length].len());
        let sizes = of.effects.iter().map(|e| e.columns.len()).chain(law);
        for (n, deviation) in sizes.zip(&of.evidence.deviations) {
            all.extend(std::iter::repeat_n((deviation.powi(-2), 0.0), n));
        }
        all
    }
}

/// The most probable explanations with so many effects and no law, one for each set.
fn most_probable(all: &[Explanation], effects: usize, most: usize) -> Vec<Explanation> {
    let like = |e: &&Explanation| e.law.is_none() && e.effects.len() == effects;
    let mut all: Vec<&Explanation> = all.iter().filter(like).collect();
    all.sort_by(|a, b| b.ln.total_cmp(&a.ln));
    let mut seen = HashSet::new();
    all.retain(|e| seen.insert(e.key()));
    all.into_iter().take(most).cloned().collect()
}

/// Places of begin and end of a force in time.
fn instants(effect: &Effect) -> Option<[usize; 2]> {
    let begin = effect.place_of(|n| matches!(n, Nature::Begin(_)))?;
    let end = effect.place_of(|n| matches!(n, Nature::End(_)))?;
    Some([begin, end])
}
