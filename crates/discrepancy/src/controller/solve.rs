//! The free values by least squares, or by instruments, between their bounds.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::Gain;
use super::equation::{BLOCKS, Equation};
use super::law::Law;
use super::seen::Seen;
use crate::estimate::bounded::bounded;

/// Rounds of Levenberg–Marquardt.
const ROUNDS: usize = 60;

/// Values that were found.
#[derive(Clone, Debug)]
pub struct Solved {
    /// In the order of [`Law::free`], in SI units.
    pub at: Vec<f64>,
    /// Their half widths at 95 %.
    pub half_widths: Vec<f64>,
}

impl Solved {
    /// A value with its interval.
    pub fn gain(&self, key: &'static str, i: usize) -> Gain {
        let (value, half) = (self.at[i], self.half_widths[i]);
        Gain {
            key,
            value,
            ci95: [value - half, value + half],
        }
    }

    /// Whether any value differs from another estimate's by more than its own interval.
    pub fn is_beside(&self, other: &Self) -> bool {
        let apart = self.apart(other);
        apart
            .iter()
            .zip(&self.half_widths)
            .any(|(by, half)| by > half)
    }

    /// It with what another estimate differs by in its intervals.
    pub fn widened(&self, other: &Self) -> Self {
        let halves = self.half_widths.iter().zip(self.apart(other));
        Self {
            at: self.at.clone(),
            half_widths: halves.map(|(half, by)| half.max(by)).collect(),
        }
    }

    fn apart(&self, other: &Self) -> Vec<f64> {
        let pairs = self.at.iter().zip(&other.at);
        pairs.map(|(a, b)| (a - b).abs()).collect()
    }
}

/// Least squares of a law's rest, or of its projection on instruments.
struct Problem<'a> {
    equation: &'a Equation<'a>,
    law: &'a Law,
    instruments: Option<&'a DMatrix<f64>>,
}

/// A step that was taken.
struct Step {
    to: Vec<f64>,
    damping: f64,
    /// By what share the squares fell.
    fall: f64,
}

impl Problem<'_> {
    fn projected(&self, x: DMatrix<f64>) -> Option<DMatrix<f64>> {
        match self.instruments {
            Some(z) => onto(z, &x),
            None => Some(x),
        }
    }

    fn rest(&self, at: &[f64]) -> Option<DMatrix<f64>> {
        let rest = self.equation.rest(self.law, at)?;
        self.projected(DMatrix::from_columns(&[rest]))
    }

    /// A step of Levenberg–Marquardt: damped as a whole, so that neither length nor a bound
    /// turns it away from its descent. None if no step leads down.
    fn step(&self, at: &[f64], damping: f64) -> Option<Step> {
        let rest = self.rest(at)?;
        let columns = self.equation.columns(self.law, at, &self.equation.logs)?;
        let columns = self.projected(columns)?;
        let before = rest.norm_squared();
        let normal = columns.tr_mul(&columns);
        let right = columns.tr_mul(&rest).column(0).into_owned();
        let mut tries = (0..10).map(|i| damping * 8f64.powi(i));
        tries.find_map(|damping| {
            let to = moved(self.law, at, &normal, &right, damping);
            let fall = 1.0 - self.rest(&to)?.norm_squared() / before;
            (fall > 0.0).then_some(Step { to, damping, fall })
        })
    }
}

impl Equation<'_> {
    /// The values of least squares, or, on `instruments`, those at which the residual has nothing
    /// in common with them: least squares of its projection (two-stage least squares). None
    /// where nothing can be compared.
    pub fn solve(&self, law: &Law, start: &[f64], instruments: Option<&[Seen]>) -> Option<Solved> {
        let z = match instruments {
            Some(shown) => Some(self.columns(law, start, shown)?),
            None => None,
        };
        let problem = Problem {
            equation: self,
            law,
            instruments: z.as_ref(),
        };
        let mut at = start.to_vec();
        let mut damping = 1e-3;
        for _ in 0..ROUNDS {
            let Some(step) = problem.step(&at, damping) else {
                break;
            };
            damping = (0.1 * step.damping).max(1e-9);
            let change = relative(law, &at, &step.to);
            at = step.to;
            if change < 1e-9 || step.fall < 1e-12 {
                break;
            }
        }
        let half_widths = self.half_widths(law, &at, z.as_ref())?;
        Some(Solved { at, half_widths })
    }

    /// Half widths at 95 % from the scatter of the score over blocks of the logs.
    fn half_widths(&self, law: &Law, at: &[f64], z: Option<&DMatrix<f64>>) -> Option<Vec<f64>> {
        let rest = self.rest(law, at)?;
        let columns = self.columns(law, at, &self.logs)?;
        let z = z.unwrap_or(&columns);
        let parameters = columns.ncols();
        let length = rest.len().div_ceil(BLOCKS).max(1);
        let mut scatter = DMatrix::zeros(parameters, parameters);
        for begin in (0..rest.len()).step_by(length) {
            let rows = length.min(rest.len() - begin);
            let score = z.rows(begin, rows).tr_mul(&rest.rows(begin, rows));
            scatter += &score * score.transpose();
        }
        let freedom = BLOCKS.saturating_sub(parameters).max(1) as f64;
        let inverse = z.tr_mul(&columns).try_inverse()?;
        let covariance = &inverse * scatter * inverse.transpose() * (BLOCKS as f64 / freedom);
        let t = StudentsT::new(0.0, 1.0, freedom).ok()?.inverse_cdf(0.975);
        let width = |i: usize| t * covariance[(i, i)].max(0.0).sqrt() * law.free[i].scale;
        Some((0..parameters).map(width).collect())
    }
}

/// L⁻¹ Zᵀ x, L Lᵀ = Zᵀ Z: x on an orthonormal basis of the instruments.
fn onto(z: &DMatrix<f64>, x: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let mut squares = z.tr_mul(z);
    let largest = squares.diagonal().amax();
    for i in 0..squares.nrows() {
        squares[(i, i)] += 1e-14 * largest;
    }
    squares.cholesky()?.l().solve_lower_triangular(&z.tr_mul(x))
}

/// The values after a damped step that stays between their bounds.
fn moved(
    law: &Law,
    at: &[f64],
    normal: &DMatrix<f64>,
    right: &DVector<f64>,
    damping: f64,
) -> Vec<f64> {
    let mut normal = normal.clone();
    for i in 0..normal.nrows() {
        normal[(i, i)] *= 1.0 + damping;
    }
    let room = |i: usize| {
        let free = &law.free[i];
        Some(free.room.map(|edge| (edge - at[i]) / free.scale))
    };
    let step = bounded(&normal, right, room);
    let all = at.iter().zip(&law.free).zip(step.iter());
    all.map(|((value, free), by)| (value + by * free.scale).clamp(free.room[0], free.room[1]))
        .collect()
}

fn relative(law: &Law, from: &[f64], to: &[f64]) -> f64 {
    let all = from.iter().zip(to).zip(&law.free);
    all.map(|((a, b), free)| ((a - b) / free.scale).abs())
        .fold(0.0, f64::max)
}
