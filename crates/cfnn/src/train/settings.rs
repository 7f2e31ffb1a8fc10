use crate::Error;

/// Below this the damping no longer changes `JᵀJ` and is not lowered further.
pub(super) const MIN_DAMPING: f64 = 1e-20;
/// So large that neither the damping nor its product with a factor overflows.
pub(super) const MAX_DAMPING: f64 = 1e100;
const MAX_THREADS: usize = 1024;

/// Starting weights.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Initialisation {
    /// Nguyen and Widrow (1990), doi 10.1109/IJCNN.1990.137819, as MATLAB's
    /// `initnw` does it; random output layer in `[-1, 1]`.
    NguyenWidrow,
    /// Hidden layers as [`Initialisation::NguyenWidrow`]; output layer: the
    /// least-squares affine map of the inputs, other links zero. Training
    /// starts at the best linear map.
    LinearStart,
    /// First hidden layer placed by the samples: centres at random samples,
    /// slopes from the spacing of the samples around them, at scales from a
    /// neuron's share of the samples up to all of them. So neurons are dense
    /// and steep where the samples are. Meant for use with
    /// [`TrainingSettings::resolve_output`]; the joint step alone moves steep neurons
    /// slowly. Later hidden layers as
    /// [`Initialisation::NguyenWidrow`]; output layer fitted by least squares.
    DataAdapted {
        /// Share of the first layer's neurons that look along one input only,
        /// the inputs in turn, 0 to 1.
        axis_aligned: f64,
    },
}

/// What the damping is added to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Normalisation {
    /// `JᵀJ + μ I` of the sum of squares, as the paper prints it.
    Sum,
    /// `JᵀJ / m + μ I` with `m` residuals: the damping's meaning does not
    /// depend on the number of samples.
    Mean,
}

/// Early stopping on samples set apart.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct EarlyStopping {
    /// Share of the samples set apart, above 0 and below 1; drawn from the
    /// seed.
    pub fraction: f64,
    /// Epochs without a new best validation loss after which training stops;
    /// at least 1.
    pub patience: usize,
}

/// Bayesian regularisation, MATLAB's `trainbr`: the training minimises
/// `β Σ r² + α Σ w²` and estimates α and β from the data (see
/// [`super::Hyperparameters`]). Samples set apart are not needed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Bayesian {
    /// Training stops when α, β and the effective number of parameters have
    /// changed by this, relative, or less in each of five epochs; 0: never
    /// for this reason.
    pub tolerance: f64,
    /// α and β are estimated anew after a step that lowers `β Σ r² + α Σ w²`
    /// by less than this share; above 0, at most 1: after each
    /// step, with which a training of few samples can end at a map that is
    /// almost linear.
    pub estimate_below: f64,
}

impl Default for Bayesian {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            estimate_below: 0.01,
        }
    }
}

/// Settings of a training. The defaults are MATLAB's `trainlm` ones, with its
/// validation switched off.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", default, deny_unknown_fields)
)]
pub struct TrainingSettings {
    /// Number of epochs after which to stop.
    pub epochs: usize,
    /// Initial damping μ (the paper's u, there called learning rate), in the
    /// units of `JᵀJ` on scaled data; from 1e-20, below which it would not
    /// change `JᵀJ`, to 1e100.
    pub initial_damping: f64,
    /// Factor on μ after a trial step that does not lower the loss; from 1.1,
    /// so that an epoch has few thousand trial steps at most, to 1e100.
    pub damping_increase: f64,
    /// Factor on μ after a step taken; above 0, at most 1.
    pub damping_decrease: f64,
    /// μ above which training stops; above 0, at most 1e100.
    pub max_damping: f64,
    /// Training stops at or below this mean square of the scaled residuals.
    pub goal: f64,
    /// Training stops at or below this Euclidean norm of `Jᵀr` (divided by
    /// the number of residuals under [`Normalisation::Mean`]; of
    /// `β Jᵀr + α w` with Bayesian regularisation).
    pub min_gradient: f64,
    /// Early stopping, or none.
    pub validation: Option<EarlyStopping>,
    /// What the damping is added to.
    pub normalisation: Normalisation,
    /// Starting weights.
    pub initialisation: Initialisation,
    /// Solve the output layer exactly, by least squares, in every trial step
    /// (the step of the hidden layers still comes from all parameters).
    pub resolve_output: bool,
    /// Bayesian regularisation, or none. Only with [`Normalisation::Sum`] and
    /// without `resolve_output`.
    pub bayesian: Option<Bayesian>,
    /// Seed of the starting weights and of the validation split.
    pub seed: u64,
    /// Worker threads, at most 1024; 0 takes all cores. No influence on the
    /// result's bits.
    pub threads: usize,
    /// Start no threads, but work in those of the caller: the pool whose
    /// `install` calls the trainer, or else rayon's global one. `threads` has
    /// no meaning then. No influence on the result's bits either.
    pub caller_pool: bool,
}

impl Default for TrainingSettings {
    fn default() -> Self {
        Self {
            epochs: 1000,
            initial_damping: 1e-3,
            damping_increase: 10.0,
            damping_decrease: 0.1,
            max_damping: 1e10,
            goal: 0.0,
            min_gradient: 1e-7,
            validation: None,
            normalisation: Normalisation::Sum,
            initialisation: Initialisation::NguyenWidrow,
            resolve_output: false,
            bayesian: None,
            seed: 0,
            threads: 0,
            caller_pool: false,
        }
    }
}

impl TrainingSettings {
    /// The defaults with [`Bayesian`] regularisation, and an initial damping of
    /// 1: weights that the data leave open then shrink over some epochs, not
    /// at once.
    #[must_use]
    pub fn regularised() -> Self {
        Self {
            bayesian: Some(Bayesian::default()),
            initial_damping: 1.0,
            ..Self::default()
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::Setting`] with the first field outside its domain.
    pub fn validate(&self) -> Result<(), Error> {
        let check = |name, value: f64, good: bool, valid| {
            if good {
                Ok(())
            } else {
                Err(Error::Setting { name, value, valid })
            }
        };
        let v = self.initial_damping;
        let good = (MIN_DAMPING..=MAX_DAMPING).contains(&v);
        check("initial_damping", v, good, "from 1e-20 to 1e100")?;
        let v = self.damping_increase;
        let good = (1.1..=MAX_DAMPING).contains(&v);
        check("damping_increase", v, good, "from 1.1 to 1e100")?;
        let v = self.damping_decrease;
        let good = v > 0.0 && v <= 1.0;
        check("damping_decrease", v, good, "above 0 and at most 1")?;
        let v = self.max_damping;
        let good = v > 0.0 && v <= MAX_DAMPING;
        check("max_damping", v, good, "above 0 and at most 1e100")?;
        check("goal", self.goal, self.goal >= 0.0, "0 or above")?;
        let v = self.min_gradient;
        check("min_gradient", v, v >= 0.0, "0 or above")?;
        if let Some(validation) = self.validation {
            let v = validation.fraction;
            let good = v > 0.0 && v < 1.0;
            check("validation.fraction", v, good, "above 0 and below 1")?;
            let v = validation.patience;
            check("validation.patience", v as f64, v >= 1, "at least 1")?;
        }
        if let Initialisation::DataAdapted { axis_aligned: v } = self.initialisation {
            let good = (0.0..=1.0).contains(&v);
            check("initialisation.axis_aligned", v, good, "from 0 to 1")?;
        }
        let v = self.threads;
        check("threads", v as f64, v <= MAX_THREADS, "at most 1024")?;
        if let Some(bayesian) = self.bayesian {
            let v = bayesian.tolerance;
            check("bayesian.tolerance", v, v >= 0.0, "0 or above")?;
            let v = bayesian.estimate_below;
            let good = v > 0.0 && v <= 1.0;
            check("bayesian.estimate_below", v, good, "above 0 and at most 1")?;
            let (name, valid) = ("resolve_output", "false with Bayesian regularisation");
            check(name, 1.0, !self.resolve_output, valid)?;
            let (name, valid) = ("normalisation", "the sum with Bayesian regularisation");
            check(name, 1.0, self.normalisation == Normalisation::Sum, valid)?;
        }
        Ok(())
    }
}
