//! One test program.

mod analytic;
mod measured;
mod support;
mod sweep;
mod tune;
