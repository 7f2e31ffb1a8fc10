//! `contour-table`: contour errors of machines of two and three axes beside goals, as a Markdown table. Each row is kept as a file,
//! so that a run that was stopped goes on.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use feed_axis::output::{Worded, note, print};
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};

use super::contour_bench::Bench;
use super::contour_measured::Measured;
use super::contour_rows::ROWS;

/// Options of the command.
// A group by itself: clap names groups after their type.
#[derive(Args)]
#[group(id = "contour-table-options")]
pub struct Options {
    /// Folder of the axis files
    #[arg(long, value_name = "DIR", default_value = "data/axes")]
    axes: PathBuf,
    /// Folder of rows that are done
    #[arg(long, value_name = "DIR", default_value = "runs/contour")]
    rows: PathBuf,
    /// Where to write the table
    #[arg(long, value_name = "FILE", default_value = "data/outcomes/contour.md")]
    out: PathBuf,
    /// Names of rows [default: all]; with names no table is written
    #[arg(value_name = "ROW")]
    names: Vec<String>,
}

#[derive(Deserialize, Serialize)]
struct Kept {
    /// What the row depends on.
    key: String,
    measured: Measured,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let bench = Bench::read(&options.axes)?;
    let asked = |name: &str| options.names.is_empty() || options.names.iter().any(|n| n == name);
    let mut all = Vec::new();
    for (name, row) in ROWS.iter().filter(|(name, _)| asked(name)) {
        let file = options.rows.join(format!("{name}.json"));
        let key = bench.key();
        let kept = read(&file).filter(|kept| kept.key == key);
        let measured = match kept {
            Some(kept) => kept.measured,
            None => {
                let measured = row(&bench).wrap_err_with(|| format!("row {name}"))?;
                std::fs::create_dir_all(&options.rows).into_diagnostic()?;
                let kept = Kept {
                    key,
                    measured: measured.clone(),
                };
                let text = serde_json::to_string_pretty(&kept).into_diagnostic()?;
                std::fs::write(&file, text).into_diagnostic()?;
                measured
            }
        };
        note(format!("{name}: {}", measured.found));
        all.push(measured);
    }
    let text = table(&all);
    if options.names.is_empty() {
        std::fs::write(&options.out, &text).into_diagnostic()?;
        note(format!("{} written", options.out.display()));
    }
    print("contour-table", &Worded { text, value: all })
}

fn read(file: &Path) -> Option<Kept> {
    serde_json::from_str(&std::fs::read_to_string(file).ok()?).ok()
}

fn table(all: &[Measured]) -> String {
    let mut text = String::from(
        "# Contour errors of machines\n\n\
         Written by `cargo xtask contour-table`. All simulated, nothing measured. Greatest contour error of the counted part in µm; X is `liu2025-machine.toml`, Y \
         `liu2025-y.toml`, noise of 10 nm, 2 µrad, 0.01 rad/s and 5 mA, 1 m/s² and 20 m/s³ for each axis, unless a row says otherwise.\n\n\
         | what | goal | found | met |\n|---|---|---|---|\n",
    );
    for row in all {
        let met = match row.met {
            Some(true) => "yes",
            Some(false) => "**no**",
            None => "–",
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {met} |",
            row.what, row.goal, row.found
        );
    }
    let notes: Vec<&Measured> = all.iter().filter(|row| !row.note.is_empty()).collect();
    if !notes.is_empty() {
        text.push_str("\n## Notes\n");
        for row in notes {
            let _ = writeln!(text, "- {}: {}", row.what, row.note);
        }
    }
    text
}
