//! How much of a residual is noise: what goes round the loop, and what the logger adds.

mod colour;
mod excess;
mod floor;
mod hum;
mod level;
mod motion;
mod sensor;
mod slow;
mod sources;
mod steady;
mod turned;

use std::collections::BTreeMap;

use axis_sim::{Axis, ClosedLoop, Measured, Replay, ReplayError, Trace};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use self::colour::Colour;
pub(crate) use self::colour::{coloured_noise, steady_bands};
pub(crate) use self::excess::{Excess, excess};
pub(crate) use self::floor::{Floor, floors, floors_with};
pub(crate) use self::hum::Hum;
use self::level::{noise_at, shows_noise};
pub(crate) use self::motion::{MotionAndRest, Simulated};
pub use self::sensor::SensorNoise;
pub(crate) use self::slow::{SlowNoise, slow_noise};
pub(crate) use self::steady::stays;
pub(crate) use self::turned::turned;
use crate::answers::{LogSet, Rest, State};
use crate::spectrum::Amplitudes;

/// Noise of logs: of the sensors, which the controller sees as well, and of the logger,
/// which nothing sees but the log.
#[derive(Clone, Debug)]
pub struct LogNoise {
    /// Of the sensors.
    pub sensors: SensorNoise,
    /// Standard deviation of what the logger adds, white, by channel, in its unit.
    pub logger: BTreeMap<&'static str, f64>,
    /// What the sensors have beside their white noise.
    colour: Colour,
    /// Steps of load and motor sensor (m or rad), of which the noise of `sensors` holds the rounding; 0 for none.
    steps: [f64; 2],
}

impl LogNoise {
    /// Of sensors alone.
    pub fn of_sensors(sensors: SensorNoise) -> Self {
        Self {
            sensors,
            logger: BTreeMap::new(),
            colour: Colour::default(),
            steps: [0.0; 2],
        }
    }

    /// Of sensors alone, with this noise up to a frequency (Hz) and none above.
    fn in_band(sensors: SensorNoise, end: f64) -> Self {
        Self {
            colour: Colour::up_to(end, sensors),
            ..Self::of_sensors(SensorNoise::NONE)
        }
    }

    /// The sensors, for [`axis_sim::ClosedLoop::run_sensed`], read every `period` seconds: the same
    /// seed gives the same noise.
    fn sensed(&self, seed: u64, period: f64) -> impl FnMut(&mut Measured) {
        let mut own = self.sensors;
        own.position = beside_steps(own.position, self.steps[0]);
        own.angle = beside_steps(own.angle, self.steps[1]);
        let mut white = own.sensors(seed);
        let mut coloured = self.colour.samples(seed, period);
        let [of_load, of_motor] = self.steps;
        move |seen: &mut Measured| {
            white(seen);
            if let Some([position, angle, speed, q, d]) = coloured.next() {
                seen.position += position;
                seen.motor_angle += angle;
                seen.motor_speed += speed;
                seen.current.q += q;
                seen.current.d += d;
            }
            seen.position = rounded(seen.position, of_load);
            seen.motor_angle = rounded(seen.motor_angle, of_motor);
        }
    }

    /// What must be known of noise in the loop that is not white.
    pub(crate) fn note(&self, machine: &Axis) -> Option<String> {
        self.colour.note(machine)
    }

    /// What the logger adds to a channel of a log, of so many samples.
    fn logged(&self, channel: &str, seed: u64, samples: usize) -> Vec<f64> {
        let deviation = self.logger.get(channel).copied().unwrap_or(0.0);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        (0..samples).map(|_| deviation * normal()).collect()
    }
}

/// Standard deviation of the noise that a sensor has beside the rounding to its steps.
fn beside_steps(noise: f64, step: f64) -> f64 {
    (noise * noise - step * step / 12.0).max(0.0).sqrt()
}

fn rounded(value: f64, step: f64) -> f64 {
    match step > 0.0 {
        true => (value / step).round() * step,
        false => value,
    }
}

/// Noise of the fitted logs, as their rest shows it; `None` of an axis that does not
/// ([`shows_noise`]). `traces` are their simulations without noise.
pub(crate) fn log_noise(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
) -> Option<LogNoise> {
    let axis = at_state(machine, state);
    shows_noise(&axis, set).then(|| noise_at(&axis, set, &set.rest(traces), traces))
}

/// The machine at a state.
fn at_state(machine: &Axis, state: &State) -> Axis {
    let mut axis = machine.with_known(&state.shares);
    axis.effects.extend_from_slice(&state.effects);
    axis
}

/// What noise does to the logs of a set; `quiet` are their simulations without any.
fn noise_series(
    closed_loop: &ClosedLoop,
    set: &LogSet,
    quiet: &[Trace],
    noise: &LogNoise,
    seed: u64,
) -> Result<Rest, ReplayError> {
    let one = |(l, (replay, quiet)): (usize, (&Replay, &Trace))| {
        let stream = 1000 * seed + l as u64 + 1;
        let sensors = noise.sensed(stream, closed_loop.axis().period);
        let noisy = replay.follow(closed_loop, sensors)?;
        let channel = |(c, name): (usize, &&'static str)| -> Vec<f64> {
            let [a, b] = [&noisy, quiet].map(|t| t.channel(name).unwrap_or_default());
            let own_stream = (stream << 8) + c as u64;
            let logged = noise.logged(name, own_stream, a.len());
            let of_loop = a.iter().zip(b).map(|(a, b)| a - b);
            let mut run: Vec<f64> = of_loop.zip(logged).map(|(n, l)| n + l).collect();
            // What they change on average is in the model.
            if noise.steps != [0.0; 2] {
                let mean = &set.logs[l].sensed[c];
                run.iter_mut().zip(mean).for_each(|(n, mean)| *n -= mean);
            }
            run
        };
        Ok(set.channels.iter().enumerate().map(channel).collect())
    };
    let logs: Vec<(&Replay, &Trace)> = set.replays().into_iter().zip(quiet).collect();
    logs.into_par_iter().enumerate().map(one).collect()
}

/// The same as amplitudes, with the machine at a state.
pub(crate) fn noise_on(
    machine: &Axis,
    state: &State,
    set: &LogSet,
    quiet: &[Trace],
    noise: &LogNoise,
    seed: u64,
) -> Result<Amplitudes, ReplayError> {
    let closed_loop = ClosedLoop::new(&at_state(machine, state))?.without_noise();
    Ok(set.amplitudes(&noise_series(&closed_loop, set, quiet, noise, seed)?))
}
