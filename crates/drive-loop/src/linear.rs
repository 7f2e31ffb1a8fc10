//! The least of a function of a few numbers under limits, by linear programs.
//!
//! At each step the function f and the limits c_i ≤ 0 are made straight, and
//!
//! ```text
//! least   g·d + W max(0, max_i (c_i + a_i·d))        |d_j| ≤ Δ
//! ```
//!
//! is the step; Δ grows where f + W max(0, max c_i) follows the straight one, and shrinks where it does not
//! (R. Fletcher, E. Sainz de la Maza, Mathematical Programming 43 (1989) 235–256, doi:10.1007/BF01582292).
//! Where limits meet in an edge a simplex (Nelder and Mead's) folds up against it; this goes along it.

use nalgebra::{DMatrix, DVector};

/// What a point is worth.
pub(crate) struct Worth {
    /// f.
    pub height: f64,
    /// c_i: above 0 where a limit is exceeded.
    pub excess: Vec<f64>,
}

/// Step of the differences.
const DIFFERENCE: f64 = 1e-4;
/// Greatest Δ, the least, and what it grows and shrinks by.
const MOST: f64 = 0.5;
const LEAST: f64 = 2e-5;
const GROWN: f64 = 2.0;
const SHRUNK: f64 = 0.35;
/// Shares of the predicted improvement with which a step is taken, and Δ grows.
const TAKEN: f64 = 0.1;
const GOOD: f64 = 0.7;
/// Rounding of a linear program whose numbers are of the order of 1.
const ROUNDING: f64 = 1e-9;

/// f + W max(0, max c_i).
fn cost(worth: &Worth, weight: f64) -> f64 {
    worth.height + weight * worth.excess.iter().copied().fold(0.0, f64::max)
}

/// The least of f + W max(0, max c_i) from a point, Δ being `size` first, with `most` evaluations or a few
/// more: the point and its value. `of` is none where there is no value; infinite where `from` has none.
pub(crate) fn least_within(
    of: &mut dyn FnMut(&[f64]) -> Option<Worth>,
    weight: f64,
    from: &[f64],
    size: f64,
    most: usize,
) -> (Vec<f64>, f64) {
    let n = from.len();
    let mut x = from.to_vec();
    let Some(mut here) = of(&x) else {
        return (x, f64::INFINITY);
    };
    let (mut used, mut reach) = (1, size);
    while used < most && reach > LEAST {
        let mut straight = Straight {
            slope: vec![0.0; n],
            excess: here.excess.clone(),
            slopes: vec![vec![0.0; n]; here.excess.len()],
        };
        for j in 0..n {
            let mut beside = x.clone();
            beside[j] += DIFFERENCE;
            used += 1;
            let Some(worth) = of(&beside) else {
                return (x, cost(&here, weight));
            };
            straight.slope[j] = (worth.height - here.height) / DIFFERENCE;
            for (i, excess) in worth.excess.iter().enumerate() {
                straight.slopes[i][j] = (excess - here.excess[i]) / DIFFERENCE;
            }
        }
        let before = cost(&here, weight);
        // A step that fails is made shorter with the same slopes.
        loop {
            let step = straight.step(weight, reach);
            let predicted = before - here.height - straight.at(&step, weight);
            let next: Vec<f64> = x.iter().zip(&step).map(|(x, d)| x + d).collect();
            used += 1;
            let found = of(&next);
            let gained = found
                .as_ref()
                .map_or(f64::NEG_INFINITY, |worth| before - cost(worth, weight));
            let share = gained / predicted;
            if let Some(worth) = found.filter(|_| predicted > 0.0 && share > TAKEN) {
                if share > GOOD {
                    reach = (GROWN * reach).min(MOST);
                }
                (x, here) = (next, worth);
                break;
            }
            reach *= SHRUNK;
            if reach < LEAST || used >= most {
                break;
            }
        }
    }
    let value = cost(&here, weight);
    (x, value)
}

/// f and limits, made straight at a point.
struct Straight {
    slope: Vec<f64>,
    excess: Vec<f64>,
    slopes: Vec<Vec<f64>>,
}

impl Straight {
    fn limit(&self, i: usize, step: &[f64]) -> f64 {
        self.excess[i] + dot(&self.slopes[i], step)
    }

    /// What the straight function is after a step, f at its begin being 0.
    fn at(&self, step: &[f64], weight: f64) -> f64 {
        let limits = (0..self.excess.len()).map(|i| self.limit(i, step));
        dot(&self.slope, step) + weight * limits.fold(0.0, f64::max)
    }

    /// The best step: with few limits first, and those that it exceeds taken in one by one.
    fn step(&self, weight: f64, reach: f64) -> Vec<f64> {
        let mut counted: Vec<usize> = Vec::new();
        loop {
            let (step, over) = self.step_with(&counted, weight, reach);
            let worst = (0..self.excess.len())
                .filter(|i| !counted.contains(i))
                .max_by(|a, b| self.limit(*a, &step).total_cmp(&self.limit(*b, &step)));
            match worst {
                Some(i) if self.limit(i, &step) > over + ROUNDING => counted.push(i),
                _ => return step,
            }
        }
    }

    /// The best step under these limits alone, and t = max(0, max c_i) there. Unknowns are d and t; the
    /// best point of a linear program is a corner, in which as many of its bounds meet as it has unknowns.
    fn step_with(&self, counted: &[usize], weight: f64, reach: f64) -> (Vec<f64>, f64) {
        let n = self.slope.len();
        // row · (d, t) ≤ bound, all with t in units of the reach.
        let mut rows: Vec<(Vec<f64>, f64)> = Vec::new();
        for j in 0..n {
            for sign in [1.0, -1.0] {
                let mut row = vec![0.0; n + 1];
                row[j] = sign;
                rows.push((row, 1.0));
            }
        }
        let mut positive = vec![0.0; n + 1];
        positive[n] = -1.0;
        rows.push((positive, 0.0));
        for i in counted {
            let mut row = self.slopes[*i].clone();
            row.push(-1.0);
            rows.push((row, -self.excess[*i] / reach));
        }
        let height = |at: &[f64]| dot(&self.slope, &at[..n]) + weight * at[n];
        let mut best: Option<(Vec<f64>, f64)> = None;
        let mut chosen: Vec<usize> = (0..=n).collect();
        loop {
            if let Some(at) = corner(&rows, &chosen)
                && best.as_ref().is_none_or(|(_, least)| height(&at) < *least)
                && rows
                    .iter()
                    .all(|(row, bound)| dot(row, &at) <= bound + ROUNDING * (1.0 + bound.abs()))
            {
                best = Some((at.clone(), height(&at)));
            }
            if !advance(&mut chosen, rows.len()) {
                break;
            }
        }
        // Without a step there is no corner but by rounding.
        let (at, _) = best.unwrap_or((vec![0.0; n + 1], 0.0));
        let step = at[..n].iter().map(|d| d * reach).collect();
        (step, at[n] * reach)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Where the chosen bounds meet; none where they do not meet in one point.
fn corner(rows: &[(Vec<f64>, f64)], chosen: &[usize]) -> Option<Vec<f64>> {
    let n = chosen.len();
    let a = DMatrix::from_fn(n, n, |i, j| rows[chosen[i]].0[j]);
    let b = DVector::from_fn(n, |i, _| rows[chosen[i]].1);
    let at = a.lu().solve(&b)?;
    at.iter()
        .all(|x| x.is_finite())
        .then(|| at.iter().copied().collect())
}

/// The next choice out of `of` in the order of dictionaries; whether there is one.
fn advance(chosen: &mut [usize], of: usize) -> bool {
    let k = chosen.len();
    let Some(i) = (0..k).rev().find(|i| chosen[*i] < of - k + i) else {
        return false;
    };
    chosen[i] += 1;
    for j in i + 1..k {
        chosen[j] = chosen[j - 1] + 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::{Worth, least_within};

    /// Along an edge of two limits, as far as a third: least −z with z ≤ x, z ≤ 1 − x + (y + 1)² and |y| ≤ 1/2. The
    /// first two meet at x = z = (1 + (y + 1)²)/2, which is most at y = 1/2: 13/8.
    #[test]
    fn it_goes_along_an_edge_of_limits() {
        let mut of = |p: &[f64]| {
            let [x, y, z] = [p[0], p[1], p[2]];
            Some(Worth {
                height: -z,
                excess: vec![
                    z - x,
                    z - (1.0 - x + (y + 1.0) * (y + 1.0)),
                    y - 0.5,
                    -y - 0.5,
                ],
            })
        };
        let (at, value) = least_within(&mut of, 30.0, &[0.0, 0.0, -1.0], 0.3, 400);
        assert!((value + 1.625).abs() < 1e-6, "{value}");
        for (found, exact) in at.iter().zip([1.625, 0.5, 1.625]) {
            assert!((found - exact).abs() < 1e-5, "{at:?}");
        }
    }

    /// The problem of Rosen and Suzuki (W. Hock, K. Schittkowski, Test Examples for Nonlinear Programming Codes,
    /// Springer 1981, problem 43) with its fourth unknown at the optimum, −1: 44 below 0 at (0, 1, 2, −1), where
    /// two of its three limits are met. It is curved in the third direction, so the last digits come slowly.
    #[test]
    fn it_finds_an_optimum_that_is_no_corner() {
        let d = -1.0;
        let mut of = |p: &[f64]| {
            let [a, b, c] = [p[0], p[1], p[2]];
            let f = a * a + b * b + 2.0 * c * c + d * d - 5.0 * a - 5.0 * b - 21.0 * c + 7.0 * d;
            Some(Worth {
                height: f,
                excess: vec![
                    a * a + b * b + c * c + d * d + a - b + c - d - 8.0,
                    a * a + 2.0 * b * b + c * c + 2.0 * d * d - a - d - 10.0,
                    2.0 * a * a + b * b + c * c + 2.0 * a - b - d - 5.0,
                ],
            })
        };
        let (at, value) = least_within(&mut of, 30.0, &[0.3, 0.3, 0.3], 0.3, 2000);
        assert!((value + 44.0).abs() < 1e-3, "{at:?} {value}");
    }

    /// Where there is no value it does not step, and says so of a start.
    #[test]
    fn it_keeps_off_places_without_a_value() {
        let mut of = |p: &[f64]| {
            (p[0] < 1.0).then(|| Worth {
                height: -p[0],
                excess: vec![],
            })
        };
        let (at, value) = least_within(&mut of, 30.0, &[0.0], 0.3, 200);
        assert!(at[0] < 1.0 && value < -0.99, "{at:?}");
        assert!(
            least_within(&mut of, 30.0, &[2.0], 0.3, 200)
                .1
                .is_infinite()
        );
    }
}
