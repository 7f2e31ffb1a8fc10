//! One test program: searches on machines with something hidden in them.

mod clocks;
mod hidden;
mod machines;
mod matrix;
mod matrix2;
mod noise;
