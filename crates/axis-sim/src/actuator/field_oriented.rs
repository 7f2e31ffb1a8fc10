//! `pmsm-foc` and `linear-pmsm-foc`: a permanent-magnet synchronous motor whose
//! current is controlled in the rotor's frame.

use std::f64::consts::PI;
use std::sync::Arc;

use compensator::Drive;
use foc_pmsm::{
    Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState, MotorParameters, Phases,
    Pmsm, Servo, ServoGains, ServoLimits, ServoState,
};

use super::delay::DelayLine;
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
        weakening: weakening(v)?,
    }))
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

/// Refuses gains (V/A, V/(A·s)) with which a current loop is unstable.
///
/// A winding under a voltage that is held over the period T is the discrete lag
///
/// ```text
/// i' = a i + b u,   a = exp(−R T / L),   b = (1 − a) / R
/// ```
///
/// and with a PI controller, which integrates before it gives its output, a pole leaves the unit circle at
/// −1 where k_p + k_i T / 2 reaches (1 + a) / b; no other does earlier (Jury's conditions).
fn current_loop(
    key: &'static str,
    [proportional, integral]: [f64; 2],
    inductance: f64,
    resistance: f64,
    period: f64,
) -> Result<(), PartError> {
    let decay = resistance * period / inductance;
    let a = (-decay).exp();
    // (1 − a) / R, which is T / L without resistance.
    let b = match decay > 1e-9 {
        true => -(-decay).exp_m1() / resistance,
        false => period / inductance,
    };
    let most = (1.0 + a) / b - 0.5 * integral * period;
    if proportional < most {
        return Ok(());
    }
    let [gain, hertz, millihenry, most] =
        [proportional, 1.0 / period, 1e3 * inductance, most.max(0.0)].map(crate::SixDigits);
    Err(PartError::together(
        format!(
            "has a frequency of {hertz} Hz, at which {key} = {gain} V/A makes the current of a winding of {millihenry} mH unstable"
        ),
        format!("the frequency of the drive's current controller, or less than {most} V/A"),
    ))
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
        };
        (field_oriented, self.delay)
    }

    fn runs_at(&self, period: f64) -> Result<(), PartError> {
        let motor = self.motor.parameters();
        let g = &self.gains;
        current_loop(
            D_PROPORTIONAL.name,
            [g.d_p, g.d_i],
            motor.inductance_d,
            motor.resistance,
            period,
        )?;
        current_loop(
            Q_PROPORTIONAL.name,
            [g.q_p, g.q_i],
            motor.inductance_q,
            motor.resistance,
            period,
        )
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
    current: Dq,
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
        q
    }

    fn command(&mut self, effort: f64, measured: &Measured) {
        let mut reference = Dq {
            d: self.d_reference.id_ref,
            q: self.delay.push(effort),
        };
        if reference.d != 0.0 {
            // The length of the current stays within its limit.
            let most = self.servo.q_current_limit(reference.d);
            reference.q = reference.q.clamp(-most, most);
        }
        let error = reference - measured.current;
        let (voltage, d, q) = self.servo.current_loop(&mut self.state, error, Dq::ZERO);
        self.voltage = voltage;
        self.saturated = d || q;
        if let Some(law) = &self.weakening {
            law.update(&mut self.d_reference, voltage, self.law.limits.voltage);
        }
    }

    fn torque(&mut self, motor: &MotorMotion, h: f64) -> f64 {
        let law = &self.law;
        let voltage = self.voltage + self.lost_voltage(motor.angle);
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

#[cfg(test)]
mod tests {
    use super::current_loop;

    /// Whether a current that is 1 A off is less than that after 4000 periods.
    fn settles([p, i]: [f64; 2], inductance: f64, resistance: f64, period: f64) -> bool {
        let (mut current, mut integral) = (1.0_f64, 0.0);
        for _ in 0..4000 {
            integral -= i * period * current;
            let voltage = integral - p * current;
            // The winding, in steps that are short beside its time constant.
            let steps = 200;
            for _ in 0..steps {
                let h = period / f64::from(steps);
                let rate = |x: f64| (voltage - resistance * x) / inductance;
                current += h * rate(current + 0.5 * h * rate(current));
            }
        }
        current.abs() < 1.0
    }

    #[test]
    fn a_gain_is_refused_from_where_the_current_swings_up() {
        for (resistance, integral) in [(2.0, 10_000.0), (0.0, 0.0), (40.0, 0.0), (2.0, 60_000.0)] {
            let (inductance, period) = (0.018, 5e-4);
            let edge = {
                let is_refused = |p: f64| {
                    current_loop("p", [p, integral], inductance, resistance, period).is_err()
                };
                let (mut low, mut high) = (0.0, 1000.0);
                assert!(!is_refused(low) && is_refused(high));
                while high - low > 1e-3 {
                    let middle = 0.5 * (low + high);
                    *(if is_refused(middle) {
                        &mut high
                    } else {
                        &mut low
                    }) = middle;
                }
                low
            };
            let at = |share: f64| settles([share * edge, integral], inductance, resistance, period);
            assert!(at(0.99) && !at(1.01), "{edge} V/A");
        }
    }
}
