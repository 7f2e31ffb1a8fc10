//! Speed and acceleration of the table from what a controller samples.
//!
//! The motor encoder gives the speed u = r ω with little noise; the linear
//! scale gives the position S. Their difference, the rate w at which the
//! transmission winds up, is slow. An α–β observer with u as its known input
//! joins them, once a cycle of length T:
//!
//! ```text
//! p⁻ = p + T ((u₋₁ + u)/2 + w)     prediction (trapezoidal in u)
//! ν  = S − p⁻                      innovation
//! p  = p⁻ + α ν                    position
//! w  = w + (β/T) ν                 wind-up rate
//! v  = u + w                       speed
//! a  = a + γ ((v − v₋₁)/T − a)     acceleration
//! ```
//!
//! The poles of the observer are the roots of z² − (2 − α − β) z + (1 − α).

use axis_scalar::Scalar;

use crate::error::{self, require};
use crate::remainder::remainder;
use crate::{CompensatorError, Sample};

/// Gains of the [`MotionEstimator`].
///
/// The default takes the scale as it is (α = 1), follows the wind-up rate
/// within 20 cycles (β = 0.05) and averages the acceleration over 20 (γ = 0.05).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ObserverGains<T = f64> {
    /// α: weight of the scale in the position, 0 < α ≤ 1. 1: no smoothing.
    pub position: T,
    /// β: gain of the wind-up rate, 0 ≤ β < 4 − 2α (the stability limit).
    /// 0: v = r ω and nothing else.
    pub drift: T,
    /// γ: weight of the newest speed difference in the acceleration, 0 < γ ≤ 1.
    pub acceleration: T,
}

impl<T: Scalar> Default for ObserverGains<T> {
    fn default() -> Self {
        Self {
            position: T::ONE,
            drift: T::of(0.05),
            acceleration: T::of(0.05),
        }
    }
}

impl<T: Scalar> ObserverGains<T> {
    /// Smoothing of the scale over `cycles`: both poles of the observer at
    /// exp(−1/cycles), α = 1 − q² and β = (1 − q)² (critically damped). Rounding
    /// leaves the gains good to about `cycles` ε: for more than some hundred
    /// cycles make them in `f64` and [`cast`](Self::cast) them.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] unless `cycles` is above zero and at most
    /// 1e6: with more, rounding would leave nothing of the gains.
    pub fn critically_damped(cycles: T) -> Result<Self, CompensatorError> {
        let inside = cycles > T::ZERO && cycles <= T::of(1e6);
        let cycles = require(inside, "cycles", cycles, "above 0 and at most 1e6")?;
        let q = (-T::ONE / cycles).exp();
        let gains = Self {
            position: T::ONE - q * q,
            drift: (T::ONE - q) * (T::ONE - q),
            ..Self::default()
        };
        gains.checked()
    }

    /// Standard deviations that white scale noise of unit standard deviation
    /// causes. Exact for the linear observer: second-order filters in white
    /// noise, solved in closed form; NaN for gains that are not valid.
    pub fn noise_gains(&self) -> NoiseGains<T> {
        let (a, b) = (self.position, self.drift);
        let (two, three) = (T::TWO, T::of(3.0));
        let d = a * (T::of(4.0) - two * a - b);
        let position = (two * a * a + two * b - three * a * b) / d;
        let prediction = (two * a * a + a * b + two * b) / d;
        // S(k) itself enters the prediction with weight α + β.
        let loop_input = T::ONE + two * (a + b) + prediction;
        NoiseGains {
            position: position.sqrt(),
            speed_times_period: b * (two / d).sqrt(),
            predicted_error: prediction.sqrt(),
            loop_input: loop_input.sqrt(),
        }
    }

    /// Each gain rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> ObserverGains<U> {
        ObserverGains {
            position: U::of(self.position.to_f64()),
            drift: U::of(self.drift.to_f64()),
            acceleration: U::of(self.acceleration.to_f64()),
        }
    }

    fn checked(self) -> Result<Self, CompensatorError> {
        let (a, b, c) = (self.position, self.drift, self.acceleration);
        require(
            a > T::ZERO && a <= T::ONE,
            "position",
            a,
            "above 0 and at most 1",
        )?;
        let stable = b >= T::ZERO && b < T::of(4.0) - T::TWO * a;
        require(stable, "drift", b, "at least 0 and below 4 - 2 position")?;
        require(
            c > T::ZERO && c <= T::ONE,
            "acceleration",
            c,
            "above 0 and at most 1",
        )?;
        Ok(self)
    }
}

/// What one unit (standard deviation) of white noise of the scale becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct NoiseGains<T = f64> {
    /// In the position estimate.
    pub position: T,
    /// In the speed estimate, times the control period.
    pub speed_times_period: T,
    /// In p + T v, and so in the predicted error Ê(k+1).
    pub predicted_error: T,
    /// In the position loop's input S_ref − S + Ê, whose S is not smoothed
    /// (1 without compensation, 2 when Ê is the present error).
    pub loop_input: T,
}

/// The controller's estimate of the table's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionEstimate<T = f64> {
    /// Position, m.
    pub position: T,
    /// Speed, m/s.
    pub velocity: T,
    /// Acceleration, m/s².
    pub acceleration: T,
}

/// Observer of the table's position, speed and acceleration; see the file's
/// head for its equations, `docs/theory/compensator.md` for noise and lag.
#[derive(Clone, Copy, Debug)]
pub struct MotionEstimator<T = f64> {
    travel_per_radian: T,
    period: T,
    gains: ObserverGains<T>,
    state: Option<State<T>>,
}

#[derive(Clone, Copy, Debug)]
struct State<T> {
    position: T,
    wind_up_rate: T,
    motor_side_speed: T,
    velocity: T,
    acceleration: T,
}

impl<T: Scalar> MotionEstimator<T> {
    /// `travel_per_radian` r = lead/2π (from 1e-9 to 1e3 m/rad), control
    /// `period` (from 1e-9 to 1e3 s), `gains`.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a value outside its range.
    pub fn new(
        travel_per_radian: T,
        period: T,
        gains: ObserverGains<T>,
    ) -> Result<Self, CompensatorError> {
        Ok(Self {
            travel_per_radian: error::travel_per_radian(travel_per_radian)?,
            period: error::period(period)?,
            gains: gains.checked()?,
            state: None,
        })
    }

    /// r, travel per radian, m/rad.
    pub fn travel_per_radian(&self) -> T {
        self.travel_per_radian
    }

    /// Control period, s.
    pub fn period(&self) -> T {
        self.period
    }

    /// Its gains.
    pub fn gains(&self) -> &ObserverGains<T> {
        &self.gains
    }

    /// The same before its first sample, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] if one leaves its range by that.
    pub fn cast<U: Scalar>(&self) -> Result<MotionEstimator<U>, CompensatorError> {
        let cast = |value: T| U::of(value.to_f64());
        let (travel, period) = (cast(self.travel_per_radian), cast(self.period));
        MotionEstimator::new(travel, period, self.gains.cast())
    }

    /// Forgets everything; the next sample starts the observer there, with no
    /// wind-up rate and no acceleration.
    pub fn reset(&mut self) {
        self.state = None;
    }

    /// Takes in one cycle's sample (position and motor speed only). One that
    /// is not finite leaves estimates that are not, until the next reset.
    pub fn update(&mut self, sample: &Sample<T>) -> MotionEstimate<T> {
        let motor_side_speed = self.travel_per_radian * sample.motor_speed;
        let state = match &self.state {
            None => State {
                position: sample.position,
                wind_up_rate: T::ZERO,
                motor_side_speed,
                velocity: motor_side_speed,
                acceleration: T::ZERO,
            },
            Some(last) => self.next(last, sample.position, motor_side_speed),
        };
        self.state = Some(state);
        MotionEstimate {
            position: state.position,
            velocity: state.velocity,
            acceleration: state.acceleration,
        }
    }

    fn next(&self, last: &State<T>, measured: T, motor_side_speed: T) -> State<T> {
        let mean = T::HALF * (last.motor_side_speed + motor_side_speed);
        let way = self.period * (mean + last.wind_up_rate);
        let innovation = remainder(measured, last.position, way);
        let wind_up_rate = last.wind_up_rate + self.gains.drift / self.period * innovation;
        let velocity = motor_side_speed + wind_up_rate;
        let difference = (velocity - last.velocity) / self.period;
        State {
            // Written so that α = 1 gives the measurement to the last bit.
            position: measured - (T::ONE - self.gains.position) * innovation,
            wind_up_rate,
            motor_side_speed,
            velocity,
            acceleration: last.acceleration
                + self.gains.acceleration * (difference - last.acceleration),
        }
    }
}
