//! `contour` on a machine: any path, laps, what lies between the axes, feed against error.

use std::path::PathBuf;

use axis_machine::{
    CirclesFound, CoupledMachine, Coupling, DriveSensors, Laps, MachineFile, MeasuredCircle,
    fit_circles,
};
use axis_pipeline::strategies::{Predictors, StrategyKind};
use axis_sim::Measured;
use clap::Args;
use discover_matrix::hidden::Noise;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rayon::prelude::*;
use toolpath::iso230_4::{CircleFigures, NominalCircle, figures, quadrant_glitches};
use toolpath::named::Direction;

use super::contour::{AFTER_REVERSAL, Both, Reversal};
use super::contour_found::{
    Contoured, FeedRow, IdentifiedCoupling, LapFigures, MachineContoured, Shown,
};
use super::contour_paths::{Leg, PathOptions, Route, Wanted};
use super::contour_places::places;
use crate::exit::wrong_use;

/// Options of machines and laps.
#[derive(Args)]
pub struct LapOptions {
    /// Machine file: names the axis files and what lies between them (docs/two-axes.md)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["x", "y"])]
    pub machine: Option<PathBuf>,
    /// Laps one after the other; a compensation that learns goes on from lap to lap
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub laps: u32,
    /// Find squareness and cross-talk from circles at these feeds, m/min: two at least
    #[arg(long, value_name = "M_PER_MIN", num_args = 1.., value_delimiter = ',')]
    pub identify: Vec<f64>,
    /// Take squareness, straightness and cross-talk off the references: those of the machine file, or found by --identify
    #[arg(long)]
    pub correct: bool,
    /// Further feeds for a table of feed against error, m/min
    #[arg(long, value_name = "M_PER_MIN", num_args = 1.., value_delimiter = ',')]
    pub feeds: Vec<f64>,
}

impl LapOptions {
    /// Whether an option was given that circles of two axis files do not have.
    pub fn are_given(&self) -> bool {
        let lists = self.identify.len() + self.feeds.len();
        self.machine.is_some() || self.laps > 1 || lists > 0 || self.correct
    }
}

/// What is run.
pub struct Run<'a> {
    pub file: &'a MachineFile,
    pub paths: &'a PathOptions,
    pub laps: &'a LapOptions,
    pub wanted: Wanted,
    pub compensation: &'static StrategyKind,
    pub noise: f64,
    pub seed: u64,
}

/// Both senses of a circle, or the one of another path.
fn senses(paths: &PathOptions) -> Vec<Direction> {
    match paths.is_circle() {
        true => vec![Direction::Clockwise, Direction::Counterclockwise],
        false => vec![Direction::Counterclockwise],
    }
}

/// Runs it all.
pub fn run(run: &Run<'_>) -> Result<MachineContoured> {
    let identified = match run.laps.identify.is_empty() {
        true => None,
        false => Some(identify(run)?),
    };
    let correction = match (run.laps.correct, &identified) {
        (false, _) => None,
        (true, Some(found)) => Some(coupling_of(found)?),
        (true, None) => Some(run.file.coupling().into_diagnostic()?),
    };
    let directions = at_feed(run, &run.wanted, correction.as_ref())?;
    let both = match (run.paths.is_circle(), &directions[..]) {
        (true, [there, back]) => {
            let found = circle_figures(&run.wanted, [&there.shown, &back.shown])?;
            Some(Both::of(&found))
        }
        _ => None,
    };
    let feeds: Vec<FeedRow> = (run.laps.feeds.par_iter())
        .map(|&feed| feed_row(run, feed, correction.as_ref()))
        .collect::<Result<_>>()?;
    Ok(MachineContoured {
        machine: run.file.text.name.clone(),
        path: run.paths.name(&run.wanted),
        path_at_feed: run.paths.title(&run.wanted),
        compensation: run.compensation.name,
        feed_m_per_min: 60.0 * run.wanted.feed,
        identified: identified.map(|found| IdentifiedCoupling {
            squareness_um_per_m: [found.squareness.value, found.squareness.standard_error]
                .map(|v| 1e6 * v),
            crosstalk_um_per_m_per_s2: [found.crosstalk.value, found.crosstalk.standard_error]
                .map(|v| 1e6 * v),
            residual_um: 1e6 * found.residual,
        }),
        corrected: correction.is_some(),
        directions,
        both,
        feeds,
        report: None,
    })
}

/// The nominal circle of the plane that is shown.
pub fn nominal(wanted: &Wanted) -> NominalCircle {
    NominalCircle {
        centre: [0.0; 2],
        radius: wanted.radius,
    }
}

fn circle_figures(wanted: &Wanted, turns: [&Shown; 2]) -> Result<CircleFigures> {
    let [there, back] = turns.map(|turn| turn.at.iter().map(|at| at[0]).collect::<Vec<_>>());
    figures(&nominal(wanted), &there, &back).into_diagnostic()
}

fn coupling_of(found: &CirclesFound) -> Result<Coupling> {
    let pair = axis_machine::AxisCoupling {
        of: 0,
        by: 1,
        squareness: found.squareness.value,
        crosstalk: found.crosstalk.value,
        straightness: None,
    };
    Coupling::new(vec![pair]).into_diagnostic()
}

fn identify(run: &Run<'_>) -> Result<CirclesFound> {
    if !run.paths.is_circle() || run.paths.tilt().is_some() {
        return Err(wrong_use(
            "--identify takes circles in the plane of X and Y; give --radius alone".to_owned(),
        ));
    }
    let cases: Vec<(f64, Direction)> = (run.laps.identify.iter())
        .flat_map(|&feed| senses(run.paths).into_iter().map(move |d| (feed / 60.0, d)))
        .collect();
    let turns: Vec<Contoured> = (cases.par_iter())
        .map(|&(feed, direction)| sense(run, &Wanted { feed, ..run.wanted }, direction, None))
        .collect::<Result<_>>()?;
    let points: Vec<Vec<[f64; 2]>> = (turns.iter())
        .map(|turn| turn.shown.at.iter().map(|at| at[0]).collect())
        .collect();
    let circles = cases.iter().zip(&points);
    let circles: Vec<MeasuredCircle<'_>> = circles
        .map(|(&(feed, direction), points)| MeasuredCircle {
            nominal: nominal(&run.wanted),
            feed,
            direction,
            points,
        })
        .collect();
    fit_circles(&circles)
        .into_diagnostic()
        .wrap_err("--identify")
}

fn at_feed(
    run: &Run<'_>,
    wanted: &Wanted,
    correction: Option<&Coupling>,
) -> Result<Vec<Contoured>> {
    let senses = senses(run.paths);
    (senses.par_iter())
        .map(|&direction| sense(run, wanted, direction, correction))
        .collect()
}

fn feed_row(run: &Run<'_>, feed: f64, correction: Option<&Coupling>) -> Result<FeedRow> {
    let wanted = Wanted {
        feed: feed / 60.0,
        ..run.wanted
    };
    let all = at_feed(run, &wanted, correction)?;
    let worst = |lap: fn(&Contoured) -> Option<&LapFigures>| {
        let laps = all.iter().filter_map(lap);
        laps.map(|lap| lap.contour_error_um).fold(0.0, f64::max)
    };
    let fastest = match run.paths.route(&wanted, Direction::Counterclockwise)? {
        Route::Flat(legs) => fastest(&legs),
        Route::Space(legs) => fastest(&legs),
    };
    Ok(FeedRow {
        feed_m_per_min: feed,
        fastest_m_per_min: 60.0 * fastest,
        duration_s: all[0].duration_s,
        first_um: worst(|c| c.laps.first()),
        last_um: worst(|c| c.laps.last()),
    })
}

/// Greatest speed of the legs that count, m/s.
fn fastest<const D: usize>(legs: &[Leg<D>]) -> f64 {
    let counted = legs.iter().filter(|leg| !leg.rapid);
    let speeds = counted.flat_map(|leg| {
        let step = leg.profile.duration() / 2000.0;
        (0..=2000).map(move |k| leg.profile.at(step * f64::from(k)).feed)
    });
    speeds.fold(0.0, f64::max)
}

fn sense(
    run: &Run<'_>,
    wanted: &Wanted,
    direction: Direction,
    correction: Option<&Coupling>,
) -> Result<Contoured> {
    let plane = run.paths.tilt().unwrap_or(0.0);
    let mut found = match run.paths.route(wanted, direction)? {
        Route::Flat(legs) => laps::<2>(run, &legs, correction, |p| p)?,
        Route::Space(legs) => laps::<3>(run, &legs, correction, |[x, y, z]| {
            [x, plane.cos() * y + plane.sin() * z]
        })?,
    };
    if run.paths.is_circle() {
        let points: Vec<[f64; 2]> = found.shown.at.iter().map(|at| at[0]).collect();
        let peaks =
            quadrant_glitches(&nominal(wanted), &points, AFTER_REVERSAL).into_diagnostic()?;
        found.reversals = peaks.iter().map(Reversal::of).collect();
    }
    Ok(found)
}

/// Laps of one sense.
fn laps<const D: usize>(
    run: &Run<'_>,
    legs: &[Leg<D>],
    correction: Option<&Coupling>,
    plane: impl Fn([f64; D]) -> [f64; 2],
) -> Result<Contoured> {
    let machine: CoupledMachine<D> = run.file.machine().into_diagnostic()?.ok_or_else(|| {
        miette!(
            "the path has {D} coordinates, and {} has {} axes; valid: a machine file with x, y and z, or a path in the plane",
            run.file.path.display(),
            run.file.dimensions()
        )
    })?;
    let mut strategies = Vec::new();
    let mut sensors: Vec<DriveSensors<'_>> = Vec::new();
    for (d, drive) in machine.drives().iter().enumerate() {
        let strategy = run.compensation.strategy(&Predictors::of(&drive.nominal));
        strategies.push(strategy.into_diagnostic()?);
        let seed = run.seed.wrapping_mul(2).wrapping_add(d as u64);
        let mut noise = Noise::good(&drive.nominal).scaled(run.noise).sensors(seed);
        let noisy = run.noise > 0.0;
        sensors.push(Box::new(move |seen: &mut Measured| {
            if noisy {
                noise(seen);
            }
        }));
    }
    let mut runner = Laps::new(&machine, strategies)
        .into_diagnostic()?
        .sensing(sensors);
    if let Some(coupling) = correction {
        runner = runner.correcting(coupling.clone());
    }
    let mut found = Vec::new();
    let mut shown = Shown {
        s: Vec::new(),
        error: Vec::new(),
        at: Vec::new(),
    };
    let (mut corners, mut curves) = (Vec::new(), Vec::new());
    for lap in 1..=run.laps.laps {
        let last = lap == run.laps.laps;
        let mut errors = Vec::new();
        let mut begun = 0.0;
        for leg in legs {
            let traced = runner.lap(&leg.profile).into_diagnostic()?.lap.traced;
            if leg.rapid {
                continue;
            }
            let feet: Vec<_> = traced.contour_error_between(leg.counted).collect();
            errors.extend(feet.iter().map(|foot| foot.length()));
            if last {
                let [sharp, bent] = places(&leg.profile, &feet, &leg.name);
                corners.extend(sharp);
                curves.extend(bent);
                for (foot, position) in feet.iter().zip(traced.between(leg.counted)) {
                    shown.s.push(begun + foot.s);
                    shown.error.push(foot.length());
                    shown
                        .at
                        .push([plane(*position), plane(foot.point.position)]);
                }
            }
            begun += leg.profile.path().length();
        }
        found.push(LapFigures::of(lap as usize, errors));
    }
    let durations = legs.iter().map(|leg| leg.profile.duration());
    Ok(Contoured {
        direction: match legs {
            [only] => only.name.clone(),
            _ => "program".to_owned(),
        },
        duration_s: durations.sum(),
        laps: found,
        reversals: Vec::new(),
        corners,
        curves,
        shown,
    })
}
