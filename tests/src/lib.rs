//! Acceptance tests across the crates; see `tests/`.

/// The Rust of the book's pages, run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/use-a-crate.md")]
struct UseACrate;

/// The Rust of the README.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
