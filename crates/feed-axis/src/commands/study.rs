//! `study`: Tables 7 to 10 over several seeds.

use std::ops::Range;
use std::path::{Path, PathBuf};

use axis_pipeline::study::{Setting, StudyRow, network, settings};
use axis_pipeline::{ErrorUnit, Figures};
use campaign::{Column, Failure, Inputs, Job, Merged, Row, Value};
use clap::Args;
use miette::Result;

use crate::context::{Claim, Common, Context};
use crate::jobs::{JobOptions, Sharding, failure, whole};
use crate::output::{Worded, print, write_whole};
use crate::store::Stage;

const STUDY: &str = "study.json";

/// Options of `study`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Only write the errors over this many seeds to --file; the samples are those of the stage
    #[arg(long, value_name = "N", requires = "file")]
    seeds: Option<u64>,
    /// Where to write them
    #[arg(long, value_name = "FILE", requires = "seeds")]
    file: Option<PathBuf>,
    #[command(flatten)]
    sharding: Sharding,
}

impl JobOptions for Options {
    fn job(&self) -> Result<Box<dyn Job>> {
        let context = self.common.open()?;
        Ok(Box::new(match (self.seeds, &self.file) {
            (Some(seeds), Some(file)) => Networks::to_file(&context, seeds, file),
            _ => Networks::of_stage(&context),
        }))
    }

    fn sharding(&self) -> &Sharding {
        &self.sharding
    }

    fn claim(&self) -> Result<Option<Claim>> {
        match self.file {
            Some(_) => Ok(None),
            None => self.common.open()?.claim().map(Some),
        }
    }
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    Stage::new(
        context,
        "study",
        &[STUDY],
        &format!("{:?}", size(context)),
        &[],
    )
    .with_scratch(&[
        "shards/study-1-of-1.parquet",
        "shards/study-1-of-1.part",
        "shards/study-1-of-1.journal",
    ])
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    whole(&Networks::of_stage(context))
}

/// The results of a finished stage.
pub fn load(context: &Context) -> Result<Vec<StudyRow>> {
    stage(context).read_json(STUDY)
}

/// Samples to train on (and as many unseen), and seeds.
fn size(context: &Context) -> (usize, u64) {
    if context.quick { (200, 2) } else { (1000, 11) }
}

/// The networks as a job: a case is a setting and a seed, the seeds of one setting after those
/// of another.
struct Networks {
    context: Context,
    settings: Vec<Setting>,
    samples: usize,
    seeds: u64,
    folder: PathBuf,
    /// Where the errors go, where not to the stage.
    file: Option<PathBuf>,
}

impl Networks {
    fn of_stage(context: &Context) -> Self {
        let (samples, seeds) = size(context);
        Self {
            folder: stage(context).path(""),
            context: context.clone(),
            settings: settings(),
            samples,
            seeds,
            file: None,
        }
    }

    fn to_file(context: &Context, seeds: u64, file: &Path) -> Self {
        let mut folder = file.as_os_str().to_owned();
        folder.push(".campaign");
        Self {
            seeds,
            folder: folder.into(),
            file: Some(file.to_owned()),
            ..Self::of_stage(context)
        }
    }

    fn table(&self, rows: &Merged) -> std::result::Result<Vec<StudyRow>, Failure> {
        let seeds = self.seeds as usize;
        let row = |(i, setting): (usize, &Setting)| {
            let errors = rows.range(i * seeds..(i + 1) * seeds).map(|row| {
                let row = row?;
                let [max, mean] = [row[0].number()?, row[1].number()?];
                Ok(Figures { max, mean })
            });
            Ok(StudyRow {
                unit: self.context.unit(),
                setting: setting.clone(),
                errors: errors.collect::<std::result::Result<_, Failure>>()?,
            })
        };
        self.settings.iter().enumerate().map(row).collect()
    }
}

impl Job for Networks {
    fn name(&self) -> &'static str {
        "study"
    }

    fn inputs(&self) -> Inputs {
        let inputs = self.context.inputs();
        inputs
            .with("samples", self.samples)
            .with("seeds", self.seeds)
    }

    fn folder(&self) -> &Path {
        &self.folder
    }

    fn columns(&self) -> &'static [Column] {
        const LINEAR: [Column; 2] = [
            Column::number("max_abs_error_um"),
            Column::number("mean_abs_error_um"),
        ];
        const ROTARY: [Column; 2] = [
            Column::number("max_abs_error_urad"),
            Column::number("mean_abs_error_urad"),
        ];
        match self.context.unit() {
            ErrorUnit::Micrometre => &LINEAR,
            ErrorUnit::Microradian => &ROTARY,
        }
    }

    fn cases(&self) -> usize {
        self.settings.len() * self.seeds as usize
    }

    fn rows(&self, cases: Range<usize>) -> std::result::Result<Vec<Row>, Failure> {
        let row = |case: usize| {
            let (i, k) = (case as u64 / self.seeds, case as u64 % self.seeds);
            let seed = self.context.seed.wrapping_add(k);
            let setting = &self.settings[i as usize];
            let error = network(&self.context.axis, setting, self.samples, seed)?;
            Ok([error.max, error.mean].map(Value::Number).to_vec())
        };
        cases.map(row).collect()
    }

    fn finish(&self, rows: &Merged) -> std::result::Result<(), Failure> {
        let table = self.table(rows)?;
        let networks = format!("{} settings over {} seeds", self.settings.len(), self.seeds);
        let text = match &self.file {
            Some(file) => {
                write_whole(file, &crate::json::pretty(&table)?).map_err(failure)?;
                format!("{networks} in {}", file.display())
            }
            None => {
                let stage = stage(&self.context);
                let write = || -> Result<()> {
                    stage.begin()?;
                    stage.write_json(STUDY, &table)?;
                    stage.finish()
                };
                write().map_err(failure)?;
                format!("study: {networks}")
            }
        };
        let value = table;
        print("study", &Worded { text, value }).map_err(failure)
    }
}
