//! What a log shows of the steps and the noise of the position sensors that its drive reads.

use axis_sim::part::Part;
use axis_sim::sensor::Sensor;
use axis_sim::{Axis, LoadSensor, SetupError};

use super::set::{ANGLE, LogSet, Prepared};

/// Time over which noise and means are looked at, s: holding and reversing take some tens of ms.
const WINDOW: f64 = 0.04;

/// Steps a sample that a sensor passes at least where rounding is white noise of a twelfth of the step's square.
const MOVING: f64 = 1.0;

/// Share of the windows with less noise than the one that counts: at a speed of whole steps a sample rounding shows none.
const QUIETER: f64 = 0.75;

/// Share of that noise which a log must show to have been taken with such steps.
const HAS_STEPS: f64 = 0.5;

/// Samples of a window.
pub(super) fn window(log: &Prepared) -> usize {
    ((WINDOW / log.period) as usize).max(1)
}

/// Share of its variance by which rounding may seem noisier: a window of 40 samples shows a variance to a fifth.
const BY_CHANCE: f64 = 0.3;

/// An axis with sensors as a log shows them.
pub(super) struct Shown {
    pub(super) axis: Axis,
    /// Whether the loop reads what the log shows: rounding is the sensor's, noise may be the logger's.
    pub(super) is_read: bool,
}

/// The axis, its sensors with the noise that the log shows beside their steps. `None` if there is neither: the file's
/// sensors are exact, or the log has not the steps of the file's.
///
/// # Errors
/// [`SetupError`] if a sensor refuses that noise.
pub(super) fn as_shown(machine: &Axis, log: &Prepared) -> Result<Option<Shown>, SetupError> {
    let mut axis = machine.clone();
    let (mut is_exact, mut is_read) = (true, true);
    for (sensor, channel) in sensors(&mut axis).into_iter().flatten() {
        if sensor.is_exact() {
            continue;
        }
        is_exact = false;
        let step = sensor.resolution();
        match Noise::of(log, channel, step) {
            Some(noise) if !noise.has_steps() => return Ok(None),
            Some(noise) => {
                is_read &= noise.own() <= noise.of_rounding();
                sensor.change(|values| values.set("noise", noise.own().sqrt()))?;
            }
            None => is_read = false,
        }
    }
    Ok((!is_exact).then_some(Shown { axis, is_read }))
}

impl LogSet {
    /// Steps of the load's and the motor's sensor (m or rad) that all logs show; 0 for none.
    pub(crate) fn steps_shown(&self, machine: &Axis) -> [f64; 2] {
        let shows = |log: &Prepared, channel: &str, step: f64| {
            Noise::of(log, channel, step).is_some_and(|noise| noise.has_steps())
        };
        sensors(&mut machine.clone()).map(|one| {
            let Some((sensor, channel)) = one else {
                return 0.0;
            };
            let step = sensor.resolution();
            let all_show = self.logs.iter().all(|log| shows(log, channel, step));
            if all_show { step } else { 0.0 }
        })
    }
}

/// The sensors of load and motor, with the channels in which logs show them.
fn sensors(axis: &mut Axis) -> [Option<(&mut Part<dyn Sensor>, &'static str)>; 2] {
    let position = axis.position_channel();
    let load = match &mut axis.sensors.load {
        LoadSensor::Fitted(sensor) => Some((sensor, position)),
        LoadSensor::Perfect | LoadSensor::Missing => None,
    };
    let motor = axis.sensors.motor.as_mut();
    [load, motor.map(|sensor| (sensor, ANGLE))]
}

/// White noise that a channel shows of a sensor with steps.
#[derive(Clone, Copy, Debug)]
struct Noise {
    step: f64,
    /// Variance while it moves, rounding included.
    moving: f64,
    /// While it stands within two steps, if it does.
    still: Option<f64>,
}

impl Noise {
    /// In a channel of a log; `None` if it is not there, or never moves.
    fn of(log: &Prepared, channel: &str, step: f64) -> Option<Self> {
        Self::in_series(log.log.channel(channel).ok()?, step, window(log))
    }

    fn in_series(series: &[f64], step: f64, window: usize) -> Option<Self> {
        let (mut moving, mut still) = (Vec::new(), Vec::new());
        let windows = series.chunks_exact(window.max(8));
        for w in windows.filter(|w| w.iter().all(|x| x.is_finite())) {
            let ends = [f64::MAX, f64::MIN];
            let ends = w.iter().fold(ends, |[a, b], x| [a.min(*x), b.max(*x)]);
            let range = ends[1] - ends[0];
            if range >= MOVING * step * w.len() as f64 {
                moving.push(white(w));
            } else if range <= 2.5 * step {
                still.push(white(w));
            }
        }
        let quantile = |all: &mut Vec<f64>, share: f64| {
            all.sort_by(f64::total_cmp);
            all.get((share * all.len() as f64) as usize).copied()
        };
        Some(Self {
            step,
            moving: quantile(&mut moving, QUIETER)?,
            // Settling takes single steps.
            still: quantile(&mut still, 0.5),
        })
    }

    /// Variance of the rounding.
    fn of_rounding(&self) -> f64 {
        self.step * self.step / 12.0
    }

    /// Whether it may hold that.
    fn has_steps(&self) -> bool {
        self.moving >= HAS_STEPS * self.of_rounding()
    }

    /// Variance beside that, if chance does not explain it: noise makes a reading go to and fro where the sensor stands, too.
    fn own(&self) -> f64 {
        let beside = self.moving - self.of_rounding();
        match beside > BY_CHANCE * self.of_rounding() {
            true => self.still.map_or(beside, |still| beside.min(still)),
            false => 0.0,
        }
    }
}

/// Variance of the white noise in a series: of fourth differences, in which a motion's jerk is nothing.
fn white(series: &[f64]) -> f64 {
    // 1² + 4² + 6² + 4² + 1²
    const SQUARES: f64 = 70.0;
    let fourth = |d: &[f64]| d[0] - 4.0 * d[1] + 6.0 * d[2] - 4.0 * d[3] + d[4];
    let squares = series.windows(5).map(|d| fourth(d).powi(2));
    squares.sum::<f64>() / (SQUARES * (series.len() - 4) as f64)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::Noise;

    /// A stroke of 40 000 steps there and back, sampled 5000 times, as a sensor of this step and noise shows it.
    fn seen(step: f64, deviation: f64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut one = |k: usize| {
            let unit: f64 = StandardNormal.sample(&mut random);
            let at =
                20_000.0 * (std::f64::consts::TAU * k as f64 / 5000.0).sin() + deviation * unit;
            if step > 0.0 {
                (at / step).round() * step
            } else {
                at
            }
        };
        (0..5000).map(&mut one).collect()
    }

    #[test]
    fn noise_and_rounding_of_a_sensor_are_seen() {
        let of = |seen: &[f64], step: f64| Noise::in_series(seen, step, 100);
        for (step, deviation) in [(1.0, 0.0), (1.0, 0.3), (1.0, 2.0), (0.0, 0.2)] {
            let exact = step * step / 12.0 + deviation * deviation;
            let shown = of(&seen(step, deviation), step).unwrap();
            assert!(
                (shown.moving / exact - 1.0).abs() < 0.2,
                "{shown:?} {exact}"
            );
            assert!(shown.has_steps());
        }
        // Taken with a sensor that has no such steps, or at rest.
        assert!(!of(&seen(0.0, 0.0), 1.0).unwrap().has_steps());
        assert!(of(&[2.0; 500], 1.0).is_none());
        // A reading that never changes at rest has no noise, whatever rounding looks like in motion.
        let mut rests = seen(1.0, 0.0);
        rests.extend([7.0; 500]);
        assert!(of(&rests, 1.0).unwrap().own() < 1e-12);
    }
}
