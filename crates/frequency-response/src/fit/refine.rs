//! Least squares of poles, residues and delay together, and what they are uncertain by.

use std::f64::consts::TAU;

use axis_fourier::Complex;
use nalgebra::{DMatrix, DVector};

use super::{FittedMode, FittedPole, Place, Plane, Target, Uncertain};

/// Steps at most, and the share by which one must improve the sum for another to be made.
const STEPS: usize = 60;
const IMPROVED: f64 = 1e-9;
/// Least z of a real pole that is reported.
const FASTEST: f64 = 1e-6;

/// The unknowns, scaled: (rate, residue) of each real pole, (−Re p, Im p, Re c, Im c) of each pair,
/// the delay.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(crate) struct Parameters {
    pub real: usize,
    pub pairs: usize,
    pub values: Vec<f64>,
}

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);
const J: Complex<f64> = Complex::new(0.0, 1.0);

impl Parameters {
    pub fn count(&self) -> usize {
        self.values.len()
    }

    pub fn delay(&self) -> f64 {
        self.values[self.count() - 1]
    }

    fn pair(&self, k: usize) -> [f64; 4] {
        let at = 2 * self.real + 4 * k;
        [0, 1, 2, 3].map(|i| self.values[at + i])
    }

    /// The response.
    pub fn at(&self, place: &Place) -> Complex<f64> {
        let Place { s, x } = *place;
        let mut sum = ZERO;
        for i in 0..self.real {
            sum += (x + self.values[2 * i]).inv() * self.values[2 * i + 1];
        }
        for k in 0..self.pairs {
            let [a, b, re, im] = self.pair(k);
            let (p, c) = (Complex::new(-a, b), Complex::new(re, im));
            sum += c / (x - p) + c.conj() / (x - p.conj());
        }
        sum * (-s * self.delay()).exp()
    }

    /// Its derivatives by all unknowns.
    fn slopes(&self, place: &Place, all: &mut Vec<Complex<f64>>) {
        let Place { s, x } = *place;
        let late = (-s * self.delay()).exp();
        all.clear();
        for i in 0..self.real {
            let part = (x + self.values[2 * i]).inv();
            all.extend([-late * part * part * self.values[2 * i + 1], late * part]);
        }
        for k in 0..self.pairs {
            let [a, b, re, im] = self.pair(k);
            let (p, c) = (Complex::new(-a, b), Complex::new(re, im));
            let [up, down] = [(x - p).inv(), (x - p.conj()).inv()];
            let [by_p, by_q] = [c * up * up, c.conj() * down * down];
            all.extend([
                -late * (by_p + by_q),
                late * J * (by_p - by_q),
                late * (up + down),
                late * J * (up - down),
            ]);
        }
        all.push(-s * self.at(place));
    }
}

/// Weighted squares of the residual.
fn squares(target: &Target, parameters: &Parameters) -> f64 {
    let lines = target.places.iter().zip(&target.value).zip(&target.weight);
    lines
        .map(|((at, value), weight)| (value - parameters.at(at)).norm_sqr() * weight * weight)
        .sum()
}

/// JᵀJ and Jᵀe of the weighted residual.
fn normal(target: &Target, parameters: &Parameters) -> (DMatrix<f64>, DVector<f64>) {
    let n = parameters.count();
    let (mut matrix, mut vector) = (DMatrix::zeros(n, n), DVector::zeros(n));
    let mut slopes = Vec::with_capacity(n);
    for ((at, value), weight) in target.places.iter().zip(&target.value).zip(&target.weight) {
        let squared = weight * weight;
        let error = value - parameters.at(at);
        parameters.slopes(at, &mut slopes);
        for (i, a) in slopes.iter().enumerate() {
            vector[i] += squared * (a.conj() * error).re;
            for (j, b) in slopes.iter().enumerate().take(i + 1) {
                matrix[(i, j)] += squared * (a.conj() * b).re;
            }
        }
    }
    matrix.fill_upper_triangle_with_lower_triangle();
    (matrix, vector)
}

/// Levenberg's and Marquardt's steps (D. W. Marquardt, SIAM Journal on Applied Mathematics 11 (1963)
/// 431–441, doi:10.1137/0111030): the refined unknowns, and their weighted squares.
pub(crate) fn refined(target: &Target, start: Parameters) -> (Parameters, f64) {
    let mut best = (start.clone(), squares(target, &start));
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let (matrix, vector) = normal(target, &best.0);
        let before = best.1;
        while damping < 1e9 {
            let mut damped = matrix.clone();
            for i in 0..damped.nrows() {
                damped[(i, i)] *= 1.0 + damping;
            }
            let step = damped.cholesky().map(|factor| factor.solve(&vector));
            let mut next = best.0.clone();
            if let Some(step) = step {
                next.values
                    .iter_mut()
                    .zip(step.iter())
                    .for_each(|(x, d)| *x += d);
                let sum = squares(target, &next);
                if sum < best.1 {
                    best = (next, sum);
                    damping *= 0.2;
                    break;
                }
            }
            damping *= 5.0;
        }
        if best.1 > before * (1.0 - IMPROVED) {
            break;
        }
    }
    best
}

/// What the unknowns are to a machine.
pub(crate) struct Described {
    pub modes: Vec<FittedMode>,
    pub poles: Vec<FittedPole>,
    pub delay: Uncertain,
}

impl Described {
    /// Modes, poles and delay as numbers, without their deviations.
    #[cfg(feature = "serde")]
    pub fn numbers(modes: &[FittedMode], poles: &[FittedPole], delay: &Uncertain) -> Vec<f64> {
        let of_mode = |mode: &FittedMode| {
            let (frequency, damping) = (mode.frequency_hz.value, mode.damping.value);
            [frequency, damping, mode.residue.re, mode.residue.im]
        };
        let of_pole = |pole: &FittedPole| [pole.rate.value, pole.residue.value];
        let modes = modes.iter().flat_map(of_mode);
        modes
            .chain(poles.iter().flat_map(of_pole))
            .chain([delay.value])
            .collect()
    }
}

/// Modes, real poles and delay with their deviations: the inverse of JᵀJ, times the mean square of the
/// residual where that is above 1, times `correlation` as neighbouring lines err together.
pub(crate) fn described(
    target: &Target,
    parameters: &Parameters,
    squares: f64,
    correlation: f64,
) -> Option<Described> {
    let (matrix, _) = normal(target, parameters);
    let free = 2.0 * target.places.len() as f64 - parameters.count() as f64;
    let widened = correlation * (squares / free.max(1.0)).max(1.0);
    let covariance = inverse(&matrix)? * widened;
    Some(described_with(&target.plane, parameters, &covariance))
}

/// Deviation of the delay, in the scale of the target, of lines that are as exact as they say; none where it is not
/// determined at all.
pub(crate) fn delay_deviation(target: &Target, parameters: &Parameters) -> Option<f64> {
    let (matrix, _) = normal(target, parameters);
    let last = parameters.count() - 1;
    Some(inverse(&matrix)?[(last, last)].max(0.0).sqrt())
}

/// The same, the unknowns having this covariance.
pub(crate) fn described_with(
    plane: &Plane,
    parameters: &Parameters,
    covariance: &DMatrix<f64>,
) -> Described {
    let scale = plane.scale;
    let deviation = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    let real = |i: usize| {
        // A negative z is no pole of a machine: as fast as can be.
        let least = match plane.held > 0.0 {
            true => (FASTEST - 1.0) / plane.held,
            false => f64::NEG_INFINITY,
        };
        let x = Complex::new((-parameters.values[2 * i]).max(least), 0.0);
        let (p, slope) = plane.back(x);
        let by = factor(x, p).re * scale;
        FittedPole {
            rate: Uncertain {
                value: -p.re * scale,
                deviation: deviation(2 * i) * slope.re * scale,
            },
            residue: Uncertain {
                value: parameters.values[2 * i + 1] * by,
                deviation: deviation(2 * i + 1) * by.abs(),
            },
        }
    };
    let mut poles: Vec<FittedPole> = (0..parameters.real).map(real).collect();
    poles.sort_by(|a, b| a.rate.value.total_cmp(&b.rate.value));
    let mode = |k: usize| {
        let [a, b, re, im] = parameters.pair(k);
        let at = 2 * parameters.real + 4 * k;
        let x = Complex::new(-a, b);
        let (p, slope) = plane.back(x);
        let size = p.norm();
        // By a and by b, which move x by −1 and by j.
        let by = [-slope, J * slope];
        let of_size = by.map(|d| (p.conj() * d).re / size);
        let of_damping = [0, 1].map(|i| -by[i].re / size + p.re / (size * size) * of_size[i]);
        let spread = |by: [f64; 2]| {
            let [aa, ab, bb] = [(at, at), (at, at + 1), (at + 1, at + 1)].map(|i| covariance[i]);
            let square = by[0] * by[0] * aa + 2.0 * by[0] * by[1] * ab + by[1] * by[1] * bb;
            square.max(0.0).sqrt()
        };
        let by = factor(x, p) * scale;
        let residue = Complex::new(re, im) * by;
        FittedMode {
            frequency_hz: Uncertain {
                value: size * scale / TAU,
                deviation: spread(of_size) * scale / TAU,
            },
            damping: Uncertain {
                value: -p.re / size,
                deviation: spread(of_damping),
            },
            residue: if b < 0.0 { residue.conj() } else { residue },
            residue_deviation: deviation(at + 2).max(deviation(at + 3)) * by.norm(),
        }
    };
    let late = parameters.count() - 1;
    let delay = Uncertain {
        value: parameters.values[late] / scale,
        deviation: deviation(late) / scale,
    };
    let mut modes: Vec<FittedMode> = (0..parameters.pairs).map(mode).collect();
    modes.sort_by(|a, b| a.frequency_hz.value.total_cmp(&b.frequency_hz.value));
    Described {
        modes,
        poles,
        delay,
    }
}

/// What a residue in the plane is to that of the machine: pT/(e^{pT} − 1) of a held input.
fn factor(x: Complex<f64>, p: Complex<f64>) -> Complex<f64> {
    match x.norm() > 0.0 {
        true => p / x,
        false => Complex::new(1.0, 0.0),
    }
}

/// Inverse of a positive matrix, its rows and columns scaled to a diagonal of 1 first.
fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let sizes: Vec<f64> = matrix.diagonal().iter().map(|x| x.sqrt()).collect();
    let scaled = |m: &DMatrix<f64>| {
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
            m[(i, j)] / (sizes[i] * sizes[j])
        })
    };
    let inverse = scaled(matrix).cholesky()?.inverse();
    Some(scaled(&inverse))
}
