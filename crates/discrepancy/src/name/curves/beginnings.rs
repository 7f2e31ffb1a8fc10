//! What a replay does not know of how each of its logs begins.
//!
//! A loop at rest holds loads by its integrator and its bristles, and how it shares them out is known
//! badly; friction of another form lets the axis go in another way. Both are forces that repeat from log
//! to log without being a law of the motion. So where laws compete with effects, each side has such forces
//! of its own in every log, whatever their size: a load throughout, one in each of the first two
//! slots of time, and four pulses at the first move.

use std::ops::Range;

use nalgebra::{Complex, DMatrix, DVector};

use super::{Place, answer, courses};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::thin::products;
use crate::spectrum::{Amplitudes, Layout};

/// Slots of time in a log, as of the library's force in time.
const SLOTS: usize = 24;

/// Pulses at the first move, which last a slot together.
const PULSES: usize = 4;

/// Share of a log's way from which on the axis has moved.
const MOVED: f64 = 1e-4;

/// Rounds of the fit, each weighed by what the last one left.
const ROUNDS: usize = 4;

/// The loop's answers to what is not known of the beginnings of its logs.
#[derive(Debug, Default)]
pub struct Beginnings {
    columns: Columns,
}

impl Beginnings {
    /// Of the logs of a fit; none of torque balances, which know no beginning.
    pub fn of(fitter: &Fitter<'_>, fit: &Fit) -> Self {
        if fitter.set.is_balanced() {
            return Self::default();
        }
        let courses = courses(fitter.machine, fitter.set, &fit.traces);
        let counted = fitter.set.counted();
        let logs = counted.len();
        let parts: Vec<Vec<Range<usize>>> = (courses.iter().zip(counted))
            .map(|(course, counted)| parts(&course.position, counted))
            .collect();
        let each = 0..parts.first().map_or(0, Vec::len);
        let columns = each.flat_map(|part| {
            let on = |log: usize| {
                let mut series = vec![0.0; courses[log].position.len()];
                series[parts[log][part].clone()].fill(1.0);
                series
            };
            let all = answer(fitter, fit, Place::Force, (0..logs).map(on).collect());
            // A log has its own beginning.
            (0..logs).map(move |of| {
                let one = all.iter().enumerate();
                one.map(|(log, bins)| match log == of {
                    true => bins.clone(),
                    false => vec![Complex::ZERO; bins.len()],
                })
                .collect()
            })
        });
        Self {
            columns: columns.collect(),
        }
    }

    /// These answers.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// What is left of a residual without them, where D is least.
    pub fn taken_out(&self, layout: &Layout, rest: Amplitudes) -> Amplitudes {
        let mut left = rest;
        if self.columns.is_empty() {
            return left;
        }
        for _ in 0..ROUNDS {
            let whitener = layout.whitener(&layout.spectral_matrices(&left));
            let white: Vec<DVector<f64>> = (self.columns.iter())
                .map(|c| layout.whiten(&whitener, c))
                .collect();
            let jacobian = DMatrix::from_columns(&white);
            let mut normal = products(&jacobian);
            for i in 0..normal.nrows() {
                normal[(i, i)] += 1e-9 * normal[(i, i)] + f64::MIN_POSITIVE;
            }
            let right = jacobian.tr_mul(&layout.whiten(&whitener, &left));
            let Some(solved) = normal.cholesky() else {
                break;
            };
            let sizes = solved.solve(&right);
            for (column, by) in self.columns.iter().zip(sizes.iter()) {
                let pairs = left.iter_mut().flatten().zip(column.iter().flatten());
                pairs.for_each(|(l, c)| *l -= c * *by);
            }
        }
        left
    }
}

/// The samples of each force in a log that moves so, and of which these samples count.
fn parts(position: &[f64], counted: Range<usize>) -> Vec<Range<usize>> {
    let slot = (counted.len() / SLOTS).max(1);
    let start = position.get(counted.start).copied().unwrap_or_default();
    let away = |x: &f64| (x - start).abs();
    let way = position.iter().map(away).fold(0.0, f64::max);
    let mut moving = counted.clone();
    let moves = moving.find(|k| away(&position[*k]) > MOVED * way);
    let moves = moves.unwrap_or(counted.start);
    let within = |from: usize, to: usize| from.min(counted.end)..to.min(counted.end);
    let slots = (0..2).map(|i| within(counted.start + i * slot, counted.start + (i + 1) * slot));
    let pulse = (slot / PULSES).max(1);
    let pulses = (0..PULSES).map(|i| within(moves + i * pulse, moves + (i + 1) * pulse));
    std::iter::once(counted.clone())
        .chain(slots)
        .chain(pulses)
        .collect()
}

#[cfg(test)]
mod tests {
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    #[test]
    fn forces_begin_with_the_log_and_with_the_first_move() {
        let position: Vec<f64> = (0..2600).map(|k| (k as f64 - 1000.0).max(0.0)).collect();
        let parts = parts(&position, 200..2600);
        assert_eq!(parts[0], 200..2600);
        assert_eq!(parts[1..3], [200..300, 300..400]);
        assert_eq!(parts[3], 1001..1026);
        assert_eq!(parts[6], 1076..1101);
    }

    /// Two logs of noise, of which the first has a step of its own besides, a hundred times the noise: with that
    /// taken out D is that of the noise, but for what its two numbers bring by chance, and of the second log nothing is
    /// taken away but chance.
    #[test]
    fn what_a_log_begins_with_is_taken_out_of_it_alone() {
        let layout = Layout::new(1, &[(2000, 1e-3), (2000, 1e-3)]);
        let mut rng = StdRng::seed_from_u64(7);
        let noise = |rng: &mut StdRng| -> Vec<f64> {
            (0..2000).map(|_| rng.random_range(-1.0..1.0)).collect()
        };
        let step = |k: usize| if k < 700 { 0.0 } else { 1.0 };
        let logs = [noise(&mut rng), noise(&mut rng)];
        let of = |logs: &[Vec<f64>; 2]| -> Amplitudes {
            let one = |(log, series): (usize, &Vec<f64>)| {
                layout.transform(log, std::slice::from_ref(series), &[false])
            };
            logs.iter().enumerate().map(one).collect()
        };
        let steps: Vec<f64> = (0..2000).map(step).collect();
        let nothing = vec![0.0; 2000];
        let begins = Beginnings {
            columns: vec![
                of(&[steps.clone(), nothing.clone()]),
                of(&[nothing, steps.clone()]),
            ],
        };
        let with_step = logs[0].iter().zip(&steps).map(|(x, s)| x + 100.0 * s);
        let measured = of(&[with_step.collect(), logs[1].clone()]);
        let noise = layout.deviance(&of(&logs));
        let before = layout.deviance(&measured);
        let left = begins.taken_out(&layout, measured.clone());
        let after = layout.deviance(&left);
        assert!(before - noise > 100.0, "{}", before - noise);
        assert!((-15.0..1.0).contains(&(after - noise)), "{}", after - noise);
        let change = |log: usize| -> f64 {
            let pairs = left[log].iter().zip(&measured[log]);
            pairs.map(|(a, b)| (a - b).norm_sqr()).sum()
        };
        assert!(change(1) < 1e-4 * change(0), "{} {}", change(0), change(1));
    }
}
