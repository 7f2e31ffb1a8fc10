//! Variables with a finite number of values: integers and categories.

use super::{Marginal, checked, is_probability, map};
use crate::{Design, LhsError};

/// Whole numbers from `lo` to `hi`, each equally likely.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Integers {
    lo: i64,
    count: usize,
}

/// Greatest magnitude of an integer: f64 holds all up to it.
const GREATEST: i64 = 1 << 53;

impl Integers {
    /// The whole numbers `lo` to `hi`, both included, in the unit of the
    /// variable.
    ///
    /// # Errors
    /// `lo` > `hi`, or one is beyond ±2^53, up to which f64 holds every whole
    /// number.
    pub fn new(lo: i64, hi: i64) -> Result<Self, LhsError> {
        let range = "within -2^53 to 2^53";
        let held = |v: i64| (-GREATEST..=GREATEST).contains(&v);
        checked("Integers", "lo", lo as f64, held(lo), range)?;
        checked("Integers", "hi", hi as f64, held(hi), range)?;
        checked("Integers", "hi", hi as f64, lo <= hi, "at or above lo")?;
        let count = (hi - lo) as usize + 1;
        Ok(Self { lo, count })
    }

    fn value(&self, index: usize) -> f64 {
        (self.lo + index as i64) as f64
    }
}

impl Marginal for Integers {
    fn inverse_cdf(&self, p: f64) -> f64 {
        level(p, self.count).map_or(f64::NAN, |k| self.value(k))
    }
}

/// A number of levels without order or distance, or with values of their own,
/// each equally likely. The value is the level's index 0, 1, 2, … or the one
/// given for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    values: Vec<f64>,
}

impl Levels {
    /// `count` categories; the value in a design is the index, 0 to
    /// `count` − 1.
    ///
    /// # Errors
    /// `count` is 0.
    pub fn categories(count: u32) -> Result<Self, LhsError> {
        let values: Vec<f64> = (0..count).map(f64::from).collect();
        Self::new(&values)
    }

    /// These values, in the unit of the variable and in any order.
    ///
    /// # Errors
    /// There is none, or one is not finite.
    pub fn new(values: &[f64]) -> Result<Self, LhsError> {
        if values.is_empty() {
            return Err(LhsError::TooShort {
                marginal: "Levels",
                len: 0,
                least: 1,
            });
        }
        for &value in values {
            checked("Levels", "value", value, value.is_finite(), "finite")?;
        }
        Ok(Self {
            values: values.to_vec(),
        })
    }
}

impl Marginal for Levels {
    /// The value of the level that `p` falls to, in the order given: falling
    /// in `p` where the values do.
    fn inverse_cdf(&self, p: f64) -> f64 {
        level(p, self.values.len()).map_or(f64::NAN, |k| self.values[k])
    }
}

/// One variable of a design with variables of different kinds.
#[derive(Clone, Copy)]
pub enum DesignVariable<'a> {
    /// A variable by its inverse distribution function.
    Continuous(&'a dyn Marginal),
    /// Whole numbers, each as often as the others.
    Integers(Integers),
    /// Levels, each as often as the others.
    Levels(&'a Levels),
}

/// As [`map`], with integers and levels balanced: among n points each of k
/// levels comes ⌊n/k⌋ or ⌈n/k⌉ times, whatever n is. (Through [`map`] a Latin
/// hypercube gives that where n is a multiple of k; else points in strata that
/// are cut by the edge of a level may make it one or two more or fewer.)
///
/// Levels go by the rank of a value within its column, the lowest ranks to the
/// first level, so that `design` must be whole, not a shard. Equal values rank
/// in the order of rows.
///
/// # Errors
/// As [`map`].
pub fn map_balanced(design: &Design, variables: &[DesignVariable<'_>]) -> Result<Design, LhsError> {
    let identity = |p: f64| p;
    let marginals: Vec<&dyn Marginal> = variables
        .iter()
        .map(|variable| match variable {
            DesignVariable::Continuous(marginal) => *marginal,
            _ => &identity,
        })
        .collect();
    let mapped = map(design, &marginals)?;
    let (n, dims) = (mapped.len(), mapped.dims());
    let mut values = mapped.into_values();
    for (dim, variable) in variables.iter().enumerate() {
        let count = match variable {
            DesignVariable::Continuous(_) => continue,
            DesignVariable::Integers(integers) => integers.count,
            DesignVariable::Levels(levels) => levels.values.len(),
        };
        let mut rows: Vec<usize> = (0..n).collect();
        rows.sort_by(|&a, &b| values[a * dims + dim].total_cmp(&values[b * dims + dim]));
        for (rank, row) in rows.into_iter().enumerate() {
            let index = (rank as u128 * count as u128 / n as u128) as usize;
            values[row * dims + dim] = match variable {
                DesignVariable::Continuous(_) => continue,
                DesignVariable::Integers(integers) => integers.value(index),
                DesignVariable::Levels(levels) => levels.values[index],
            };
        }
    }
    Design::from_rows(dims, values)
}

/// The one of `count` equally likely levels that `p` falls to.
fn level(p: f64, count: usize) -> Option<usize> {
    is_probability(p).then(|| ((p * count as f64) as usize).min(count - 1))
}
