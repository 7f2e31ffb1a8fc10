//! `export`: what other programs and machines can use, one file a format.

mod c;
mod controller;
pub mod drive;
pub mod fmu;
mod guard;
mod linuxcnc;
mod onnx;

use clap::Subcommand;
use miette::Result;

/// What to export, one line a format.
#[derive(Subcommand)]
pub enum Export {
    /// Write a strategy as one C99 file for a controller (docs/controller-export.md)
    C(c::Options),
    /// Write a strategy as a LinuxCNC component (docs/controller-export.md)
    Linuxcnc(linuxcnc::Options),
    /// Write the trained network as an ONNX file (docs/controller-export.md)
    Onnx(onnx::Options),
    /// Write the part of the correction that a drive or CNC can take, as constants and tables
    /// (docs/drive-terms.md)
    Drive(drive::Options),
    /// Write the axis or a machine as an FMI co-simulation unit, 3.0 or 2.0, for other simulators (docs/fmu.md)
    Fmu(fmu::Options),
}

/// Runs the command.
pub fn command(export: &Export) -> Result<()> {
    match export {
        Export::C(options) => c::command(options),
        Export::Linuxcnc(options) => linuxcnc::command(options),
        Export::Onnx(options) => onnx::command(options),
        Export::Drive(options) => drive::command(options),
        Export::Fmu(options) => fmu::command(options),
    }
}
