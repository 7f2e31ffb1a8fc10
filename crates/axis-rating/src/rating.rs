//! A value beside its limit.

/// On which side of its limit a value must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Bound {
    /// The value may be as large as the limit: a torque, a speed, a temperature.
    AtMost,
    /// The value must be as large as the limit: a life, a safety factor.
    AtLeast,
}

/// A value beside its limit, both in the same unit.
///
/// The margin is by how much the limit is kept: limit/value of what may be at most the limit,
/// value/limit of what must be at least that. At 1 the limit is just reached, below 1 exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rating {
    /// What the duty asks, or what the part gives under it ([`Bound::AtLeast`]).
    pub value: f64,
    /// What the data sheet says.
    pub limit: f64,
    /// The unit of both; empty of a plain number.
    pub unit: &'static str,
    /// On which side of the limit the value must be.
    pub bound: Bound,
}

impl Rating {
    /// Of a value that may be at most the limit.
    pub fn at_most(value: f64, limit: f64, unit: &'static str) -> Self {
        let bound = Bound::AtMost;
        Self {
            value,
            limit,
            unit,
            bound,
        }
    }

    /// Of a value that must be at least the limit.
    pub fn at_least(value: f64, limit: f64, unit: &'static str) -> Self {
        let bound = Bound::AtLeast;
        Self {
            value,
            limit,
            unit,
            bound,
        }
    }

    /// By how much the limit is kept: 1 just, below 1 not. Infinite if nothing is asked.
    pub fn margin(&self) -> f64 {
        match self.bound {
            Bound::AtMost if self.value == 0.0 => f64::INFINITY,
            Bound::AtMost => self.limit / self.value,
            Bound::AtLeast if self.limit == 0.0 => f64::INFINITY,
            Bound::AtLeast => self.value / self.limit,
        }
    }

    /// Whether the limit is kept. A value that is no number keeps none.
    pub fn holds(&self) -> bool {
        match self.bound {
            Bound::AtMost => self.value <= self.limit,
            Bound::AtLeast => self.value >= self.limit,
        }
    }

    /// The one of two ratings with the smaller margin.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        // A margin that is no number is the worst.
        match other.margin().is_nan() || other.margin() < self.margin() {
            true => other,
            false => self,
        }
    }
}
