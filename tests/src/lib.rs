//! Acceptance tests across the crates; see `tests/`.
