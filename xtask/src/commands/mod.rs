//! One file a command.

pub mod bench;
pub mod campaign;
pub mod compensate;
mod compensate_moves;
mod control_table;
pub mod discover;
pub mod discover_matrix;
mod discover_matrix2;
pub mod export_drive;
pub mod identify;
pub mod identify_control;
pub mod independent;
pub mod layers;
pub mod learn;
pub mod log;
mod matrix_job;
pub mod merge;
pub mod pipeline;
pub mod report;
pub mod residuals;
pub mod robustness;
pub mod sample;
pub mod simulate;
pub mod study;
pub mod torture;
pub mod train;
pub mod validate;
