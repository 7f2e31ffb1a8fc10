//! Torque balance: measured motion in, the motor torque that a model needs for it out.
//!
//! Where nobody knows the controller, a log cannot be replayed through the closed loop. But
//! whatever made the motion, the motor's torque must have been that of the equation of
//! motion along it,
//!
//! ```text
//! T(t) = J_m α + r (m a + F_friction(v, z) + F_loads(x, v, t)),
//! ```
//!
//! and what a log shows of the torque (a current, a command, a torque sensor) is compared
//! with that. Both go through the same low-pass without phase before they are compared, so
//! what it does to one it does to the other (inverse dynamic identification with parallel
//! filtering: Gautier, Janot, Vandanjon, IEEE Trans. Control Syst. Technol. 21 (2013)
//! 428–444, doi:10.1109/TCST.2012.2185697). The page docs/theory/torque-balance.md has the
//! formulas, what was decided, and the limits.

mod filter;
mod friction_scatter;
mod law;
mod motion;
mod prepared;
mod quality;
mod shown;
mod spectrum;
mod transmission;
mod wind_up;

use axis_log::Log;

use crate::axis::Axis;
pub use crate::balance_error::{BalanceError, CutoffReason};
use crate::control::absent::{encoder_skew, sampled_inertia};
use crate::effects::ActiveEffect;
use crate::replay::{Probe, ReplayError, Trace};
use crate::torque_channel::TorqueChannel;
use filter::{LowPass, ahead, derivative};
use law::{Ends, Motions, torque};
use prepared::TorqueNoise;
pub use quality::BalanceQuality;
pub use shown::{FrictionCourse, ObservedMotion};
pub use transmission::TRANSMISSION_ERROR;
use transmission::{Transmission, error, give};

/// One log's measured motion and torque, ready to be compared with any model of the axis.
#[derive(Clone, Debug)]
pub struct Balance {
    channel: TorqueChannel,
    /// Compared beside the torque where load and motor were measured.
    transmission: Option<Transmission>,
    motions: Motions,
    /// Sampling period of the log, s.
    period: f64,
    /// Applied to both sides before they are compared.
    filter: LowPass,
    /// Samples compared, of those at the log's rate.
    kept: Vec<usize>,
    /// What of the load's motion goes with a trace: name, samples kept.
    position: (&'static str, Vec<f64>),
    speed: Vec<f64>,
    compared: Log,
    quality: BalanceQuality,
    noise: TorqueNoise,
}

/// Noise alone in a channel that is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceNoise {
    /// Root mean square, in the channel's unit.
    pub rms: f64,
    /// Whether it is the least that is possible: nobody knows what a controller makes of its sensors'
    /// noise.
    pub is_least: bool,
}

impl Balance {
    /// What the model needs at the compared samples: the torque's channel and, where load and motor
    /// were measured, the transmission error; and the load's position and speed as they were measured.
    ///
    /// # Errors
    /// [`ReplayError::Setup`] if an effect does not fit the axis.
    pub fn run(
        &self,
        axis: &Axis,
        effects: &[ActiveEffect],
        probe: Option<&Probe>,
    ) -> Result<Trace, ReplayError> {
        let mut axis = axis.clone();
        axis.effects.extend_from_slice(effects);
        let (axis, hooks) = axis.with_effects()?;
        let per_torque = self.channel.per_torque(&axis);
        // What a current's sensors show of a current: (1 + c) i + i_0(θ).
        let sensors = self.channel.is_current(&axis).then_some(&hooks.sensors);
        let per_torque = sensors.map_or(1.0, |s| 1.0 + s.current_gain) * per_torque;
        let zero = |angle: f64| {
            let offset = sensors.and_then(|s| s.current_offset.at(angle));
            offset.map_or(0.0, |offset| offset.q)
        };
        let ends = Ends::of(&axis, &hooks, &self.motions, self.period);
        let mut needed = torque(&axis, &hooks, &ends, self.period);
        if self.channel.is_controlled() {
            let more = sampled_inertia(&axis.control) - 1.0;
            let inertia = more * axis.mechanism.total_inertia();
            let pairs = needed.iter_mut().zip(&self.motions.motor.acceleration);
            pairs.for_each(|(torque, a)| *torque += inertia * a);
        }
        let [early, lag] = self.channel.ahead(&axis, self.period);
        // T + τ Ṫ makes the torque T of an actuator with the time constant τ.
        let rates = derivative(&needed, self.period);
        let angles = self.motions.motor.position.iter();
        let pairs = needed.iter().zip(rates).zip(angles);
        let shown = pairs.map(|((t, rate), angle)| per_torque * (t + lag * rate) + zero(*angle));
        // A position that is logged late shows the motion of before.
        let by = (early + hooks.clock_offset) / self.period;
        let mut compared = self.compare(&ahead(shown.collect(), by));
        if let Some(Probe::Load(force)) = probe {
            let by = per_torque * axis.travel_per_radian();
            let pairs = compared.iter_mut().zip(force.iter());
            pairs.for_each(|(value, force)| *value += by * force);
        }
        let mut channels = vec![(self.channel.name, compared), self.position.clone()];
        if let Some(transmission) = &self.transmission {
            let late = hooks.clock_offset + encoder_skew(&axis.control) * self.period;
            let mut compared = self.compare(&error(&axis, &hooks, &ends, late, self.period));
            self.disturb(&axis, &mut compared, probe);
            channels.push((transmission.name, compared));
        }
        Ok(Trace {
            channels,
            speed: self.speed.clone(),
        })
    }

    /// A series as it is compared: behind the low-pass, at the samples that are kept.
    fn compare(&self, series: &[f64]) -> Vec<f64> {
        let smooth = self.filter.apply(series);
        self.kept.iter().map(|&k| smooth[k]).collect()
    }

    /// Adds what a disturbance does to the transmission error.
    fn disturb(&self, axis: &Axis, error: &mut [f64], probe: Option<&Probe>) {
        let (series, per_unit): (_, &dyn Fn(f64) -> f64) = match probe {
            None => return,
            Some(Probe::Load(force)) => (force, &|position| -give(axis, position)),
            Some(Probe::Offset(offset)) => (offset, &|_| 1.0),
        };
        let pairs = error.iter_mut().zip(series.iter()).zip(&self.position.1);
        pairs.for_each(|((value, by), position)| *value += per_unit(*position) * by);
    }

    /// Name of the torque's channel.
    pub fn channel(&self) -> &'static str {
        self.channel.name
    }

    /// Names of the channels that are compared: the torque's and, where load and motor were measured,
    /// the transmission error.
    pub fn channels(&self) -> Vec<&'static str> {
        let error = self.transmission.iter().map(|t| t.name);
        std::iter::once(self.channel.name).chain(error).collect()
    }

    /// The log as it is compared: low-passed, at a lower rate, without what lies at its
    /// ends and without standstill. Its time has gaps where samples are left out.
    pub fn compared(&self) -> &Log {
        &self.compared
    }

    /// Sampling period of the log, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Period of the compared samples, s.
    pub fn compared_period(&self) -> f64 {
        self.quality.compared_period
    }

    /// Correlation of white noise, as it is compared, over a time (s).
    pub fn correlation(&self, over: f64) -> f64 {
        spectrum::correlation(self.quality.cutoff, over)
    }

    /// Noise alone in each of [`Balance::channels`] with the inertia of this axis, RMS in its unit, with
    /// the uncertainty of the friction. Of the torque it is the least that the upper spectra of torque
    /// and motion leave possible; what two encoders show of one motion, they show beside each other.
    pub fn noise(&self, axis: &Axis) -> Vec<BalanceNoise> {
        let torque = self.noise.rms(axis).hypot(self.quality.friction);
        let force = self.quality.friction
            / (self.channel.per_torque(axis) * axis.travel_per_radian()).abs();
        let middle = self.position.1.get(self.position.1.len() / 2);
        let of_friction = middle.map_or(0.0, |&x| force * give(axis, x));
        let error = self.transmission.iter().map(|t| BalanceNoise {
            rms: t.noise.hypot(of_friction),
            is_least: false,
        });
        let torque = BalanceNoise {
            rms: torque,
            is_least: true,
        };
        std::iter::once(torque).chain(error).collect()
    }

    /// What was decided for this log, and why.
    pub fn quality(&self) -> &BalanceQuality {
        &self.quality
    }
}
