use std::vec::Vec;

use super::bayes::{Fit, settled, squares};
use super::checkpoint::{Best, Checkpoint};
use super::dataset::{Dataset, SampleBlock, blocks};
use super::engine::{Engine, Step};
use super::initial::{Placement, adapt_first_layer, starting_weights};
use super::report::{EpochReport, History, Hyperparameters, TrainingOutcome};
use super::settings::{Initialisation, MIN_DAMPING, Normalisation, TrainingSettings};
use super::split::split;
use crate::error::{all_finite, same_length};
use crate::{Architecture, Error, Network, Scaling};

/// Ridge of the output layer's exact solution: as small as rounding allows.
const EXACT: f64 = 1e-13;
/// Ridge of the fitted start: moderate weights, from which training can move.
const MODERATE: f64 = 1e-4;

/// A training in progress: the caller asks for one epoch after the other.
#[derive(Debug)]
pub struct Trainer {
    settings: TrainingSettings,
    architecture: Architecture,
    scaling: Scaling,
    training: Vec<SampleBlock>,
    validation: Vec<SampleBlock>,
    engine: Engine,
    pool: Pool,
    /// All finite, at every moment.
    weights: Vec<f64>,
    sum_of_squares: f64,
    damping: f64,
    hyperparameters: Option<Hyperparameters>,
    best: Option<Best>,
    history: History,
    outcome: Option<TrainingOutcome>,
    fingerprint: u64,
}

/// The threads to work on: its own, or the caller's.
#[derive(Debug)]
struct Pool(Option<rayon::ThreadPool>);

impl Pool {
    fn new(settings: &TrainingSettings) -> Result<Self, Error> {
        if settings.caller_pool {
            return Ok(Self(None));
        }
        let threads = settings.threads;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        match pool.build() {
            Ok(pool) => Ok(Self(Some(pool))),
            Err(_) => Err(Error::Threads { threads }),
        }
    }

    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

impl Trainer {
    /// Prepares a training from new starting weights, of a [`crate::Shape`] or
    /// an [`Architecture`].
    ///
    /// # Errors
    /// What [`TrainingSettings::validate`] and [`Architecture::validate`] refuse,
    /// [`Error::TrainingMemory`], [`Error::Length`] if shape, scaling and
    /// data do not fit, or where the validation split leaves one side empty,
    /// [`Error::NotFinite`] if starting weights fitted to the data overflow;
    /// [`Error::Threads`].
    pub fn new(
        architecture: impl Into<Architecture>,
        scaling: Scaling,
        data: &Dataset,
        settings: TrainingSettings,
    ) -> Result<Self, Error> {
        let architecture = architecture.into();
        let weights = starting_weights(&architecture, settings.seed)?;
        let network = Network::new(architecture, scaling, weights)?;
        let mut trainer = Self::prepare(network, data, settings, data.fingerprint())?;
        trainer.initialise(data);
        all_finite("starting weights", &trainer.weights)?;
        trainer.enter();
        Ok(trainer)
    }

    /// Goes on from a checkpoint, with the same bits as without the break.
    ///
    /// # Errors
    /// [`Error::OtherData`] for data other than the checkpoint's, and as
    /// [`Trainer::new`].
    pub fn resume(data: &Dataset, checkpoint: Checkpoint) -> Result<Self, Error> {
        let found = data.fingerprint();
        if found != checkpoint.fingerprint {
            return Err(Error::OtherData {
                found,
                expected: checkpoint.fingerprint,
            });
        }
        let mut trainer = Self::prepare(checkpoint.current, data, checkpoint.settings, found)?;
        trainer.damping = checkpoint.damping;
        trainer.hyperparameters = checkpoint.hyperparameters;
        trainer.best = checkpoint.best;
        trainer.history = checkpoint.history;
        trainer.enter();
        trainer.outcome = trainer.judge();
        Ok(trainer)
    }

    fn prepare(
        network: Network,
        data: &Dataset,
        settings: TrainingSettings,
        fingerprint: u64,
    ) -> Result<Self, Error> {
        settings.validate()?;
        let architecture = network.architecture().clone();
        let shape = architecture.shape();
        same_length("inputs of the data", data.inputs(), shape.inputs)?;
        same_length("outputs of the data", data.outputs(), shape.outputs)?;
        let (training, validation) = split(data.len(), &settings)?;
        let scaling = network.scaling().clone();
        let training = blocks(data, &training, &scaling);
        Engine::check_memory(&architecture, training.len())?;
        Ok(Self {
            engine: Engine::new(&architecture, training.len()),
            pool: Pool::new(&settings)?,
            validation: blocks(data, &validation, &scaling),
            weights: network.weights().to_vec(),
            damping: settings.initial_damping,
            sum_of_squares: f64::INFINITY,
            hyperparameters: None,
            best: None,
            history: History::new(),
            outcome: None,
            training,
            settings,
            architecture,
            scaling,
            fingerprint,
        })
    }

    /// Starting weights other than Nguyen–Widrow's, which are there already.
    fn initialise(&mut self, data: &Dataset) {
        let shape = self.architecture.shape();
        let (unknowns, ridge) = match self.settings.initialisation {
            Initialisation::NguyenWidrow => return,
            Initialisation::LinearStart => (1 + shape.inputs, EXACT),
            Initialisation::DataAdapted { axis_aligned } => {
                if let [first, _, ..] = self.engine.layout.layers[..] {
                    // The split was possible a moment ago, so it is again.
                    let chosen = split(data.len(), &self.settings)
                        .map_or_else(|_| (0..data.len()).collect(), |(training, _)| training);
                    let seen = self.architecture.seen(0);
                    let inputs: Vec<usize> = (0..shape.inputs).filter(|i| seen[i + 1]).collect();
                    let place = Placement {
                        data,
                        chosen: &chosen,
                        scaling: &self.scaling,
                        inputs: &inputs,
                        axis_aligned,
                        seed: self.settings.seed,
                    };
                    adapt_first_layer(&mut self.weights, &first, &place);
                }
                (shape.activations(), MODERATE)
            }
        };
        let (engine, training, weights) = (&mut self.engine, &self.training, &mut self.weights);
        self.pool
            .install(|| engine.fit_output(training, weights, unknowns, ridge));
    }

    /// The loss at the present weights, and what Bayesian regularisation
    /// begins with, unless a checkpoint has it.
    fn enter(&mut self) {
        let (engine, training, weights) = (&mut self.engine, &self.training, &self.weights);
        self.sum_of_squares = self
            .pool
            .install(|| engine.sum_of_squares(training, weights));
        let before = self.hyperparameters;
        self.hyperparameters = (self.settings.bayesian)
            .map(|_| before.unwrap_or_else(|| Hyperparameters::initial(self.fit())));
    }

    fn fit(&self) -> Fit {
        let counted = |block: &SampleBlock| match &block.roots {
            None => block.rows,
            Some(roots) => roots.iter().filter(|&&root| root > 0.0).count(),
        };
        let samples: usize = self.training.iter().map(counted).sum();
        Fit {
            residuals: (samples * self.architecture.shape().outputs) as f64,
            parameters: self.engine.layout.trained() as f64,
            squares: self.sum_of_squares,
            weights: squares(&self.weights),
        }
    }

    /// One epoch of Levenberg–Marquardt: `JᵀJ` once, then trial steps with
    /// rising damping until one lowers the loss. Once the training has ended
    /// this does nothing and returns the last report.
    pub fn epoch(&mut self) -> EpochReport {
        if let (Some(_), Some(last)) = (self.outcome, self.history.last()) {
            return *last;
        }
        // The normal equations at the present weights.
        let (engine, training, weights) = (&mut self.engine, &self.training, &self.weights);
        self.pool
            .install(|| engine.normal_equations(training, weights));
        let mut gradient = self.engine.gradient_norm(self.factor(), self.decay());
        if gradient <= self.settings.min_gradient && self.hyperparameters.is_some() {
            // The minimum for these α and β: there may be others.
            self.estimate();
            gradient = self.engine.gradient_norm(self.factor(), self.decay());
        }

        // Trial steps, eq. of the paper: Δ = -(JᵀJ + μI)⁻¹ Jᵀr.
        let mut trials = 0;
        while gradient > self.settings.min_gradient && self.damping <= self.settings.max_damping {
            trials += 1;
            if self.try_step() {
                self.damping = (self.damping * self.settings.damping_decrease).max(MIN_DAMPING);
                break;
            }
            self.damping *= self.settings.damping_increase;
        }
        self.estimate_where_no_step_is_left();

        // Validation, report, verdict.
        let validation_loss = self.validate();
        let report = EpochReport {
            epoch: self.history.len() + 1,
            loss: self.loss(),
            validation_loss,
            gradient,
            damping: self.damping,
            trials,
            hyperparameters: self.hyperparameters,
        };
        self.history.push(report);
        self.outcome = self.judge();
        tracing::debug!(
            epoch = report.epoch,
            loss = report.loss,
            damping = report.damping
        );
        report
    }

    /// Runs until the training ends, telling each epoch to `each`.
    pub fn run(&mut self, mut each: impl FnMut(&EpochReport)) -> TrainingOutcome {
        loop {
            if let Some(outcome) = self.outcome {
                return outcome;
            }
            if self.history.len() >= self.settings.epochs {
                return TrainingOutcome::EpochsDone;
            }
            each(&self.epoch());
        }
    }

    /// Tries the step at the present damping; takes it if the loss (with
    /// Bayesian regularisation `β E_D + α E_W`) falls.
    fn try_step(&mut self) -> bool {
        let refit = self.settings.resolve_output;
        let unknowns = self.architecture.shape().activations();
        let (factor, damping) = (self.factor(), self.damping);
        let hyperparameters = self.hyperparameters;
        let performance = |sum: f64, weights: &[f64]| match hyperparameters {
            None => sum,
            Some(h) => h.performance(sum, squares(weights)),
        };
        let present = performance(self.sum_of_squares, &self.weights);
        let (engine, training, weights) = (&mut self.engine, &self.training, &self.weights);
        let trial = self.pool.install(|| {
            let step = engine.step(Step {
                factor,
                damping,
                decay: hyperparameters.map(|h| (h.alpha, &weights[..])),
            })?;
            let mut trial: Vec<f64> = weights.iter().zip(&step).map(|(w, d)| w + d).collect();
            if refit {
                engine.fit_output(training, &mut trial, unknowns, EXACT);
            }
            let sum = engine.sum_of_squares(training, &trial);
            Some((trial, sum))
        });
        match trial {
            // A NaN is not smaller than anything; an infinite weight can give
            // a finite loss, since tansig saturates.
            Some((trial, sum))
                if performance(sum, &trial) < present && trial.iter().all(|w| w.is_finite()) =>
            {
                let after = performance(sum, &trial);
                self.weights = trial;
                self.sum_of_squares = sum;
                let bayesian = self.settings.bayesian;
                if bayesian.is_some_and(|b| present - after < b.estimate_below * present) {
                    self.estimate();
                }
                true
            }
            _ => false,
        }
    }

    /// Where damping has passed its limit: if that changes α or β, the training
    /// goes on from the initial damping.
    fn estimate_where_no_step_is_left(&mut self) {
        let (Some(bayesian), Some(before)) = (self.settings.bayesian, self.hyperparameters) else {
            return;
        };
        if self.damping > self.settings.max_damping {
            self.estimate();
            let after = self.hyperparameters.unwrap_or(before);
            if !after.near(&before, bayesian.tolerance) {
                self.damping = self.settings.initial_damping;
            }
        }
    }

    /// New α, β and γ, with the `JᵀJ` of this epoch.
    fn estimate(&mut self) {
        let Some(before) = self.hyperparameters else {
            return;
        };
        let engine = &mut self.engine;
        let trace = (self.pool).install(|| engine.trace_of_inverse(before.beta, before.alpha));
        if let Some(trace) = trace {
            self.hyperparameters = Some(before.update(trace, self.fit()));
        }
    }

    fn validate(&mut self) -> Option<f64> {
        if self.validation.is_empty() {
            return None;
        }
        let (engine, blocks, weights) = (&mut self.engine, &self.validation, &self.weights);
        let sum = self.pool.install(|| engine.sum_of_squares(blocks, weights));
        let loss = sum / self.residuals(&self.validation);
        match &mut self.best {
            Some(best) if !improves(loss, best.loss) => best.age = best.age.saturating_add(1),
            best => {
                *best = Some(Best {
                    weights: self.weights.clone(),
                    loss,
                    age: 0,
                });
            }
        }
        Some(loss)
    }

    /// Why the training has ended, judged by its last report.
    fn judge(&self) -> Option<TrainingOutcome> {
        let settings = &self.settings;
        let last = self.history.last()?;
        let patience = settings.validation.map_or(usize::MAX, |v| v.patience);
        let validation_loss = last.validation_loss.unwrap_or(0.0);
        let numbers = [last.gradient, last.loss, validation_loss];
        if !numbers.iter().all(|v| v.is_finite()) {
            Some(TrainingOutcome::NotFinite)
        } else if last.gradient <= settings.min_gradient {
            Some(TrainingOutcome::GradientSmall)
        } else if last.damping > settings.max_damping {
            Some(TrainingOutcome::DampingLimit)
        } else if last.loss <= settings.goal {
            Some(TrainingOutcome::GoalMet)
        } else if (settings.bayesian).is_some_and(|b| settled(&self.history, b.tolerance)) {
            Some(TrainingOutcome::Settled)
        } else if self.best.as_ref().is_some_and(|b| b.age >= patience) {
            Some(TrainingOutcome::ValidationStopped)
        } else if self.history.len() >= settings.epochs {
            Some(TrainingOutcome::EpochsDone)
        } else {
            None
        }
    }

    /// Why the training has ended; none while it goes on.
    #[must_use]
    pub fn outcome(&self) -> Option<TrainingOutcome> {
        self.outcome
    }

    /// Mean square of the scaled residuals over the training samples, now;
    /// each square times its sample's weight.
    #[must_use]
    pub fn loss(&self) -> f64 {
        self.sum_of_squares / self.residuals(&self.training)
    }

    /// What Bayesian regularisation has estimated so far; none without it.
    #[must_use]
    pub fn hyperparameters(&self) -> Option<Hyperparameters> {
        self.hyperparameters
    }

    /// Reports of all epochs so far.
    #[must_use]
    pub fn history(&self) -> &[EpochReport] {
        &self.history
    }

    /// The network: at the best validation loss where there is a validation
    /// split, as it is now otherwise.
    #[must_use]
    pub fn network(&self) -> Network {
        let weights = self.best.as_ref().map_or(&self.weights, |b| &b.weights);
        self.network_of(weights)
    }

    /// The network at the last epoch, whatever its validation loss.
    #[must_use]
    pub fn latest_network(&self) -> Network {
        self.network_of(&self.weights)
    }

    /// Everything from which [`Trainer::resume`] goes on.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            settings: self.settings.clone(),
            current: self.latest_network(),
            damping: self.damping,
            hyperparameters: self.hyperparameters,
            best: self.best.clone(),
            history: self.history.clone(),
            fingerprint: self.fingerprint,
        }
    }

    fn network_of(&self, weights: &[f64]) -> Network {
        let architecture = self.architecture.clone();
        Network::from_valid(architecture, self.scaling.clone(), weights.to_vec())
    }

    fn residuals(&self, blocks: &[SampleBlock]) -> f64 {
        (blocks.iter().map(|b| b.rows).sum::<usize>() * self.architecture.shape().outputs) as f64
    }

    /// Factor on the squares of the weights, with the weights.
    fn decay(&self) -> Option<(f64, &[f64])> {
        self.hyperparameters.map(|h| (h.alpha, &self.weights[..]))
    }

    /// Factor on `JᵀJ`.
    fn factor(&self) -> f64 {
        if let Some(h) = self.hyperparameters {
            return h.beta;
        }
        match self.settings.normalisation {
            Normalisation::Sum => 1.0,
            Normalisation::Mean => 1.0 / self.residuals(&self.training),
        }
    }
}

/// Whether a loss is lower than the best so far, be that NaN.
fn improves(loss: f64, best: f64) -> bool {
    loss < best || best.is_nan()
}
