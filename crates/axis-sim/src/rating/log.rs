//! A duty from a log: position, and the current or the command of torque or force.

use axis_log::Log;

use super::CheckError;
use super::duty::{AxisDuty, DutyStretch};
use crate::axis::Axis;
use crate::channels::{CHANNELS, position_in};

/// Half of the window over which a position is differentiated, s.
const WINDOW: f64 = 5e-3;

/// Channels that a log must have one of, by what the actuator takes.
const EFFORTS: [&str; 5] = [
    "iq_a",
    "iq_ref_a",
    "torque_ref_n_m",
    "force_ref_n",
    "drive_command_v",
];

impl AxisDuty {
    /// Adds a log of the axis: torque from the q current, or from the command of the actuator where it has none; speed from
    /// the position and acceleration from the motor's angle, or from the position where the log has none, by a parabola
    /// through 5 ms on both sides.
    ///
    /// # Errors
    /// [`CheckError`] if the log has no position, or nothing that tells the torque.
    pub fn add_log(&mut self, axis: &Axis, log: &Log) -> Result<(), CheckError> {
        let position = position_in(log)?;
        let known = |name: &&&str| {
            log.has(name)
                && CHANNELS
                    .iter()
                    .any(|c| c.linear[0] == **name && (c.of)(axis))
        };
        let effort = EFFORTS.iter().find(known).ok_or(CheckError::NoTorque)?;
        let effort = log.channel(effort)?;
        let (constant, radius) = (axis.torque_constant(), axis.travel_per_radian());
        let angle = "motor_angle_rad";
        let angle = log.has(angle).then(|| log.channel(angle)).transpose()?;
        let field = log.has("id_a").then(|| log.channel("id_a")).transpose()?;
        let time = log.time();
        let (first, last) = (time.first().copied(), time.last().copied());
        let span = last.zip(first).map_or(0.0, |(last, first)| last - first);
        let step = span / (time.len().max(2) - 1) as f64;
        if step <= 0.0 {
            return Err(CheckError::NoTime);
        }
        let half = ((WINDOW / step).round() as usize).max(2);
        let has_currents = axis.actuator.has_currents();
        for k in 0..time.len() - 1 {
            let [speed, of_load] = derivatives(position, k, half, step);
            let of_motor = |angle| derivatives(angle, k, half, step)[1] * radius;
            let current = match has_currents {
                true => [field.map_or(0.0, |d| d[k]), effort[k]],
                false => [0.0; 2],
            };
            self.push(&DutyStretch {
                duration: time[k + 1] - time[k],
                speed,
                acceleration: angle.map_or(of_load, of_motor),
                torque: constant * effort[k],
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
