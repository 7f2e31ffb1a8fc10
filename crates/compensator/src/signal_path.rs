//! What a drive has between a correction and its command: rates of its loops, and filters.

use axis_scalar::Scalar;

/// A filter of a drive in discrete time,
/// y(k) = b₀ u(k) + b₁ u(k−1) + b₂ u(k−2) − a₁ y(k−1) − a₂ y(k−2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveFilter<T = f64> {
    /// b₀, b₁, b₂.
    pub b: [T; 3],
    /// a₁, a₂.
    pub a: [T; 2],
}

impl<T: Scalar> DriveFilter<T> {
    /// The next sample through the filter, in direct form II transposed; `memory` is what it keeps from
    /// one sample to the next, zeros at standstill.
    pub fn step(&self, memory: &mut [T; 2], input: T) -> T {
        let output = self.b[0] * input + memory[0];
        memory[0] = self.b[1] * input - self.a[0] * output + memory[1];
        memory[1] = self.b[2] * input - self.a[1] * output;
        output
    }
}

/// Rates and filters of a drive's own loops. None by default: each loop runs once in a control
/// period, and reads what the correction was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalPath<T = f64> {
    /// Control periods from one execution of the position controller to the next.
    pub position_every: u32,
    /// The same of the speed controller, with its filters.
    pub speed_every: u32,
    /// Filter of the motor's speed on its way into the speed controller.
    pub speed: Option<DriveFilter<T>>,
    /// Whether the speed controller has the load's mean speed over the last two periods, from
    /// its measured position, instead of [`crate::Sample::motor_speed`].
    pub speed_of_position: bool,
    /// Filters of the command, behind the speed controller and before the limit, in order.
    pub command: [Option<DriveFilter<T>>; 2],
    /// Whether the position controller goes by another position than
    /// [`crate::Sample::position`]: the motor's beside a sensor at the load, or both blended.
    pub other_position: bool,
    /// Where that is both blended: the low pass of the load's position less the motor's, run with
    /// the position controller, that is added to the motor's.
    pub blend: Option<DriveFilter<T>>,
}

impl<T> Default for SignalPath<T> {
    fn default() -> Self {
        Self {
            position_every: 1,
            speed_every: 1,
            speed: None,
            speed_of_position: false,
            command: [None, None],
            other_position: false,
            blend: None,
        }
    }
}

impl<T: Scalar> SignalPath<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> SignalPath<U> {
        let to = |value: T| U::of(value.to_f64());
        let filter = |f: DriveFilter<T>| DriveFilter {
            b: f.b.map(to),
            a: f.a.map(to),
        };
        SignalPath {
            position_every: self.position_every,
            speed_every: self.speed_every,
            speed: self.speed.map(filter),
            speed_of_position: self.speed_of_position,
            command: self.command.map(|f| f.map(filter)),
            other_position: self.other_position,
            blend: self.blend.map(filter),
        }
    }
}
