//! Why parameters make no friction law.

use thiserror::Error;

/// Which parameter makes no law, and what would.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum FrictionError {
    /// A parameter is NaN, infinite or outside its range.
    #[error("friction parameter `{field}` is {value}, but must be {valid}")]
    Invalid {
        /// The field, as it is called in the parameters.
        field: &'static str,
        /// The value found, exactly, whatever the scalar.
        value: f64,
        /// What would be accepted.
        valid: &'static str,
    },
    /// A break-away level lies below the Coulomb level of the same direction.
    #[error(
        "friction parameter `{direction}.stiction` is {stiction}, but must be at least \
         `{direction}.coulomb` = {coulomb}"
    )]
    StictionBelowCoulomb {
        /// `"forward"` or `"backward"`.
        direction: &'static str,
        /// The break-away level, N or N·m.
        stiction: f64,
        /// The Coulomb level, N or N·m.
        coulomb: f64,
    },
}
