//! Options of `tuning`, and how its numbers are written.

use std::path::PathBuf;

use clap::Args;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Folder of the axis files
    #[arg(long, value_name = "DIR", default_value = "data/axes")]
    pub axes: PathBuf,
    /// Write axis files with tuned gains instead, as `feed-axis tune` makes them, of every file in the
    /// folder that can be tuned, and print a Markdown table of their errors before and after
    #[arg(long)]
    pub write: bool,
    /// Folder to write them to
    #[arg(
        long,
        value_name = "DIR",
        default_value = "data/axes/tuned",
        requires = "write"
    )]
    pub out: PathBuf,
    /// Names of the axes [default: all]
    #[arg(value_name = "AXIS")]
    pub names: Vec<String>,
}

impl Options {
    pub fn asked(&self, name: &str) -> bool {
        self.names.is_empty() || self.names.iter().any(|n| n == name)
    }
}

/// Three significant digits.
pub fn three(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    rounded.to_string()
}
