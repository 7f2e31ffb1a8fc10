//! Folders of finished stages: one of their files or manifests damaged, or another's.

use std::path::{Path, PathBuf};

use axis_pipeline::Figures;
use axis_pipeline::measured::{Rms, TrainingRms, ValidationRms};
use axis_sim::Axis;
use cfnn::artifact::network_to_bytes;
use miette::{IntoDiagnostic, Result};

use super::artifact::some_network;
use super::axis::small_screw;
use super::{Input, Kind, Verdict, fault};
use crate::commands::torture::random::Source;
use crate::commands::torture::{message, mutate};
use feed_axis::commands::identify::{self, Friction, Transfer};
use feed_axis::commands::train::{self, Training};
use feed_axis::context::Context;
use feed_axis::output::write_whole;

/// Files of the two stages, below the run's folder.
const FILES: [&str; 6] = [
    "identify/friction.json",
    "identify/transfer_functions.json",
    "identify/manifest.json",
    "train/network.cfnn",
    "train/training.json",
    "train/manifest.json",
];

/// The axis file with the friction, and the logs that it was identified from, which no later stage reads.
const UNREAD: [&str; 3] = ["axis.toml", "constant-speed.parquet", "pre-sliding.parquet"];

struct StageFolder {
    context: Context,
    bases: Vec<Vec<u8>>,
}

/// The stages `identify` and `train`, with small made-up results.
pub fn kind(desk: &Path) -> Result<Box<dyn Kind>> {
    let text = small_screw();
    let axis = Axis::parse("base", &text)?;
    let context = Context {
        machine: axis.clone(),
        axis,
        axis_file: "base.toml".into(),
        axis_text: text,
        has_machine: false,
        out: desk.join("run"),
        seed: 1,
        threads: 1,
        quick: true,
        options: Vec::new(),
    };
    make(&context)?;
    let read = |file: &&str| std::fs::read(context.out.join(file)).into_diagnostic();
    let bases = FILES.iter().map(read).collect::<Result<_>>()?;
    Ok(Box::new(StageFolder { context, bases }))
}

fn make(context: &Context) -> Result<()> {
    let unit = context.unit();
    let law = context.axis.friction.law.parameters();
    let transfer = || Transfer {
        period: 1e-4,
        direct: 0.5,
        poles: vec![0.5, 0.25],
        coefficients: vec![1.0, 0.5],
        training_rms: TrainingRms::new(unit, 1.0),
        validation_rms: ValidationRms::new(unit, 1.5),
        candidates: 3,
    };
    let stage = identify::stage(context);
    stage.begin()?;
    stage.write_json(
        "friction.json",
        &Friction {
            simulated: true,
            parameters: Vec::new(),
            open: Vec::new(),
            notes: Vec::new(),
            runs: Vec::new(),
            small_motions: Vec::new(),
            law: [
                law.coulomb,
                law.stiction,
                law.stribeck_speed,
                law.stiffness,
                law.damping,
                law.viscous,
            ],
        },
    )?;
    stage.write_json("transfer_functions.json", &[transfer(), transfer()])?;
    for file in UNREAD {
        write_whole(&stage.path(file), b"")?;
    }
    stage.finish()?;
    let stage = train::stage(context);
    stage.begin()?;
    let bytes = network_to_bytes(&some_network()?, &context.axis.fingerprint).into_diagnostic()?;
    write_whole(&stage.path("network.cfnn"), &bytes)?;
    let figures = Figures {
        max: 2.0,
        mean: 1.0,
    };
    stage.write_json(
        "training.json",
        &Training {
            hidden: vec![2, 2],
            epochs: 3,
            unit,
            initial_damping: 0.97,
            train_samples: 10,
            test_samples: 10,
            network: figures,
            linear: figures,
            seen: figures,
            rms: Rms::new(unit, vec![3.0, 2.0, 1.0]),
            seconds: 0.1,
        },
    )?;
    stage.finish()
}

impl Kind for StageFolder {
    fn name(&self) -> &'static str {
        "stage folder"
    }

    fn share(&self) -> usize {
        2
    }

    fn input(&self, random: &mut Source) -> Input {
        let file = random.below(FILES.len());
        let base = &self.bases[file];
        let mut bytes = base.clone();
        while bytes == *base {
            bytes = if random.chance(0.1) {
                random.pick(&self.bases).clone()
            } else if let (true, Ok(text)) = (random.chance(0.5), std::str::from_utf8(base)) {
                mutate::text(text, random)
            } else {
                mutate::bytes(base, random)
            };
        }
        Input {
            file: format!("run/{}", FILES[file]),
            bytes,
            damaged: true,
        }
    }

    fn judge(&self, input: &Input, _: &Path) -> Verdict {
        let context = &self.context;
        let trained = input.file.starts_with("run/train");
        let stages = [identify::stage(context), train::stage(context)];
        if stages[usize::from(trained)].is_current() {
            return fault("a damaged stage counts as up to date");
        }
        if !stages[usize::from(!trained)].is_current() {
            return fault("a whole stage does not count as up to date");
        }
        let reads = if trained {
            vec![
                train::load_network(context).map(drop),
                train::load_training(context).map(drop),
            ]
        } else {
            let logs = UNREAD.map(|log| stages[0].read(log).map(drop));
            let results = [
                identify::load_friction(context).map(drop),
                identify::load_transfer(context).map(drop),
            ];
            results.into_iter().chain(logs).collect()
        };
        let folder = PathBuf::from(&input.file);
        let folder = folder
            .parent()
            .unwrap_or(Path::new(""))
            .display()
            .to_string();
        let mut refusals = 0;
        for error in reads.into_iter().filter_map(Result::err) {
            refusals += 1;
            if let Err(wrong) = message::judge(&error, &folder, false) {
                return fault(wrong);
            }
        }
        if refusals == 0 {
            return fault("results of a damaged stage are read");
        }
        Verdict::Refused
    }

    fn restore(&self, input: &Input, desk: &Path) -> Result<()> {
        let mut all = FILES.iter().zip(&self.bases);
        let base = all.find(|(file, _)| input.file.ends_with(*file));
        let path = desk.join(&input.file);
        feed_axis::output::remove(&path)?;
        base.map_or(Ok(()), |(_, bytes)| std::fs::write(path, bytes))
            .into_diagnostic()
    }
}
