//! One test program.

mod analytic;
mod compliance;
mod measured;
mod support;
mod sweep;
mod tune;
