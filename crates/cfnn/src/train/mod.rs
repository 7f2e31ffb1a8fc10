//! Levenberg–Marquardt training, plain or with Bayesian regularisation.
//!
//! All work is in `f64` on scaled data. An epoch forms `JᵀJ` once and then
//! tries steps at rising damping `μ` until one lowers the loss: `μ` times
//! `damping_increase` after a failure, times `damping_decrease` after a
//! success (Hagan and Menhaj 1994, doi 10.1109/72.329697; the factors 10 and
//! 0.1 are MATLAB's `trainlm`).
//!
//! The Jacobian is never formed. Its entry for the weight from activation `i`
//! to neuron `p` is `δ_p a_i`, so `JᵀJ` follows from the products of pairs of
//! deltas and pairs of activations, 256 samples at a time; equal entries are
//! computed once. The memory beyond the samples does not grow with their
//! number.
//!
//! The bits of the result depend on data, settings and seed, not on the
//! number of threads: work is cut by sizes alone, and every sum has a fixed
//! order.
//!
//! With [`TrainingSettings::regularised`] the weights are kept small by as much
//! as the data ask for, without samples set apart (MATLAB's `trainbr`): for
//! few, noisy samples.
//!
//! ```
//! use cfnn::train::{Dataset, Trainer, TrainingSettings};
//! use cfnn::Shape;
//! // A line with an error that alternates: two parameters' worth.
//! let x: Vec<f64> = (0..20).map(f64::from).collect();
//! let y = x.iter().enumerate().map(|(i, x)| x + if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
//! let data = Dataset::new(1, 1, x, y)?;
//! let settings = TrainingSettings::regularised();
//! let shape = Shape { inputs: 1, hidden: vec![8], outputs: 1 };
//! let mut trainer = Trainer::new(shape, data.scaling()?, &data, settings)?;
//! trainer.run(|_| ());
//! let found = trainer.hyperparameters().ok_or("no regularisation")?;
//! assert!(found.effective_parameters < 5.0, "of 26: {found:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! For a map that is almost linear, start with
//! [`Initialisation::LinearStart`] or [`Initialisation::DataAdapted`] and set
//! `resolve_output`: the output layer, whose links carry the linear part, is
//! then exact in every trial step. Set `min_gradient` to 0 as well: where the
//! linear map leaves a residual of 1e-4, all gradients are small.
//!
//! ```
//! use cfnn::train::{Dataset, Initialisation, TrainingOutcome, Trainer, TrainingSettings};
//! use cfnn::Shape;
//! let x: Vec<f64> = (0..100).map(|i| f64::from(i) / 50.0 - 1.0).collect();
//! let y = x.iter().map(|x| 2.0 * x + 1e-4 * (9.0 * x).tanh()).collect();
//! let data = Dataset::new(1, 1, x, y)?;
//! let settings = TrainingSettings {
//!     epochs: 100,
//!     initialisation: Initialisation::LinearStart,
//!     resolve_output: true,
//!     min_gradient: 0.0,
//!     ..TrainingSettings::default()
//! };
//! let shape = Shape { inputs: 1, hidden: vec![6, 3], outputs: 1 };
//! let mut trainer = Trainer::new(shape, data.scaling()?, &data, settings)?;
//! let linear = trainer.loss();
//! trainer.epoch();
//! // Between epochs the state can be kept, and training resumed from it.
//! let mut trainer = Trainer::resume(&data, trainer.checkpoint())?;
//! let outcome = trainer.run(|_| ());
//! assert_ne!(outcome, TrainingOutcome::GoalMet); // the goal is 0
//! assert!(trainer.loss() < 1e-6 * linear);
//! # Ok::<(), cfnn::Error>(())
//! ```

mod bayes;
mod block;
mod checkpoint;
mod cholesky;
mod dataset;
mod engine;
mod gram;
mod initial;
mod output_fit;
mod report;
mod settings;
mod split;
#[cfg(test)]
mod tests;
mod trainer;

#[cfg(feature = "artifact")]
pub(crate) use checkpoint::Best;
pub use checkpoint::Checkpoint;
pub use dataset::Dataset;
pub use engine::MAX_TRAINING_BYTES;
pub use initial::{nguyen_widrow, starting_weights};
pub use report::{EpochReport, History, Hyperparameters, TrainingOutcome};
pub use settings::{Bayesian, EarlyStopping, Initialisation, Normalisation, TrainingSettings};
pub use trainer::Trainer;
