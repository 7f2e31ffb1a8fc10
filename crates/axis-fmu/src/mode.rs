//! Where a unit is in the calling order.

use std::fmt;

/// State of the calling order (FMI 3.0.2, Sections 2.3 and 4.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Made, or reset.
    Instantiated,
    /// Between the two calls of the initialisation.
    Initialization,
    /// Ready for steps.
    Step,
    /// Ended by the environment.
    Terminated,
    /// Given up after an error.
    Failed,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "in initialization mode",
            Self::Step => "in step mode",
            Self::Terminated => "terminated",
            Self::Failed => "stopped by an error",
        })
    }
}
