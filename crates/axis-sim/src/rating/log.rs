//! A duty from a log: the motion and the motor's torque, as every command reads them.

use axis_log::Log;
use axis_log::quality::check_sampling;

use super::CheckError;
use super::duty::{AxisDuty, DutyStretch};
use crate::axis::Axis;
use crate::balance::ObservedMotion;

/// Half of the window over which a position is differentiated, s.
const WINDOW: f64 = 5e-3;

impl AxisDuty {
    /// Adds a log of the axis, with the channels of motion and torque that an [`ObservedMotion`] takes: speed from the
    /// load's position and acceleration from the motor's angle, or from the load's position where the log has none, by a
    /// parabola through 5 ms on both sides.
    ///
    /// # Errors
    /// [`CheckError`] if the log is not evenly sampled at 20 Hz to 20 kHz, or short, or nothing tells the motion or the torque.
    pub fn add_log(&mut self, axis: &Axis, log: &Log) -> Result<(), CheckError> {
        let step = check_sampling(log)?.period;
        let shown = ObservedMotion::of(log, step, axis)?;
        let (constant, radius) = (axis.torque_constant(), axis.travel_per_radian());
        let (position, motor) = (shown.positions(), shown.motor_positions());
        let torque = shown.torque();
        let field = log.channel("id_a").ok();
        let half = ((WINDOW / step).round() as usize).max(2);
        let has_currents = axis.actuator.has_currents();
        for k in 0..torque.len() - 1 {
            let [speed, of_load] = derivatives(&position, k, half, step);
            let of_motor = |angle: &Vec<f64>| derivatives(angle, k, half, step)[1] * radius;
            let current = match has_currents {
                true => [field.map_or(0.0, |d| d[k]), torque[k] / constant],
                false => [0.0; 2],
            };
            self.push(&DutyStretch {
                duration: step,
                speed,
                acceleration: motor.as_ref().map_or(of_load, of_motor),
                torque: torque[k],
                current,
            })?;
        }
        Ok(())
    }
}

/// First and second derivative at sample `k` by a parabola of least squares through up to `half` even samples on both
/// sides (Savitzky and Golay, Anal. Chem. 36 (1964) 1627, doi:10.1021/ac60214a047); 0 where there are too few.
fn derivatives(values: &[f64], k: usize, half: usize, step: f64) -> [f64; 2] {
    let from = k.min(half);
    let half = from.min(values.len() - 1 - k);
    if half == 0 {
        return [0.0; 2];
    }
    let (mut first, mut second) = ([0.0; 2], [0.0; 2]);
    let n = half as f64;
    let mean = n * (n + 1.0) / 3.0;
    for (i, value) in values[k - half..=k + half].iter().enumerate() {
        let at = i as f64 - n;
        // Of the middle value, which keeps digits.
        let value = value - values[k];
        let even = at * at - mean;
        first = [first[0] + at * value, first[1] + at * at];
        second = [second[0] + even * value, second[1] + even * even];
    }
    let curvature = 2.0 * second[0] / second[1];
    [first[0] / first[1] / step, curvature / (step * step)]
}

#[cfg(test)]
mod tests {
    use super::derivatives;

    /// Exact of a parabola, at the ends of the window too.
    #[test]
    fn a_parabola_is_differentiated_exactly() {
        let step = 1e-3;
        let at = |k: usize| 0.3 + 0.2 * (k as f64 * step) + 1.7 * (k as f64 * step).powi(2);
        let values: Vec<f64> = (0..50).map(at).collect();
        for k in 1..49 {
            let [speed, acceleration] = derivatives(&values, k, 5, step);
            assert!((speed - (0.2 + 3.4 * k as f64 * step)).abs() < 1e-10);
            assert!((acceleration - 3.4).abs() < 1e-7, "{k}: {acceleration}");
        }
        assert_eq!(derivatives(&values, 0, 5, step), [0.0; 2]);
        assert_eq!(derivatives(&[1.0], 0, 5, step), [0.0; 2]);
    }
}
