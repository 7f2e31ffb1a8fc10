//! Means over a duty: root mean square, and the mean load by which a life is computed.

/// Root mean square over time, from stretches of constant value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RootMeanSquare {
    square_seconds: f64,
    duration_s: f64,
}

impl RootMeanSquare {
    /// Adds a stretch of `duration_s` seconds.
    pub fn push(&mut self, duration_s: f64, value: f64) {
        self.square_seconds += duration_s * value * value;
        self.duration_s += duration_s;
    }

    /// The root mean square; 0 before anything was added.
    pub fn value(&self) -> f64 {
        match self.duration_s > 0.0 {
            true => (self.square_seconds / self.duration_s).sqrt(),
            false => 0.0,
        }
    }
}

/// Mean load over travel, the constant load under which a rolling contact lives as long:
///
/// ```text
/// P_m = (Σ P_i^p u_i / Σ u_i)^(1/p)
/// ```
///
/// with u_i the travel (revolutions, m) under P_i and p the exponent of the life. The formula is that of
/// ISO 281 and ISO 3408-5 (source not read in the standards; Steinmeyer's service life pages describe it with
/// u_i = n_i q_i, speed times share of time).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanLoad {
    exponent: f64,
    sum: f64,
    travel: f64,
    /// Loads are summed as multiples of the greatest so far, so that no power overflows.
    greatest: f64,
}

impl MeanLoad {
    /// For a life of exponent p: 3 for balls, 10/3 for rollers ([`crate::RollingElement::exponent`]).
    pub fn new(exponent: f64) -> Self {
        Self {
            exponent,
            sum: 0.0,
            travel: 0.0,
            greatest: 0.0,
        }
    }

    /// Adds a stretch of `travel` (revolutions, m) under `load_n`; both without their signs.
    pub fn push(&mut self, travel: f64, load_n: f64) {
        let (travel, load) = (travel.abs(), load_n.abs());
        if load > self.greatest {
            self.sum *= (self.greatest / load).powf(self.exponent);
            self.greatest = load;
        }
        if self.greatest > 0.0 {
            self.sum += travel * (load / self.greatest).powf(self.exponent);
        }
        self.travel += travel;
    }

    /// The mean load, N; 0 without travel.
    pub fn load_n(&self) -> f64 {
        match self.travel > 0.0 {
            true => self.greatest * (self.sum / self.travel).powf(self.exponent.recip()),
            false => 0.0,
        }
    }

    /// Whole travel, in the unit in which it was added.
    pub fn travel(&self) -> f64 {
        self.travel
    }
}
