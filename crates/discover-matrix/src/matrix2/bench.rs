//! What is the same for all cases of a plot, and what can be seen in a case beforehand.

use axis_log::Log;
use axis_sim::effects::{ActiveEffect, Scales};
use axis_sim::{Axis, ReplayError};
use discrepancy::{Hypothesis, LogSet, PredictedEffect, Prediction, State};
use trajectories::Program;

use super::case::{Case, CaseSetting, Channels};
use super::design::{shares, started};
use super::sight::Sight;
use crate::hidden::{Noise, Rough, Truth, exercise, supposed};
use crate::matrix::{BenchError, active, scale_at, times_size};

/// What is the same for all cases of a plot.
pub struct Bench {
    pub(super) setting: CaseSetting,
    /// The machine with its control.
    pub(super) axis: Axis,
    /// What the search is given: the same, without control for a torque balance.
    pub(super) machine: Axis,
    /// To fit to and to check on.
    pub(super) motions: [Program; 2],
    /// Control cycles of a sample.
    pub(super) every: usize,
    /// Logs of the clean machine on them, without noise where they are replayed.
    pub(super) templates: [LogSet; 2],
    /// Of the first of them; `None` for a torque balance.
    pub(super) prediction: Option<Prediction>,
}

/// Sizes between which one is sought, as multiples of the typical.
const SCALES: (f64, f64) = (1e-5, 30.0);

/// Rest of each log and channel.
type Rest = Vec<Vec<Vec<f64>>>;

/// Rate of the logs, Hz.
const RATE: f64 = 1000.0;

impl Bench {
    /// Simulates what the setting needs; `axis` is the machine of that name.
    ///
    /// # Errors
    /// [`BenchError`] where the axis does not run the motion.
    pub fn new(axis: &Axis, setting: &CaseSetting) -> Result<Self, BenchError> {
        let axis = started(axis, setting);
        let motions = [
            exercise(&axis, setting.exercise, false)?,
            exercise(&axis, setting.exercise, true)?,
        ];
        let machine = match setting.channels {
            Channels::Balance => axis.clone().without_control().map_err(unset)?,
            _ => axis.clone(),
        };
        let every = ((1.0 / (RATE * axis.period)).round() as usize).max(1);
        let period = every as f64 * axis.period;
        // A balance takes its cut-off from the noise, and of a log without any takes none
        // that would serve a log with some.
        let level = match setting.channels {
            Channels::Balance => 1.0,
            _ => 0.0,
        };
        let quiet = Truth {
            effects: Vec::new(),
            shares: Vec::new(),
            noise: Rough::white(level),
            wound: 0.0,
            seed: 0,
        };
        let template = |place: usize| -> Result<LogSet, BenchError> {
            let log = quiet.log(&axis, &motions[place], every)?;
            let log = setting.channels.of(&log).map_err(ReplayError::from)?;
            let name = ["fit", "check"][place].to_owned();
            Ok(LogSet::new(vec![(name, log, period)], &machine)?)
        };
        let templates = [template(0)?, template(1)?];
        let good = supposed(Noise::good(&axis));
        let prediction = match setting.channels {
            Channels::Balance => None,
            _ => Some(Prediction::new(&machine, &templates[0], good)?),
        };
        Ok(Self {
            setting: setting.clone(),
            axis,
            machine,
            motions,
            every,
            templates,
            prediction,
        })
    }

    /// What its cases have in common.
    pub fn setting(&self) -> &CaseSetting {
        &self.setting
    }

    /// The machine of a case with its sizes as they stand there.
    pub(super) fn truth(&self, case: &Case) -> Truth {
        let hidden: Vec<ActiveEffect> = case.hidden.iter().filter_map(active).collect();
        let form = case.form.on(&self.axis, &hidden, case.form_at);
        let mut effects = hidden;
        effects.extend(form.unwrap_or_default());
        Truth {
            effects,
            shares: shares(&self.axis, case),
            noise: case.noise,
            wound: case.wound,
            seed: case.seed,
        }
    }

    /// A log as a set that is compared with the machine.
    pub(super) fn set(&self, place: usize, log: &Log) -> Result<LogSet, ReplayError> {
        let log = self.setting.channels.of(log)?;
        self.templates[place].again(vec![log], &self.machine)
    }

    /// The case with its sizes where they are to be, and what can be known of each of its
    /// effects beforehand; `None` of one that does not run on the nominal machine.
    pub(super) fn predicted(
        &self,
        case: &Case,
    ) -> Result<(Case, Vec<Option<PredictedEffect>>), ReplayError> {
        let mut case = case.clone();
        if case.hidden.is_empty() {
            return Ok((case, Vec::new()));
        }
        let noise = self
            .truth(&case)
            .noise_logs(&self.axis, &self.motions[0], self.every)?;
        match &self.prediction {
            Some(prediction) => {
                let (loud, of_channels) = self.loudness(&case, &noise)?;
                let supposed = |effects: Vec<ActiveEffect>| Hypothesis {
                    effects,
                    shares: shares(&self.axis, &case),
                    noise: loud,
                    of_channels: of_channels.clone(),
                    rejected: case.rejected.clone(),
                };
                let gain = |effect| prediction.gain_over_needed(&supposed(vec![effect]));
                let sized = self.sized(&case, gain);
                let all = supposed(sized.iter().filter_map(active).collect());
                case.hidden = sized;
                Ok((case, prediction.predict(&all)))
            }
            None => {
                let sight = Sight::new(&self.machine, &self.set(0, &noise[0])?)?;
                case.hidden = self.sized(&case, |e| sight.gain_over_needed(&e));
                let all: Vec<ActiveEffect> = case.hidden.iter().filter_map(active).collect();
                let predicted = sight.predict(&all, &case.rejected);
                Ok((case, predicted))
            }
        }
    }

    /// Hidden effects, each scaled until it alone would be seen as the case says.
    fn sized(
        &self,
        case: &Case,
        gain_over_needed: impl Fn(ActiveEffect) -> f64,
    ) -> Vec<crate::matrix::HiddenEffect> {
        let scales = Scales::of(&self.axis);
        let one = |(hidden, visible): (&crate::matrix::HiddenEffect, &f64)| {
            let seen = |by: f64| {
                let effect = active(&times_size(hidden, by, &scales));
                effect.map_or(f64::INFINITY, &gain_over_needed) >= *visible
            };
            times_size(hidden, scale_at(SCALES, seen), &scales)
        };
        case.hidden.iter().zip(&case.visible).map(one).collect()
    }

    /// The case's noise as a multiple of that of good sensors: white noise of that multiple
    /// in the loop hides what the case hides as well as its own noise does; and of each
    /// channel that is fitted, RMS.
    fn loudness(
        &self,
        case: &Case,
        [noisy, quiet]: &[Log; 2],
    ) -> Result<(f64, Vec<f64>), ReplayError> {
        let template = &self.templates[0];
        let layout = &template.layout;
        let white = Truth {
            noise: Rough::white(1.0),
            ..self.truth(case)
        };
        let [of_good, _] = white.noise_logs(&self.axis, &self.motions[0], self.every)?;
        let state = State::initial(&self.machine);
        let nominal = template.simulate(&self.machine, &state)?;
        let quiet = self.set(0, quiet)?.rest(&nominal);
        let noise = |log: &Log| -> Result<Rest, ReplayError> {
            let mut rest = self.set(0, log)?.rest(&nominal);
            let channels = rest
                .iter_mut()
                .zip(&quiet)
                .flat_map(|(a, b)| a.iter_mut().zip(b));
            channels.for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(a, b)| *a -= b));
            Ok(rest)
        };
        let (own, good) = (noise(noisy)?, noise(&of_good)?);
        let mut with = state;
        with.effects = case.hidden.iter().filter_map(active).collect();
        let traces = template.simulate(&self.machine, &with)?;
        let change = template.difference(&traces, &nominal, 1.0);
        let [in_own, in_good] = [&own, &good].map(|noise| {
            let matrices = layout.spectral_matrices(&template.amplitudes(noise));
            let whitened = layout.whiten(&layout.whitener(&matrices), &change);
            whitened.norm_squared()
        });
        let loud = (in_good / in_own).sqrt();
        let of_channel = |&c: &usize| (mean_square(&own, c) / mean_square(&good, c)).sqrt();
        let loud = match loud.is_finite() && loud > 0.0 {
            true => loud,
            false => case.noise.level,
        };
        Ok((loud, template.fitted.iter().map(of_channel).collect()))
    }
}

/// Of a channel, over all logs.
pub(super) fn mean_square(rest: &Rest, channel: usize) -> f64 {
    let samples = rest.iter().flat_map(|log| &log[channel]);
    let (sum, count) = samples.fold((0.0, 0), |(sum, n), r| (sum + r * r, n + 1));
    sum / f64::from(count.max(1))
}

fn unset(error: axis_sim::part::PartError) -> ReplayError {
    ReplayError::from(axis_sim::SetupError::from(error))
}
