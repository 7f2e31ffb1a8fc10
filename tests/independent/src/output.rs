//! A case as files.

use std::path::Path;

use toml_edit::{DocumentMut, Item, Table as TomlTable, value};

use crate::cases::{Case, Noise};
use crate::error::IndependentError;
use crate::logger::{Columns, Logger, Table};
use crate::motion::{Motion, exercises};
use crate::parameters::Parameters;
use crate::random::Random;
use crate::run::{LoopNoise, run};
use crate::slide::{SlideDrive, SlideHidden, slide_log, slide_motions};
use crate::truth::Truth;

/// The axis as its file says.
const AXIS: &str = include_str!("../../../data/axes/liu2025.toml");

/// What a rough logger does besides: nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rough {
    /// Noise of neighbouring samples alike by 0.9.
    pub coloured: bool,
    /// Position in steps of 100 nm, current in steps of 10 mA.
    pub stepped: bool,
    /// One sample of the current in 500 is off by 0.3 A.
    pub outliers: bool,
}

impl Rough {
    fn on(self, mut logger: Logger) -> Logger {
        if self.coloured {
            logger.colour = 0.9;
        }
        if self.stepped {
            (logger.position_step, logger.current_step) = (100e-9, 10e-3);
        }
        if self.outliers {
            (logger.outliers, logger.outlier_size) = (2e-3, 0.3);
        }
        logger
    }
}

/// Writes `fit-1.csv`, `fit-2.csv`, `check-1.csv`, `check-2.csv`, `axis.toml` and
/// `truth.json` into a folder, which is made where it is missing.
///
/// # Errors
/// [`IndependentError`] of the run, or [`IndependentError::File`].
pub fn write_case(
    case: &Case,
    seed: u64,
    rough: Rough,
    folder: &Path,
) -> Result<Truth, IndependentError> {
    std::fs::create_dir_all(folder).map_err(|e| of_file(folder, &e))?;
    let mut p = Parameters::paper();
    let mut random = Random::new(seed, 100 * case.stream);
    let off = p.put_off(case.off_percent / 100.0, &mut random);
    for (number, (name, motion)) in (1..).zip(exercises()) {
        let mut random = Random::new(seed, 100 * case.stream + number);
        let table = log(&p, case, rough, &motion, &mut random)?;
        write_csv(&folder.join(format!("{name}.csv")), &table)?;
    }
    let path = folder.join("axis.toml");
    let text = axis_file(case).map_err(|e| of_file(&path, &e))?;
    std::fs::write(&path, text).map_err(|e| of_file(&path, &e))?;
    let secret = (case.secret)();
    let put_off = off.iter().filter(|(_, by)| *by != 0.0);
    let truth = Truth {
        case: case.name.to_owned(),
        seed,
        verdict: secret.verdict,
        effects: secret.effect.into_iter().collect(),
        also_right: secret.also_right,
        variable: secret.outside.map(|o| o[0].to_owned()),
        law: secret.outside.map(|o| o[1].to_owned()),
        put_off: put_off.map(|(n, by)| ((*n).to_owned(), *by)).collect(),
        told_percent: case.off_percent.max(1.0),
    };
    let path = folder.join("truth.json");
    let text = serde_json::to_string_pretty(&truth).map_err(|e| of_file(&path, &e))?;
    std::fs::write(&path, text + "\n").map_err(|e| of_file(&path, &e))?;
    Ok(truth)
}

/// The log of one motion of a case.
///
/// # Errors
/// [`IndependentError`] of the run.
pub fn log(
    p: &Parameters,
    case: &Case,
    rough: Rough,
    motion: &Motion,
    random: &mut Random,
) -> Result<Table, IndependentError> {
    let (inside, logger) = match case.noise {
        Noise::Loop => (LoopNoise::GOOD, Logger::default()),
        Noise::Logger => (LoopNoise::default(), Logger::NOISY),
    };
    let hidden = (case.secret)().hidden;
    let mut samples = Vec::new();
    run((p, &hidden), motion, (&inside, random), |s| {
        samples.push(*s)
    })?;
    let columns = if case.few { Columns::Few } else { Columns::All };
    Ok(rough.on(logger).log(&samples, columns, random))
}

fn of_file(path: &Path, reason: &dyn std::fmt::Display) -> IndependentError {
    IndependentError::File {
        path: path.to_owned(),
        reason: reason.to_string(),
    }
}

/// Writes `fit.csv` and `check.csv` of a slide with [`SlideDrive::OTHER`] into a folder, which is
/// made where it is missing.
///
/// # Errors
/// [`IndependentError::File`].
pub fn write_slide(hidden: &SlideHidden, seed: u64, folder: &Path) -> Result<(), IndependentError> {
    std::fs::create_dir_all(folder).map_err(|e| of_file(folder, &e))?;
    for ((seed, name), motion) in (seed..).zip(["fit.csv", "check.csv"]).zip(slide_motions()) {
        let mut random = Random::new(seed, 1);
        let table = slide_log(&SlideDrive::OTHER, hidden, &motion, &mut random);
        write_csv(&folder.join(name), &table)?;
    }
    Ok(())
}

fn write_csv(path: &Path, table: &Table) -> Result<(), IndependentError> {
    let mut writer = csv::Writer::from_path(path).map_err(|e| of_file(path, &e))?;
    let failed = |e: csv::Error| of_file(path, &e);
    writer.write_record(&table.names).map_err(failed)?;
    for row in &table.rows {
        // Times as people write them: 0.3 s is not 0.30000000000000004 s.
        let time = format!("{:.4}", row[0]);
        let rest = row[1..].iter().map(|v| format!("{v:.14e}"));
        let fields = std::iter::once(time).chain(rest);
        writer.write_record(fields).map_err(failed)?;
    }
    writer.flush().map_err(|e| of_file(path, &e))
}

/// The axis file, with the tolerance that is told, and without the files beside it.
fn axis_file(case: &Case) -> Result<String, toml_edit::TomlError> {
    let mut document: DocumentMut = AXIS.parse()?;
    document.remove("experiment");
    if case.off_percent > 0.0 {
        let mut table = TomlTable::new();
        table.insert("known_parameters_percent", value(case.off_percent));
        document.insert("tolerances", Item::Table(table));
    }
    Ok(document.to_string())
}
