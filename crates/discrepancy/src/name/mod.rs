//! Which effects of the library explain what a model leaves.

pub mod curves;
pub mod gap;
pub(crate) mod left;
pub mod library;
pub mod screen;
pub mod search;
pub mod terms;
