//! One file a command.

pub mod bench;
pub mod discover_matrix;
mod discover_matrix2;
pub mod independent;
pub mod layers;
mod matrix_job;
pub mod peers_cases;
pub mod torture;
