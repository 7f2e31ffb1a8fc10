//! What each effect of the library does on a set of logs.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, EffectParameter, Machine};
use rayon::prelude::*;

use crate::curves::Curves;
use crate::fit::{Columns, Fit, Fitter};
use crate::linear::Room;
use crate::model::Prepared;

/// What all effects, and curves for what is no effect, do on a set of logs.
#[derive(Debug)]
pub struct Library {
    pub(crate) candidates: Vec<Candidate>,
    pub(crate) curves: Curves,
    /// Of the known parameters, as derivatives.
    pub(crate) known: Columns,
}

impl Library {
    pub(crate) fn new(fitter: &Fitter<'_>, fit: &Fit, known: Columns) -> Self {
        Self {
            curves: Curves::new(fitter.machine, fitter.set, fit),
            ..Self::of_effects(fitter, fit, known, |_| true)
        }
    }

    /// Of some effects, and no curves.
    pub(crate) fn of_effects(
        fitter: &Fitter<'_>,
        fit: &Fit,
        known: Columns,
        wanted: impl Fn(&Effect) -> bool,
    ) -> Self {
        Self {
            known,
            candidates: candidates(fitter, fit, wanted),
            curves: Curves::default(),
        }
    }
}

/// An effect with one choice of its shape.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Which.
    pub effect: &'static Effect,
    /// Starting values, sizes typical.
    pub values: Vec<f64>,
    /// Response to each size parameter at its typical value; for an effect
    /// with a phase, to phase 0 and to phase π/2.
    pub columns: Columns,
}

/// Bounds of an effect's columns, which are those of typical sizes; one with a
/// phase has two, free both.
pub fn rooms(effect: &Effect) -> Vec<Room> {
    let phase = effect.parameters.iter().any(|p| p.name == "phase");
    let room = |p: &EffectParameter| {
        let mut edges = p.bounds.map(|edge| edge / p.typical);
        edges.sort_by(f64::total_cmp);
        Some(edges)
    };
    let sizes = effect.parameters.iter().filter(|p| p.size);
    match phase {
        true => sizes.flat_map(|_| [None, None]).collect(),
        false => sizes.map(room).collect(),
    }
}

/// Values of an effect whose columns count so often.
pub fn values_at(effect: &Effect, values: &[f64], solution: &[f64]) -> Vec<f64> {
    let parameters = effect.parameters;
    let mut values = values.to_vec();
    let phase = parameters.iter().position(|p| p.name == "phase");
    let mut next = solution.iter();
    for (i, p) in parameters.iter().enumerate().filter(|(_, p)| p.size) {
        let mut size = next.next().copied().unwrap_or(0.0);
        if let Some(at) = phase {
            let quadrature = next.next().copied().unwrap_or(0.0);
            values[at] = quadrature.atan2(size);
            size = size.hypot(quadrature);
        }
        values[i] = (size * p.typical).clamp(p.bounds[0], p.bounds[1]);
    }
    values
}

/// Values of shape parameters to begin with.
fn shapes(fitter: &Fitter<'_>, effect: &Effect) -> Vec<Vec<f64>> {
    let duration = |l: &Prepared| l.log.len() as f64 * l.period;
    let end = fitter.set.logs.iter().map(duration).fold(0.0, f64::max);
    let positions = fitter
        .set
        .logs
        .iter()
        .flat_map(|l| l.log.channel("position_m").unwrap_or(&[]));
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let typical = effect.typical();
    let along = |i: usize, n: usize| low + (high - low) * (i as f64 + 0.5) / n as f64;
    match effect.name {
        "stribeck-friction" => [0.004, 0.015, 0.05]
            .iter()
            .map(|&v| vec![typical[0], v])
            .collect(),
        "position-dependent-friction" => {
            let width = (high - low) / 16.0;
            (0..8)
                .map(|i| vec![typical[0], along(i, 8), width])
                .collect()
        }
        FORCE => (0..SLOTS)
            .map(|i| {
                let slot = end / SLOTS as f64;
                vec![typical[0], slot * i as f64, slot * (i + 1) as f64]
            })
            .collect(),
        "cogging-torque" => (1..=ORDERS)
            .map(|order| vec![typical[0], f64::from(order), 0.0])
            .collect(),
        "thermal-expansion" => [1.0, 5.0].iter().map(|&t| vec![typical[0], t]).collect(),
        _ => vec![typical],
    }
}

/// Highest order of cogging that is looked for, per motor turn.
const ORDERS: u8 = 24;

/// Name of the force in time.
pub const FORCE: &str = "process-force";

/// Parts of a motion's time in which a force may begin and end.
const SLOTS: usize = 24;

/// Effects of the library that a machine of this kind can have.
pub fn applicable(machine: &Machine) -> impl Iterator<Item = &'static Effect> {
    let rigid = matches!(machine, Machine::Rigid(_));
    let all = EFFECTS.iter().copied();
    all.filter(move |e| e.on_rigid || !rigid)
}

/// Candidates of the library that are `wanted`, at the state of `fit`.
fn candidates(fitter: &Fitter<'_>, fit: &Fit, wanted: impl Fn(&Effect) -> bool) -> Vec<Candidate> {
    let wanted: Vec<(&'static Effect, Vec<f64>)> = applicable(fitter.machine)
        .filter(|e| wanted(e))
        .flat_map(|e| shapes(fitter, e).into_iter().map(move |values| (e, values)))
        .collect();
    wanted
        .into_par_iter()
        .map(|(effect, values)| Candidate {
            columns: responses(fitter, fit, effect, &values),
            effect,
            values,
        })
        .collect()
}

/// Secants at half of the typical size: derivatives would say nothing of
/// gaps and dry friction.
pub fn responses(
    fitter: &Fitter<'_>,
    fit: &Fit,
    effect: &'static Effect,
    values: &[f64],
) -> Columns {
    const SHARE: f64 = 0.5;
    let phase = effect.parameters.iter().position(|p| p.name == "phase");
    let sizes = effect.parameters.iter().enumerate().filter(|(_, p)| p.size);
    let with = |size: usize, angle: Option<f64>| {
        let mut tried = values.to_vec();
        for (value, p) in tried.iter_mut().zip(effect.parameters) {
            if p.size {
                *value = 0.0;
            }
        }
        tried[size] = SHARE * effect.parameters[size].typical;
        if let (Some(at), Some(angle)) = (phase, angle) {
            tried[at] = angle;
        }
        let mut state = fit.state.clone();
        state.effects.push(ActiveEffect {
            effect,
            values: tried,
        });
        fitter.column(fit, state, SHARE)
    };
    match phase {
        Some(_) => sizes
            .flat_map(|(i, _)| [0.0, std::f64::consts::FRAC_PI_2].map(|angle| with(i, Some(angle))))
            .collect(),
        None => sizes.map(|(i, _)| with(i, None)).collect(),
    }
}
