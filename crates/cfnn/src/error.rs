use thiserror::Error;

/// Why a network, a scaling, a data set or a training could not be made.
///
/// Everything is checked when a value is constructed; evaluation and training
/// themselves cannot fail afterwards, apart from the length checks of the
/// slice-based calls.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A slice or a count has the wrong size.
    #[error("{what}: found {found}, must be {expected}")]
    Length {
        /// What was counted.
        what: &'static str,
        /// The size found.
        found: usize,
        /// The size that would be valid.
        expected: usize,
    },
    /// A layer without neurons, a network without inputs or outputs, or a
    /// table without a whole row of samples.
    #[error("{what}[{index}] is 0: must be at least 1")]
    EmptyLayer {
        /// Which list of sizes.
        what: &'static str,
        /// Position in that list.
        index: usize,
    },
    /// The network would have too many parameters.
    #[error("shape has {found} parameters: must be at most {limit}")]
    TooLarge {
        /// Parameters of the shape; `usize::MAX` stands for that many or more.
        found: usize,
        /// The largest number of parameters accepted.
        limit: usize,
    },
    /// Training a network of this shape would need too much memory.
    #[error(
        "training this shape takes {bytes} bytes beside the samples: must be at most {limit}, so fewer neurons, inputs or outputs"
    )]
    TrainingMemory {
        /// Bytes that the training would need beside the samples.
        bytes: u64,
        /// Most bytes accepted.
        limit: u64,
    },
    /// A table of derivatives would need too much memory.
    #[error("these derivatives take {bytes} bytes: must be at most {limit}, so fewer rows at once")]
    DerivativeMemory {
        /// Bytes of the table; `u64::MAX` stands for that many or more.
        bytes: u64,
        /// Most bytes accepted.
        limit: u64,
    },
    /// A number that is NaN or infinite.
    #[error("{what}[{index}] is {value}: must be finite")]
    NotFinite {
        /// Which list of numbers.
        what: &'static str,
        /// Position in that list.
        index: usize,
        /// The number found.
        value: f64,
    },
    /// A weight of a link that the architecture does not have.
    #[error("weights[{index}] is {value}: must be 0, since the architecture has no such link")]
    AbsentLink {
        /// Index of the weight.
        index: usize,
        /// The weight found.
        value: f64,
    },
    /// Inputs of which none would be left, or that do not exist.
    #[error("dropped inputs: {found} of {inputs}, must be other than all, each below {inputs}")]
    DroppedInputs {
        /// Number of inputs to be dropped.
        found: usize,
        /// Inputs of the shape.
        inputs: usize,
    },
    /// Hidden layers of another transfer function than tansig, where only
    /// that is possible.
    #[error("hidden layer {layer} is not tansig: must be tansig here")]
    NotTansig {
        /// The layer, counted from 0.
        layer: usize,
    },
    /// A number below zero, or a list in which none is above it.
    #[error("{what}[{index}] is {value}: must be 0 or above, and one of them above 0")]
    Negative {
        /// Which list of numbers.
        what: &'static str,
        /// Position in that list.
        index: usize,
        /// The number found.
        value: f64,
    },
    /// A scaling range without width.
    #[error(
        "{what} range [{minimum}, {maximum}]: the minimum must lie below the maximum, both finite"
    )]
    Range {
        /// Which side of the network: `"input"` or `"output"`.
        what: &'static str,
        /// Lower end found.
        minimum: f64,
        /// Upper end found.
        maximum: f64,
    },
    /// A training setting outside its domain.
    #[error("setting {name} is {value}: must be {valid}")]
    Setting {
        /// Field of the settings.
        name: &'static str,
        /// The value found.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A checkpoint that was made with other data.
    #[error(
        "the checkpoint belongs to another data set (fingerprint {found:#018x}, checkpoint has {expected:#018x})"
    )]
    OtherData {
        /// Fingerprint of the data set given.
        found: u64,
        /// Fingerprint stored in the checkpoint.
        expected: u64,
    },
    /// The thread pool could not be started.
    #[error("could not start {threads} worker threads")]
    Threads {
        /// Number of threads asked for.
        threads: usize,
    },
}

/// Refuses the first number that is NaN or infinite.
#[cfg(feature = "alloc")]
pub(crate) fn all_finite(what: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(Error::NotFinite {
            what,
            index,
            value: values[index],
        }),
        None => Ok(()),
    }
}

/// Number of rows of a row-major table, which must be whole rows.
#[cfg(feature = "alloc")]
pub(crate) fn rows_of(what: &'static str, values: &[f64], width: usize) -> Result<usize, Error> {
    let rows = values.len().checked_div(width).unwrap_or(0);
    if rows == 0 {
        return Err(Error::EmptyLayer {
            what: "samples",
            index: 0,
        });
    }
    // rows * width is at most the length: no overflow.
    same_length(what, values.len(), rows * width)?;
    Ok(rows)
}

/// Refuses a size other than the one expected.
pub(crate) fn same_length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::Length {
            what,
            found,
            expected,
        })
    }
}
