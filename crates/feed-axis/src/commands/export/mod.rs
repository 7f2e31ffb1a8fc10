//! `export`: what other programs and machines can use, one file a format.

pub mod drive;
pub mod fmu;

use clap::Subcommand;
use miette::Result;

/// What to export, one line a format.
#[derive(Subcommand)]
pub enum Export {
    /// Write what of the correction a drive or CNC can be given (docs/drive-terms.md)
    Drive(drive::Options),
    /// Write the axis as an FMI 3.0 co-simulation unit for other simulators (docs/fmu.md)
    Fmu(fmu::Options),
}

/// Runs the command.
pub fn command(export: &Export) -> Result<()> {
    match export {
        Export::Drive(options) => drive::command(options),
        Export::Fmu(options) => fmu::command(options),
    }
}
