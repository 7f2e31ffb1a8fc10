//! One test program: S-curves, programs and their files.

mod axes;
mod bits;
mod file;
mod limits;
mod program;
mod scurve;
mod single_precision;
mod transfer;
mod velocity_change;
