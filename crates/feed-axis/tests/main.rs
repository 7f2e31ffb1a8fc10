//! One test program: the commands as a user runs them.

mod campaign;
mod check;
mod cli;
mod common;
mod contour;
mod discover;
mod export_controller;
mod export_drive;
mod export_fmu;
mod frf;
mod heat;
mod identify;
mod identify_control;
mod log_convert;
mod loops;
mod machine_gains;
mod outside;
mod pages;
mod pipeline;
mod refused_files;
mod schema;
mod schema_of;
mod simulate;
mod standard_output;
mod stopped;
#[path = "../../controller-export/tests/support/mod.rs"]
mod support;
mod terminal;
mod text_files;
mod units;
