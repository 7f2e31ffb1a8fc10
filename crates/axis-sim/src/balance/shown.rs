//! What a log shows of an axis by itself: its motion, its motor's torque, and the force of
//! friction that follows from the two without any law of friction.

use std::ops::Range;

use axis_log::Log;

use super::filter::{LowPass, ahead, derivative};
use super::motion::{Course, Measured, Whose};
use super::spectrum::least_noise;
use crate::axis::Axis;
use crate::balance_error::BalanceError;
use crate::torque_channel::TorqueChannel;

/// Highest cut-off as a share of the sampling rate: above it, differences are no derivatives
/// any more.
const HIGHEST: f64 = 0.1;

/// Share of the deviation of a motion or a torque that a low-pass may take from it.
const TAKEN: f64 = 2e-3;

/// The motion and the motor's torque that a log shows, side by side and not filtered.
///
/// Positions and forces are the load's, m and N or rad and N·m.
#[derive(Clone, Debug)]
pub struct ObservedMotion {
    measured: Vec<Measured>,
    channel: TorqueChannel,
    period: f64,
    torque: Vec<f64>,
    travel_per_radian: f64,
    holes: Vec<Range<usize>>,
}

/// The force of friction along a motion, low-passed: one value a sample.
///
/// Both have gone through the same filter without phase, so that what it does to one it does
/// to the other.
#[derive(Clone, Debug)]
pub struct FrictionCourse {
    /// Position of the load, m or rad.
    pub position: Vec<f64>,
    /// Its speed, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Force of friction against positive motion, N or N·m: of the motor's, what neither
    /// inertia nor the axis' own loads take.
    pub force: Vec<f64>,
    /// Force that inertia takes of the motor's, N or N·m.
    pub inertia: Vec<f64>,
}

impl ObservedMotion {
    /// Of a log with the sampling period `period`, s.
    ///
    /// # Errors
    /// [`BalanceError`] names the channels of which one would do.
    pub fn of(log: &Log, period: f64, axis: &Axis) -> Result<Self, BalanceError> {
        if !(period.is_finite() && period > 0.0) {
            return Err(BalanceError::Period { period });
        }
        let channel = TorqueChannel::of(&[log], axis)?;
        let measured = Measured::of(log, period, axis)?;
        let per_torque = channel.per_torque(axis);
        let logged = log.channel(channel.name).unwrap_or_default();
        let torque = logged.iter().map(|value| value / per_torque).collect();
        // A command acts later than it is logged, and the torque follows it later still.
        let [early, lag] = channel.ahead(axis, period);
        let names = measured.iter().map(|m| m.name).chain([channel.name]);
        let holes = names.flat_map(|name| log.missing(name).iter().cloned());
        Ok(Self {
            holes: holes.collect(),
            torque: ahead(torque, -(early + lag) / period),
            travel_per_radian: axis.travel_per_radian(),
            measured,
            channel,
            period,
        })
    }

    /// Sampling period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Samples.
    pub fn len(&self) -> usize {
        self.torque.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.torque.is_empty()
    }

    /// Motor torque at the instants of the motion, N·m.
    pub fn torque(&self) -> &[f64] {
        &self.torque
    }

    /// The channels that were read: of the motion, and of the torque.
    pub fn channels(&self) -> Vec<&'static str> {
        let motion = self.measured.iter().map(|m| m.name);
        motion.chain([self.channel.name]).collect()
    }

    /// Samples at which one of them has no value.
    pub fn holes(&self) -> &[Range<usize>] {
        &self.holes
    }

    /// Whether a sensor at the load shows its motion, and not the motor's through the
    /// transmission.
    pub fn sees_load(&self) -> bool {
        self.of_whom(Whose::Load).is_some()
    }

    /// Position of the load, of the motor through a stiff transmission where nothing shows the
    /// load's, m or rad.
    pub fn positions(&self) -> Vec<f64> {
        self.scaled(self.nearest().positions(self.period))
    }

    /// Angle of the motor, rad, where a sensor shows it.
    pub fn motor_positions(&self) -> Option<Vec<f64>> {
        let motor = self.of_whom(Whose::Motor)?;
        Some(motor.positions(self.period))
    }

    /// Speed of the load, likewise: as it was sampled, or from sample to sample.
    pub fn speeds(&self) -> Vec<f64> {
        self.scaled(self.nearest().speeds(self.period))
    }

    /// How far a mean of that speed over `time` seconds may be off by the sensor's noise and
    /// resolution, one standard deviation.
    pub fn speed_uncertainty(&self, time: f64) -> f64 {
        self.per_load() * self.nearest().speed_uncertainty(self.period, time)
    }

    /// The lowest cut-off, Hz, that takes no more from motion and torque between two samples than
    /// noise, and at which the noise of acceleration is worth at most `force` (N or N·m at the load)
    /// of inertia.
    pub fn quiet_cutoff(&self, axis: &Axis, within: Range<usize>, force: f64) -> f64 {
        let most = HIGHEST / self.period;
        let nearest = self.nearest();
        let part = |series: &[f64]| series.get(within.clone()).unwrap_or_default().to_vec();
        let [motion, torque] = [part(nearest.samples()), part(&self.torque)];
        let of_torque = 0.5 * least_noise(&torque, self.period) / self.period;
        let both = [
            (motion, nearest.noise_power(self.period)),
            (torque, of_torque),
        ];
        let kept = |cutoff: f64| {
            let filter = LowPass::new(cutoff * self.period);
            both.iter().all(|(series, noise)| {
                let smooth = filter.apply(series);
                let pairs = series.iter().zip(&smooth);
                let taken = power(pairs.map(|(a, b)| a - b));
                // Beside white noise, a twentieth for its own scatter.
                taken <= 1.05 * noise + TAKEN.powi(2) * power(series.iter().copied())
            })
        };
        // Steps by a fourth root of 2 over a bit more than two decades.
        let lower = |k: i32| most * 0.5_f64.powf(0.25 * f64::from(k));
        let quiet = |cutoff: f64| self.inertia_noise(axis, cutoff) <= force;
        let smooth = (1..=28).map(lower).take_while(|&cutoff| kept(cutoff));
        let lowest = smooth.last().unwrap_or(most);
        let loud = (0..=28).map(lower).find(|&cutoff| quiet(cutoff));
        lowest.min(loud.unwrap_or(lowest))
    }

    /// Noise of the force of inertia behind a low-pass, RMS, N or N·m at the load.
    fn inertia_noise(&self, axis: &Axis, cutoff: f64) -> f64 {
        let r = self.travel_per_radian;
        let load = axis.mechanism.load_inertia();
        let all = axis.mechanism.total_inertia();
        let one = |m: &Measured| {
            let both = self.measured.len() == 2;
            let inertia = match (m.whose, both) {
                (Whose::Load, true) => load,
                (Whose::Load, false) => all / (r * r),
                (Whose::Motor, true) => (all - load * r * r) / r,
                (Whose::Motor, false) => all / r,
            };
            inertia * m.noise.least_acceleration(cutoff)
        };
        self.measured.iter().map(one).fold(0.0, f64::hypot)
    }

    /// Friction along the motion, both low-passed at `cutoff`, Hz.
    ///
    /// Every rotating part takes part in acceleration with its share of the static wind-up
    /// between motor and load. Where only the motor's motion is shown, the load is behind it
    /// by what the transmitted force winds up.
    pub fn friction(&self, axis: &Axis, cutoff: f64) -> FrictionCourse {
        let r = self.travel_per_radian;
        let torque = LowPass::new(cutoff * self.period).apply(&self.torque);
        let course = |m: &Measured| m.course(self.period, cutoff);
        let load = self.of_whom(Whose::Load).map(course);
        let motor = self.of_whom(Whose::Motor).map(course);
        let (load, motor) = match (load, motor) {
            (Some(load), Some(motor)) => (load, motor),
            (Some(load), None) => (load.clone(), load.times(1.0 / r)),
            (None, Some(motor)) => (self.behind(axis, &motor, &torque), motor),
            // `Measured::of` finds one at least.
            (None, None) => return FrictionCourse::empty(),
        };
        let middle = load.position.get(load.position.len() / 2).copied();
        let parts = axis.mechanism.rotating(middle.unwrap_or(0.0));
        let mass = axis.mechanism.load_inertia();
        let inertia = |k: usize| {
            let (of_motor, of_load) = (motor.acceleration[k], load.acceleration[k]);
            let lag = of_motor - of_load / r;
            let turn = |[j, share]: &[f64; 2]| j * (of_motor - share * lag);
            parts.iter().map(turn).sum::<f64>() / r + mass * of_load
        };
        let inertia: Vec<f64> = (0..torque.len()).map(inertia).collect();
        let force = |k: usize| torque[k] / r - inertia[k] - axis.load_at(load.position[k]);
        FrictionCourse {
            force: (0..torque.len()).map(force).collect(),
            inertia,
            position: load.position,
            speed: load.speed,
        }
    }

    /// The load's course where the motor's and its torque are known.
    fn behind(&self, axis: &Axis, motor: &Course, torque: &[f64]) -> Course {
        let r = self.travel_per_radian;
        let load = motor.times(r);
        let middle = load.position.get(load.position.len() / 2).copied();
        let compliance = axis.mechanism.compliance(middle.unwrap_or(0.0));
        if compliance == 0.0 {
            return load;
        }
        let own = axis.mechanism.total_inertia() - axis.mechanism.load_inertia() * r * r;
        let lags = torque.iter().zip(&motor.acceleration);
        let lag = lags.map(|(torque, a)| r * compliance * (torque - own * a));
        let position: Vec<f64> = lag.collect();
        let speed = derivative(&position, self.period);
        let acceleration = derivative(&speed, self.period);
        let lag = Course {
            position,
            speed,
            acceleration,
        };
        load.plus(-1.0, &lag)
    }

    fn of_whom(&self, whose: Whose) -> Option<&Measured> {
        self.measured.iter().find(|m| m.whose == whose)
    }

    /// The motion that is measured at the load, or else at the motor.
    fn nearest(&self) -> &Measured {
        // `Measured::of` finds one at least.
        self.of_whom(Whose::Load).unwrap_or(&self.measured[0])
    }

    /// Of the load per unit of that motion.
    fn per_load(&self) -> f64 {
        match self.nearest().whose {
            Whose::Load => 1.0,
            Whose::Motor => self.travel_per_radian,
        }
    }

    fn scaled(&self, mut series: Vec<f64>) -> Vec<f64> {
        let by = self.per_load();
        series.iter_mut().for_each(|value| *value *= by);
        series
    }
}

impl FrictionCourse {
    fn empty() -> Self {
        Self {
            position: Vec::new(),
            speed: Vec::new(),
            force: Vec::new(),
            inertia: Vec::new(),
        }
    }
}

/// Variance.
fn power(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|v| (v - mean).powi(2)).sum::<f64>() / count
}
