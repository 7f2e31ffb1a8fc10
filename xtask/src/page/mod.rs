//! Pages on the matrices of hidden effects.

pub mod matrix;
pub mod matrix2;
