//! `sample`: one-cycle samples, to train on and to judge by.

use std::ops::Range;
use std::path::{Path, PathBuf};

use axis_pipeline::ErrorUnit;
use axis_pipeline::sample_file;
use axis_pipeline::sampling::{SamplePlan, SampleSet, Sampler, SpeedDensity};
use axis_sim::CycleInput;
use campaign::{Column, Failure, Inputs, Job, Merged, Row, Value};
use clap::Args;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use crate::context::{Claim, Common, Context};
use crate::jobs::{JobOptions, Sharding, failure, whole};
use crate::out_file;
use crate::output::{Worded, print};
use crate::store::Stage;

/// Samples to train on.
const TRAINING: &str = "training.samples";
/// As many, evenly spread as in the paper: for the linear map beside the network.
const EVEN: &str = "even.samples";
/// Samples that no training sees, evenly spread.
const UNSEEN: &str = "unseen.samples";

/// Options of `sample`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Only write this many samples to --file, evenly spread over the axis
    /// file's ranges; any number works, in bounded memory
    #[arg(long, value_name = "N", requires = "file")]
    count: Option<usize>,
    /// Where to write them
    #[arg(long, value_name = "FILE", requires = "count", value_parser = out_file::file())]
    file: Option<PathBuf>,
    #[command(flatten)]
    sharding: Sharding,
}

impl JobOptions for Options {
    fn job(&self) -> Result<Box<dyn Job>> {
        let context = self.common.open()?;
        let (Some(count), Some(file)) = (self.count, &self.file) else {
            return Ok(Box::new(Samples::of_stage(&context)?));
        };
        let plan = SamplePlan {
            count,
            seed: context.seed,
            density: SpeedDensity::Uniform,
        };
        let mut folder = file.clone().into_os_string();
        folder.push(".campaign");
        let sets = vec![(file.clone(), plan)];
        Ok(Box::new(Samples::new(
            &context,
            folder.into(),
            sets,
            false,
        )?))
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
    let files = &[TRAINING, EVEN, UNSEEN];
    Stage::new(
        context,
        "sample",
        files,
        &format!("{:?}", plans(context)),
        &[],
    )
    .with_scratch(&[
        "shards/sample-1-of-1.parquet",
        "shards/sample-1-of-1.part",
        "shards/sample-1-of-1.journal",
    ])
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    whole(&Samples::of_stage(context)?)
}

/// The samples of a finished stage: to train on, as many evenly spread, unseen.
pub fn load(context: &Context) -> Result<[SampleSet; 3]> {
    let stage = stage(context);
    let load = |file: &str| -> Result<SampleSet> {
        stage.read(file)?;
        sample_file::read(&stage.path(file), &context.axis.fingerprint).into_diagnostic()
    };
    Ok([load(TRAINING)?, load(EVEN)?, load(UNSEEN)?])
}

fn plans(context: &Context) -> [SamplePlan; 3] {
    let (training, unseen) = if context.quick {
        (2000, 1000)
    } else {
        (5000, 1000)
    };
    [
        SamplePlan {
            count: training,
            seed: context.seed,
            density: SpeedDensity::NEAR_ZERO,
        },
        SamplePlan {
            count: training,
            seed: context.seed ^ 0xe7e4_0000_0000_0000,
            density: SpeedDensity::Uniform,
        },
        SamplePlan {
            count: unseen,
            seed: context.seed ^ 0x7e57_0000_0000_0000,
            density: SpeedDensity::Uniform,
        },
    ]
}

/// Samples as a job: a case is a sample, those of one set after those of another.
struct Samples {
    context: Context,
    folder: PathBuf,
    /// Files, and what each holds.
    sets: Vec<(PathBuf, SamplePlan)>,
    samplers: Vec<Sampler>,
    is_stage: bool,
}

impl Samples {
    fn of_stage(context: &Context) -> Result<Self> {
        let stage = stage(context);
        let files = [TRAINING, EVEN, UNSEEN].map(|file| stage.path(file));
        let sets = files.into_iter().zip(plans(context)).collect();
        Self::new(context, stage.path(""), sets, true)
    }

    fn new(
        context: &Context,
        folder: PathBuf,
        sets: Vec<(PathBuf, SamplePlan)>,
        is_stage: bool,
    ) -> Result<Self> {
        let sampler = |(_, plan): &(PathBuf, SamplePlan)| Sampler::new(&context.axis, plan);
        let samplers = sets.iter().map(sampler).collect::<Result<_, _>>();
        Ok(Self {
            samplers: samplers.into_diagnostic()?,
            context: context.clone(),
            folder,
            sets,
            is_stage,
        })
    }

    /// The sets' shares of some cases: set, and its rows.
    fn shares(&self, cases: &Range<usize>) -> Vec<(usize, Range<usize>)> {
        let mut shares = Vec::new();
        let mut start = 0;
        for (set, sampler) in self.samplers.iter().enumerate() {
            let end = start + sampler.count();
            let share = cases.start.max(start)..cases.end.min(end);
            if !share.is_empty() {
                shares.push((set, share.start - start..share.end - start));
            }
            start = end;
        }
        shares
    }

    fn write(&self, rows: &Merged) -> std::result::Result<(), Failure> {
        let mut rows = rows.rows();
        for ((path, _), sampler) in self.sets.iter().zip(&self.samplers) {
            let fingerprint = &self.context.axis.fingerprint;
            let mut writer = sample_file::Writer::create(path, sampler.count(), fingerprint)?;
            for row in rows.by_ref().take(sampler.count()) {
                let (input, increment) = of_row(&row?)?;
                writer.put(&input, increment)?;
            }
            writer.finish()?;
        }
        Ok(())
    }
}

/// As the binary file has them; of an axis that moves along a line, and of one that turns.
const LINEAR: &[Column] = &[
    Column::number("position_m"),
    Column::number("speed_m_per_s"),
    Column::number("acceleration_m_per_s2"),
    Column::number("iq_command_a"),
    Column::number("increment_m"),
];
const ROTARY: &[Column] = &[
    Column::number("position_rad"),
    Column::number("speed_rad_per_s"),
    Column::number("acceleration_rad_per_s2"),
    Column::number("iq_command_a"),
    Column::number("increment_rad"),
];

fn of_row(row: &Row) -> std::result::Result<(CycleInput, f64), Failure> {
    let number = |i: usize| row[i].number();
    let input = CycleInput {
        position: number(0)?,
        speed: number(1)?,
        acceleration: number(2)?,
        command: number(3)?,
    };
    Ok((input, number(4)?))
}

/// What was written.
#[derive(Serialize)]
struct Written {
    /// Samples in the file, or to train on.
    samples: usize,
    /// Samples of the stage that no training sees.
    unseen: Option<usize>,
    /// The file, or the stage's folder.
    file: PathBuf,
}

impl Job for Samples {
    fn name(&self) -> &'static str {
        "sample"
    }

    fn inputs(&self) -> Inputs {
        let plans: Vec<&SamplePlan> = self.sets.iter().map(|(_, plan)| plan).collect();
        self.context.inputs().with("samples", format!("{plans:?}"))
    }

    fn folder(&self) -> &Path {
        &self.folder
    }

    fn columns(&self) -> &'static [Column] {
        match self.context.unit() {
            ErrorUnit::Micrometre => LINEAR,
            ErrorUnit::Microradian => ROTARY,
        }
    }

    fn cases(&self) -> usize {
        self.samplers.iter().map(Sampler::count).sum()
    }

    /// Some tenths of a second.
    fn block(&self) -> usize {
        1 << 14
    }

    fn rows(&self, cases: Range<usize>) -> std::result::Result<Vec<Row>, Failure> {
        let mut made = Vec::with_capacity(cases.len());
        for (set, rows) in self.shares(&cases) {
            let samples = self.samplers[set].rows(rows)?;
            for (input, increment) in samples.inputs.iter().zip(samples.increments) {
                let numbers = [
                    input.position,
                    input.speed,
                    input.acceleration,
                    input.command,
                    increment,
                ];
                made.push(numbers.map(Value::Number).to_vec());
            }
        }
        Ok(made)
    }

    fn finish(&self, rows: &Merged) -> std::result::Result<(), Failure> {
        if !self.is_stage {
            self.write(rows)?;
            let (file, plan) = &self.sets[0];
            let text = format!("{} samples in {}", plan.count, file.display());
            let value = Written {
                samples: plan.count,
                unseen: None,
                file: file.clone(),
            };
            return print("sample", &Worded { text, value }).map_err(failure);
        }
        let stage = stage(&self.context);
        stage.begin().map_err(failure)?;
        self.write(rows)?;
        stage.finish().map_err(failure)?;
        let [training, _, unseen] = plans(&self.context).map(|plan| plan.count);
        let text = format!("sample: {training} samples to train on, {unseen} unseen");
        let value = Written {
            samples: training,
            unseen: Some(unseen),
            file: stage.path(""),
        };
        print("sample", &Worded { text, value }).map_err(failure)
    }
}
