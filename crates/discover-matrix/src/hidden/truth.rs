//! A machine as hard as a real one: its laws differ in form, its noise is no white one, and
//! it begins as it was left.

use axis_log::Log;
use axis_sim::effects::ActiveEffect;
use axis_sim::{Axis, ClosedLoop, Recorder, ReplayError};
use compensator::NoCompensation;
use trajectories::Motion;

use super::{Noise, Rough, late, made, recorded};

/// A machine with effects hidden in it, and how its logs are taken.
#[derive(Clone, Debug)]
pub struct Truth {
    /// What is hidden, forms of laws and laws outside the library among it.
    pub effects: Vec<ActiveEffect>,
    /// Shares by which its known parameters are off, in the order of [`Axis::known`].
    pub shares: Vec<f64>,
    /// Noise.
    pub noise: Rough,
    /// Share of sliding by which the bristles are deflected at the start, −1 to 1.
    pub wound: f64,
    /// Of the noise.
    pub seed: u64,
}

impl Truth {
    /// The log of a motion, one sample every `every` control cycles.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine cannot be set up or does not hold.
    pub fn log(&self, axis: &Axis, motion: &impl Motion, every: usize) -> Result<Log, ReplayError> {
        let truth = made(axis, &self.shares, &self.effects);
        let good = Noise::good(axis);
        let sense = self.noise.sensors(good, axis.period, self.seed);
        let log = recorded(axis, &truth, self.seed, self.wound, motion, sense)?;
        let log = late(&self.effects, log)?.decimate(every)?;
        let period = every as f64 * axis.period;
        Ok(self.noise.logged(&log, good, period, self.seed)?)
    }

    /// Its noise alone as it is on the machine as its file says: a log with it, and one
    /// without, both by the fast simulation.
    ///
    /// # Errors
    /// As [`Truth::log`].
    pub fn noise_logs(
        &self,
        axis: &Axis,
        motion: &impl Motion,
        every: usize,
    ) -> Result<[Log; 2], ReplayError> {
        let closed_loop = ClosedLoop::new(axis)?;
        let good = Noise::good(axis);
        let run = |noise: Rough, closed_loop: &ClosedLoop| -> Result<Log, ReplayError> {
            let mut recorder = Recorder::new(axis);
            let sense = noise.sensors(good, axis.period, self.seed);
            closed_loop
                .run_sensed(motion, &mut NoCompensation, sense, |c| recorder.push(c))
                .completed()?;
            let period = every as f64 * axis.period;
            let log = recorder.log()?.decimate(every)?;
            Ok(noise.logged(&log, good, period, self.seed)?)
        };
        let noisy = run(self.noise, &closed_loop.clone().with_seed(self.seed))?;
        let quiet = run(Rough::white(0.0), &closed_loop.without_noise())?;
        Ok([noisy, quiet])
    }
}
