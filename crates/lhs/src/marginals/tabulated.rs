//! A distribution function given as a table.

use super::{Cumulative, Marginal, is_probability};
use crate::LhsError;

/// A piecewise linear distribution function through given points.
///
/// A repeated x is a jump (that value has a probability of its own); a
/// repeated cumulative probability is a gap that no sample falls into.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    points: Vec<(f64, f64)>,
}

impl Tabulated {
    /// Takes pairs (x, G(x)): x in the unit of the variable, G from 0 at the
    /// first pair to 1 at the last.
    ///
    /// # Errors
    /// Fewer than two pairs, an x that is not finite, x or G falling from one
    /// pair to the next, x rising by more than f64 holds, or G not running from
    /// 0 to 1.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, LhsError> {
        let len = points.len();
        if len < 2 {
            return Err(LhsError::TooShort {
                marginal: "Tabulated",
                len,
                least: 2,
            });
        }
        for index in 0..len {
            let before = (index > 0).then(|| points[index - 1]);
            if let Some(valid) = fault(before, points[index], index + 1 == len) {
                let (x, p) = points[index];
                return Err(LhsError::Table { index, x, p, valid });
            }
        }
        // Flat ends carry no probability; without them p = 0 and p = 1 give
        // the ends of the support.
        let first = points.partition_point(|&(_, p)| p <= 0.0) - 1;
        let last = points.partition_point(|&(_, p)| p < 1.0);
        Ok(Self {
            points: points[first..=last].to_vec(),
        })
    }

    /// The points in use: those given, without flat ends.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }
}

fn fault(before: Option<(f64, f64)>, (x, p): (f64, f64), last: bool) -> Option<&'static str> {
    match before {
        _ if !x.is_finite() => Some("x must be finite"),
        None if p != 0.0 => Some("the first cumulative probability must be 0"),
        Some((x0, _)) if x < x0 => Some("x must not fall"),
        Some((x0, _)) if (x - x0).is_infinite() => Some("x must rise by less than 1.8e308"),
        // Written so that NaN is caught as well.
        Some((_, p0)) if !(p0..=1.0).contains(&p) => {
            Some("the cumulative probability must not fall, nor pass 1")
        }
        _ if last && p != 1.0 => Some("the last cumulative probability must be 1"),
        _ => None,
    }
}

impl Marginal for Tabulated {
    fn inverse_cdf(&self, p: f64) -> f64 {
        if !is_probability(p) {
            return f64::NAN;
        }
        // The first point has G = 0 < G of the second, the last has G = 1, so
        // the segment exists and rises.
        let k = self.points.partition_point(|&(_, g)| g < p).max(1);
        let ((x0, p0), (x1, p1)) = (self.points[k - 1], self.points[k]);
        between([(p1 - p) / (p1 - p0), (p - p0) / (p1 - p0)], x0, x1)
    }
}

impl Tabulated {
    /// The table's points on either side of `x`, as far as there are.
    fn around(&self, x: f64) -> [Option<(f64, f64)>; 2] {
        let k = self.points.partition_point(|&(x0, _)| x0 <= x);
        let before = k.checked_sub(1).map(|i| self.points[i]);
        [before, self.points.get(k).copied()]
    }
}

impl Cumulative for Tabulated {
    fn cdf(&self, x: f64) -> f64 {
        match self.around(x) {
            [None, _] => 0.0,
            [_, None] => 1.0,
            [Some((x0, p0)), Some((x1, p1))] => {
                between([(x1 - x) / (x1 - x0), (x - x0) / (x1 - x0)], p0, p1)
            }
        }
    }

    fn survival(&self, x: f64) -> f64 {
        match self.around(x) {
            [None, _] => 1.0,
            [_, None] => 0.0,
            [Some((x0, p0)), Some((x1, p1))] => {
                let shares = [(x - x0) / (x1 - x0), (x1 - x) / (x1 - x0)];
                between(shares, 1.0 - p1, 1.0 - p0)
            }
        }
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        if !is_probability(q) {
            return f64::NAN;
        }
        let k = self.points.partition_point(|&(_, g)| 1.0 - g > q).max(1);
        let ((x0, p0), (x1, p1)) = (self.points[k - 1], self.points[k]);
        let (q0, q1) = (1.0 - p0, 1.0 - p1);
        between([(q - q1) / (q0 - q1), (q0 - q) / (q0 - q1)], x0, x1)
    }
}

/// a and b ≥ a by their shares, which add up to one: exactly either where its share is 1,
/// never past it, and with the digits of a small share. The two products keep b − a from
/// overflowing.
fn between(shares: [f64; 2], a: f64, b: f64) -> f64 {
    (shares[0] * a + shares[1] * b).clamp(a, b)
}
