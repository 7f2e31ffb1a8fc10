//! Compensations of a machine that are made of results of other commands, of each axis its own.

use std::path::Path;

use axis_machine::{FileDrive, MachineFile};
use axis_pipeline::strategies::{Need, Predictors, StrategyKind};
use miette::{IntoDiagnostic, Result, WrapErr};

use super::contour_drives::DriveCompensations;
use super::contour_found::NetworkRow;
use super::{pipeline, train, validate};
use crate::context::{Common, Context};

/// The folder of results where none is named, one folder an axis by its name.
pub const RUNS: &str = "runs";

/// Where the results of an axis are, and how they were made.
pub struct ResultFolders<'a> {
    /// The folder that has one folder an axis, by its name.
    pub runs: &'a Path,
    /// Whether they were made with `--quick`.
    pub quick: bool,
    /// Whether stages that are not up to date are run first.
    pub makes: bool,
}

impl ResultFolders<'_> {
    /// The options of the pipeline's stages for an axis of a machine.
    fn context(&self, drive: &FileDrive<'_>) -> Result<Context> {
        let out = (self.runs != Path::new(RUNS)).then(|| self.runs.join(&drive.nominal.name));
        let common = Common {
            axis: drive.file.clone(),
            set: Vec::new(),
            machine: None,
            out,
            seed: 1,
            threads: 0,
            quick: self.quick,
        };
        common.open()
    }

    fn predictors(&self, drive: &FileDrive<'_>, needs: &[Need]) -> Result<Predictors> {
        if needs.is_empty() {
            return Ok(Predictors::of(drive.nominal));
        }
        let context = self.context(drive)?;
        match self.makes {
            true => pipeline::predictors(&context, needs),
            false => validate::predictors(&context, needs),
        }
    }

    /// One strategy on all drives, each with what its axis' results hold of what it needs.
    ///
    /// # Errors
    /// Which result is missing, and the command that makes it; [`DriveCompensations::of`].
    pub fn compensation(
        &self,
        kind: &'static StrategyKind,
        file: &MachineFile,
    ) -> Result<DriveCompensations> {
        let needs: Vec<&str> = kind.needs.iter().map(|need| need.name()).collect();
        let mut drives = Vec::new();
        for drive in file.drives() {
            let predictors = self.predictors(&drive, kind.needs).wrap_err_with(|| {
                let needs = needs.join(" and ");
                let (strategy, axis) = (kind.label, &drive.nominal.name);
                format!("{strategy} needs {needs} of {axis}")
            })?;
            drives.push((kind, predictors));
        }
        DriveCompensations::new(drives).into_diagnostic()
    }

    /// What the training of each drive's network showed, if the strategy needs one.
    ///
    /// # Errors
    /// As [`ResultFolders::compensation`].
    pub fn networks(&self, kind: &StrategyKind, file: &MachineFile) -> Result<Vec<NetworkRow>> {
        if !kind.needs.contains(&Need::Network) {
            return Ok(Vec::new());
        }
        let row = |drive: FileDrive<'_>| {
            let found = train::load_training(&self.context(&drive)?)?;
            Ok(NetworkRow {
                axis: ["X", "Y", "Z"][drive.axis.min(2)].to_owned(),
                name: drive.nominal.name.clone(),
                samples: found.train_samples,
                unseen_um: [found.network.max, found.network.mean],
                linear_um: [found.linear.max, found.linear.mean],
            })
        };
        file.drives().into_iter().map(row).collect()
    }
}
