//! The closed loop and the one-cycle samples.

use std::hint::black_box;

use axis_pipeline::sample_file;
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity};
use axis_sim::{Axis, ClosedLoop};
use compensator::NoCompensation;
use miette::{IntoDiagnostic, Result};
use rayon::prelude::*;
use trajectories::{Motion, SCurve};

use super::timing::least;
use super::{Plan, Row, pool};

pub fn rows(axis: &Axis, plan: &Plan) -> Result<Vec<Row>> {
    let mut rows = closed_loops(axis, plan)?;
    for (file, text) in OTHERS {
        rows.push(other_loop(&Axis::parse(file, text)?, plan)?);
    }
    rows.extend(samples(axis, plan)?);
    Ok(rows)
}

/// Axes on mechanisms without elements.
const OTHERS: [(&str, &str); 4] = [
    ("rack.toml", include_str!("../../../../data/axes/rack.toml")),
    ("belt.toml", include_str!("../../../../data/axes/belt.toml")),
    (
        "joint.toml",
        include_str!("../../../../data/axes/joint.toml"),
    ),
    (
        "linear-stage.toml",
        include_str!("../../../../data/axes/linear-stage.toml"),
    ),
];

/// All trajectories of an axis, one after another.
fn other_loop(axis: &Axis, plan: &Plan) -> Result<Row> {
    let plans = axis.trajectories.iter();
    let motions = plans.map(|spec| axis.plan(spec).into_diagnostic());
    let motions: Vec<SCurve> = motions.collect::<Result<_>>()?;
    let closed_loop = ClosedLoop::new(axis).into_diagnostic()?;
    let run = |motion: &SCurve| {
        black_box(closed_loop.run(motion, &mut NoCompensation, |cycle| {
            black_box(cycle.error());
        }));
    };
    let real_time: f64 = motions.iter().map(Motion::duration).sum();
    let [once] = least(plan.repetitions, [&mut || motions.iter().for_each(run)]);
    Ok(Row {
        name: format!(
            "closed loop of {} at {:.0} kHz, {:.0} steps a cycle",
            axis.mechanism.kind().name,
            1e-3 / axis.period,
            closed_loop.steps(&motions[0]) / closed_loop.cycles(&motions[0]) as f64
        ),
        value: once,
        unit: "s",
        ratio: real_time / once,
        against: "real time",
    })
}

fn closed_loops(axis: &Axis, plan: &Plan) -> Result<Vec<Row>> {
    let count = plan.size(axis.trajectories.len(), 1);
    let motions = axis.trajectories[..count.min(axis.trajectories.len())]
        .iter()
        .map(|spec| axis.plan(spec).into_diagnostic())
        .collect::<Result<Vec<SCurve>>>()?;
    let closed_loop = ClosedLoop::new(axis).into_diagnostic()?;
    let run = |motion: &SCurve| {
        let mut most = 0.0_f64;
        let outcome = closed_loop.run(motion, &mut NoCompensation, |cycle| {
            most = most.max(cycle.error().abs());
        });
        black_box((outcome, most));
    };
    let real_time: f64 = motions.iter().map(Motion::duration).sum();
    let batch: Vec<&SCurve> = std::iter::repeat_n(&motions, 4).flatten().collect();
    let alone = pool(1)?;
    let run_batch = || {
        let runs = batch.par_iter().with_max_len(1);
        runs.for_each(|motion| run(motion));
    };
    let [once, single, several] = least(
        plan.repetitions,
        [
            &mut || motions.iter().for_each(run),
            &mut || alone.install(run_batch),
            &mut || plan.pool.install(run_batch),
        ],
    );
    Ok(vec![
        Row {
            name: format!("closed loop, {} motions of {real_time:.3} s", motions.len()),
            value: once,
            unit: "s",
            ratio: real_time / once,
            against: "real time",
        },
        Row {
            name: format!("{} closed loops on {} threads", batch.len(), plan.threads),
            value: several,
            unit: "s",
            ratio: single / several,
            against: "one thread",
        },
    ])
}

fn samples(axis: &Axis, plan: &Plan) -> Result<Vec<Row>> {
    let sampler = |count| {
        let samples = SamplePlan {
            count,
            seed: 1,
            density: SpeedDensity::Uniform,
        };
        Sampler::new(axis, &samples).into_diagnostic()
    };
    let few = sampler(5000)?;
    let real_time = 5000.0 * axis.period;
    let mut simulated = true;
    let [time] = least(
        plan.repetitions,
        [&mut || {
            simulated &= plan.pool.install(|| black_box(few.all())).is_ok();
        }],
    );
    miette::ensure!(simulated, "the one-cycle samples cannot be simulated");
    let mut rows = vec![Row {
        name: "5000 one-cycle samples".into(),
        value: time,
        unit: "s",
        ratio: real_time / time,
        against: "real time",
    }];
    rows.push(streamed(&sampler(plan.size(1_000_000, 10_000))?, plan)?);
    Ok(rows)
}

/// Samples simulated and written a part at a time, beside the simulation alone.
fn streamed(sampler: &Sampler, plan: &Plan) -> Result<Row> {
    let folder = tempfile::tempdir().into_diagnostic()?;
    let file = folder.path().join("samples.bin");
    let (mut written, mut simulated) = (Ok(()), true);
    let count = sampler.count();
    let [write, simulate] = plan.pool.install(|| {
        least(
            plan.repetitions.div_ceil(4),
            [
                &mut || {
                    let result = sample_file::write(&file, sampler, "bench", |_| ());
                    if let Err(error) = result {
                        written = Err(error);
                    }
                },
                &mut || {
                    for start in (0..count).step_by(1 << 16) {
                        let rows = start..(start + (1 << 16)).min(count);
                        simulated &= black_box(sampler.rows(rows)).is_ok();
                    }
                },
            ],
        )
    });
    written.into_diagnostic()?;
    miette::ensure!(simulated, "the one-cycle samples cannot be simulated");
    Ok(Row {
        name: format!("{count} samples streamed to disk"),
        value: write,
        unit: "s",
        ratio: simulate / write,
        against: "the same without a file",
    })
}
