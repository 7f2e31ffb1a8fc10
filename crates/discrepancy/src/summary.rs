//! Where only a table of maximum and mean errors was measured.
//!
//! Each effect alone is fitted to the figures, all relative gaps alike:
//!
//! ```text
//! min over the effect's sizes of   RMS over figures of (simulated − measured) / measured
//! ```
//!
//! A dozen figures cannot name more than one effect with one or two numbers,
//! and give no noise floor; what is shown is how far each effect closes the gap.

use axis_log::metrics::ErrorSummary;
use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, EffectChannel, Scales};
use axis_sim::{Axis, ClosedLoop, ReplayError};
use compensator::NoCompensation;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::estimate::gauss_newton::Descent;

/// Measured figures of one trajectory of the axis file, m.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredError {
    /// Number of the trajectory, from 1.
    pub trajectory: usize,
    /// Maximum of |error|, m.
    pub max: f64,
    /// Mean of |error|, m.
    pub mean: f64,
}

/// How far one effect closes the gap.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Closing {
    /// Its name.
    pub name: String,
    /// Parameter names, SI values and units.
    pub parameters: Vec<(String, f64, String)>,
    /// RMS of the relative gaps that are left.
    pub gap: f64,
}

/// The effects, the one that closes the gap furthest first.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SummaryFound {
    /// RMS of the relative gaps without any effect.
    pub before: f64,
    /// All effects that can be tried.
    pub ranked: Vec<Closing>,
}

/// Ranks the effects by how far each closes the gap to the measured figures.
///
/// # Errors
/// [`ReplayError`] if the axis as its file says does not run.
pub fn rank(
    axis: &Axis,
    measured: &[MeasuredError],
    done: impl Fn() + Sync,
) -> Result<SummaryFound, ReplayError> {
    let base = gaps(axis, measured, &[])?;
    let one = |effect: &&'static Effect| {
        let ranked = close(axis, measured, effect, &base);
        done();
        ranked
    };
    let mut ranked: Vec<Closing> = EFFECTS
        .par_iter()
        .filter(|effect| shows(effect, axis))
        .map(one)
        .collect();
    ranked.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    Ok(SummaryFound {
        before: rms(&base),
        ranked,
    })
}

/// Number of effects that [`rank`] tries.
pub fn tried(axis: &Axis) -> usize {
    EFFECTS.iter().filter(|effect| shows(effect, axis)).count()
}

/// Whether an effect may show in errors of position alone: a sensor's clock does not.
fn shows(effect: &Effect, axis: &Axis) -> bool {
    effect.channel != EffectChannel::Clock && effect.applies_to(axis).is_ok()
}

fn rms(gaps: &DVector<f64>) -> f64 {
    gaps.norm() / (gaps.len() as f64).sqrt()
}

/// (simulated − measured) / measured of all figures.
fn gaps(
    axis: &Axis,
    measured: &[MeasuredError],
    effects: &[ActiveEffect],
) -> Result<DVector<f64>, ReplayError> {
    let mut axis = axis.clone();
    axis.effects.extend_from_slice(effects);
    let closed_loop = ClosedLoop::new(&axis)?;
    let mut all = Vec::new();
    for row in measured {
        let Some(spec) = axis.trajectories.get(row.trajectory - 1) else {
            continue;
        };
        let Ok(motion) = axis.plan(spec) else {
            continue;
        };
        let mut errors = Vec::new();
        closed_loop
            .run(&motion, &mut NoCompensation, |cycle| {
                errors.push(cycle.error())
            })
            .completed()?;
        if let Ok(figures) = ErrorSummary::of(&errors) {
            all.extend([figures.max / row.max - 1.0, figures.mean / row.mean - 1.0]);
        }
    }
    Ok(DVector::from_vec(all))
}

/// Gauss–Newton on the sizes of one effect.
fn close(
    axis: &Axis,
    measured: &[MeasuredError],
    effect: &'static Effect,
    base: &DVector<f64>,
) -> Closing {
    let scales = Scales::of(axis);
    let sizes: Vec<usize> = (0..effect.parameters.len())
        .filter(|&i| effect.parameters[i].is_size())
        .collect();
    let run = |values: &[f64]| {
        let active = ActiveEffect {
            effect,
            values: values.to_vec(),
        };
        gaps(axis, measured, &[active]).ok()
    };
    type Point = (Vec<f64>, DVector<f64>);
    let step = |(values, left): &Point| {
        let column = |&i: &usize| {
            let step = 0.1
                * effect.parameters[i]
                    .typical(&scales)
                    .abs()
                    .max(values[i].abs());
            let mut moved = values.clone();
            moved[i] += step;
            run(&moved).map_or_else(|| DVector::zeros(left.len()), |g| (g - left) / step)
        };
        let columns: Vec<DVector<f64>> = sizes.iter().map(column).collect();
        let matrix = DMatrix::from_columns(&columns);
        matrix.svd(true, true).solve(left, 1e-12).ok()
    };
    let better = |(values, left): &Point, step: &DVector<f64>, length: f64| {
        let mut moved = values.clone();
        for (s, &i) in sizes.iter().enumerate() {
            let [low, high] = effect.parameters[i].bounds(&scales);
            moved[i] = (values[i] - length * step[s]).clamp(low, high);
        }
        let better = run(&moved).filter(|g| g.norm() < left.norm())?;
        Some((moved, better))
    };
    let descent = Descent {
        rounds: 12,
        lengths: 8,
        shorter: 0.5,
    };
    let start = (effect.null(&scales), base.clone());
    let (values, left) = descent.from(start, step, better, |(_, before), (_, after)| {
        let before = before.norm();
        before - after.norm() >= 1e-5 * before
    });
    let named = effect.parameters.iter().zip(&values);
    Closing {
        name: effect.name.to_owned(),
        parameters: named
            .map(|(p, &v)| (p.name.to_owned(), v, p.unit(&scales).to_owned()))
            .collect(),
        gap: rms(&left),
    }
}
