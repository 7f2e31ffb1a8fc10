//! What the functions of both versions answer.

use std::ffi::{CStr, c_void};

/// An address that is only passed on, or never looked at.
pub type Address = *mut c_void;

/// `fmi3Status` and `fmi2Status`, whose numbers are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// What is asked for is not known (in FMI 2.0 alone).
    Discard = 2,
    /// The call was refused or stopped; the message went to the logger.
    Error = 3,
}

impl Status {
    /// The category of its messages, which the description declares.
    pub fn category(self) -> &'static CStr {
        match self {
            Self::Discard => c"logStatusDiscard",
            Self::Ok | Self::Error => c"logStatusError",
        }
    }
}
