//! What the rows are measured with.

use std::sync::Arc;

use axis_machine::{CoupledMachine, Coupling, DriveSensors, Laps};
use axis_pipeline::strategies::{NONE, Predictors, STRATEGIES, StrategyKind};
use axis_sim::Axis;
use axis_sim::NoiseLevels;
use compensator::DriveModel;
use miette::{IntoDiagnostic, Result, miette};
use toolpath::named::{CircleTest, Direction};
use toolpath::{FeedLimits, FeedProfile};

/// The axes of most rows.
pub struct Bench {
    pub folder: std::path::PathBuf,
    pub x: Axis,
    pub y: Axis,
}

/// What each lap left: greatest contour error, µm, and the counted positions.
pub type Left<const D: usize> = Vec<(f64, Vec<[f64; D]>)>;

/// A path with the part that counts.
pub struct Task<const D: usize> {
    pub profile: Arc<FeedProfile<D>>,
    pub counted: (f64, f64),
}

impl Task<2> {
    pub fn circle(radius: f64, feed_m_per_min: f64, direction: Direction) -> Result<Self> {
        let circle = CircleTest {
            start: std::f64::consts::FRAC_PI_4,
            direction,
            ..CircleTest::new(radius)
        };
        let circle = circle.path().into_diagnostic()?;
        Ok(Self {
            profile: planned(&circle.path, feed_m_per_min)?,
            counted: circle.counted,
        })
    }
}

pub fn planned<const D: usize>(
    path: &toolpath::Path<D>,
    feed_m_per_min: f64,
) -> Result<Arc<FeedProfile<D>>> {
    let feed = feed_m_per_min / 60.0;
    let limits = FeedLimits::equal(feed, feed, 1.0, 20.0);
    Ok(Arc::new(
        FeedProfile::plan(path, &limits).into_diagnostic()?,
    ))
}

pub fn strategy(name: &str) -> Result<&'static StrategyKind> {
    let all = STRATEGIES.iter().copied().chain([&NONE]);
    let mut found = all.filter(|kind| kind.name == name);
    found
        .next()
        .ok_or_else(|| miette!("there is no strategy {name}"))
}

/// Laps with sensors as noisy as good ones.
pub fn laps<const D: usize>(
    machine: &CoupledMachine<D>,
    models: &[Option<DriveModel>],
    kind: &StrategyKind,
    task: &Task<D>,
    (count, correction): (usize, Option<&Coupling>),
) -> Result<Left<D>> {
    let tasks: Vec<&Task<D>> = std::iter::repeat_n(task, count).collect();
    series(machine, models, kind, &tasks, correction)
}

/// The same, of several paths one after the other.
pub fn series<const D: usize>(
    machine: &CoupledMachine<D>,
    models: &[Option<DriveModel>],
    kind: &StrategyKind,
    tasks: &[&Task<D>],
    correction: Option<&Coupling>,
) -> Result<Left<D>> {
    let mut strategies = Vec::new();
    let mut sensors: Vec<DriveSensors<'_>> = Vec::new();
    for (d, drive) in machine.drives().iter().enumerate() {
        let mut predictors = Predictors::of(&drive.nominal);
        // What is hidden in a machine its model does not know.
        predictors.axis.effects.clear();
        predictors.assumed_model = models.get(d).copied().flatten();
        strategies.push(kind.strategy(&predictors).into_diagnostic()?);
        sensors.push(Box::new(NoiseLevels::GOOD.sensors(7 + d as u64)));
    }
    let mut runner = Laps::new(machine, strategies)
        .into_diagnostic()?
        .sensing(sensors);
    if let Some(coupling) = correction {
        runner = runner.correcting(coupling.clone());
    }
    let mut all = Vec::new();
    for task in tasks {
        let traced = runner.lap(&task.profile).into_diagnostic()?.lap.traced;
        let feet = traced.contour_error_between(task.counted);
        let worst = feet.map(|foot| foot.length()).fold(0.0, f64::max);
        all.push((1e6 * worst, traced.between(task.counted).to_vec()));
    }
    Ok(all)
}
