//! Looking at logs before anything is concluded from them.

mod admit;
mod apart;
mod checks;
mod error;
mod relations;
mod shared;
mod standstill;
mod start;

pub use self::admit::{admit, most_samples, needed_channels};
pub use self::apart::{NamedLog, set_apart};
pub use self::checks::{check_distinct, check_log};
pub use self::error::LogSetError;
pub use self::relations::{cross_checks, relations};
pub use self::start::from_rest;
