//! Why something cannot be exported.

use thiserror::Error;

/// Why there is no export.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// There is no such strategy, or it does nothing.
    #[error("there is no strategy \"{name}\" that a controller can run; valid: {valid}")]
    NoStrategy {
        /// The name asked for.
        name: String,
        /// Names that can be exported.
        valid: String,
    },
    /// The strategy learns between moves, which is the work of a host.
    #[error(
        "the strategy \"{name}\" learns between moves, from logs: that is the work of a host. What it has learned can be exported: the strategy {instead}, with the adapted model as its model; valid: {valid}"
    )]
    LearnsBetweenMoves {
        /// The name asked for.
        name: String,
        /// What runs cycle by cycle of it.
        instead: &'static str,
        /// Names that can be exported.
        valid: String,
    },
    /// The strategy is for drives that take constants.
    #[error(
        "the strategy \"{name}\" is for drives that take constants and tables: `export drive` writes them, and there is no C code of it; valid: {valid}"
    )]
    ForDrives {
        /// The name asked for.
        name: String,
        /// Names that can be exported.
        valid: String,
    },
    /// The name cannot stand in C.
    #[error(
        "the name \"{name}\" cannot be that of the code: {why}; valid: lower-case letters, digits and _, a letter first, at most 31, no word of C or C++"
    )]
    Name {
        /// The name.
        name: String,
        /// What is wrong with it.
        why: String,
    },
    /// Something of the strategy has no counterpart in C.
    #[error("the strategy \"{name}\" of this axis cannot be exported: {what}; valid: {valid}")]
    Unsupported {
        /// The strategy.
        name: String,
        /// What there is no C for.
        what: &'static str,
        /// What there is C for.
        valid: String,
    },
    /// The strategy cannot be made of the predictors.
    #[error("nothing can be exported: {0}")]
    Pipeline(#[from] axis_pipeline::PipelineError),
    /// A setting of the compensator or of its guard is not valid in this precision.
    #[error("nothing can be exported: {0}")]
    Compensator(#[from] compensator::CompensatorError),
    /// The friction law is not valid in this precision.
    #[error("the friction law cannot be exported: {0}")]
    Friction(#[from] lugre::LugreError),
    /// The network is not valid in this precision.
    #[error("the network cannot be exported: {0}")]
    Network(#[from] cfnn::Error),
}
