//! `report`: summary.json and report.html from the stages' results, or two runs compared.

use std::path::{Path, PathBuf};

use axis_pipeline::summary::Summary;
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;

use super::{compensate, identify, validate};
use crate::context::{Common, Context, read_text};
use crate::exit::wrong_use;
use crate::file_set::FileSet;
use crate::output::{Worded, print, ready, write_whole};
use crate::page::compare::RunFolder;
use crate::store::read_finished;
use crate::{page, program, results, shell};

const SUMMARY: &str = "summary.json";
const REPORT: &str = "report.html";

/// What was written.
#[derive(Serialize)]
struct Written<'a> {
    summary: &'a Summary,
    files: [&'a PathBuf; 2],
}

/// Two runs that were compared.
#[derive(Serialize)]
struct Compared<'a> {
    a: &'a Path,
    b: &'a Path,
    file: &'a Path,
}

fn compare(a: &Path, b: &Path, out: Option<&Path>) -> Result<()> {
    let [first, second] = [run_folder(a)?, run_folder(b)?];
    let [of_a, of_b] = [first.validation.unit, second.validation.unit];
    if of_a != of_b {
        return Err(wrong_use(format!(
            "--compare: the errors of {} are in {of_a}, those of {} in {of_b}; give two runs of axes that both turn, \
             or both move along a line",
            a.display(),
            b.display()
        )));
    }
    let out = out.unwrap_or(Path::new("runs/compare"));
    ready(out)?;
    let file = out.join(COMPARED);
    let html = axis_report::render(&page::compare::page(&first, &second))
        .into_diagnostic()
        .wrap_err("the comparison cannot be made")?;
    write_whole(&file, html.as_bytes())?;
    let text = format!("report: {}", file.display());
    let value = Compared { a, b, file: &file };
    print("report", &Worded { text, value })
}

/// The results of a finished run, as its stages vouch for them.
fn run_folder(folder: &Path) -> Result<RunFolder> {
    let path = folder.join(SUMMARY);
    let summary = serde_json::from_str(&read_text(&path)?)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "{} is no summary of a run; make it with `{} pipeline --axis FILE --out {}`",
                path.display(),
                program::name(),
                shell::word(&folder.display().to_string())
            )
        })?;
    let fits: [identify::Transfer; 2] = read_finished(folder, "identify", identify::TRANSFER)?;
    Ok(RunFolder {
        name: folder.display().to_string(),
        summary,
        validation: read_finished(folder, "validate", validate::VALIDATION)?,
        compensation: read_finished(folder, "compensate", compensate::COMPENSATION)?,
        period: fits[0].period,
    })
}

/// Page of two runs.
const COMPARED: &str = "compare.html";

/// Options of `report`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Compare the finished runs in the folders A and B (--out of `pipeline`) on a page
    /// compare.html, in --out [default: runs/compare]
    #[arg(long, num_args = 2, value_names = ["A", "B"], conflicts_with_all = ["axis", "machine", "seed", "quick"])]
    compare: Vec<PathBuf>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    if let [a, b] = options.compare.as_slice() {
        return compare(a, b, options.common.out.as_deref());
    }
    let context = options.common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// Writes both files.
pub fn run(context: &Context) -> Result<()> {
    let results = results::gather(context)?;
    let [summary_path, report_path] = [SUMMARY, REPORT].map(|name| context.out.join(name));
    let mut files = FileSet::new(&context.out, &[SUMMARY, REPORT])?;
    let json = crate::json::pretty(&results.summary).into_diagnostic()?;
    files.put(SUMMARY, &json)?;
    let html = axis_report::render(&page::page(context, &results))
        .into_diagnostic()
        .wrap_err("the report cannot be made")?;
    files.put(REPORT, html.as_bytes())?;
    files.publish()?;
    let text = format!(
        "report: {} and {}",
        summary_path.display(),
        report_path.display()
    );
    let value = Written {
        summary: &results.summary,
        files: [&summary_path, &report_path],
    };
    print("report", &Worded { text, value })
}
