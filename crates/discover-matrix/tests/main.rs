//! One test program: searches on machines with something hidden in them.

mod hidden;
mod matrix;
mod matrix2;
