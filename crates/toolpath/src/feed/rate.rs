//! The rate at which a base motion is passed, in least time within the limits of the axes.

use super::FeedLimits;
use super::band::Pentadiagonal;
use super::base::{Base, basis, sum};
use crate::PathPoint;

/// A place at which the limits are held.
#[derive(Clone, Debug)]
pub(super) struct Held<const D: usize> {
    pub(super) k: usize,
    /// Values of the three splines there: coefficients of the rate.
    b: [f64; 3],
    /// Weight in the sum that is the time.
    weight: f64,
    /// Coefficients of the acceleration of each axis over its limit …
    a: [[f64; 3]; D],
    /// … and of its jerk over its limit and the root of the rate.
    j: [[f64; 3]; D],
    /// Greatest rate squared for the velocities, as its inverse.
    v: f64,
}

impl<const D: usize> Held<D> {
    /// At place `x` of interval `k`, where the path is `point`; `speed` (m/s) is a further limit.
    pub(super) fn new(
        base: &Base,
        (k, x): (usize, f64),
        point: &PathPoint<D>,
        limits: &FeedLimits<D>,
        speed: f64,
    ) -> Self {
        let [d1, d2, d3] = base.at(k, x).d;
        let b = basis(x);
        let (mut a, mut j) = ([[0.0; 3]; D], [[0.0; 3]; D]);
        let mut slowness = 1.0 / limits.feed.min(speed);
        for i in 0..D {
            let (x1, x2, x3) = (point.tangent[i], point.curvature[i], point.third[i]);
            let y1 = x1 * d1;
            let y2 = x2 * d1 * d1 + x1 * d2;
            let y3 = x3 * d1 * d1 * d1 + 3.0 * x2 * d1 * d2 + x1 * d3;
            a[i] = std::array::from_fn(|m| {
                (y2 * b[0][m] + 0.5 * y1 * b[1][m]) / limits.acceleration[i]
            });
            j[i] = std::array::from_fn(|m| {
                (y3 * b[0][m] + 1.5 * y2 * b[1][m] + 0.5 * y1 * b[2][m]) / limits.jerk[i]
            });
            slowness = slowness.max(x1.abs() / limits.velocity[i]);
        }
        let v = d1 * d1 * slowness * slowness;
        Self {
            k,
            b: b[0],
            weight: 0.0,
            a,
            j,
            v,
        }
    }

    /// By which factor the rate q must be multiplied so that the greatest of velocity,
    /// acceleration and jerk is at its limit.
    pub(super) fn factor(&self, q: &[f64]) -> f64 {
        let c = &q[self.k..];
        let rate = sum(c, &self.b);
        let mut most = rate * self.v;
        let root = rate.sqrt();
        for i in 0..D {
            most = most.max(sum(c, &self.a[i]).abs());
            let jerk = (root * sum(c, &self.j[i])).abs();
            most = most.max(libm::cbrt(jerk * jerk));
        }
        1.0 / most
    }
}

/// Least-time rates: q = (dτ/dt)² as a quadratic spline.
///
/// With y(τ) = x(s(τ)), ′ by τ: a = y″q + ½y′q′ and j = √q (y‴q + 3/2 y″q′ + ½y′q″). The time
/// ∫ q^(−1/2) dτ is convex in q and limits of velocity and acceleration are linear. That of jerk,
/// |L(q)| ≤ q^(−1/2), is not convex; its right side is, so that the barrier's Hessian without
/// the curvature of that side is positive definite. The minimum of time/μ − Σ log(slack) is found
/// by Newton's method with that Hessian, of five diagonals, for falling μ; all iterates keep all
/// limits strictly.
pub(super) struct Problem<const D: usize> {
    pub(super) base: Base,
    pub(super) held: Vec<Held<D>>,
    n: usize,
}

impl<const D: usize> Problem<D> {
    /// Limits held at the begin, the middle and the end of each interval.
    pub(super) fn new(
        base: Base,
        limits: &FeedLimits<D>,
        at: impl Fn(f64) -> PathPoint<D>,
    ) -> Self {
        let n = base.intervals();
        let mut held = Vec::with_capacity(3 * n);
        for k in 0..n {
            for (x, weight) in [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)] {
                let point = at(base.at(k, x).s);
                let mut place = Held::new(&base, (k, x), &point, limits, f64::INFINITY);
                place.weight = weight;
                held.push(place);
            }
        }
        Self {
            base,
            held,
            n: n + 2,
        }
    }

    /// The greatest factor by which `q` may be multiplied.
    pub(super) fn factor(&self, q: &[f64]) -> f64 {
        self.held
            .iter()
            .map(|h| h.factor(q))
            .fold(f64::INFINITY, f64::min)
    }

    /// The greatest uniform rate, less a margin.
    pub(super) fn uniform(&self) -> Vec<f64> {
        let one = vec![1.0; self.n];
        vec![0.7 * self.factor(&one); self.n]
    }

    /// Time, s, by Simpson's rule.
    fn time(&self, q: &[f64]) -> f64 {
        self.held
            .iter()
            .map(|h| h.weight / sum(&q[h.k..], &h.b).sqrt())
            .sum()
    }

    /// Improves the strictly feasible `q` until the time is within about `gap` of the least, of
    /// which the first `start` says how far it is at first.
    pub(super) fn solve(&self, q: &mut Vec<f64>, start: f64, gap: f64) {
        let count = (self.held.len() * (4 * D + 1)) as f64;
        let mut share = start;
        loop {
            share = share.max(gap);
            // Gap of the barrier's minimum: count × μ.
            let weight = count / (share * self.time(q));
            self.center(q, weight);
            if share <= gap {
                break;
            }
            share *= 0.2;
        }
    }

    /// Newton's method at one weight of the time.
    fn center(&self, q: &mut Vec<f64>, weight: f64) {
        let mut hessian = Pentadiagonal::zeros(self.n);
        let mut step = vec![0.0; self.n];
        let mut merit = self.merit(q, weight);
        for _ in 0..30 {
            let gradient = self.assemble(q, weight, &mut hessian);
            for (s, g) in step.iter_mut().zip(&gradient) {
                *s = -g;
            }
            hessian.solve(&mut step);
            let slope: f64 = step.iter().zip(&gradient).map(|(s, g)| s * g).sum();
            // A decrement of less than one constraint in a thousand is no part of the gap.
            // False for a NaN too.
            let holds = slope < -1e-3 * self.held.len() as f64;
            if !holds {
                break;
            }
            let mut length = 1.0;
            loop {
                let next: Vec<f64> = q.iter().zip(&step).map(|(q, s)| q + length * s).collect();
                let value = self.merit(&next, weight);
                if value <= merit + 0.1 * length * slope {
                    *q = next;
                    merit = value;
                    break;
                }
                length *= 0.5;
                if length < 1e-10 {
                    return;
                }
            }
        }
    }

    /// Time times weight less the logarithms of all slacks; infinite outside.
    fn merit(&self, q: &[f64], weight: f64) -> f64 {
        if !q.iter().all(|q| *q > 0.0) {
            return f64::INFINITY;
        }
        // The coefficients are positive, and with them the rate between all places.
        let mut sum_of_all: f64 = -q.iter().map(|&q| libm::log(q)).sum::<f64>();
        for h in &self.held {
            let c = &q[h.k..h.k + 3];
            let rate = sum(c, &h.b);
            let inverse = 1.0 / rate.sqrt();
            let mut product = 1.0 - rate * h.v;
            let mut inside = product > 0.0;
            for i in 0..D {
                let a = sum(c, &h.a[i]);
                let j = sum(c, &h.j[i]);
                inside &= a.abs() < 1.0 && j.abs() < inverse;
                product *= (1.0 - a * a) * (inverse - j) * (inverse + j);
            }
            if !inside {
                return f64::INFINITY;
            }
            sum_of_all += weight * h.weight * inverse - libm::log(product);
        }
        sum_of_all
    }

    fn assemble(&self, q: &[f64], weight: f64, hessian: &mut Pentadiagonal) -> Vec<f64> {
        hessian.clear();
        let mut gradient: Vec<f64> = q.iter().map(|q| -1.0 / q).collect();
        for (row, g) in hessian.rows.iter_mut().zip(&gradient) {
            row[0] = g * g;
        }
        for h in &self.held {
            let c = &q[h.k..h.k + 3];
            let rate = sum(c, &h.b);
            let inverse = 1.0 / rate.sqrt();
            let cubed = inverse * inverse * inverse;
            let mut local = [0.0; 3];
            let mut along = |k: f64, row: &[f64; 3]| {
                for (g, r) in local.iter_mut().zip(row) {
                    *g += k * r;
                }
            };
            // Time: derivatives −½ q^(−3/2) and ¾ q^(−5/2); velocity: slack 1 − v q.
            let slack = 1.0 - rate * h.v;
            along(h.v / slack - 0.5 * weight * h.weight * cubed, &h.b);
            let bend = 0.75 * weight * h.weight * cubed * inverse * inverse;
            hessian.add(h.k, bend + (h.v / slack) * (h.v / slack), &h.b);
            for i in 0..D {
                let row = h.a[i];
                let a = sum(c, &row);
                let (low, high) = (1.0 / (1.0 + a), 1.0 / (1.0 - a));
                along(high - low, &row);
                hessian.add(h.k, high * high + low * low, &row);
                let row = h.j[i];
                let j = sum(c, &row);
                for sign in [1.0, -1.0] {
                    let part = 1.0 / (inverse - sign * j);
                    let slope: [f64; 3] =
                        std::array::from_fn(|m| 0.5 * cubed * h.b[m] + sign * row[m]);
                    along(part, &slope);
                    hessian.add(h.k, part * part, &slope);
                }
            }
            for (g, l) in gradient[h.k..].iter_mut().zip(local) {
                *g += l;
            }
        }
        gradient
    }
}
