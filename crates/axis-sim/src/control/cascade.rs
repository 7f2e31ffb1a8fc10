//! `p-pi`: the cascade of drives, a proportional position controller over a
//! proportional-integral speed controller, each at its own rate.
//!
//! ```text
//! ω_ref  = P (S_ref − S + Δ) + f_v v_ref / r                 P = Kv / r
//! u      = PI(ω_ref − ω_m) + f_a a_ref + u_added             filtered, limited, anti-windup
//! ```
//!
//! S is the load's position, the motor's, or both blended: slow from the load, fast from
//! the motor. The speed passes a low pass on its way in, the command a low pass and a notch
//! on its way out, where the file has them. The limit comes behind these, and the integral
//! waits while it would press on against it.

use std::sync::Arc;

use compensator::SignalPath;
use foc_pmsm::{Pi, PiParameters, PiState};

use super::filter::Filter;
use super::output::Output;
use super::{CascadeGains, Control, Controller, Demand, Situation};
use crate::SixDigits;
use crate::actuator::{Effort, Surroundings};
use crate::cycle::Measured;
use crate::part::units::{
    ACCELERATION_FEEDFORWARD, FREQUENCY, POSITION_GAIN, SPEED_INTEGRAL, SPEED_PROPORTIONAL, TIME,
    VELOCITY_GAIN,
};
use crate::part::{Known, PartError, PartKind, Role, Values, number, quantity, word};

/// Damping of a notch's denominator, if a file does not state it.
pub const NOTCH_DAMPING: f64 = 0.3;
/// Share that a notch leaves at its middle, if a file does not state it.
pub const NOTCH_DEPTH: f64 = 0.1;

pub(super) static KIND: PartKind<dyn Control> = PartKind {
    name: "p-pi",
    summary: "cascade of a P position and a PI speed controller, feed-forward, filters",
    keys: &[
        quantity("position_gain", &POSITION_GAIN, 0.0, 1e9)
            .optional()
            .role(Role::PositionGain),
        quantity("kv", &VELOCITY_GAIN, 0.0, 1e6)
            .optional()
            .role(Role::PositionGain),
        number("velocity_feedforward", -10.0, 10.0).role(Role::VelocityFeedforward),
        quantity(
            "acceleration_feedforward",
            &ACCELERATION_FEEDFORWARD,
            0.0,
            1e9,
        )
        .optional(),
        quantity("speed_proportional", &SPEED_PROPORTIONAL, 0.0, 1e9).role(Role::SpeedGain),
        quantity("speed_integral", &SPEED_INTEGRAL, 0.0, 1e12)
            .optional()
            .role(Role::SpeedGain),
        quantity("speed_integral_time", &TIME, 1e-6, 1e3).optional(),
        word("feedback", &["load", "motor", "blend"]).optional(),
        quantity("blend", &FREQUENCY, 1e-3, 1e5).optional(),
        quantity("speed_rate", &FREQUENCY, 1.0, 1e6).optional(),
        quantity("position_rate", &FREQUENCY, 1.0, 1e6).optional(),
        quantity("speed_lowpass", &FREQUENCY, 1e-3, 1e6).optional(),
        quantity("command_lowpass", &FREQUENCY, 1e-3, 1e6).optional(),
        quantity("notch", &FREQUENCY, 1e-3, 1e6).optional(),
        number("notch_damping", 1e-3, 10.0).optional(),
        number("notch_depth", 0.0, 1.0).optional(),
    ],
    known: &[
        Known::exact("position_gain"),
        Known::exact("kv"),
        Known::exact("velocity_feedforward"),
        Known::exact("speed_proportional"),
        Known::exact("speed_integral"),
        Known::exact("speed_integral_time"),
    ],
    build,
};

#[derive(Clone, Copy, Debug)]
enum PositionGain {
    /// Motor speed per position error, (rad/s)/m.
    AtMotor(f64),
    /// Kv, 1/s.
    AtLoad(f64),
}

#[derive(Clone, Copy, Debug)]
enum Feedback {
    Load,
    Motor,
    /// Load below this frequency (Hz), motor above.
    Blend(f64),
}

#[derive(Clone, Copy, Debug)]
struct Cascade {
    position: PositionGain,
    velocity_feedforward: f64,
    /// Effort per acceleration of the load.
    acceleration_feedforward: f64,
    speed: [f64; 2],
    feedback: Feedback,
    /// Hz; the control's own if there is none.
    speed_rate: Option<f64>,
    position_rate: Option<f64>,
    speed_lowpass: Option<f64>,
    command_lowpass: Option<f64>,
    /// Frequency (Hz), damping, depth.
    notch: Option<[f64; 3]>,
    effort: Option<Effort>,
}

fn build(v: &Values) -> Result<Arc<dyn Control>, PartError> {
    let position = match (v.optional("position_gain"), v.optional("kv")) {
        (Some(gain), None) => PositionGain::AtMotor(gain),
        (None, Some(kv)) => PositionGain::AtLoad(kv),
        (None, None) => {
            return Err(PartError::of(
                "position_gain",
                "is missing",
                "one of position_gain_rpm_per_mm, position_gain_rad_per_s_per_m, kv_per_s, kv_m_per_min_per_mm",
            ));
        }
        (Some(_), Some(_)) => {
            return Err(PartError::of(
                "kv",
                "states the position controller's gain a second time",
                "one of position_gain and kv",
            ));
        }
    };
    let proportional = v.number("speed_proportional")?;
    let integral = match (
        v.optional("speed_integral"),
        v.optional("speed_integral_time"),
    ) {
        (Some(_), Some(_)) => {
            return Err(PartError::of(
                "speed_integral_time",
                "states the integral gain a second time",
                "one of speed_integral and speed_integral_time",
            ));
        }
        (Some(integral), None) => integral,
        (None, Some(time)) => proportional / time,
        (None, None) => 0.0,
    };
    let feedback = match v.word("feedback") {
        Some("motor") => Feedback::Motor,
        Some("blend") => Feedback::Blend(v.optional("blend").ok_or_else(|| {
            let valid = "the frequency above which the motor counts, such as blend_hz = 10";
            PartError::of("blend", "is missing", valid)
        })?),
        _ => Feedback::Load,
    };
    let notch = v.optional("notch");
    Ok(Arc::new(Cascade {
        position,
        velocity_feedforward: v.number("velocity_feedforward")?,
        acceleration_feedforward: v.or("acceleration_feedforward", 0.0),
        speed: [proportional, integral],
        feedback,
        speed_rate: v.optional("speed_rate"),
        position_rate: v.optional("position_rate"),
        speed_lowpass: v.optional("speed_lowpass"),
        command_lowpass: v.optional("command_lowpass"),
        notch: notch.map(|f| {
            [
                f,
                v.or("notch_damping", NOTCH_DAMPING),
                v.or("notch_depth", NOTCH_DEPTH),
            ]
        }),
        effort: Effort::of_gain(v.unit("speed_proportional")),
    }))
}

impl Control for Cascade {
    fn velocity_gain(&self, travel: f64) -> Option<f64> {
        Some(match self.position {
            PositionGain::AtMotor(gain) => gain * travel,
            PositionGain::AtLoad(kv) => kv,
        })
    }

    fn integrates(&self) -> bool {
        self.speed[1] > 0.0
    }

    fn speed_gain(&self) -> Option<f64> {
        Some(self.speed[0])
    }

    fn speed_every(&self, period: f64) -> u32 {
        // What is no divisor is refused at the start.
        every("speed_rate", self.speed_rate, period).unwrap_or(1)
    }

    fn ticks(&self, period: f64) -> u32 {
        let position = every("position_rate", self.position_rate, period).unwrap_or(1);
        let speed = self.speed_every(period);
        let least = (1..=speed).find(|by| (position * by).is_multiple_of(speed));
        position * least.unwrap_or(1)
    }

    fn cascade(&self, travel: f64, period: f64) -> Option<compensator::Cascade> {
        Some(compensator::Cascade {
            position: self.velocity_gain(travel)? / travel,
            velocity_feedforward: self.velocity_feedforward,
            acceleration_feedforward: self.acceleration_feedforward,
            speed: self.speed[0],
            speed_integral: self.speed[1],
            from_motor: matches!(self.feedback, Feedback::Motor),
            signal_path: self.signal_path(period),
        })
    }

    fn retuned(&self, values: &Values, gains: &CascadeGains, travel: f64) -> Option<Values> {
        let mut values = values.clone();
        match self.position {
            PositionGain::AtMotor(_) => values.set("position_gain", gains.position / travel),
            PositionGain::AtLoad(_) => values.set("kv", gains.position),
        }
        values.set("speed_proportional", gains.speed);
        match (values.optional("speed_integral_time"), gains.speed_integral) {
            (Some(_), integral) if integral > 0.0 => {
                values.set("speed_integral_time", gains.speed / integral);
            }
            (_, integral) => values.set("speed_integral", integral),
        }
        if let Some(fed) = gains.acceleration_feedforward {
            values.set("acceleration_feedforward", fed);
        }
        if let Some([frequency, damping, depth]) = gains.notch {
            values.set("notch", frequency);
            values.set("notch_damping", damping);
            values.set("notch_depth", depth);
        }
        Some(values)
    }

    fn effort(&self) -> Option<Effort> {
        self.effort
    }

    fn at_motor(&self) -> &'static [&'static str] {
        &["speed_proportional", "speed_integral"]
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Controller>, PartError> {
        let speed_every = every("speed_rate", self.speed_rate, on.period)?;
        let position_every = every("position_rate", self.position_rate, on.period)?;
        let speed_period = on.period * f64::from(speed_every);
        let pi = Pi::new(PiParameters {
            kp: self.speed[0],
            ki: self.speed[1],
            // Behind the filters.
            limit: f64::INFINITY,
            period: speed_period,
        })
        .map_err(|e| PartError::together(e, "other control parameters"))?;
        let [speed_filter, command_filter, notch] = self.filters(speed_period)?;
        let blend = self.blend(on.period * f64::from(position_every))?;
        Ok(Box::new(State {
            position_gain: match self.position {
                PositionGain::AtMotor(gain) => gain,
                PositionGain::AtLoad(kv) => kv / on.travel_per_radian,
            },
            speed_feedforward: self.velocity_feedforward / on.travel_per_radian,
            acceleration_feedforward: self.acceleration_feedforward,
            travel: on.travel_per_radian,
            home: 0.0,
            from_motor: matches!(self.feedback, Feedback::Motor),
            blend,
            speed_every,
            position_every,
            pi,
            speed_filter,
            output: Output {
                filters: [command_filter, notch],
            },
            integral: PiState::default(),
            cycle: 0,
            demand: Demand::default(),
        }))
    }
}

impl Cascade {
    /// Low pass of the speed, low pass and notch of the command, for a speed loop with that
    /// period, s.
    fn filters(&self, period: f64) -> Result<[Option<Filter>; 3], PartError> {
        let low_pass = |at: Option<f64>| at.map(|f| Filter::low_pass(f, period)).transpose();
        let notch = |[f, damping, depth]: [f64; 3]| Filter::notch(f, damping, depth, period);
        Ok([
            low_pass(self.speed_lowpass)?,
            low_pass(self.command_lowpass)?,
            self.notch.map(notch).transpose()?,
        ])
    }

    /// The low pass of the load's position less the motor's, for a position loop with that
    /// period, s; none where only one of both counts.
    fn blend(&self, period: f64) -> Result<Option<Filter>, PartError> {
        match self.feedback {
            Feedback::Blend(frequency) => Filter::low_pass(frequency, period).map(Some),
            _ => Ok(None),
        }
    }

    /// What lies between a correction and the command. Rates and filters that the period
    /// does not go with are refused at the start.
    fn signal_path(&self, period: f64) -> SignalPath {
        let speed_every = self.speed_every(period);
        let filters = self.filters(period * f64::from(speed_every));
        let [speed, low_pass, notch] = filters.unwrap_or_default();
        let law = |filter: Option<Filter>| filter.map(|filter| filter.law());
        let position_every = every("position_rate", self.position_rate, period).unwrap_or(1);
        let blend = self.blend(period * f64::from(position_every));
        SignalPath {
            position_every,
            speed_every,
            speed: law(speed),
            command: [law(low_pass), law(notch)],
            other_position: matches!(self.feedback, Feedback::Blend(_)),
            blend: law(blend.unwrap_or_default()),
            ..SignalPath::default()
        }
    }
}

/// Control cycles from one execution of a loop to the next.
fn every(key: &'static str, rate: Option<f64>, period: f64) -> Result<u32, PartError> {
    let Some(rate) = rate else {
        return Ok(1);
    };
    let cycles = 1.0 / (rate * period);
    let whole = cycles.round();
    if (1.0..=1e6).contains(&whole) && (cycles - whole).abs() <= 1e-6 * whole {
        return Ok(whole as u32);
    }
    let own = SixDigits(1.0 / period);
    Err(PartError::of(
        key,
        format!("is {} Hz", SixDigits(rate)),
        format!("the control frequency of {own} Hz, or that divided by a whole number"),
    ))
}

#[derive(Clone, Debug)]
struct State {
    /// (rad/s)/m.
    position_gain: f64,
    /// (rad/s)/(m/s).
    speed_feedforward: f64,
    acceleration_feedforward: f64,
    travel: f64,
    /// Position where the motor's angle would be 0, as it was homed at the start.
    home: f64,
    from_motor: bool,
    blend: Option<Filter>,
    speed_every: u32,
    position_every: u32,
    pi: Pi,
    speed_filter: Option<Filter>,
    output: Output,
    integral: PiState,
    /// Control cycles so far, up to the least common multiple of the two rates.
    cycle: u64,
    demand: Demand,
}

impl State {
    /// The position that the position controller goes by.
    fn position(&mut self, measured: &Measured) -> f64 {
        let motor = self.home + self.travel * measured.motor_angle;
        if self.from_motor {
            return motor;
        }
        match &mut self.blend {
            None => measured.position,
            Some(filter) => motor + filter.pass(measured.position - motor),
        }
    }
}

impl Controller for State {
    fn settle(&mut self, effort: f64, measured: &Measured, speed: f64) {
        self.integral = PiState { integral: effort };
        self.home = measured.position - self.travel * measured.motor_angle;
        let speed = speed / self.travel;
        self.output.settle(effort);
        let filters = [(&mut self.blend, 0.0), (&mut self.speed_filter, speed)];
        for (filter, value) in filters {
            if let Some(filter) = filter {
                filter.settle(value);
            }
        }
        self.demand = Demand {
            effort,
            ..Demand::default()
        };
    }

    fn begin_after(&mut self, cycles: u32) {
        self.cycle = u64::from(cycles);
    }

    fn cycle(&mut self, s: &Situation<'_>) -> Demand {
        let cycle = self.cycle;
        self.cycle += 1;
        if cycle.is_multiple_of(u64::from(self.position_every)) {
            let error = s.reference.position - self.position(s.measured) + s.correction.position;
            let fed = self.speed_feedforward * s.reference.velocity;
            self.demand.speed_ref = self.position_gain * error + fed;
        }
        if cycle.is_multiple_of(u64::from(self.speed_every)) {
            let mut speed = s.measured.motor_speed;
            if let Some(filter) = &mut self.speed_filter {
                speed = filter.pass(speed);
            }
            let mut fed = s.correction.command;
            if self.acceleration_feedforward != 0.0 {
                fed += self.acceleration_feedforward * s.reference.acceleration;
            }
            let error = self.demand.speed_ref - speed;
            let before = self.integral;
            let integral = &mut self.integral;
            let out = self
                .pi
                .update_with_feed_forward(integral, error, fed, f64::INFINITY);
            let limited = self.output.pass(out.value, s.limit);
            if limited.presses(error) {
                self.integral = before;
            }
            self.demand.effort = limited.effort;
            self.demand.saturated = limited.saturated;
        }
        self.demand
    }

    fn copy(&self) -> Box<dyn Controller> {
        Box::new(self.clone())
    }
}
