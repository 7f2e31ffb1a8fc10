//! The logs of all hypotheses, and the machine about which all is linear.

use std::borrow::Cow;

use axis_sim::effects::{ActiveEffect, Effect, EffectParameter, FrictionForm, Nature, Scales};
use axis_sim::{Axis, ReplayError};
use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use super::evidence::Prior;
use super::hypotheses::{Explanation, FormTried, LawTried, Shaped, Space, Tried};
use super::likelihood::Likelihood;
use super::nuisance::{At, DISCREPANCY, Family, LENGTH};
use super::prior::MOST_EFFECTS;
use super::process::{LENGTHS, factor};
use super::products::Reference;
use crate::answers::{LogSet, State};
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::{known_deviations, tolerances};
use crate::name::curves::{Factor, Place, Shape, Variable, answer, courses};
use crate::name::library::{Candidate, Library, phase_of};
use crate::name::search::{Settings, own_friction};
use crate::name::terms::{middle, terms};
use crate::spectrum::{Amplitudes, Layout};

/// Edges of bands, Hz: motion has its power in the lowest, and what is missing there would be taken
/// for noise in wide ones.
const EDGES: [f64; 13] = [
    1.0, 2.0, 3.5, 6.0, 10.0, 16.0, 25.0, 37.0, 52.0, 72.0, 100.0, 135.0, 180.0,
];

/// Fewest complex values of a band for each channel.
const LEAST: f64 = 8.0;

/// Effects of a hypothesis at most in the first pass, which only looks for what is left.
const FIRST_PASS: usize = 2;

/// Values that the reference spectrum of the first pass counts for.
const NU: f64 = 4.0;

/// Share of what known parameters did, and of what nuisances did, by which they may be off: they are
/// linear here.
const OF_KNOWN: f64 = 0.03;
const OF_NUISANCE: f64 = 0.02;

/// Share of a spectrum by which any may be off.
const OF_SPECTRUM: f64 = 1e-4;

/// Ratio of frequencies, as its logarithm, over which the spectrum of noise is alike.
const SMOOTH: f64 = 1.2;

/// Dry friction of one level, and of one a direction.
pub const PLAIN: &str = "coulomb-friction";
pub const BY_DIRECTION: &str = "asymmetric-friction";

/// Rounds of a fit of what is there already.
const ROUNDS: usize = 8;

/// Share of the values of a band that are left at least where others were fitted.
const LEFT: f64 = 0.25;

/// Fit and check logs together, and a fit of the known parameters to them.
pub struct Base<'a> {
    pub machine: &'a Axis,
    pub set: LogSet,
    pub fit: Fit,
    pub known: Columns,
    pub library: Library,
    families: Vec<Family>,
    /// Short terms over what each curve is over, of unit size.
    terms: Vec<Vec<Columns>>,
    /// Of the effects that are there already, the free numbers in their order.
    kept: Vec<Kept>,
    own_level: f64,
    layout: Layout,
    pub settings: &'a Settings,
}

/// A number of an effect that is there in every hypothesis.
pub struct Kept {
    /// What it does, per unit.
    column: Amplitudes,
    unit: f64,
    /// Of its value over the unit.
    prior: Prior,
}

/// Prior of a number of an effect that was `first`, in its unit, which stands before it. `deviation` is
/// that of sizes, over the typical ones; a form has priors of its own.
pub fn prior_of(
    active: &ActiveEffect,
    place: usize,
    first: f64,
    deviation: f64,
    scales: &Scales,
) -> (f64, Prior) {
    let (parameter, value) = (&active.effect.parameters[place], active.values[place]);
    let of_form = FrictionForm::of(active).and_then(|form| form.deviation(place));
    let (unit, precision, mean) = match of_form {
        Some(deviation) => (deviation, 1.0, 0.0),
        None if parameter.is_size() => (parameter.typical(scales).abs(), deviation.powi(-2), 0.0),
        None => (shape_deviation(parameter, first, scales), 1.0, first),
    };
    let [low, high] = parameter.bounds(scales);
    let room = [(low - value) / unit, (high - value) / unit];
    let prior = Prior {
        column: 0,
        mean: (mean - value) / unit,
        precision,
        room: Some([room[0].min(0.0), room[1].max(0.0)]),
    };
    (unit, prior)
}

/// Deviation of a shape about where it was found, as it is thought of beforehand.
fn shape_deviation(parameter: &EffectParameter, value: f64, scales: &Scales) -> f64 {
    let stroke = scales.stroke[1] - scales.stroke[0];
    match parameter.nature {
        Nature::Phase => std::f64::consts::PI / 3f64.sqrt(),
        Nature::Place(_) => stroke / 12f64.sqrt(),
        Nature::Width(_) => 0.1 * stroke,
        Nature::Begin(_) | Nature::End(_) => 3.0,
        _ if value == 0.0 => 1.0,
        _ => 0.6 * value.abs(),
    }
}

/// Greatest size of an effect over its typical one, and not less than a little.
pub fn size_over_typical(active: &ActiveEffect, scales: &Scales) -> f64 {
    let pairs = active.effect.parameters.iter().zip(&active.values);
    let sizes = pairs.filter(|(p, _)| p.is_size());
    let over = sizes.map(|(p, v)| (v / p.typical(scales)).abs());
    over.fold(1e-4, f64::max)
}

/// Both sets of logs as one.
pub fn together(fit: &LogSet, check: &LogSet) -> LogSet {
    let logs: Vec<_> = fit.logs.iter().chain(&check.logs).cloned().collect();
    let sizes: Vec<(usize, f64)> = logs.iter().map(|l| (l.log.len(), l.period)).collect();
    LogSet {
        layout: Layout::new(fit.fitted.len(), &sizes),
        logs,
        channels: fit.channels.clone(),
        fitted: fit.fitted.clone(),
    }
}

/// What a column of the products is.
struct Columned<'a> {
    all: Vec<Cow<'a, Amplitudes>>,
}

impl<'a> Columned<'a> {
    fn push(&mut self, column: &'a Amplitudes) -> usize {
        self.all.push(Cow::Borrowed(column));
        self.all.len() - 1
    }

    fn push_scaled(&mut self, column: &Amplitudes, by: f64) -> usize {
        self.all.push(Cow::Owned(scaled(column, by)));
        self.all.len() - 1
    }
}

type Spectra = Vec<DMatrix<Complex<f64>>>;

impl<'a> Base<'a> {
    /// From the state of a fit of the first logs on. What effects and curves do hardly depends on what is
    /// there already: a `library` of another state may be given.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run the others.
    pub fn new(
        machine: &'a Axis,
        set: LogSet,
        begin: &State,
        settings: &'a Settings,
        library: Option<Library>,
    ) -> Result<Self, ReplayError> {
        let fitter = Fitter { machine, set: &set };
        let near = fitter.at(begin.clone())?;
        let known = fitter.known_columns(&near);
        let near = fitter.refine(near, &known, ROUNDS);
        let (fit, known) = fitter.calibrated(near, known);
        let scales = Scales::of(machine);
        let slopes = fitter.effect_columns(&fit, 0);
        let kept = free_parameters(&fit.state).into_iter().zip(slopes);
        let kept = kept.map(|((e, p), slope)| {
            let active = &fit.state.effects[e];
            let deviation = size_over_typical(active, &scales);
            let (unit, prior) = prior_of(active, p, active.values[p], deviation, &scales);
            Kept {
                column: scaled(&slope, unit),
                unit,
                prior,
            }
        });
        let kept = kept.collect();
        let library = library.unwrap_or_else(|| Library::new(&fitter, &fit, known.clone()));
        let terms = terms_of(&fitter, &fit, &library);
        let own = friction_of(machine, &fit.state);
        let at = At {
            fitter: &fitter,
            fit: &fit,
            own: own.as_ref(),
        };
        let families = at.families();
        let layout = set.layout.in_bands(&EDGES, LEAST);
        Ok(Self {
            machine,
            fit,
            known,
            library,
            families,
            terms,
            kept,
            own_level: own.map_or(0.0, |own| own.values[0]),
            layout,
            settings,
            set,
        })
    }

    /// Free numbers of effects that are there already, with the unit of each.
    pub fn kept_units(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.kept.iter().map(|k| k.unit)
    }

    /// Greatest speed of the motions.
    pub fn fastest(&self) -> f64 {
        let speeds = self.fit.traces.iter().flat_map(|t| &t.speed);
        speeds.fold(0.0_f64, |most, v| most.max(v.abs()))
    }

    pub fn fitter(&self) -> Fitter<'_> {
        Fitter {
            machine: self.machine,
            set: &self.set,
        }
    }

    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Variance by which a simulation may be off, by channel, as of white noise.
    fn inexact(&self) -> Vec<f64> {
        let channels = self.set.fitted.iter();
        let one = |&c: &usize| self.set.inexactness(self.machine, c).powi(2);
        channels.map(one).collect()
    }

    /// Priors of the known parameters, whose columns begin at the first, beside the state of a fit.
    pub fn of_known(&self, shares: &[f64], first: usize) -> Vec<Prior> {
        let deviations = known_deviations(self.machine);
        let tolerances = tolerances(self.machine);
        let one = |(i, &share): (usize, &f64)| Prior {
            column: first + i,
            mean: -share / deviations[i],
            precision: 1.0,
            room: Some([-tolerances[i] - share, tolerances[i] - share].map(|e| e / deviations[i])),
        };
        shares.iter().enumerate().map(one).collect()
    }

    /// Columns of the known parameters, per deviation.
    pub fn known_per_deviation(&self) -> Columns {
        let deviations = known_deviations(self.machine);
        let pairs = self.known.iter().zip(deviations);
        pairs.map(|(column, by)| scaled(column, by)).collect()
    }

    /// Small laws that are always there, of unit deviation.
    pub fn small_laws(&self) -> Columns {
        let over = [Variable::Effort, Variable::Acceleration];
        let shapes = self.library.curves.shapes.iter();
        let shapes = shapes.filter(|(shape, _)| {
            shape.place == Place::Force
                && shape.factor == Factor::One
                && over.contains(&shape.variable)
        });
        let mut all = Vec::new();
        for (shape, columns) in shapes {
            let factor = factor(shape, LENGTH) * (DISCREPANCY * self.own_level);
            all.extend((0..columns.len()).map(|j| sum(columns, factor.column(j).iter())));
        }
        all
    }

    /// Columns of a form of the own friction, per deviation.
    pub fn form(&self, form: usize) -> Columns {
        let columns = self.families[form].columns.iter();
        columns.map(|(column, by)| scaled(column, *by)).collect()
    }

    /// Columns of a law per number of unit variance: a curve of this length, or, beyond these, a short
    /// term.
    pub fn law(&self, law: usize, length: usize) -> Columns {
        if let Some(term) = length.checked_sub(LENGTHS.len()) {
            let columns = self.terms[law][term].iter();
            return columns.map(|c| scaled(c, self.unit_of(law))).collect();
        }
        let (shape, columns) = &self.library.curves.shapes[law];
        let factor = factor(shape, LENGTHS[length]) * self.unit_of(law);
        (0..columns.len())
            .map(|j| sum(columns, factor.column(j).iter()))
            .collect()
    }

    /// Number of columns of a law.
    pub fn numbers_of_law(&self, law: usize, length: usize) -> usize {
        match length.checked_sub(LENGTHS.len()) {
            Some(term) => self.terms[law][term].len(),
            None => self.library.curves.shapes[law].1.len(),
        }
    }

    /// Values at the knots of a law with these numbers of unit variance.
    pub fn law_values(&self, law: usize, length: usize) -> DMatrix<f64> {
        factor(&self.library.curves.shapes[law].0, LENGTHS[length]) * self.unit_of(law)
    }

    /// What a law is measured in: dry friction that an axis may have, or a way.
    fn unit_of(&self, law: usize) -> f64 {
        let (shape, _) = &self.library.curves.shapes[law];
        let scales = Scales::of(self.machine);
        let typical = |name: &str| {
            let size = |e: &Effect| e.parameters.iter().find(|p| p.is_size());
            let effect = Effect::named(name).and_then(size);
            effect.map_or(1.0, |p| p.typical(&scales).abs())
        };
        let unit = match shape.place {
            Place::Force => typical("coulomb-friction"),
            Place::Offset => typical("backlash"),
        };
        let most = match shape.factor {
            Factor::Speed => {
                let speeds = self.fit.traces.iter().flat_map(|t| &t.speed);
                speeds.fold(0.0_f64, |most, v| most.max(v.abs()))
            }
            Factor::One | Factor::Direction => 1.0,
        };
        unit / most.max(f64::MIN_POSITIVE)
    }

    /// Of the only size of an effect that is there, its place among the numbers that are kept.
    pub fn kept_place(&self, name: &str) -> Option<usize> {
        let effects = &self.fit.state.effects;
        let mut free = free_parameters(&self.fit.state).into_iter();
        free.position(|(e, _)| effects[e].effect.name == name)
    }

    fn is_wanted(&self, candidate: &Candidate) -> bool {
        let name = candidate.effect.name;
        let mut rejected = self.settings.rejected.iter();
        let mut there = self.fit.state.effects.iter();
        rejected.all(|other| other != name) && there.all(|a| a.effect.name != name)
    }

    /// All hypotheses beside a reference spectrum.
    fn space(&self, spectra: &Spectra, likelihood: Likelihood) -> Space {
        let mut columns = Columned { all: Vec::new() };
        columns.push(&self.fit.rest);
        let known = self.known_per_deviation();
        let first = columns.all.len();
        for column in &known {
            columns.push(column);
        }
        let mut always = self.of_known(&self.fit.state.shares, first);
        for kept in &self.kept {
            always.push(Prior {
                column: columns.push(&kept.column),
                ..kept.prior
            });
        }
        let small = self.small_laws();
        for column in &small {
            always.push(free(columns.push(column)));
        }
        let mut forms = Vec::new();
        for family in &self.families {
            let of = family.columns.iter();
            let priors = of.map(|(column, by)| free(columns.push_scaled(column, *by)));
            forms.push(FormTried {
                priors: priors.collect(),
                instead_of: family.instead_of,
            });
        }
        let mut effects: Vec<Tried> = Vec::new();
        for candidate in self.library.candidates.iter().filter(|c| self.is_wanted(c)) {
            let does = candidate.columns.iter();
            if does.flatten().flatten().all(|v| v.norm_sqr() == 0.0) {
                continue;
            }
            let shaped = Shaped {
                effect: candidate.effect,
                values: candidate.values.clone(),
                columns: candidate.columns.iter().map(|c| columns.push(c)).collect(),
                bounds: bounds(candidate.effect, &candidate.scales),
            };
            match effects.last_mut() {
                Some(last) if last.effect.name == shaped.effect.name => last.shapes.push(shaped),
                _ => effects.push(Tried {
                    effect: shaped.effect,
                    shapes: vec![shaped],
                }),
            }
        }
        let mut hats: Vec<Vec<usize>> = Vec::new();
        for (_, of) in self.library.curves.shapes.iter() {
            hats.push(of.iter().map(|c| columns.push(c)).collect());
        }
        let mut of_terms: Vec<Vec<Vec<usize>>> = Vec::new();
        for (law, terms) in self.terms.iter().enumerate() {
            let unit = self.unit_of(law);
            let mut push = |term: &Columns| -> Vec<usize> {
                term.iter().map(|c| columns.push_scaled(c, unit)).collect()
            };
            of_terms.push(terms.iter().map(&mut push).collect());
        }
        let all: Vec<&Amplitudes> = columns.all.iter().map(AsRef::as_ref).collect();
        let mut products = Reference::new(&self.layout, spectra).products(&all);
        let mut sums: Vec<Vec<(usize, f64)>> = Vec::new();
        for (law, hats) in hats.iter().enumerate() {
            for length in 0..LENGTHS.len() {
                let factor = self.law_values(law, length);
                for j in 0..hats.len() {
                    let column = factor.column(j);
                    sums.push(hats.iter().copied().zip(column.iter().copied()).collect());
                }
            }
        }
        let mut of_laws = products.with(&sums);
        let laws = hats.iter().zip(&of_terms).map(|(hats, terms)| {
            let curves = (0..LENGTHS.len()).map(|_| of_laws.by_ref().take(hats.len()).collect());
            let mut lengths: Vec<Vec<usize>> = curves.collect();
            lengths.extend(terms.iter().cloned());
            LawTried { lengths }
        });
        let laws = laws.collect();
        Space {
            products,
            likelihood,
            always,
            forms,
            effects,
            laws,
        }
    }

    /// All explanations, with the reference spectrum that judged them: a first pass against noise of
    /// which nothing is known finds what is left at best, which is the noise of the second.
    pub fn explanations(&self) -> (Vec<Explanation>, Spectra, Space) {
        let spectra = self.spectra(&self.fit.rest, None);
        let mut space = self.space(&spectra, Likelihood::Free(NU));
        let first = space.explanations(FIRST_PASS);
        let Some(best) = first.iter().max_by(|a, b| a.ln.total_cmp(&b.ln)) else {
            return (first, spectra, space);
        };
        let spectra = self.reference(best, &space);
        let mut space = self.space(&spectra, Likelihood::Referenced);
        let all = space.explanations(MOST_EFFECTS);
        (all, spectra, space)
    }

    /// Spectrum of what is left, so many numbers fitted in each band and channel.
    fn spectra(&self, left: &Amplitudes, fitted: Option<&[f64]>) -> Spectra {
        let channels = self.layout.channels();
        let inexact = self.inexact();
        let mut all = self.layout.spectral_matrices(left);
        for (b, s) in all.iter_mut().enumerate() {
            let n = self.layout.values()[b];
            for c in 0..channels {
                let fitted = fitted.map_or(0.0, |f| 0.5 * f[b * channels + c]);
                let by = (n / (n - fitted).max(LEFT * n)).sqrt();
                for other in 0..channels {
                    s[(c, other)] *= Complex::new(by, 0.0);
                    s[(other, c)] *= Complex::new(by, 0.0);
                }
            }
        }
        let mut all = self.smooth(&all);
        for s in &mut all {
            for c in 0..channels {
                let own = s[(c, c)].re;
                s[(c, c)] += inexact[c] + OF_SPECTRUM * own + f64::MIN_POSITIVE.sqrt();
            }
        }
        all
    }

    /// Each band beside its neighbours: noise changes little from one to the next, and what is missing
    /// in one would pass for its noise.
    fn smooth(&self, spectra: &Spectra) -> Spectra {
        let bands: Vec<([f64; 2], f64)> = self.layout.bands().collect();
        let middle = |b: usize| (0.5 * (bands[b].0[0] + bands[b].0[1])).ln();
        let one = |b: usize| {
            let channels = spectra[b].nrows();
            // Channel by channel, as the logarithm of its power; how channels go together stays.
            let by: Vec<f64> = (0..channels)
                .map(|c| {
                    let (mut sum, mut count) = (0.0, 0.0);
                    for (k, of) in spectra.iter().enumerate() {
                        let apart = (middle(k) - middle(b)) / SMOOTH;
                        let weight = bands[k].1 * (-0.5 * apart * apart).exp();
                        sum += weight * of[(c, c)].re.max(f64::MIN_POSITIVE).ln();
                        count += weight;
                    }
                    (0.5 * (sum / count - spectra[b][(c, c)].re.max(f64::MIN_POSITIVE).ln())).exp()
                })
                .collect();
            DMatrix::from_fn(channels, channels, |i, j| {
                spectra[b][(i, j)] * Complex::new(by[i] * by[j], 0.0)
            })
        };
        (0..spectra.len()).map(one).collect()
    }

    /// Spectrum of what the best explanation leaves, and of what it may be off by.
    fn reference(&self, best: &Explanation, space: &Space) -> Spectra {
        let columns = self.columns_of(best);
        let known = self.fit.state.shares.len();
        let always = space.always.len();
        let form = best.form.map_or(0, |f| space.forms[f].priors.len());
        let part = |from: usize, to: usize| {
            let mut all = self.fitter().nothing(&self.fit);
            for i in from..to {
                add(&mut all, &columns[i], best.evidence.x[i]);
            }
            all
        };
        let mut left = self.fit.rest.clone();
        for (column, x) in columns.iter().zip(best.evidence.x.iter()) {
            add(&mut left, column, -x);
        }
        let mut all = self.spectra(&left, Some(&best.evidence.fitted));
        for (did, share) in [
            (part(0, known), OF_KNOWN),
            (part(known, always + form), OF_NUISANCE),
        ] {
            let of = self.layout.spectral_matrices(&did);
            for (s, of) in all.iter_mut().zip(of) {
                for c in 0..self.layout.channels() {
                    s[(c, c)] += of[(c, c)] * share * share;
                }
            }
        }
        all
    }

    /// Columns of an explanation's coefficients, as amplitudes.
    pub fn columns_of(&self, of: &Explanation) -> Columns {
        let mut all = self.known_per_deviation();
        all.extend(self.kept.iter().map(|k| k.column.clone()));
        all.extend(self.small_laws());
        if let Some(form) = of.form {
            all.extend(self.form(form));
        }
        for shaped in &of.effects {
            all.extend(self.does(shaped));
        }
        if let Some((law, length)) = of.law {
            all.extend(self.law(law, length));
        }
        all
    }

    /// What an effect in a shape does, per typical size: simulated, as a window in time is in no library.
    fn does(&self, shaped: &Shaped) -> Columns {
        let library = self.library.candidates.iter();
        let mut same = library.filter(|c| c.effect.name == shaped.effect.name);
        let known = same.find(|c| c.values == shaped.values);
        known.map_or_else(
            || {
                crate::name::library::responses(
                    &self.fitter(),
                    &self.fit,
                    shaped.effect,
                    &shaped.values,
                )
            },
            |c| c.columns.clone(),
        )
    }
}

/// A number of unit variance.
fn free(column: usize) -> Prior {
    Prior {
        column,
        mean: 0.0,
        precision: 1.0,
        room: None,
    }
}

fn scaled(column: &Amplitudes, by: f64) -> Amplitudes {
    let mut column = column.clone();
    column.iter_mut().flatten().for_each(|v| *v *= by);
    column
}

pub fn add(to: &mut Amplitudes, column: &Amplitudes, by: f64) {
    let pairs = to.iter_mut().flatten().zip(column.iter().flatten());
    pairs.for_each(|(a, c)| *a += c * by);
}

fn sum<'b>(columns: &Columns, by: impl Iterator<Item = &'b f64>) -> Amplitudes {
    let mut all: Amplitudes = columns[0]
        .iter()
        .map(|l| vec![Complex::ZERO; l.len()])
        .collect();
    for (column, by) in columns.iter().zip(by) {
        add(&mut all, column, *by);
    }
    all
}

/// The axis' own dry friction with that of a state, whose form may be another.
pub fn friction_of(machine: &Axis, state: &State) -> Option<ActiveEffect> {
    let own = own_friction(machine);
    let level = own.as_ref().map_or(0.0, |own| own.values[0]);
    let named = |name: &str| state.effects.iter().find(|a| a.effect.name == name);
    if let Some(by_direction) = named(BY_DIRECTION) {
        let mut active = by_direction.clone();
        active.values.iter_mut().for_each(|v| *v += level);
        return Some(active);
    }
    let Some(plain) = named(PLAIN) else {
        return own;
    };
    let mut active = plain.clone();
    active.values[0] += level;
    (active.values[0] > 0.0).then_some(active)
}

/// Short terms over what each curve of a library is over, and what each is taken with, of unit size on
/// these motions.
fn terms_of(fitter: &Fitter<'_>, fit: &Fit, library: &Library) -> Vec<Vec<Columns>> {
    let motions = courses(fitter.machine, fitter.set, &fit.traces);
    let middle = middle(&motions);
    let of_curve = |(shape, _): &(Shape, Columns)| {
        let column = |mut series: Vec<Vec<f64>>| {
            let all = series.iter().flatten();
            let most = all.fold(f64::MIN_POSITIVE, |most, v| most.max(v.abs()));
            series.iter_mut().flatten().for_each(|v| *v /= most);
            answer(fitter, fit, shape.place, series)
        };
        let own = terms(shape.place).iter();
        let own = own.filter(|term| term.over == (shape.variable, shape.factor));
        own.map(|term| {
            term.series(&motions, middle)
                .into_iter()
                .map(column)
                .collect()
        })
        .collect()
    };
    library.curves.shapes.par_iter().map(of_curve).collect()
}

/// Bounds of an effect's sizes over their typical values.
fn bounds(effect: &Effect, scales: &Scales) -> Vec<[f64; 2]> {
    if phase_of(effect).is_some() {
        return Vec::new();
    }
    let one = |p: &axis_sim::effects::EffectParameter| {
        let mut edges = p.bounds(scales).map(|edge| edge / p.typical(scales));
        edges.sort_by(f64::total_cmp);
        edges
    };
    let sizes = effect.parameters.iter().filter(|p| p.is_size());
    sizes.map(one).collect()
}
