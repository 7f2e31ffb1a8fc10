//! One file a command.

pub mod bench;
pub mod contour;
mod contour_geometry;
mod contour_networks;
mod contour_pairs;
mod contour_rows;
pub mod crates;
pub mod discover_matrix;
mod discover_matrix2;
pub mod heat;
mod heat_both;
mod heat_identified;
mod heat_table;
pub mod independent;
pub mod layers;
mod matrix_job;
pub mod names;
pub mod peers_cases;
pub mod publish;
pub mod torture;
pub mod tuning;
mod tuning_files;
