//! The drive of Liu et al. 2025 (doi 10.3390/machines13050433, Tables 2, 4
//! and 5), in SI units: rpm and mm converted.
#![allow(dead_code)] // each test file uses its own part

use foc_pmsm::{MotorParameters, Pmsm, Servo, ServoGains, ServoLimits};

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
