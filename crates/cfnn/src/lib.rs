#![no_std]
//! Cascade-forward and feed-forward networks: evaluation, derivatives, and
//! Levenberg–Marquardt training, plain or with Bayesian regularisation.
//!
//! # The problem
//!
//! A cascade-forward network maps `x` (`I` numbers) to `y` (`O` numbers). Each
//! layer sees the inputs and the outputs of all earlier layers. With
//! `a₀ = [1, x̂]`, hidden layers `l = 1..L` and output layer `L + 1`:
//!
//! ```text
//! h_l = tanh(W_lᵀ a_{l-1}),   a_l = [a_{l-1}, h_l]        (tansig, l ≤ L)
//! ŷ   = W_{L+1}ᵀ a_L                                      (purelin)
//! x̂_i = 2 (x_i - min_i) / (max_i - min_i) - 1             (mapminmax)
//! ```
//!
//! and `y` from `ŷ` by the inverse of the same scaling. `W_l` has one row for
//! each number that the layer sees (the bias first) and one column for each
//! of its neurons. Training minimises `F = ½ Σ r²` over the residuals
//! `r = ŷ - t̂` of all samples and outputs by Levenberg–Marquardt,
//!
//! ```text
//! Δ = -(JᵀJ + μ I)⁻¹ Jᵀ r .
//! ```
//!
//! An [`Architecture`] has fewer links (plain feed-forward, inputs left out)
//! or other transfer functions than this.
//!
//! The network as Liu, Guo, Liu and Niu use it: Machines 2025, 13(5), 433,
//! section 4.3, doi 10.3390/machines13050433.
//!
//! # Symbols, shapes and units
//!
//! `x`, `y`: inputs and outputs, in the caller's units; `x̂`, `ŷ`, `t̂`: the same and the targets,
//! scaled to `[-1, 1]`, without units, as is all inside. `a_l`: what layer `l + 1` sees; `h_l`: outputs of
//! layer `l`; `J`: derivatives of all residuals by all weights; `μ`: damping of a step `Δ`. Tables of samples are row-major, one sample a row.
//! The weights are one list: layer after layer, and within a layer row by row
//! of `W_l`, so the parameter from activation `i` to neuron `j` of a layer of
//! `H` neurons is the layer's number `i H + j`. Activation 0 is the constant
//! 1, then come the inputs, then the hidden layers' outputs. A network
//! 4-34-19-8-1 has 1441 parameters.
//!
//! # Example
//!
//! ```
//! # #[cfg(feature = "train")] {
//! use cfnn::train::{Dataset, Trainer, TrainingSettings};
//! use cfnn::{Predictor, Shape};
//!
//! // y = x + tanh(3 x) on 200 samples.
//! let x: Vec<f64> = (0..200).map(|i| f64::from(i) / 100.0 - 1.0).collect();
//! let y: Vec<f64> = x.iter().map(|x| x + (3.0 * x).tanh()).collect();
//! let data = Dataset::new(1, 1, x, y)?;
//!
//! let shape = Shape { inputs: 1, hidden: vec![3, 2], outputs: 1 };
//! let settings = TrainingSettings { epochs: 100, ..TrainingSettings::default() };
//! let mut trainer = Trainer::new(shape, data.scaling()?, &data, settings)?;
//! trainer.run(|report| println!("epoch {}: loss {:.1e}", report.epoch, report.loss));
//!
//! let mut predictor = Predictor::<1, 1>::new(trainer.network())?;
//! let [y] = predictor.predict(&[0.5]);
//! assert!((y - (0.5 + 1.5f64.tanh())).abs() < 1e-3);
//! # }
//! # Ok::<(), cfnn::Error>(())
//! ```
//!
//! # Features
//!
//! Without features the crate is `no_std` without an allocator:
//! [`FixedNetwork`] borrows its weights and evaluates in `f64` or `f32`.
//! `alloc` adds [`Network`]; `simd` (needs std) finds the processor's vector
//! instructions at run time; `train` (needs std) adds training on faer;
//! `serde` adds networks and settings in any of its formats; `artifact`
//! (needs std) adds networks and checkpoints as bytes with a hash.
//!
//! # What this crate knows nothing of
//!
//! Axes, units, trajectories, where samples come from, files and folders, and
//! progress bars: the caller drives the epochs and writes the bytes.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

#[cfg(feature = "alloc")]
mod architecture;
#[cfg(feature = "artifact")]
pub mod artifact;
mod backward;
#[cfg(feature = "alloc")]
mod derivatives;
mod error;
mod fixed;
mod forward;
#[cfg(feature = "alloc")]
mod network;
mod pack;
mod range;
mod real;
#[cfg(feature = "alloc")]
mod scaling;
#[cfg(feature = "serde")]
mod serialised;
#[cfg(feature = "alloc")]
mod shape;
#[cfg(feature = "alloc")]
mod simd;
mod tansig;
#[cfg(feature = "train")]
pub mod train;
mod transfer;

#[cfg(feature = "alloc")]
pub use architecture::{Architecture, Links};
pub use error::Error;
pub use fixed::FixedNetwork;
#[cfg(feature = "alloc")]
pub use network::{Network, Predictor, Scratch};
pub use pack::{pack, packed_len};
pub use range::ScalingRange;
pub use real::NetworkScalar;
#[cfg(feature = "alloc")]
pub use scaling::Scaling;
#[cfg(feature = "alloc")]
pub use shape::{Layer, MAX_PARAMETERS, Shape};
pub use transfer::{Activation, AllTansig, Transfers};

/// The README's examples, run as tests.
#[cfg(all(doctest, feature = "train"))]
#[doc = include_str!("../README.md")]
struct Readme;
