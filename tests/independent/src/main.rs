//! Writes the logs of a case: `independent-axis --case NAME --seed N --out DIR`.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use independent_axis::cases::{CASES, named};
use independent_axis::{Rough, SLIDE_CASES, write_case, write_heat, write_slide};

/// Logs of the paper's ball-screw axis from a simulator of their own, with something hidden
#[derive(Parser)]
struct Options {
    /// Names of all cases
    #[arg(long)]
    list: bool,
    /// Case; all where none is given, each in a folder of its name
    #[arg(long, value_name = "NAME")]
    case: Option<String>,
    /// A slide on a linear motor instead, with this hidden
    #[arg(long, value_name = "NAME", conflicts_with = "case", value_parser = SLIDE_CASES.map(|(name, _)| name))]
    slide: Option<String>,
    /// Hours of growth of a screw instead, and the duties in them
    #[arg(long, conflicts_with_all = ["case", "slide"])]
    heat: bool,
    /// Seed of noise and of parameter errors
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Folder for fit-1.csv, fit-2.csv, check-1.csv, check-2.csv, axis.toml, truth.json
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
    /// The logger's noise is alike from sample to sample
    #[arg(long)]
    coloured: bool,
    /// The logger writes in steps of 100 nm and 10 mA
    #[arg(long)]
    stepped: bool,
    /// One sample of the current in 500 is far off
    #[arg(long)]
    outliers: bool,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout().lock();
    if options.list {
        for case in CASES {
            writeln!(out, "{:<18} {}", case.name, case.words)?;
        }
        return Ok(());
    }
    let rough = Rough {
        coloured: options.coloured,
        stepped: options.stepped,
        outliers: options.outliers,
    };
    let Some(folder) = &options.out else {
        return Ok(());
    };
    if options.heat {
        write_heat(folder, options.seed)?;
        return Ok(writeln!(out, "{}", folder.display())?);
    }
    if let Some(asked) = &options.slide {
        for (_, hidden) in SLIDE_CASES.iter().filter(|(name, _)| name == asked) {
            write_slide(hidden, options.seed, folder)?;
        }
        return Ok(writeln!(out, "{}", folder.display())?);
    }
    if let Some(name) = &options.case {
        write_case(named(name)?, options.seed, rough, folder)?;
        return Ok(writeln!(out, "{}", folder.display())?);
    }
    for case in CASES {
        let folder = folder.join(case.name);
        write_case(case, options.seed, rough, &folder)?;
        writeln!(out, "{}", folder.display())?;
    }
    Ok(())
}
