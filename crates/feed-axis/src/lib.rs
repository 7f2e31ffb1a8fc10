//! The commands of the project, one file each, which parse, call one library function
//! and write. Nothing here knows physics.
//!
//! Two programs are made of them: `feed-axis`, for users, and `cargo xtask`, which adds
//! what concerns developers alone. Each has its own list of jobs ([`jobs::Jobs`]).

pub mod cli;
pub mod commands;
pub mod context;
mod diagnostic;
pub mod exit;
pub mod file_set;
pub mod jobs;
pub mod json;
mod log_out;
mod out_file;
pub mod output;
mod page;
mod paper;
pub mod program;
pub mod progress;
mod results;
pub mod set_key;
mod shell;
pub mod store;
mod strategy_name;
pub mod terminal;

pub use page::contour_laps::page as machine_page;
pub use page::discovery::page as discovery_page;
