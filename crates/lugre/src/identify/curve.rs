//! The weighted fit of the steady-state curve behind `identify_static`.

use nalgebra::{DMatrix, DVector, SMatrix};

use super::Estimate;
use super::error::IdentifyError;
use super::least_squares::{Minimum, Problem, square};
use super::record::ConstantSpeedRun;
use super::statics::{LeftOut, StaticFit};

/// (`T_C`, `T_S − T_C`, `Ω_S`, `σ2`, offset): in these the bounds are simple.
type Unknowns = [f64; 5];

/// The runs of a fit, with their weights.
pub(super) struct Curve<'a> {
    runs: &'a [ConstantSpeedRun],
    /// Standard errors with the floor, N·m.
    errors: Vec<f64>,
    /// Whether both directions allow an offset to be told from `T_C`.
    offset: bool,
}

impl<'a> Curve<'a> {
    pub fn new(runs: &'a [ConstantSpeedRun]) -> Self {
        let largest = runs.iter().map(|r| r.torque.abs()).fold(0.0, f64::max);
        // The floor keeps a noise-free run from having infinite weight.
        let floor = (1e-6 * largest).max(f64::MIN_POSITIVE);
        let forward = runs.iter().filter(|r| r.speed > 0.0).count();
        Self {
            runs,
            errors: runs
                .iter()
                .map(|r| r.torque_standard_error.max(floor))
                .collect(),
            offset: forward >= 2 && runs.len() - forward >= 2,
        }
    }

    fn free(&self) -> [bool; 5] {
        [true, true, true, true, self.offset]
    }

    /// Equation (4) plus the offset, divided by the standard errors.
    fn residuals(&self, x: &Unknowns, out: &mut [f64]) {
        let [coulomb, rise, stribeck, viscous, offset] = *x;
        for ((out, run), error) in out.iter_mut().zip(self.runs).zip(&self.errors) {
            let level = coulomb + rise * falling(run.speed, stribeck);
            let model = level.copysign(run.speed) + viscous * run.speed + offset;
            *out = (model - run.torque) / error;
        }
    }

    /// The best start among 200 Stribeck speeds, spaced by equal ratios over
    /// the range of speeds and a factor of 2 beyond.
    pub fn search(&self) -> Option<Unknowns> {
        const STEPS: i32 = 200;
        let speeds = self.runs.iter().map(|r| r.speed.abs());
        let low = 0.5 * speeds.clone().fold(f64::INFINITY, f64::min);
        let ratio = 2.0 * speeds.fold(0.0, f64::max) / low;
        (0..=STEPS)
            .filter_map(|i| {
                let stribeck = low * ratio.powf(f64::from(i) / f64::from(STEPS));
                self.linear(stribeck)
            })
            .filter(|(x, _)| x[0] > 0.0 && x[1] > 0.0)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(x, _)| x)
    }

    /// Linear least squares for a given Stribeck speed, and its cost.
    fn linear(&self, stribeck: f64) -> Option<(Unknowns, f64)> {
        let columns = if self.offset { 4 } else { 3 };
        let design = DMatrix::from_fn(self.runs.len(), columns, |i, j| {
            let speed = self.runs[i].speed;
            let value = match j {
                0 => speed.signum(),
                1 => falling(speed, stribeck).copysign(speed),
                2 => speed,
                _ => 1.0,
            };
            value / self.errors[i]
        });
        let target = DVector::from_fn(self.runs.len(), |i, _| self.runs[i].torque / self.errors[i]);
        let scale: Vec<f64> = design.column_iter().map(|c| c.norm()).collect();
        if scale.iter().any(|s| !s.is_normal()) {
            return None;
        }
        let scaled = DMatrix::from_fn(design.nrows(), columns, |i, j| design[(i, j)] / scale[j]);
        let qr = scaled.qr();
        let right = qr.q().transpose() * target;
        let solution = qr.r().solve_upper_triangular(&right)?;
        let get = |j: usize| solution.get(j).map_or(0.0, |v| v / scale[j]);
        let x = [get(0), get(1), stribeck, get(2).max(0.0), get(3)];
        let mut r = vec![0.0; self.runs.len()];
        self.residuals(&x, &mut r);
        Some((x, square(&r)))
    }

    /// Levenberg–Marquardt on all unknowns, with `T_C, T_S − T_C, σ2 ≥ 0`.
    pub fn refine(&self, start: Unknowns) -> Minimum<5> {
        let fastest = self.runs.iter().map(|r| r.speed.abs()).fold(0.0, f64::max);
        let residuals = |x: &Unknowns, out: &mut [f64]| self.residuals(x, out);
        let problem = Problem {
            residuals: &residuals,
            count: self.runs.len(),
            scale: [start[0], start[1], start[2], start[0] / fastest, start[0]],
            lower: [0.0, 0.0, 1e-3 * start[2], 0.0, f64::NEG_INFINITY],
            free: self.free(),
        };
        problem.minimise(start)
    }

    /// The estimates; the covariance of (`T_C`, `T_S`, …) from that of
    /// (`T_C`, `T_S − T_C`, …).
    pub fn report(
        &self,
        minimum: Minimum<5>,
        used: Vec<usize>,
        left_out: Vec<LeftOut>,
    ) -> Result<StaticFit, IdentifyError> {
        let [coulomb, rise, stribeck, viscous, offset] = minimum.x;
        let chi_squared = square(&minimum.residuals);
        let fitted = self.free().iter().filter(|&&f| f).count();
        let degrees_of_freedom = self.runs.len() - fitted;
        let error_scale = error_scale(chi_squared, degrees_of_freedom);
        let inverse = minimum.inverse.ok_or(IdentifyError::NoStribeckEffect {
            rise,
            standard_error: f64::INFINITY,
        })?;
        let mut to_stiction = SMatrix::<f64, 5, 5>::identity();
        to_stiction[(1, 0)] = 1.0;
        let c = to_stiction * inverse * to_stiction.transpose() * (error_scale * error_scale);
        let estimate = |i: usize, value: f64| Estimate {
            value,
            standard_error: c[(i, i)].max(0.0).sqrt(),
        };
        let torque_squares: f64 = minimum
            .residuals
            .iter()
            .zip(&self.errors)
            .map(|(r, e)| (r * e) * (r * e))
            .sum();
        Ok(StaticFit {
            coulomb: estimate(0, coulomb),
            stiction: estimate(1, coulomb + rise),
            stribeck_speed: estimate(2, stribeck),
            viscous: estimate(3, viscous),
            torque_offset: estimate(4, offset),
            covariance: core::array::from_fn(|i| core::array::from_fn(|j| c[(i, j)])),
            residual_rms: (torque_squares / self.runs.len() as f64).sqrt(),
            chi_squared,
            degrees_of_freedom,
            error_scale,
            used,
            left_out,
            outcome: minimum.outcome,
        })
    }
}

/// `exp(−(ω/Ω_S)²)`.
fn falling(speed: f64, stribeck: f64) -> f64 {
    (-(speed / stribeck).powi(2)).exp()
}

/// 1, or the Birge ratio where the misfit cannot be the runs' own noise: χ²/ν
/// has the standard deviation √(2/ν).
fn error_scale(chi_squared: f64, degrees_of_freedom: usize) -> f64 {
    let nu = degrees_of_freedom as f64;
    let ratio = chi_squared / nu;
    if ratio > 1.0 + 3.0 * (2.0 / nu).sqrt() {
        ratio.sqrt()
    } else {
        1.0
    }
}
