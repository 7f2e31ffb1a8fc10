//! One test program: evaluation, derivatives, training and artifacts of networks.

#[cfg(feature = "train")]
mod architecture;
#[cfg(all(feature = "train", feature = "artifact"))]
mod artifact;
#[cfg(feature = "train")]
mod bayes;
mod bits;
#[cfg(feature = "train")]
mod derivatives;
#[cfg(feature = "train")]
mod evaluation;
#[cfg(feature = "train")]
mod limits;
#[cfg(feature = "train")]
mod sample_weights;
#[cfg(all(feature = "train", feature = "serde"))]
mod serialised;
#[cfg(feature = "train")]
mod support;
#[cfg(feature = "train")]
mod training;
