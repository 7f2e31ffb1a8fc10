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
    /// A layer without neurons, or a network without inputs or outputs.
    #[error("{what}[{index}] is 0: must be at least 1")]
    EmptyLayer {
        /// Which list of sizes.
        what: &'static str,
        /// Position in that list.
        index: usize,
    },
    /// The network would have more parameters than can be addressed sensibly.
    #[error("shape has more than {limit} parameters")]
    TooLarge {
        /// The largest number of parameters accepted.
        limit: usize,
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
