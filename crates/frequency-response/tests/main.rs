//! Truths here are closed forms, in code of their own: exact recursions of oscillators, their responses by
//! hand, noise of another generator than the crate's.

mod estimates;
mod excitations;
mod fits;
mod machine;
mod margins;
mod refusals;
#[cfg(feature = "serde")]
mod stored;
