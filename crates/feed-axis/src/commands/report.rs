//! `report`: summary.json and report.html from the stages' results.

use std::path::PathBuf;

use miette::{IntoDiagnostic, Result, WrapErr};
use pipeline::summary::Summary;
use serde::Serialize;

use crate::context::{Common, Context};
use crate::output::{Worded, print, sweep, write_whole};
use crate::{page, results};

const SUMMARY: &str = "summary.json";
const REPORT: &str = "report.html";

/// What was written.
#[derive(Serialize)]
struct Written<'a> {
    summary: &'a Summary,
    files: [&'a PathBuf; 2],
}

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// Writes both files.
pub fn run(context: &Context) -> Result<()> {
    let results = results::gather(context)?;
    sweep(&context.out, &[SUMMARY, REPORT])?;
    let json = serde_json::to_vec_pretty(&results.summary).into_diagnostic()?;
    let summary_path = context.out.join(SUMMARY);
    write_whole(&summary_path, &json)?;
    let report_path = context.out.join(REPORT);
    let html = ::report::render(&page::page(context, &results))
        .into_diagnostic()
        .wrap_err("the report cannot be made")?;
    write_whole(&report_path, html.as_bytes())?;
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
