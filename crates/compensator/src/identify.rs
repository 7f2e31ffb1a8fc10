//! Least-squares identification of a [`TransferFunctionModel`].
//!
//! For given poles the model is linear in its coefficients, and its terms are
//! known filters of the reference: least squares minimises the error of the
//! model's output over a whole motion, not of one step from measured values.
//! Every row counts (no decimation): rows are folded block by block into the
//! triangle R of [Φ y] = Q R, so memory does not grow with the motion. One
//! triangle answers for all orders, because the terms are nested.

mod check;
mod error;
mod triangle;

use std::vec::Vec;

use crate::TransferFunctionModel;
use check::check;
use triangle::{Solution, Triangle};

pub use error::TransferFunctionError;

/// Validation errors closer than this fraction of the best count as equal.
const TIE: f64 = 0.01;
/// Residuals below this fraction of the error's RMS are rounding.
const ROUNDING: f64 = 1e-9;

/// One motion from rest without compensation, sampled once a cycle.
#[derive(Clone, Copy, Debug)]
pub struct MotionRecord<'a> {
    /// Control period, s.
    pub period: f64,
    /// Reference acceleration, m/s².
    pub acceleration: &'a [f64],
    /// Tracking error S_ref − S at the same instants, m.
    pub error: &'a [f64],
}

/// What [`identify_transfer_function`] tries: every order up to the largest,
/// with and without direct feed-through, on every cycle of poles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Candidates {
    /// Largest order, 1 to [`MAX_ORDER`](crate::MAX_ORDER).
    pub max_order: usize,
    /// Poles of z, repeated in turn up to the order: one pole makes a Laguerre
    /// basis, two alternate.
    pub pole_cycles: Vec<Vec<f64>>,
}

impl Candidates {
    /// The usual choice for a feed axis: time constants from 1 to 100 ms in
    /// 13 steps, each alone and in pairs at least two steps apart; order up to 12.
    ///
    /// `period` in s; for one that no model may have the poles are refused when
    /// they are used.
    pub fn for_period(period: f64) -> Self {
        let times = (0..13).map(|i| 1e-3 * libm::pow(10.0, f64::from(i) / 6.0));
        let poles: Vec<f64> = times.map(|time| libm::exp(-period / time)).collect();
        let mut pole_cycles: Vec<Vec<f64>> = poles.iter().map(|&p| Vec::from([p])).collect();
        for (i, &fast) in poles.iter().enumerate() {
            pole_cycles.extend(poles[i + 1..].iter().skip(1).map(|&p| Vec::from([fast, p])));
        }
        Self {
            max_order: 12,
            pole_cycles,
        }
    }
}

/// One candidate's result.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Trial {
    /// Cycle of poles.
    pub poles: Vec<f64>,
    /// Order.
    pub order: usize,
    /// Whether the direct feed-through was free (else 0).
    pub direct: bool,
    /// RMS of the model's deviation on the training motions, m.
    pub training_rms: f64,
    /// RMS of the model's deviation on the validation motions, m.
    pub validation_rms: f64,
}

impl Trial {
    /// Number of coefficients.
    pub fn parameters(&self) -> usize {
        self.order + usize::from(self.direct)
    }
}

/// What was identified.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct TransferFunctionFit {
    /// The model chosen.
    pub model: TransferFunctionModel,
    /// Its row of [`TransferFunctionFit::trials`].
    pub chosen: Trial,
    /// Standard errors of the direct feed-through (0 if it was not free)
    /// and of each coefficient, s², as if the residuals were white noise.
    /// Friction and sampling make real residuals coloured: then they are too small.
    pub standard_errors: Vec<f64>,
    /// All candidates, in the order tried.
    pub trials: Vec<Trial>,
}

/// Fits every candidate to `training` by least squares and chooses by the RMS
/// on `validation`: of all within 1 % of the best, the one with the fewest
/// coefficients, of these the best, of these the first tried.
///
/// The bits depend on the arguments alone. Cost: one filter pass and one triangularisation of the
/// training and of the validation motions for each cycle of poles.
///
/// # Errors
/// [`TransferFunctionError`] for invalid motions or candidates, or motions that
/// determine none.
pub fn identify_transfer_function(
    training: &[MotionRecord],
    validation: &[MotionRecord],
    candidates: &Candidates,
) -> Result<TransferFunctionFit, TransferFunctionError> {
    let period = check(training, validation, candidates)?;
    let cycles = candidates.pole_cycles.iter();
    let fits: Vec<_> = cycles
        .flat_map(|cycle| fit_cycle(training, validation, cycle, candidates.max_order))
        .collect();
    let floor = ROUNDING * Triangle::of(validation, &[]).rms(&[]);
    let index = choose(fits.iter().map(|(trial, _)| trial), floor);
    let (chosen, solution) = &fits[index.ok_or(TransferFunctionError::Undetermined)?];

    let split = usize::from(chosen.direct);
    let direct = solution.coefficients[..split].iter().sum();
    let coefficients = &solution.coefficients[split..];
    let poles = repeat(&chosen.poles, chosen.order);
    let mut standard_errors = solution.standard_errors.clone();
    if !chosen.direct {
        standard_errors.insert(0, 0.0);
    }
    Ok(TransferFunctionFit {
        model: TransferFunctionModel::new(period, direct, &poles, coefficients)?,
        chosen: chosen.clone(),
        standard_errors,
        trials: fits.into_iter().map(|(trial, _)| trial).collect(),
    })
}

/// All orders on one cycle of poles, without and with direct feed-through.
fn fit_cycle(
    training: &[MotionRecord],
    validation: &[MotionRecord],
    cycle: &[f64],
    max_order: usize,
) -> Vec<(Trial, Solution)> {
    let poles = repeat(cycle, max_order);
    let train = Triangle::of(training, &poles);
    let valid = Triangle::of(validation, &poles);
    let mut fits = Vec::new();
    for direct in [false, true] {
        let (train, valid) = (train.with_direct(direct), valid.with_direct(direct));
        for order in 1..=max_order {
            let Some(solution) = train.solve(order + usize::from(direct)) else {
                continue;
            };
            let trial = Trial {
                poles: cycle.to_vec(),
                order,
                direct,
                training_rms: train.rms(&solution.coefficients),
                validation_rms: valid.rms(&solution.coefficients),
            };
            fits.push((trial, solution));
        }
    }
    fits
}

fn repeat(cycle: &[f64], order: usize) -> Vec<f64> {
    cycle.iter().copied().cycle().take(order).collect()
}

fn choose<'a>(trials: impl Iterator<Item = &'a Trial> + Clone, floor: f64) -> Option<usize> {
    let best = trials
        .clone()
        .map(|trial| trial.validation_rms)
        .fold(f64::INFINITY, f64::min);
    let limit = (best * (1.0 + TIE)).max(floor);
    trials
        .enumerate()
        .filter(|(_, trial)| trial.validation_rms <= limit)
        .min_by(|(_, a), (_, b)| {
            let fewer = a.parameters().cmp(&b.parameters());
            fewer.then(a.validation_rms.total_cmp(&b.validation_rms))
        })
        .map(|(index, _)| index)
}
