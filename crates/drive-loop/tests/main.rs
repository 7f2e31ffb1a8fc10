//! One test program.

mod analytic;
mod compliance;
mod five_machines;
mod machines;
mod measured;
mod support;
mod sweep;
mod tune;
