//! Arithmetic that several modules share; nothing here knows what a channel is.

pub(crate) mod align;
pub(crate) mod grid;
pub(crate) mod holes;
pub(crate) mod lag;
pub(crate) mod order;
pub(crate) mod resample;
pub(crate) mod welch;
pub(crate) mod wrap;
