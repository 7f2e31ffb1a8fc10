//! `pmsm-foc` and `linear-pmsm-foc`: a permanent-magnet synchronous motor whose
//! current is controlled in the rotor's frame.
//!
//! The voltage that is made of a sample comes late: `current_delay_periods` from the sample to
//! the middle of the control period for which it is held, so 1.5 where it is computed in one
//! period and held by the inverter over the next, as in most drives (Bae and Sul, IEEE Trans.
//! Ind. Appl. 39 (2003) 802–810, doi:10.1109/TIA.2003.810660). A voltage that is held from its
//! sample on is 0.5 late, and 0 says just that: the delay of an ideal drive is the hold's.
//! While it is under way the rotor turns; the drive turns its voltage ahead by as much, as
//! drives do, so that it acts in the frame in which it was asked for.

use std::f64::consts::PI;
use std::sync::Arc;

use compensator::Drive;
use foc_pmsm::{
    Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState, MotorParameters, Phases,
    Pmsm, Servo, ServoGains, ServoLimits, ServoState,
};

use super::current_loop::CurrentLoop;
use super::delay::DelayLine;
use super::late_voltage::LateVoltage;
use super::{Actuating, Actuator, Effort, Electrical, MotorMotion, Surroundings};
use crate::cycle::Measured;
use crate::part::units::*;
use crate::part::{Key, Known, PartError, PartKind, Role, Values, count, number, quantity};

pub(super) static ROTARY: PartKind<dyn Actuator> = PartKind {
    name: "pmsm-foc",
    summary: "permanent-magnet motor under field-oriented current control",
    keys: &[
        count("pole_pairs", 1, 100),
        quantity("torque_constant", &TORQUE_CONSTANT, 1e-5, 1e4).role(Role::TorqueConstant),
        RESISTANCE_KEY,
        INDUCTANCE_D,
        INDUCTANCE_Q,
        DC_LINK,
        D_PROPORTIONAL,
        D_INTEGRAL,
        Q_PROPORTIONAL,
        Q_INTEGRAL,
        CURRENT_LIMIT,
        DEAD_TIME,
        DELAY,
        CURRENT_DELAY,
        WEAKENING_GAIN,
        WEAKENING_CURRENT,
        WEAKENING_SHARE,
    ],
    known: KNOWN,
    build: |v| {
        let pole_pairs = v.count("pole_pairs")?;
        build(v, pole_pairs, v.number("torque_constant")?, 1.0)
    },
};

pub(super) static LINEAR: PartKind<dyn Actuator> = PartKind {
    name: "linear-pmsm-foc",
    summary: "linear permanent-magnet motor under field-oriented current control",
    keys: &[
        quantity("pole_pitch", &LENGTH, 1e-4, 1.0),
        quantity("force_constant", &FORCE_CONSTANT, 1e-5, 1e6).role(Role::TorqueConstant),
        RESISTANCE_KEY,
        INDUCTANCE_D,
        INDUCTANCE_Q,
        DC_LINK,
        D_PROPORTIONAL,
        D_INTEGRAL,
        Q_PROPORTIONAL,
        Q_INTEGRAL,
        CURRENT_LIMIT,
        DEAD_TIME,
        DELAY,
        CURRENT_DELAY,
        WEAKENING_GAIN,
        WEAKENING_CURRENT,
        WEAKENING_SHARE,
    ],
    known: KNOWN,
    // One pole pair in π of the electrical angle, x π / pitch.
    build: |v| {
        let gear = PI / v.number("pole_pitch")?;
        build(v, 1, v.number("force_constant")? / gear, gear)
    },
};

const RESISTANCE_KEY: Key = quantity("resistance", &RESISTANCE, 0.0, 1e4).role(Role::Resistance);
const INDUCTANCE_D: Key = quantity("inductance_d", &INDUCTANCE, 1e-8, 100.0);
const INDUCTANCE_Q: Key = quantity("inductance_q", &INDUCTANCE, 1e-8, 100.0);
const DC_LINK: Key = quantity("dc_link", &VOLTAGE, 1.0, 1e5);
const D_PROPORTIONAL: Key = quantity("current_d_proportional", &CURRENT_PROPORTIONAL, 0.0, 1e6);
const D_INTEGRAL: Key = quantity("current_d_integral", &CURRENT_INTEGRAL, 0.0, 1e9);
const Q_PROPORTIONAL: Key = quantity("current_q_proportional", &CURRENT_PROPORTIONAL, 0.0, 1e6);
const Q_INTEGRAL: Key = quantity("current_q_integral", &CURRENT_INTEGRAL, 0.0, 1e9);
const CURRENT_LIMIT: Key = quantity("current_limit", &CURRENT, 1e-3, 1e5);
const DEAD_TIME: Key = quantity("dead_time_voltage", &VOLTAGE, -1e3, 1e3)
    .or(0.0)
    .role(Role::DeadTimeVoltage);
const DELAY: Key = quantity("command_delay", &TIME, 0.0, 0.1)
    .or(0.0)
    .role(Role::CommandDelay);

/// Half a control period: that for which a voltage is held, in its mean.
const HELD: f64 = 0.5;
/// Control periods that the sum of small delays is at least taken for: k_p = 0.4 L/T then, which a
/// winding of half the inductance still bears.
const SHORTEST: f64 = 1.25;
const CURRENT_DELAY: Key = number("current_delay_periods", 0.0, 8.0).or(1.5).counted();

/// Field weakening is on where its gain is given.
const WEAKENING_GAIN: Key =
    quantity("field_weakening_gain", &FIELD_WEAKENING, 1e-6, 1e6).optional();
const WEAKENING_CURRENT: Key = quantity("field_weakening_current", &CURRENT, 1e-3, 1e5).optional();
const WEAKENING_SHARE: Key = number("field_weakening_voltage_share", 0.1, 0.999).or(0.95);

const KNOWN: &[Known] = &[
    Known::by("torque_constant", |v, by| {
        v.scale("torque_constant", by);
        v.scale("force_constant", by);
    }),
    Known::key("resistance"),
    Known::key("inductance_d"),
    Known::key("inductance_q"),
];

#[derive(Clone, Copy, Debug)]
struct FieldOriented {
    motor: Pmsm,
    gains: ServoGains,
    limits: ServoLimits,
    /// K_t at i_d = 0, N·m/A (N/A).
    constant: f64,
    /// Radians of the electrical machine per radian (m) of the motor.
    gear: f64,
    dead_time_voltage: f64,
    delay: f64,
    /// Control periods from a sample until the voltage made of it begins to act.
    late: f64,
    /// Gain, greatest current and share of the voltage.
    weakening: Option<[f64; 3]>,
}

fn build(
    v: &Values,
    pole_pairs: u32,
    torque_constant: f64,
    gear: f64,
) -> Result<Arc<dyn Actuator>, PartError> {
    let motor = Pmsm::new(MotorParameters {
        pole_pairs,
        resistance: v.number("resistance")?,
        inductance_d: v.number("inductance_d")?,
        inductance_q: v.number("inductance_q")?,
        // K_t = 1.5 p ψ at i_d = 0.
        flux_linkage: torque_constant / (1.5 * f64::from(pole_pairs)),
    })
    .map_err(|e| PartError::together(e, "other motor parameters"))?;
    let gains = ServoGains {
        position: 0.0,
        speed_p: 0.0,
        speed_i: 0.0,
        d_p: v.number("current_d_proportional")?,
        d_i: v.number("current_d_integral")?,
        q_p: v.number("current_q_proportional")?,
        q_i: v.number("current_q_integral")?,
    };
    let limits = ServoLimits {
        current: v.number("current_limit")?,
        // The largest circle that SVPWM reaches linearly.
        voltage: v.number("dc_link")? / 3f64.sqrt(),
    };
    Ok(Arc::new(FieldOriented {
        motor,
        gains,
        limits,
        constant: gear * torque_constant,
        gear,
        dead_time_voltage: v.or("dead_time_voltage", 0.0),
        delay: v.or("command_delay", 0.0),
        late: late(v)?,
        weakening: weakening(v)?,
    }))
}

fn late(v: &Values) -> Result<f64, PartError> {
    let delay = v.or("current_delay_periods", 1.5);
    if delay > 0.0 && delay < HELD {
        return Err(PartError::of(
            "current_delay_periods",
            format!(
                "is {}, less than the half of a period by which a voltage that is held is late by itself",
                crate::SixDigits(delay)
            ),
            "0 (held from its sample on, the same as 0.5), or from 0.5 to 8; 1.5 in most drives",
        ));
    }
    Ok((delay - HELD).max(0.0))
}

fn weakening(v: &Values) -> Result<Option<[f64; 3]>, PartError> {
    let Some(gain) = v.optional("field_weakening_gain") else {
        return Ok(None);
    };
    let current = v.number("field_weakening_current")?;
    let limit = v.number("current_limit")?;
    if current >= limit {
        return Err(PartError::of(
            "field_weakening_current",
            format!("is {} A", crate::SixDigits(current)),
            format!("below the current limit of {} A", crate::SixDigits(limit)),
        ));
    }
    let share = v.or("field_weakening_voltage_share", 0.95);
    Ok(Some([gain, current, share]))
}

impl Actuator for FieldOriented {
    fn effort(&self) -> Effort {
        Effort::Current
    }

    fn limit(&self) -> f64 {
        self.limits.current
    }

    fn torque_constant(&self, _: f64) -> f64 {
        self.constant
    }

    fn has_currents(&self) -> bool {
        true
    }

    fn current_gain(&self) -> Option<f64> {
        Some(self.gains.d_p)
    }

    fn pole_pairs(&self) -> Option<f64> {
        Some(self.gear * f64::from(self.motor.parameters().pole_pairs))
    }

    fn inverse(&self, _: f64) -> (Drive, f64) {
        let field_oriented = Drive::FieldOriented {
            motor: self.motor,
            gear: self.gear,
            d: [self.gains.d_p, self.gains.d_i],
            q: [self.gains.q_p, self.gains.q_i],
            voltage: self.limits.voltage,
            late: self.late,
        };
        (field_oriented, self.delay)
    }

    /// k_p = L/(2 T_σ) and k_i = k_p R/L: the integral takes away the winding's own time, and the
    /// loop that is left is damped by 1/√2 (C. Kessler, "Über die Vorausberechnung optimal
    /// abgestimmter Regelkreise III", Regelungstechnik 3 (1955) 40–49). T_σ is the delay of the
    /// voltage with its hold, and at least [`SHORTEST`] periods, as no winding is known to better
    /// than that asks for.
    fn with_magnitude_optimum(&self, values: &Values, period: f64) -> Option<Values> {
        let motor = self.motor.parameters();
        let lag = (self.late + HELD).max(SHORTEST) * period;
        let mut values = values.clone();
        let axes = [
            (motor.inductance_d, D_PROPORTIONAL.name, D_INTEGRAL.name),
            (motor.inductance_q, Q_PROPORTIONAL.name, Q_INTEGRAL.name),
        ];
        for (inductance, proportional, integral) in axes {
            values.set(proportional, 0.5 * inductance / lag);
            values.set(integral, 0.5 * motor.resistance / lag);
        }
        Some(values)
    }

    fn runs_at(&self, period: f64) -> Result<(), PartError> {
        let motor = self.motor.parameters();
        let g = &self.gains;
        let at = |inductance| CurrentLoop {
            inductance,
            resistance: motor.resistance,
            period,
            late: self.late,
        };
        at(motor.inductance_d).check(D_PROPORTIONAL.name, [g.d_p, g.d_i])?;
        at(motor.inductance_q).check(Q_PROPORTIONAL.name, [g.q_p, g.q_i])
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Actuating>, PartError> {
        let servo = Servo::new(self.gains, self.limits, on.period)
            .map_err(|e| PartError::together(e, "other current controllers"))?;
        let weakening = |[ki, current, voltage_share]: [f64; 3]| {
            FieldWeakening::new(FieldWeakeningParameters {
                voltage_share,
                ki,
                current,
                period: on.period,
            })
            .map_err(|e| PartError::together(e, "another field weakening"))
        };
        Ok(Box::new(State {
            law: *self,
            weakening: self.weakening.map(weakening).transpose()?,
            d_reference: FieldWeakeningState::default(),
            servo,
            state: ServoState::default(),
            delay: DelayLine::new(self.delay / on.period),
            acting: LateVoltage::new(self.late, on.period),
            current: Dq::ZERO,
            voltage: Dq::ZERO,
            saturated: false,
        }))
    }
}

#[derive(Clone, Debug)]
struct State {
    law: FieldOriented,
    weakening: Option<FieldWeakening>,
    d_reference: FieldWeakeningState,
    servo: Servo,
    state: ServoState,
    delay: DelayLine,
    /// The voltage on its way to the winding.
    acting: LateVoltage,
    current: Dq,
    /// What was asked for last.
    voltage: Dq,
    saturated: bool,
}

impl Actuating for State {
    fn settle(&mut self, torque: f64, speed: f64) -> f64 {
        let motor = &self.law.motor;
        let q = motor.q_current(torque / self.law.gear);
        self.current = Dq { d: 0.0, q };
        self.voltage = motor.steady_voltage(self.current, self.law.gear * speed);
        self.state = ServoState::settled(q, self.voltage);
        self.delay.settle(q);
        self.acting.settle(self.voltage);
        q
    }

    fn available(&self) -> f64 {
        self.servo.q_current_limit(self.d_reference.id_ref)
    }

    fn command(&mut self, effort: f64, measured: &Measured) {
        // The length of the current stays within its limit.
        let most = self.available();
        let reference = Dq {
            d: self.d_reference.id_ref,
            q: self.delay.push(effort).clamp(-most, most),
        };
        let error = reference - measured.current;
        let (voltage, d, q) = self.servo.current_loop(&mut self.state, error, Dq::ZERO);
        self.voltage = voltage;
        self.acting.push(voltage);
        self.saturated = d || q;
        if let Some(law) = &self.weakening {
            law.update(&mut self.d_reference, voltage, self.law.limits.voltage);
        }
    }

    fn torque(&mut self, motor: &MotorMotion, h: f64) -> f64 {
        let law = &self.law;
        let voltage = self.acting.over(h) + self.lost_voltage(motor.angle);
        let speed = law.gear * motor.speed;
        self.current = law.motor.step(self.current, voltage, speed, h);
        law.gear * law.motor.torque(self.current)
    }

    fn electrical(&self) -> Electrical {
        Electrical {
            current: self.current,
            voltage: self.voltage,
            saturated: self.saturated,
        }
    }

    fn copy(&self) -> Box<dyn Actuating> {
        Box::new(self.clone())
    }
}

/// Half the current ripple below which dead time counts less, A.
const DEAD_TIME_CURRENT: f64 = 0.05;

impl State {
    /// What dead time takes from the voltage, in the rotor's frame: in each
    /// phase against its current, softened below [`DEAD_TIME_CURRENT`], where
    /// the current's ripple makes it cross zero in every period.
    fn lost_voltage(&self, motor_angle: f64) -> Dq {
        let lost = self.law.dead_time_voltage;
        if lost == 0.0 {
            return Dq::ZERO;
        }
        let at = self.law.motor.electrical_speed(self.law.gear * motor_angle);
        let phases = self.current.inverse_park(at).inverse_clarke();
        let soft = |i: f64| -lost * (i / DEAD_TIME_CURRENT).tanh();
        Phases {
            a: soft(phases.a),
            b: soft(phases.b),
            c: soft(phases.c),
        }
        .clarke()
        .park(at)
    }
}
