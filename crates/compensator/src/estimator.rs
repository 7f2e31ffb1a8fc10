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

use crate::error::{self, require};
use crate::{CompensatorError, Sample};

/// Gains of the [`MotionEstimator`].
///
/// The default takes the scale as it is (α = 1), follows the wind-up rate
/// within 20 cycles (β = 0.05) and averages the acceleration over 20 (γ = 0.05).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverGains {
    /// α: weight of the scale in the position, 0 < α ≤ 1. 1: no smoothing.
    pub position: f64,
    /// β: gain of the wind-up rate, 0 ≤ β < 4 − 2α (the stability limit).
    /// 0: v = r ω and nothing else.
    pub drift: f64,
    /// γ: weight of the newest speed difference in the acceleration, 0 < γ ≤ 1.
    pub acceleration: f64,
}

impl Default for ObserverGains {
    fn default() -> Self {
        Self {
            position: 1.0,
            drift: 0.05,
            acceleration: 0.05,
        }
    }
}

impl ObserverGains {
    /// Smoothing of the scale over `cycles`: both poles of the observer at
    /// exp(−1/cycles), α = 1 − q² and β = (1 − q)² (critically damped).
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] unless `cycles` is above zero and at most
    /// 1e6: with more, rounding would leave nothing of the gains.
    pub fn critically_damped(cycles: f64) -> Result<Self, CompensatorError> {
        let inside = cycles > 0.0 && cycles <= 1e6;
        let cycles = require(inside, "cycles", cycles, "above 0 and at most 1e6")?;
        let q = libm::exp(-1.0 / cycles);
        let gains = Self {
            position: 1.0 - q * q,
            drift: (1.0 - q) * (1.0 - q),
            ..Self::default()
        };
        gains.checked()
    }

    /// Standard deviations that white scale noise of unit standard deviation
    /// causes. Exact for the linear observer: second-order filters in white
    /// noise, solved in closed form; NaN for gains that are not valid.
    pub fn noise_gains(&self) -> NoiseGains {
        let (a, b) = (self.position, self.drift);
        let d = a * (4.0 - 2.0 * a - b);
        let position = (2.0 * a * a + 2.0 * b - 3.0 * a * b) / d;
        let prediction = (2.0 * a * a + a * b + 2.0 * b) / d;
        // S(k) itself enters the prediction with weight α + β.
        let loop_input = 1.0 + 2.0 * (a + b) + prediction;
        NoiseGains {
            position: libm::sqrt(position),
            speed_times_period: b * libm::sqrt(2.0 / d),
            predicted_error: libm::sqrt(prediction),
            loop_input: libm::sqrt(loop_input),
        }
    }

    fn checked(self) -> Result<Self, CompensatorError> {
        let (a, b, c) = (self.position, self.drift, self.acceleration);
        require(a > 0.0 && a <= 1.0, "position", a, "above 0 and at most 1")?;
        let stable = b >= 0.0 && b < 4.0 - 2.0 * a;
        require(stable, "drift", b, "at least 0 and below 4 - 2 position")?;
        require(
            c > 0.0 && c <= 1.0,
            "acceleration",
            c,
            "above 0 and at most 1",
        )?;
        Ok(self)
    }
}

/// What one unit (standard deviation) of white noise of the scale becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseGains {
    /// In the position estimate.
    pub position: f64,
    /// In the speed estimate, times the control period.
    pub speed_times_period: f64,
    /// In p + T v, and so in the predicted error Ê(k+1).
    pub predicted_error: f64,
    /// In the position loop's input S_ref − S + Ê, whose S is not smoothed
    /// (1 without compensation, 2 when Ê is the present error).
    pub loop_input: f64,
}

/// The controller's estimate of the table's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Position, m.
    pub position: f64,
    /// Speed, m/s.
    pub velocity: f64,
    /// Acceleration, m/s².
    pub acceleration: f64,
}

/// Observer of the table's position, speed and acceleration; see the file's
/// head for its equations, `docs/theory/compensator.md` for noise and lag.
#[derive(Clone, Copy, Debug)]
pub struct MotionEstimator {
    travel_per_radian: f64,
    period: f64,
    gains: ObserverGains,
    state: Option<State>,
}

#[derive(Clone, Copy, Debug)]
struct State {
    position: f64,
    wind_up_rate: f64,
    motor_side_speed: f64,
    velocity: f64,
    acceleration: f64,
}

impl MotionEstimator {
    /// `travel_per_radian` r = lead/2π (from 1e-9 to 1e3 m/rad), control
    /// `period` (from 1e-9 to 1e3 s), `gains`.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a value outside its range.
    pub fn new(
        travel_per_radian: f64,
        period: f64,
        gains: ObserverGains,
    ) -> Result<Self, CompensatorError> {
        Ok(Self {
            travel_per_radian: error::travel_per_radian(travel_per_radian)?,
            period: error::period(period)?,
            gains: gains.checked()?,
            state: None,
        })
    }

    /// Forgets everything; the next sample starts the observer there, with no
    /// wind-up rate and no acceleration.
    pub fn reset(&mut self) {
        self.state = None;
    }

    /// Takes in one cycle's sample (position and motor speed only). One that
    /// is not finite leaves estimates that are not, until the next reset.
    pub fn update(&mut self, sample: &Sample) -> Estimate {
        let motor_side_speed = self.travel_per_radian * sample.motor_speed;
        let state = match &self.state {
            None => State {
                position: sample.position,
                wind_up_rate: 0.0,
                motor_side_speed,
                velocity: motor_side_speed,
                acceleration: 0.0,
            },
            Some(last) => self.next(last, sample.position, motor_side_speed),
        };
        self.state = Some(state);
        Estimate {
            position: state.position,
            velocity: state.velocity,
            acceleration: state.acceleration,
        }
    }

    fn next(&self, last: &State, measured: f64, motor_side_speed: f64) -> State {
        let mean = 0.5 * (last.motor_side_speed + motor_side_speed);
        let predicted = last.position + self.period * (mean + last.wind_up_rate);
        let innovation = measured - predicted;
        let wind_up_rate = last.wind_up_rate + self.gains.drift / self.period * innovation;
        let velocity = motor_side_speed + wind_up_rate;
        let difference = (velocity - last.velocity) / self.period;
        State {
            // Written so that α = 1 gives the measurement to the last bit.
            position: measured - (1.0 - self.gains.position) * innovation,
            wind_up_rate,
            motor_side_speed,
            velocity,
            acceleration: last.acceleration
                + self.gains.acceleration * (difference - last.acceleration),
        }
    }
}
