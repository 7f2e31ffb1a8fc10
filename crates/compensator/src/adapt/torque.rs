//! The motor's torque along a log.

use std::vec::Vec;

use foc_pmsm::Dq;
use libm::exp;

use crate::{Drive, DriveModel, Sample};

/// Torque of the motor at each sample, N·m, from the measured current; from the command
/// through the assumed delay and lag where there is no current.
pub(super) fn torques(model: &DriveModel, log: &[Sample]) -> Vec<f64> {
    match model.drive {
        Drive::Lag { gain, bandwidth } => {
            let kept = exp(-bandwidth * model.period);
            let cycles = model.delay / model.period;
            let (whole, part) = (cycles.floor(), cycles - cycles.floor());
            // A sample has the command of the cycle before it.
            let commanded = |k: usize, late: usize| log[k.saturating_sub(late)].last_command;
            let acting = |k: usize| {
                let late = whole as usize;
                gain * ((1.0 - part) * commanded(k, late) + part * commanded(k, late + 1))
            };
            let last = log.len() - 1;
            let mut made = acting(0);
            let at = (0..log.len()).map(|k| {
                made = acting(k) + kept * (made - acting(k));
                match kept {
                    // It jumps at the sample: the mean of before and after.
                    0.0 => 0.5 * (acting(k) + acting((k + 1).min(last))),
                    _ => made,
                }
            });
            at.collect()
        }
        Drive::FieldOriented {
            motor,
            gear,
            d,
            voltage,
            ..
        } => {
            // The d current is not logged, and makes torque where the motor is salient:
            // it is that of the assumed motor under its controller.
            let h = model.period;
            let (mut id, mut integral) = (0.0, 0.0);
            let at = log.iter().map(|sample| {
                let i = Dq {
                    d: id,
                    q: sample.iq,
                };
                let speed = gear * sample.motor_speed;
                let torque = gear * motor.torque(i);
                integral += d[1] * h * -id;
                let held = Dq {
                    d: (d[0] * -id + integral).max(-voltage).min(voltage),
                    q: motor.steady_voltage(i, speed).q,
                };
                id = motor.step(i, held, speed, h).d;
                torque
            });
            at.collect()
        }
    }
}
