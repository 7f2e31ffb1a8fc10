//! Drives drawn in `f64`, in either scalar.

use super::CurrentLoop;
use axis_scalar::Scalar;
use foc_pmsm::{Dq, FocError, MotorParameters, Pmsm, Servo, ServoGains, ServoLimits};

pub fn dq<T: Scalar>(x: Dq) -> Dq<T> {
    Dq {
        d: T::of(x.d),
        q: T::of(x.q),
    }
}

pub fn widened<T: Scalar>(x: Dq<T>) -> Dq {
    Dq {
        d: x.d.to_f64(),
        q: x.q.to_f64(),
    }
}

pub fn motor<T: Scalar>(m: &Pmsm) -> Pmsm<T> {
    let p = m.parameters();
    Pmsm::new(MotorParameters {
        pole_pairs: p.pole_pairs,
        resistance: T::of(p.resistance),
        inductance_d: T::of(p.inductance_d),
        inductance_q: T::of(p.inductance_q),
        flux_linkage: T::of(p.flux_linkage),
    })
    .unwrap()
}

pub fn gains<T: Scalar>(g: &ServoGains) -> ServoGains<T> {
    ServoGains {
        position: T::of(g.position),
        speed_p: T::of(g.speed_p),
        speed_i: T::of(g.speed_i),
        d_p: T::of(g.d_p),
        d_i: T::of(g.d_i),
        q_p: T::of(g.q_p),
        q_i: T::of(g.q_i),
    }
}

pub fn servo<T: Scalar>(
    g: &ServoGains,
    limits: &ServoLimits,
    period: f64,
) -> Result<Servo<T>, FocError> {
    let limits = ServoLimits {
        current: T::of(limits.current),
        voltage: T::of(limits.voltage),
    };
    Servo::new(gains(g), limits, T::of(period))
}

/// The servo of a drawn current loop.
pub fn current_loop<T: Scalar>(plant: &CurrentLoop) -> Servo<T> {
    let same = plant.servo();
    servo(same.gains(), same.limits(), plant.period).unwrap()
}
