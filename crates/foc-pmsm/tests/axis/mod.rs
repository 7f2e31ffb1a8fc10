//! The drive of Liu et al. 2025 (doi 10.3390/machines13050433, Tables 2, 4
//! and 5), in SI units: rpm and mm converted; and drives drawn at random.
#![allow(dead_code)] // each test file uses its own part

pub mod cast;
pub mod rigid;

use foc_pmsm::{Dq, MotorParameters, Pmsm, Servo, ServoGains, ServoLimits};
use proptest::prelude::*;

pub const TORQUE_CONSTANT: f64 = 1.641;
pub const DC_VOLTAGE: f64 = 540.0;
pub const PERIOD: f64 = 1e-4;
/// 1 rpm in rad/s.
pub const RPM: f64 = core::f64::consts::PI / 30.0;
/// Rated speed, 2000 rpm.
pub const RATED_SPEED: f64 = 2000.0 * RPM;

pub fn motor() -> Pmsm {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: 0.75,
        inductance_d: 4.11e-3,
        inductance_q: 13.2e-3,
        flux_linkage: 0.0,
    };
    Pmsm::new(parameters.from_torque_constant(TORQUE_CONSTANT)).unwrap()
}

pub fn gains() -> ServoGains {
    ServoGains {
        position: 280.2 * RPM / 1e-3,
        speed_p: 0.0678 / RPM,
        speed_i: 0.7122 / RPM,
        d_p: 2.776,
        d_i: 626.2,
        q_p: 8.805,
        q_i: 1003.3,
    }
}

pub fn limits() -> ServoLimits {
    ServoLimits {
        current: 15.0,
        voltage: DC_VOLTAGE / 3f64.sqrt(),
    }
}

pub fn servo() -> Servo {
    Servo::new(gains(), limits(), PERIOD).unwrap()
}

/// Equal chances for equal ratios.
pub fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

/// Motors from hobby servos to mill drives, salient either way.
pub fn drawn_motor() -> impl Strategy<Value = Pmsm> {
    (
        1u32..=24,
        log_uniform(5e-3, 50.0),
        log_uniform(2e-5, 0.1),
        log_uniform(0.2, 5.0),
        log_uniform(1e-3, 2.0),
    )
        .prop_map(
            |(pole_pairs, resistance, inductance_d, saliency, flux_linkage)| {
                Pmsm::new(MotorParameters {
                    pole_pairs,
                    resistance,
                    inductance_d,
                    inductance_q: saliency * inductance_d,
                    flux_linkage,
                })
                .unwrap()
            },
        )
}

/// DC links from a battery to a medium-voltage drive, V.
pub fn drawn_dc_voltage() -> impl Strategy<Value = f64> {
    log_uniform(12.0, 3000.0)
}

/// PWM periods from 100 kHz to 500 Hz, s.
pub fn drawn_period() -> impl Strategy<Value = f64> {
    log_uniform(1e-5, 2e-3)
}

/// Any gains at all, stable or not, each possibly 0.
pub fn drawn_gains() -> impl Strategy<Value = ServoGains> {
    let gain = |low, high| prop_oneof![9 => log_uniform(low, high), 1 => Just(0.0)];
    (
        gain(1.0, 1e6),
        gain(1e-4, 1e2),
        gain(1e-3, 1e4),
        gain(1e-2, 1e3),
        gain(1.0, 1e6),
        gain(1e-2, 1e3),
        gain(1.0, 1e6),
    )
        .prop_map(
            |(position, speed_p, speed_i, d_p, d_i, q_p, q_i)| ServoGains {
                position,
                speed_p,
                speed_i,
                d_p,
                d_i,
                q_p,
                q_i,
            },
        )
}

/// Every value there is: NaN, infinities, zeros of either sign, subnormal
/// and huge numbers as often as ordinary ones.
pub fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => prop::num::f64::ANY,
        3 => -1e3..1e3,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e308, -1e308,
            f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, 1.0, -1.0, 0.5,
        ]),
    ]
}
/// A current loop on its inverter.
#[derive(Clone, Copy, Debug)]
pub struct CurrentLoop {
    pub motor: Pmsm,
    pub gains: ServoGains,
    pub dc_voltage: f64,
    pub period: f64,
    /// P_ix/L_x, 1/s: about the bandwidth of the closed loop.
    pub bandwidth: f64,
    /// The step, A.
    pub reference: Dq,
}

impl CurrentLoop {
    pub fn servo(&self) -> Servo {
        let limits = ServoLimits {
            current: f64::INFINITY,
            voltage: self.dc_voltage / 3f64.sqrt(),
        };
        Servo::new(self.gains, limits, self.period).unwrap()
    }
}

pub fn paper_current_loop() -> CurrentLoop {
    CurrentLoop {
        motor: motor(),
        gains: gains(),
        dc_voltage: DC_VOLTAGE,
        period: PERIOD,
        bandwidth: gains().q_p / motor().parameters().inductance_q,
        reference: Dq { d: 0.0, q: 5.0 },
    }
}

/// Loops that are stable by design: P = L ω_c, I = L ω_c²/4 in each axis, so
/// that s² + (R/L + ω_c) s + ω_c²/4 = 0 at standstill. The motor's and the
/// loop's time constants are sampled well: R T/L < 0.2 and ω_c T < 0.2. The
/// DC link has room for a step at ω_e < ω_c/4.
pub fn drawn_current_loop() -> impl Strategy<Value = CurrentLoop> {
    (
        drawn_motor(),
        drawn_period(),
        log_uniform(0.01, 0.2),
        log_uniform(0.05, 0.2),
        log_uniform(0.1, 100.0),
        2.0..5.0,
    )
        .prop_map(|(motor, period, decay, share, step, room)| {
            let p = *motor.parameters();
            let p = MotorParameters {
                resistance: decay * p.inductance_d.min(p.inductance_q) / period,
                ..p
            };
            let motor = Pmsm::new(p).unwrap();
            let bandwidth = share / period;
            let p_gain = |l: f64| l * bandwidth;
            let i_gain = |l: f64| l * bandwidth * bandwidth / 4.0;
            let gains = ServoGains {
                position: 0.0,
                speed_p: 0.0,
                speed_i: 0.0,
                d_p: p_gain(p.inductance_d),
                d_i: i_gain(p.inductance_d),
                q_p: p_gain(p.inductance_q),
                q_i: i_gain(p.inductance_q),
            };
            let flux = p.flux_linkage + (p.inductance_d + p.inductance_q) * step;
            let needed = bandwidth * flux + p.resistance * step;
            CurrentLoop {
                motor,
                gains,
                dc_voltage: 3f64.sqrt() * room * needed,
                period,
                bandwidth,
                reference: Dq { d: 0.0, q: step },
            }
        })
}
