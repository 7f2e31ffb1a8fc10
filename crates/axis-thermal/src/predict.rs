//! Growth and friction while an axis works, from its reference alone.

use crate::duty::{Duty, DutySample};
use crate::error::{ThermalError, check};
use crate::growth::Growth;
use crate::growth_log::GrowthOf;
use crate::model::ThermalModel;
use crate::run::ThermalAccuracy;
use crate::state::ThermalState;

/// Spread of positions below which a probing tells no slope, m.
const NARROW: f64 = 1e-3;

/// Follows the heat of an axis by the losses of its reference, with no sensor but that of the air: what a
/// controller takes from its reference ([`GrowthPredictor::growth`]) and scales the friction of its
/// feed-forward by ([`GrowthPredictor::friction_factors`]).
///
/// Samples are gathered for a window, and the temperatures advance at its end: growth between two ends
/// is a straight line that ends a window late, so that a correction has no jumps. In the first minutes of a
/// duty of the paper's axis that costs 14 µm with a window of a minute, and 2 µm with one of 7.6 s, the duty's
/// own length; a window is the solution of an eigenproblem, some milliseconds.
///
/// ```
/// use axis_thermal::{DutySample, GrowthPredictor, ThermalModel, ThermalParameters};
///
/// let model = ThermalModel::new(ThermalParameters::default())?;
/// let mut predictor = GrowthPredictor::new(model, 20.0, 60.0)?;
/// for k in 0..36_000 {
///     let there = f64::from(k % 1000) / 1000.0; // m
///     let sample = DutySample {
///         duration: 0.1,
///         position: 0.3 + 0.6 * there,
///         screw_speed: 100.0,
///         dry_power: 60.0,
///         viscous_power: 200.0,
///         ..DutySample::default()
///     };
///     predictor.push(&sample, 20.5)?;
/// }
/// assert!(predictor.growth(0.9).screw > 50e-6);
/// assert!(predictor.friction_factors()[1] < 0.9);
/// # Ok::<(), axis_thermal::ThermalError>(())
/// ```
#[derive(Clone, Debug)]
pub struct GrowthPredictor {
    model: ThermalModel,
    window: f64,
    gathered: Duty,
    homed: ThermalState,
    before: ThermalState,
    now: ThermalState,
    factors: [f64; 2],
    /// By which growth was off when it was probed: an offset (m) and a slope (m/m), before the running
    /// window and after it.
    off: [[f64; 2]; 2],
    /// Share of the window that was over then.
    probed_at: f64,
}

impl GrowthPredictor {
    /// Homed now, all at one temperature (°C); windows of so many seconds.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] for a window without sense.
    pub fn new(model: ThermalModel, temperature: f64, window: f64) -> Result<Self, ThermalError> {
        let inside = (0.1..=3600.0).contains(&window);
        check(inside, "window", window, "s", "from 0.1 to 3600")?;
        let state = model.at_rest(temperature);
        let mut predictor = Self {
            gathered: model.duty(),
            window,
            homed: state.clone(),
            before: state.clone(),
            now: state,
            factors: [1.0; 2],
            off: [[0.0; 2]; 2],
            probed_at: 0.0,
            model,
        };
        predictor.factors = predictor.factors_now()?;
        Ok(predictor)
    }

    /// Takes a stretch of the motion, and the temperature of the air, °C.
    ///
    /// # Errors
    /// [`ThermalError::RunsAway`] as [`AxisAtWork::run`](crate::AxisAtWork::run).
    pub fn push(&mut self, sample: &DutySample, air: f64) -> Result<(), ThermalError> {
        self.gathered.push(sample);
        // A sum of many samples may fall short by its rounding.
        if self.gathered.duration() < self.window * (1.0 - 1e-9) {
            return Ok(());
        }
        let duty = std::mem::replace(&mut self.gathered, self.model.duty());
        self.advance(&duty, duty.duration(), |_| air)
    }

    /// Advances at once by `duration` seconds of a duty, in air that follows the time (s).
    ///
    /// # Errors
    /// As [`AxisAtWork::run_in`](crate::AxisAtWork::run_in).
    pub fn advance(
        &mut self,
        duty: &Duty,
        duration: f64,
        air: impl Fn(f64) -> f64,
    ) -> Result<(), ThermalError> {
        let at_work = self.model.under(duty)?;
        let mut next = self.now.clone();
        at_work.run_in(&mut next, air, duration, &ThermalAccuracy::default())?;
        self.factors = at_work.friction_factors(&next);
        self.before = std::mem::replace(&mut self.now, next);
        self.off[0] = self.off[1];
        self.probed_at = 0.0;
        Ok(())
    }

    /// The axis has been homed: growth is counted from now on.
    pub fn home(&mut self) {
        self.homed = self.now.clone();
        self.before = self.now.clone();
        self.off = [[0.0; 2]; 2];
    }

    /// Growth since homing has been probed at some positions (each the position and what was read there, m).
    /// From now on a straight line over the position, an offset if all are one position, is added to
    /// the model's growth, so that it goes through what was read; [`GrowthPredictor::growth`] takes
    /// it up along the running window. The line holds until the next probing or homing: what a model
    /// lacks changes slowly and is much alike at all positions (bearings, bed, air).
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] if nothing was read, or a number is not finite.
    pub fn probed(&mut self, of: GrowthOf, read: &[[f64; 2]]) -> Result<(), ThermalError> {
        let count = read.len() as f64;
        let valid = "one position or more";
        check(count > 0.0, "positions that were probed", count, "", valid)?;
        for value in read.iter().flatten() {
            check(value.is_finite(), "a reading", *value, "m", "finite")?;
        }
        let model = |x: f64| self.model.growth(&self.homed, &self.now, x).read(of);
        let errors: Vec<[f64; 2]> = read.iter().map(|&[x, y]| [x, y - model(x)]).collect();
        let mean = |i: usize| errors.iter().map(|e| e[i]).sum::<f64>() / count;
        let [place, error] = [mean(0), mean(1)];
        let sum = |f: fn([f64; 2]) -> f64| -> f64 {
            let about = errors.iter().map(|e| f([e[0] - place, e[1] - error]));
            about.sum()
        };
        let spread = sum(|[x, _]| x * x);
        let slope = match spread > count * NARROW * NARROW {
            true => sum(|[x, y]| x * y) / spread,
            false => 0.0,
        };
        self.off = [self.off_now(), [error - slope * place, slope]];
        self.probed_at = self.share();
        Ok(())
    }

    /// Share of the running window that is over.
    fn share(&self) -> f64 {
        (self.gathered.duration() / self.window).min(1.0)
    }

    fn off_now(&self) -> [f64; 2] {
        let [from, to] = self.off;
        let left = 1.0 - self.probed_at;
        let share = match left > 0.0 {
            true => ((self.share() - self.probed_at) / left).clamp(0.0, 1.0),
            false => 1.0,
        };
        [0, 1].map(|i| from[i] + share * (to[i] - from[i]))
    }

    /// Growth at `x` (m) since homing, along the straight line of the running window.
    pub fn growth(&self, x: f64) -> Growth {
        let of = |state| self.model.growth(&self.homed, state, x);
        let (from, to) = (of(&self.before), of(&self.now));
        let share = self.share();
        let between = |from: f64, to: f64| from + share * (to - from);
        let [offset, slope] = self.off_now();
        Growth {
            screw: between(from.screw, to.screw) + offset + slope * x,
            scale: between(from.scale, to.scale),
            bed: between(from.bed, to.bed),
        }
    }

    /// Growth at `x` (m) since homing at the end of the last window, without a delay.
    pub fn growth_at_end(&self, x: f64) -> Growth {
        let growth = self.model.growth(&self.homed, &self.now, x);
        let [_, [offset, slope]] = self.off;
        Growth {
            screw: growth.screw + offset + slope * x,
            ..growth
        }
    }

    /// Dry and viscous friction as multiples of what they are at the reference temperature, under the
    /// last duty.
    pub fn friction_factors(&self) -> [f64; 2] {
        self.factors
    }

    /// The temperatures.
    pub fn state(&self) -> &ThermalState {
        &self.now
    }

    /// Factors of a motion at the middle of the screw.
    fn factors_now(&self) -> Result<[f64; 2], ThermalError> {
        let mut duty = self.model.duty();
        let half = self
            .model
            .parameters()
            .screw
            .map_or(0.0, |screw| 0.5 * screw.length);
        duty.push(&DutySample {
            duration: 1.0,
            position: half,
            ..DutySample::default()
        });
        Ok(self.model.under(&duty)?.friction_factors(&self.now))
    }
}
