//! A machine on a path: laps, couplings between the axes, feed against error.

use axis_machine::{
    AxisCoupling, CirclesFound, CoupledMachine, Coupling, DriveSensors, Laps, MachineFile,
    MeasuredCircle, fit_circles,
};
use axis_sim::Measured;
use axis_sim::NoiseLevels;
use rayon::prelude::*;
use toolpath::iso230_4::{CircleFigures, NominalCircle, figures, quadrant_glitches};
use toolpath::named::Direction;

use super::contour_drives::{ContourError, DriveCompensations};
use super::contour_found::{
    AFTER_REVERSAL, Both, Contoured, FeedRow, IdentifiedCoupling, LapFigures, MachineContoured,
    Reversal, Shown,
};
use super::contour_places::places;
use super::contour_route::{Leg, PathChoice, Route, Wanted};

/// What is run.
pub struct Run<'a> {
    /// The machine.
    pub file: &'a MachineFile,
    /// The path.
    pub path: &'a PathChoice,
    /// Feed and limits.
    pub wanted: Wanted,
    /// Laps one after the other, from 1.
    pub laps: u32,
    /// Feeds of circles from which squareness and cross-talk are found, m/s; none to leave that.
    pub identify: Vec<f64>,
    /// What is taken off the references.
    pub correct: ReferenceCorrection,
    /// Further feeds for a table of feed against error, m/s.
    pub feeds: Vec<f64>,
    /// Compensation of the drives.
    pub compensation: DriveCompensations,
    /// Noise of the sensors, in multiples of good ones.
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
    /// Called after every lap, from any thread.
    pub each: &'a (dyn Fn() + Sync),
}

/// What is taken off the references.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferenceCorrection {
    /// Nothing.
    Nothing,
    /// What the machine file says, or what was found from circles if some were asked for.
    FileOrFound,
    /// This.
    Known(Coupling),
}

impl Run<'_> {
    /// How often [`Run::each`] will be called: laps of all senses and feeds, a program's parts as one.
    pub fn laps_in_all(&self) -> u64 {
        let senses = self.path.senses().len() as u64;
        let feeds = self.feeds.len() as u64 + 1;
        senses * (u64::from(self.laps) * feeds + self.identify.len() as u64)
    }
}

/// Runs it all.
///
/// # Errors
/// [`ContourError`]: what was refused, and what would be valid.
pub fn run(run: &Run<'_>) -> Result<MachineContoured, ContourError> {
    let identified = match run.identify.is_empty() {
        true => None,
        false => Some(identify(run)?),
    };
    let correction = match (&run.correct, &identified) {
        (ReferenceCorrection::Nothing, _) => None,
        (ReferenceCorrection::Known(coupling), _) => Some(coupling.clone()),
        (ReferenceCorrection::FileOrFound, Some(found)) => Some(coupling_of(found)?),
        (ReferenceCorrection::FileOrFound, None) => Some(run.file.coupling()?),
    };
    let directions = at_feed(run, &run.wanted, correction.as_ref())?;
    let figures = match (run.path.radius(), &directions[..]) {
        (Some(radius), [there, back]) => Some(circle_figures(radius, [&there.shown, &back.shown])?),
        _ => None,
    };
    let feeds = in_order(&run.feeds, |&feed| feed_row(run, feed, correction.as_ref()))?;
    Ok(MachineContoured {
        machine: run.file.text.name.clone(),
        path: run.path.name(),
        path_at_feed: run.path.title(&run.wanted),
        compensation: run.compensation.name.clone(),
        feed_m_per_min: 60.0 * run.wanted.feed,
        identified: identified.map(|found| IdentifiedCoupling::of(&found)),
        networks: Vec::new(),
        corrected: correction.is_some(),
        directions,
        both: figures.as_ref().map(Both::of),
        figures,
        feeds,
        report: None,
    })
}

fn nominal(radius: f64) -> NominalCircle {
    NominalCircle {
        centre: [0.0; 2],
        radius,
    }
}

fn circle_figures(radius: f64, turns: [&Shown; 2]) -> Result<CircleFigures, ContourError> {
    let [there, back] = turns.map(|turn| turn.at.iter().map(|at| at[0]).collect::<Vec<_>>());
    Ok(figures(&nominal(radius), &there, &back)?)
}

/// The coupling that takes away what was found from circles.
///
/// # Errors
/// [`ContourError::Machine`] for values that no machine has.
pub fn coupling_of(found: &CirclesFound) -> Result<Coupling, ContourError> {
    let pair = AxisCoupling {
        of: 0,
        by: 1,
        squareness: found.squareness.value,
        crosstalk: found.crosstalk.value,
        straightness: None,
    };
    Ok(Coupling::new(vec![pair])?)
}

/// Squareness and cross-talk from circles at the feeds of [`Run::identify`], in both directions.
///
/// # Errors
/// [`ContourError::NoCircle`] for another path, [`ContourError::Circles`] if the circles do not tell them apart.
pub fn identify(run: &Run<'_>) -> Result<CirclesFound, ContourError> {
    let (Some(radius), None) = (run.path.radius(), run.path.tilt()) else {
        return Err(ContourError::NoCircle);
    };
    let cases: Vec<(f64, Direction)> = (run.identify.iter())
        .flat_map(|&feed| run.path.senses().into_iter().map(move |d| (feed, d)))
        .collect();
    let turns = in_order(&cases, |&(feed, direction)| {
        let wanted = Wanted { feed, ..run.wanted };
        sense(run, (&wanted, 1), direction, None)
    })?;
    let points: Vec<Vec<[f64; 2]>> = (turns.iter())
        .map(|turn| turn.shown.at.iter().map(|at| at[0]).collect())
        .collect();
    let circles = cases.iter().zip(&points);
    let circles: Vec<MeasuredCircle<'_>> = circles
        .map(|(&(feed, direction), points)| MeasuredCircle {
            nominal: nominal(radius),
            feed,
            direction,
            points,
        })
        .collect();
    Ok(fit_circles(&circles)?)
}

fn at_feed(
    run: &Run<'_>,
    wanted: &Wanted,
    correction: Option<&Coupling>,
) -> Result<Vec<Contoured>, ContourError> {
    in_order(&run.path.senses(), |&direction| {
        sense(run, (wanted, run.laps), direction, correction)
    })
}

/// What `one` makes of each item, on all threads; of several errors the first in the items' order.
fn in_order<T: Sync, U: Send>(
    items: &[T],
    one: impl Fn(&T) -> Result<U, ContourError> + Sync,
) -> Result<Vec<U>, ContourError> {
    let all: Vec<Result<U, ContourError>> = items.par_iter().map(&one).collect();
    all.into_iter().collect()
}

fn feed_row(
    run: &Run<'_>,
    feed: f64,
    correction: Option<&Coupling>,
) -> Result<FeedRow, ContourError> {
    let wanted = Wanted { feed, ..run.wanted };
    let all = at_feed(run, &wanted, correction)?;
    let worst = |lap: fn(&Contoured) -> Option<&LapFigures>| {
        let laps = all.iter().filter_map(lap);
        laps.map(|lap| lap.contour_error_um).fold(0.0, f64::max)
    };
    Ok(FeedRow {
        feed_m_per_min: 60.0 * feed,
        fastest_m_per_min: 60.0 * all.iter().map(|one| one.fastest).fold(0.0, f64::max),
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
    (wanted, count): (&Wanted, u32),
    direction: Direction,
    correction: Option<&Coupling>,
) -> Result<Contoured, ContourError> {
    let plane = run.path.tilt().unwrap_or(0.0);
    let mut found = match run.path.route(wanted, direction)? {
        Route::Flat(legs) => laps::<2>(run, (&legs, count), correction, |p| p)?,
        Route::Space(legs) => laps::<3>(run, (&legs, count), correction, |[x, y, z]| {
            [x, plane.cos() * y + plane.sin() * z]
        })?,
    };
    if let Some(radius) = run.path.radius() {
        let points: Vec<[f64; 2]> = found.shown.at.iter().map(|at| at[0]).collect();
        let peaks = quadrant_glitches(&nominal(radius), &points, AFTER_REVERSAL)?;
        found.reversals = peaks.iter().map(Reversal::of).collect();
    }
    Ok(found)
}

/// Laps of one sense.
fn laps<const D: usize>(
    run: &Run<'_>,
    (legs, count): (&[Leg<D>], u32),
    correction: Option<&Coupling>,
    plane: impl Fn([f64; D]) -> [f64; 2],
) -> Result<Contoured, ContourError> {
    let machine: Option<CoupledMachine<D>> = run.file.machine()?;
    let machine = machine.ok_or_else(|| ContourError::Dimensions {
        machine: run.file.path.clone(),
        axes: run.file.dimensions(),
        path: D,
    })?;
    let strategies = run.compensation.strategies(machine.drives().len())?;
    let mut sensors: Vec<DriveSensors<'_>> = Vec::new();
    for (d, drive) in machine.drives().iter().enumerate() {
        let seed = run.seed.wrapping_mul(2).wrapping_add(d as u64);
        let mut noise = NoiseLevels::good(&drive.nominal)
            .scaled(run.noise)
            .sensors(seed);
        let noisy = run.noise > 0.0;
        sensors.push(Box::new(move |seen: &mut Measured| {
            if noisy {
                noise(seen);
            }
        }));
    }
    let mut runner = Laps::new(&machine, strategies)?.sensing(sensors);
    if let Some(coupling) = correction {
        runner = runner.correcting(coupling.clone());
    }
    let mut found = Vec::new();
    let mut shown = Shown::default();
    let (mut corners, mut curves) = (Vec::new(), Vec::new());
    for lap in 1..=count {
        let last = lap == count;
        let mut errors = Vec::new();
        let mut begun = 0.0;
        for leg in legs {
            let traced = runner.lap(&leg.profile)?.lap.traced;
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
                    shown.push(begun, foot, position, &plane);
                }
            }
            begun += leg.profile.path().length();
        }
        found.push(LapFigures::of(lap as usize, errors));
        (run.each)();
    }
    let durations = legs.iter().map(|leg| leg.profile.duration());
    Ok(Contoured {
        direction: match legs {
            [only] => only.name.clone(),
            _ => "program".to_owned(),
        },
        duration_s: durations.sum(),
        fastest: fastest(legs),
        laps: found,
        reversals: Vec::new(),
        corners,
        curves,
        shown,
    })
}
