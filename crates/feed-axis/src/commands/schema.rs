//! `schema`: the JSON Schema of a file, for editors and other programs.

use std::path::PathBuf;

use axis_machine::MachineText;
use axis_pipeline::summary::Summary;
use axis_sim::Registry;
use clap::{Args, ValueEnum};
use discrepancy::Discovery;
use drive_loop::LoopAnalysis;
use miette::{IntoDiagnostic, Result};
use schemars::generate::SchemaSettings;
use serde_json::Value;

use super::frf::FrfFound;
use super::manual;
use super::tune::TuneFound;
use crate::out_file;
use crate::output::{note, write_whole};

/// Options of `schema`.
#[derive(Args)]
pub struct Options {
    /// The file
    of: File,
    /// Where to write it [default: standard output]
    #[arg(long, value_name = "FILE", value_parser = out_file::file())]
    out: Option<PathBuf>,
}

/// The files that have a schema, one line each.
#[derive(Clone, Copy, ValueEnum)]
pub enum File {
    /// The axis file, TOML
    Axis,
    /// summary.json of `report` and `pipeline`
    Summary,
    /// discovery.json of `discover`
    Discovery,
    /// The machine file, TOML
    Machine,
    /// What `analyse --format json` writes
    Loops,
    /// What `tune --format json` writes
    Tuning,
    /// What `frf --format json` writes
    Frf,
}

impl File {
    /// Its JSON Schema, draft 2020-12.
    pub fn schema(self) -> Value {
        let settings = SchemaSettings::draft2020_12().for_serialize();
        let generator = settings.into_generator();
        let result = match self {
            Self::Axis => return Registry::default().json_schema(),
            Self::Machine => {
                // What a reader must give: keys with a default may be left out.
                let settings = SchemaSettings::draft2020_12().for_deserialize();
                return settings
                    .into_generator()
                    .into_root_schema_for::<MachineText>()
                    .to_value();
            }
            Self::Summary => generator.into_root_schema_for::<Summary>().to_value(),
            Self::Loops => generator.into_root_schema_for::<LoopAnalysis>().to_value(),
            Self::Tuning => generator.into_root_schema_for::<TuneFound>().to_value(),
            Self::Frf => generator.into_root_schema_for::<FrfFound>().to_value(),
            Self::Discovery => generator.into_root_schema_for::<Discovery>().to_value(),
        };
        crate::json::with_words(result)
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let text = serde_json::to_string_pretty(&options.of.schema()).into_diagnostic()? + "\n";
    match &options.out {
        Some(path) => {
            write_whole(path, text.as_bytes())?;
            note(format!("{} written", path.display()));
            Ok(())
        }
        None => manual::out(text.as_bytes()),
    }
}
