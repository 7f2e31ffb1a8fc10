//! Why an identification was refused.

use thiserror::Error;

use crate::CompensatorError;

/// Why no model could be identified.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TransferFunctionError {
    /// A candidate, or the period, is not valid.
    #[error(transparent)]
    Setting(#[from] CompensatorError),
    /// There is nothing to choose from.
    #[error("no {0} given: at least one is needed")]
    Empty(&'static str),
    /// A motion's two series differ in length.
    #[error(
        "{set} motion {index} has {accelerations} accelerations and {errors} errors: they must be as many"
    )]
    Length {
        /// "training" or "validation".
        set: &'static str,
        /// Which motion, from 0.
        index: usize,
        /// Its accelerations.
        accelerations: usize,
        /// Its errors.
        errors: usize,
    },
    /// A motion was sampled at another period than the first.
    #[error(
        "{set} motion {index} has period {period} s: all must have that of the first, {first} s"
    )]
    Period {
        /// "training" or "validation".
        set: &'static str,
        /// Which motion, from 0.
        index: usize,
        /// Its period, s.
        period: f64,
        /// The first training motion's, s.
        first: f64,
    },
    /// A sample is no number whose square could be summed.
    #[error(
        "{set} motion {index}, sample {sample}: {what} = {value} is not valid: it must be from -1e100 to 1e100"
    )]
    Value {
        /// "training" or "validation".
        set: &'static str,
        /// Which motion, from 0.
        index: usize,
        /// Which sample, from 0.
        sample: usize,
        /// Which series.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// The training motions do not determine a single candidate.
    #[error(
        "the training motions determine no candidate: they need more samples than coefficients and an acceleration that is not always zero"
    )]
    Undetermined,
}
