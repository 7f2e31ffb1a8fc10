//! One test program: evaluation, training and artifacts of networks.

#[cfg(all(feature = "train", feature = "artifact"))]
mod artifact;
mod bits;
#[cfg(feature = "train")]
mod evaluation;
#[cfg(feature = "train")]
mod limits;
#[cfg(feature = "train")]
mod training;
