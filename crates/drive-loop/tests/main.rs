//! One test program.

mod analytic;
mod support;
mod sweep;
mod tune;
