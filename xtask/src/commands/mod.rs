//! One file a command.

pub mod bench;
pub mod compensate;
mod compensate_moves;
pub mod discover;
pub mod discover_matrix;
mod discover_matrix2;
pub mod export_drive;
pub mod identify;
pub mod independent;
pub mod layers;
pub mod learn;
pub mod log;
pub mod pipeline;
pub mod report;
pub mod robustness;
pub mod sample;
pub mod simulate;
pub mod study;
pub mod torture;
pub mod train;
pub mod validate;
