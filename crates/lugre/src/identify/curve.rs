//! The weighted fit of the steady-state curve behind `identify_static`.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Minimum, Problem, square};
use super::record::ConstantSpeedRun;

/// (`T_C`, `T_S − T_C`, `Ω_S`, `σ2`, offset): in these the bounds are simple.
type Unknowns = [f64; 5];

/// The runs of a fit, with their weights.
pub(super) struct Curve<'a> {
    pub runs: &'a [ConstantSpeedRun],
    /// Standard errors with the floor, N·m.
    pub errors: Vec<f64>,
    /// The least that an unknown standard error counts as, N·m.
    unknown: f64,
    /// Whether both directions allow an offset to be told from `T_C`.
    offset: bool,
}

impl<'a> Curve<'a> {
    pub fn new(runs: &'a [ConstantSpeedRun]) -> Self {
        let largest = runs.iter().map(|r| r.torque.abs()).fold(0.0, f64::max);
        // The floor keeps a noise-free run from having infinite weight.
        let floor = (1e-6 * largest).max(f64::MIN_POSITIVE);
        let known = runs.iter().filter_map(|r| r.torque_standard_error);
        let unknown = known.fold(floor, f64::max);
        let error = |r: &ConstantSpeedRun| r.torque_standard_error.unwrap_or(unknown).max(floor);
        let forward = runs.iter().filter(|r| r.speed > 0.0).count();
        Self {
            runs,
            errors: runs.iter().map(error).collect(),
            unknown,
            offset: forward >= 2 && runs.len() - forward >= 2,
        }
    }

    /// The minimum, with the runs of unknown standard error weighted by what
    /// they scatter about it; `None` if no falling curve fits.
    pub fn fit(&mut self) -> Option<Minimum<5>> {
        const ROUNDS: usize = 10;
        let mut minimum = self.refine(self.search()?);
        for _ in 0..ROUNDS {
            let scatter = self.scatter_of_unknown(&minimum);
            let before = self.errors.clone();
            for (error, run) in self.errors.iter_mut().zip(self.runs) {
                if run.torque_standard_error.is_none() {
                    *error = scatter.max(self.unknown);
                }
            }
            let settled = |(new, old): (&f64, &f64)| (new / old - 1.0).abs() < 1e-3;
            if self.errors.iter().zip(&before).all(settled) {
                self.errors = before;
                break;
            }
            minimum = self.refine(minimum.x);
        }
        Some(minimum)
    }

    /// RMS departure from the curve, N·m, of the runs whose standard error is
    /// not known; each run has its share of the degrees of freedom.
    fn scatter_of_unknown(&self, minimum: &Minimum<5>) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        let residuals = minimum.residuals.iter().zip(&self.errors).zip(self.runs);
        for ((residual, error), run) in residuals {
            if run.torque_standard_error.is_none() {
                squares += (residual * error).powi(2);
                count += 1.0;
            }
        }
        let share = self.degrees_of_freedom() as f64 / self.runs.len() as f64;
        (squares / (f64::max(count, 1.0) * share)).sqrt()
    }

    pub fn degrees_of_freedom(&self) -> usize {
        let fitted = self.free().iter().filter(|&&f| f).count();
        self.runs.len() - fitted
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
    fn search(&self) -> Option<Unknowns> {
        const STEPS: i32 = 200;
        let speeds = self.runs.iter().map(|r| r.speed.abs());
        let low = 0.5 * speeds.clone().fold(f64::INFINITY, f64::min);
        let ratio = 2.0 * speeds.fold(0.0, f64::max) / low;
        (0..=STEPS)
            .filter_map(|i| {
                let stribeck = low * ratio.powf(f64::from(i) / f64::from(STEPS));
                self.linear(stribeck)
            })
            .filter(|(x, cost)| x[0] > 0.0 && x[1] > 0.0 && cost.is_finite())
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
    fn refine(&self, start: Unknowns) -> Minimum<5> {
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
}

/// `exp(−(ω/Ω_S)²)`.
fn falling(speed: f64, stribeck: f64) -> f64 {
    (-(speed / stribeck).powi(2)).exp()
}
