//! One test program: S-curves, programs and their files.

mod axes;
mod bits;
mod file;
mod limits;
mod program;
mod scurve;
mod single_precision;
mod transfer;
mod transfer_cases;
mod velocity_change;
