//! Intervals of values.

/// A closed interval, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Lower end.
    pub least: f64,
    /// Upper end.
    pub most: f64,
}

impl ValueRange {
    /// Whether `value` lies inside.
    pub fn contains(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}
