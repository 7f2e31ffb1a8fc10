use std::vec::Vec;

/// Why a training ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TrainingOutcome {
    /// The number of epochs asked for is done.
    EpochsDone,
    /// The loss reached the goal.
    GoalMet,
    /// The gradient fell to the limit.
    GradientSmall,
    /// The damping passed its limit: no step lowers the loss any more.
    DampingLimit,
    /// The loss or the gradient is no finite number, so there is no step to
    /// take: data lie too far outside the scaling's ranges for `f64`.
    NotFinite,
    /// Bayesian regularisation: α, β and the effective number of parameters
    /// have changed by less than the tolerance in each of five epochs.
    Settled,
    /// The validation loss has not improved for as long as the patience.
    ValidationStopped,
}

/// What one epoch did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpochReport {
    /// Number of the epoch, from 1.
    pub epoch: usize,
    /// Mean square of the scaled residuals after the epoch, over the training
    /// samples and all outputs.
    pub loss: f64,
    /// The same over the validation samples, if there are any.
    pub validation_loss: Option<f64>,
    /// Norm of the gradient before the step (see `TrainingSettings::min_gradient`).
    pub gradient: f64,
    /// Damping that the next epoch starts with.
    pub damping: f64,
    /// Trial steps, the one taken included.
    pub trials: usize,
    /// Under Bayesian regularisation what is estimated, after the epoch.
    pub hyperparameters: Option<Hyperparameters>,
}

/// The reports of all epochs so far.
pub type History = Vec<EpochReport>;

/// What Bayesian regularisation estimates beside the weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hyperparameters {
    /// Factor `α` of the sum of squared weights: `1/(2α)` is the variance of
    /// the weights.
    pub alpha: f64,
    /// Factor `β` of the sum of squared scaled residuals: `1/(2β)` is the
    /// variance of the noise, on scaled data.
    pub beta: f64,
    /// Effective number of parameters `γ`.
    pub effective_parameters: f64,
}
