//! The feed along one stretch between two stops.

use super::FeedLimits;
use super::base::{Base, basis, sum};
use super::rate::{Held, Problem};
use crate::contour::Cell;
use crate::error::ToolpathError;
use crate::quadrature::{Panels, gauss};
use crate::{JunctionKind, Path, PathPoint};

/// Motion along the path: arc length and its derivatives by time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FeedPoint {
    /// Arc length, m.
    pub s: f64,
    /// Feed ds/dt, m/s.
    pub feed: f64,
    /// d²s/dt², m/s².
    pub acceleration: f64,
    /// d³s/dt³, m/s³.
    pub jerk: f64,
}

/// A base motion passed at a rate: s(τ), (dτ/dt)² = q(τ).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stretch {
    base: Base,
    /// Coefficients of q, 1/s².
    rates: Vec<f64>,
    time: Panels,
}

/// Where the limits are asked for besides: the sides of a junction.
struct Side<const D: usize> {
    s: f64,
    point: PathPoint<D>,
    /// Greatest feed, m/s.
    speed: f64,
}

/// How close to the least time of the spline the planner goes.
const GAP: f64 = 2e-3;

/// Plans the stretch from `from` to `to` (m), inside of which are no stops.
pub(super) fn plan<const D: usize>(
    path: &Path<D>,
    cells: &[Cell],
    limits: &FeedLimits<D>,
    (from, to): (f64, f64),
) -> Result<Stretch, ToolpathError> {
    let sides = sides(path, limits, from, to);
    let mut table = places(cells, limits.feed, (from, to));
    ramps(&mut table, limits);
    // A first answer shows where the feed is low; the second is made on a base that follows it, and
    // is better at sharp tips. The problem is not convex, so that it may also be worse.
    let first = problem(path, limits, base(path, limits, &table), &sides);
    let mut rates = first.uniform();
    first.solve(&mut rates, 1.0, GAP);
    let motion = Stretch::new(first.base.clone(), rates.clone());
    let second = problem(path, limits, base(path, limits, &motion.speeds()), &sides);
    let mut carried = motion.carried(&second.base);
    let factor = 0.99 * second.factor(&carried);
    carried.iter_mut().for_each(|q| *q *= factor);
    second.solve(&mut carried, 0.05, GAP);
    let mut stretch = hold_peaks(path, limits, second, carried);
    if motion.duration() < stretch.duration() {
        let motion = hold_peaks(path, limits, first, rates);
        if motion.duration() < stretch.duration() {
            stretch = motion;
        }
    }
    if stretch.duration().is_finite() {
        return Ok(stretch);
    }
    let reason = "the limits are too far apart in magnitude; limits within 1e6 of one another";
    Err(ToolpathError::Feed { from, to, reason })
}

fn sides<const D: usize>(
    path: &Path<D>,
    limits: &FeedLimits<D>,
    from: f64,
    to: f64,
) -> Vec<Side<D>> {
    let mut sides = Vec::new();
    for junction in path.junctions().iter().filter(|j| j.s > from && j.s < to) {
        let mut speed = f64::INFINITY;
        if junction.kind == JunctionKind::Curvature {
            for i in 0..D {
                let step = (junction.after.curvature[i] - junction.before.curvature[i]).abs();
                if step > 0.0 {
                    speed = speed.min((limits.acceleration_step[i] / step).sqrt());
                }
            }
        }
        for point in [junction.before, junction.after] {
            sides.push(Side {
                s: junction.s,
                point,
                speed,
            });
        }
    }
    sides
}

/// Places close enough to show the path's shape, each with the feed.
///
/// A first base with the feed that each place allows by itself was tried: its low places stay in
/// the answer where they need not.
fn places(cells: &[Cell], feed: f64, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
    let mut places = vec![to];
    for cell in cells.iter().filter(|c| c.to > from && c.from < to) {
        let (a, b) = (cell.from.max(from), cell.to.min(to));
        // A long line still needs room for its ramps.
        let samples = if cell.second == 0.0 { 64 } else { 8 };
        for m in 0..samples {
            places.push(a + (b - a) * f64::from(m) / f64::from(samples));
        }
    }
    // Close to the ends, where speeds grow as s^(2/3).
    for m in 1..=40 {
        let d = (to - from) / (1u64 << m) as f64;
        places.extend([from + d, to - d]);
    }
    places.sort_by(f64::total_cmp);
    places.dedup();
    places.into_iter().map(|s| (s, feed)).collect()
}

/// Lowers the speeds to what ramps from standstill to standstill reach, roughly.
fn ramps<const D: usize>(table: &mut [(f64, f64)], limits: &FeedLimits<D>) {
    let least = |values: &[f64; D]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let (acceleration, jerk) = (least(&limits.acceleration), least(&limits.jerk));
    let n = table.len();
    let (first, last) = (table[0].0, table[n - 1].0);
    for row in table.iter_mut() {
        // s = j t³/6 and v = j t²/2.
        let d = (row.0 - first).min(last - row.0);
        row.1 = row.1.min(libm::cbrt(4.5 * jerk * d * d));
    }
    let after = |v: f64, d: f64| (v * v + 2.0 * acceleration * d).sqrt();
    for i in 1..n {
        table[i].1 = table[i]
            .1
            .min(after(table[i - 1].1, table[i].0 - table[i - 1].0));
    }
    for i in (0..n - 1).rev() {
        table[i].1 = table[i]
            .1
            .min(after(table[i + 1].1, table[i + 1].0 - table[i].0));
    }
}

/// A base motion with a knot about every twelfth of the time in which an acceleration is built up
/// (from 160 to 4000 over the duration), and every 0.05 rad of the path.
fn base<const D: usize>(path: &Path<D>, limits: &FeedLimits<D>, table: &[(f64, f64)]) -> Base {
    let rise = (0..D).map(|i| limits.acceleration[i] / limits.jerk[i]);
    // Time at constant acceleration between two rows.
    let time = |p: &[(f64, f64)]| 2.0 * (p[1].0 - p[0].0) / (p[0].1 + p[1].1);
    let duration: f64 = table.windows(2).map(time).sum();
    let interval = rise.fold(f64::INFINITY, f64::min) / 12.0;
    let interval = interval.clamp(duration / 4000.0, duration / 160.0);
    let mut count = vec![(table[0].0, 0.0)];
    let mut bend = path.at(table[0].0).curvature_size();
    for pair in table.windows(2) {
        let (a, b) = (pair[0].0, pair[1].0);
        let next = path.at(b).curvature_size();
        let part = time(pair) / interval + (b - a) * 0.5 * (bend + next) / 0.05;
        count.push((b, count[count.len() - 1].1 + part));
        bend = next;
    }
    let n = count[count.len() - 1].1.ceil().clamp(64.0, 20_000.0);
    Base::new(&count, n as usize)
}

fn problem<const D: usize>(
    path: &Path<D>,
    limits: &FeedLimits<D>,
    base: Base,
    sides: &[Side<D>],
) -> Problem<D> {
    let mut problem = Problem::new(base, limits, |s| path.at(s));
    for side in sides {
        let place = problem.base.place(side.s);
        let held = Held::new(&problem.base, place, &side.point, limits, side.speed);
        problem.held.push(held);
    }
    problem
}

/// Between the places that are held a limit may be passed by a little: holds the worst place of
/// each interval too, and slows the whole by what still remains.
fn hold_peaks<const D: usize>(
    path: &Path<D>,
    limits: &FeedLimits<D>,
    mut problem: Problem<D>,
    mut rates: Vec<f64>,
) -> Stretch {
    for round in 0..3 {
        let peaks = peaks(path, limits, &problem.base, &rates);
        let worst = peaks
            .iter()
            .map(|p| p.1)
            .fold(problem.factor(&rates), f64::min);
        let scale = worst.min(1.0) * (1.0 - 1e-12);
        if round == 2 || worst > 1.0 - 1e-5 {
            rates.iter_mut().for_each(|q| *q *= scale);
            break;
        }
        for (place, factor) in peaks {
            if factor < 1.0 {
                let point = path.at(problem.base.at(place.0, place.1).s);
                let held = Held::new(&problem.base, place, &point, limits, f64::INFINITY);
                problem.held.push(held);
            }
        }
        rates.iter_mut().for_each(|q| *q *= 0.999 * scale);
        problem.solve(&mut rates, GAP, GAP);
    }
    Stretch::new(problem.base, rates)
}

/// The place in each interval at which the limits allow the least factor, and that factor.
fn peaks<const D: usize>(
    path: &Path<D>,
    limits: &FeedLimits<D>,
    base: &Base,
    rates: &[f64],
) -> Vec<((usize, f64), f64)> {
    const SAMPLES: usize = 8;
    let factor = |k: usize, x: f64| {
        let point = path.at(base.at(k, x).s);
        Held::new(base, (k, x), &point, limits, f64::INFINITY).factor(rates)
    };
    let mut peaks: Vec<((usize, f64), f64)> = (0..base.intervals())
        .map(|k| {
            let places = (0..=SAMPLES).map(|m| m as f64 / SAMPLES as f64);
            let worst = places.map(|x| (x, factor(k, x)));
            let worst = worst.fold((0.0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
            ((k, worst.0), worst.1)
        })
        .collect();
    let least = peaks
        .iter()
        .map(|p| p.1)
        .fold(f64::INFINITY, f64::min)
        .min(1.0);
    for peak in peaks.iter_mut().filter(|p| p.1 < least * (1.0 + 1e-2)) {
        let (k, x) = peak.0;
        let width = 1.0 / SAMPLES as f64;
        let (mut a, mut b) = ((x - width).max(0.0), (x + width).min(1.0));
        for _ in 0..40 {
            let (c, d) = (b - 0.618_034 * (b - a), a + 0.618_034 * (b - a));
            if factor(k, c) < factor(k, d) {
                b = d
            } else {
                a = c
            }
        }
        let refined = factor(k, 0.5 * (a + b));
        if refined < peak.1 {
            *peak = ((k, 0.5 * (a + b)), refined);
        }
    }
    peaks
}

impl Stretch {
    fn new(base: Base, rates: Vec<f64>) -> Self {
        let mut stretch = Self {
            base,
            rates,
            time: Panels::default(),
        };
        let edges = (0..=stretch.base.intervals()).map(|k| k as f64);
        stretch.time = Panels::fixed(edges, |tau| stretch.slowness(tau));
        stretch
    }

    fn split(&self, tau: f64) -> (usize, f64) {
        let k = (tau.max(0.0) as usize).min(self.base.intervals() - 1);
        (k, (tau - k as f64).clamp(0.0, 1.0))
    }

    /// dt/dτ, s.
    fn slowness(&self, tau: f64) -> f64 {
        let (k, x) = self.split(tau);
        1.0 / sum(&self.rates[k..], &basis(x)[0]).sqrt()
    }

    pub(super) fn duration(&self) -> f64 {
        self.time.total()
    }

    pub(super) fn at(&self, t: f64) -> FeedPoint {
        let integral = |a: f64, b: f64| gauss(a, b, |tau| self.slowness(tau));
        let tau = self.time.invert(t, integral, |tau| self.slowness(tau));
        let (k, x) = self.split(tau);
        self.inside(k, x)
    }

    fn inside(&self, k: usize, x: f64) -> FeedPoint {
        let base = self.base.at(k, x);
        let [d1, d2, d3] = base.d;
        let b = basis(x);
        let c = &self.rates[k..];
        let (q, q1, q2) = (sum(c, &b[0]), sum(c, &b[1]), sum(c, &b[2]));
        let root = q.sqrt();
        FeedPoint {
            s: base.s,
            feed: d1 * root,
            acceleration: d2 * q + 0.5 * d1 * q1,
            jerk: root * (d3 * q + 1.5 * d2 * q1 + 0.5 * d1 * q2),
        }
    }

    /// The rates of the same motion on another base: each coefficient is the rate in the middle of
    /// its spline.
    fn carried(&self, base: &Base) -> Vec<f64> {
        let n = base.intervals();
        (0..n + 2)
            .map(|k| {
                // At the ends, where both slopes vanish, as one interval further inside.
                let tau = (k as f64 - 0.5).clamp(1.0, n as f64 - 1.0);
                let point = base.at((tau as usize).min(n - 1), tau.fract());
                let (l, x) = self.base.place(point.s);
                let rate = self.inside(l, x).feed / point.d[0];
                rate * rate
            })
            .collect()
    }

    /// Arc length and feed at each knot and in each middle, of which the ends, at rest, have a
    /// small feed.
    fn speeds(&self) -> Vec<(f64, f64)> {
        let n = self.base.intervals();
        let inner = (0..n)
            .flat_map(|k| [(k, 0.0), (k, 0.5)])
            .chain([(n - 1, 1.0)]);
        let mut table: Vec<(f64, f64)> = Vec::with_capacity(2 * n + 1);
        for (k, x) in inner {
            let point = self.inside(k, x);
            if table.last().is_none_or(|before| point.s > before.0) {
                table.push((point.s, point.feed));
            }
        }
        let most = table.iter().map(|row| row.1).fold(0.0, f64::max);
        table
            .iter_mut()
            .for_each(|row| row.1 = row.1.max(1e-4 * most));
        table
    }
}
