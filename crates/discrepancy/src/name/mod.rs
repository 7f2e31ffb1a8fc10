//! Which effects of the library explain what a model leaves.

pub mod curves;
pub mod gap;
pub mod library;
pub mod screen;
pub mod search;
pub mod terms;
pub(crate) mod transfer;
