//! Friction from logs that a user gives.
//!
//! Their paths and hashes stand in a file of the stage's folder, so that the stage's key holds
//! them and later stages need not be told.

use std::path::{Path, PathBuf};

use axis_log::Log;
use axis_log::intake::files;
use axis_pipeline::identification::identify_from_logs;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};

use super::friction::Friction;
use crate::commands::discover::read_as_one;
use crate::context::Context;
use crate::output::{note, ready, write_whole};

/// The file in which the logs are listed.
pub(super) const LIST: &str = "logs.json";

/// A log that was read.
#[derive(Serialize, Deserialize)]
struct Listed {
    /// As it was given.
    path: PathBuf,
    /// blake3 of each of its files.
    blake3: Vec<String>,
}

/// Where the logs are listed.
pub(super) fn list(context: &Context) -> PathBuf {
    context.out.join("identify").join(LIST)
}

/// The list as it stands; none if there is none.
pub(super) fn remembered(context: &Context) -> Option<String> {
    let bytes = std::fs::read(list(context)).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

/// Lists the logs.
pub(super) fn remember(context: &Context, logs: &[PathBuf]) -> Result<()> {
    let hash = |file: &PathBuf| -> Result<String> {
        let bytes = std::fs::read(file)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", file.display()))?;
        Ok(blake3::hash(&bytes).to_hex().to_string())
    };
    let one = |path: &PathBuf| {
        Ok(Listed {
            path: std::path::absolute(path).into_diagnostic()?,
            blake3: files(path).iter().map(hash).collect::<Result<_>>()?,
        })
    };
    let listed: Vec<Listed> = logs.iter().map(one).collect::<Result<_>>()?;
    let json = serde_json::to_vec_pretty(&listed).into_diagnostic()?;
    ready(&context.out.join("identify"))?;
    write_whole(&list(context), &json)
}

/// Identifies friction again from the logs of the list.
pub(super) fn again(context: &Context) -> Result<Friction> {
    let text = remembered(context).unwrap_or_default();
    let listed: Vec<Listed> = serde_json::from_str(&text).map_err(|e| {
        miette!(
            "{} is not a list of logs ({e}); run `{}` again, with --log or without",
            list(context).display(),
            context.line("identify")
        )
    })?;
    let logs: Vec<PathBuf> = listed.into_iter().map(|log| log.path).collect();
    let found = identify(context, &logs).wrap_err_with(|| {
        format!(
            "friction was last identified from logs; run `{0} --log FILE` with others, or `{0}` for the simulated machine's",
            context.line("identify")
        )
    })?;
    remember(context, &logs)?;
    Ok(found)
}

/// Identifies friction from logs.
pub(super) fn identify(context: &Context, logs: &[PathBuf]) -> Result<Friction> {
    let mut notes = Vec::new();
    let mut read = |path: &PathBuf| -> Result<(String, Log)> {
        let log = read_as_one(path, &context.axis, &[], &mut notes)?;
        Ok((name(path), log))
    };
    let named: Vec<(String, Log)> = logs.iter().map(&mut read).collect::<Result<_>>()?;
    notes.iter().for_each(note);
    let found = identify_from_logs(&context.axis, &named).into_diagnostic()?;
    let names: Vec<String> = named.into_iter().map(|(name, _)| name).collect();
    let mut friction = Friction::of(&found, &names, &context.axis.friction, None);
    notes.append(&mut friction.notes);
    friction.notes = notes;
    Ok(friction)
}

fn name(path: &Path) -> String {
    path.display().to_string()
}
