//! A coordinate over a step with average acceleration.

/// Value, rate and acceleration of a coordinate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Course {
    pub value: f64,
    pub rate: f64,
    pub acceleration: f64,
}

impl Course {
    /// The end of a step of `h` seconds with the acceleration of its start.
    #[inline]
    pub fn predicted(self, h: f64) -> Self {
        let moved = Self {
            value: self.value + h * self.rate,
            ..self
        };
        moved.accelerated(h, self.acceleration)
    }

    /// With what an acceleration at one end of a step of `h` seconds adds.
    #[inline]
    pub fn accelerated(self, h: f64, acceleration: f64) -> Self {
        self.pushed(0.25 * h * h * acceleration, 0.5 * h * acceleration)
    }

    /// Further by `value` and faster by `rate`.
    #[inline]
    pub fn pushed(self, value: f64, rate: f64) -> Self {
        Self {
            value: self.value + value,
            rate: self.rate + rate,
            ..self
        }
    }
}
