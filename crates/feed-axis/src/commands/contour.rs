//! `contour`: two axes on a circle, in both directions; a machine on any path.

use std::f64::consts::FRAC_PI_4;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_machine::{AxisMotion, Driven, MachineFile, MachineFileError, trace};
use axis_pipeline::strategies::{Predictors, StrategyKind};
use axis_sim::NoiseLevels;
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, ClosedLoop, Measured};
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};
use toolpath::iso230_4::{DirectionFigures, NominalCircle, figures, quadrant_glitches};
use toolpath::named::{CirclePath, CircleTest, Direction};
use toolpath::{FeedLimits, FeedProfile};

use super::contour_circle::{Contoured, Turned};
use super::contour_drives::ContourError;
use super::contour_found::{AFTER_REVERSAL, Both, Reversal};
use super::contour_laps::{self, ReferenceCorrection, Run};
use super::contour_paths::{LapOptions, PathOptions};
use super::contour_results::ResultFolders;
use super::contour_route::Wanted;
use super::simulate::{NOISE, factor};
use crate::context::read_axis;
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::print;
use crate::page::{contour as contour_page, contour_laps as laps_page};
use crate::strategy_name::strategy_name;

/// Options of `contour`.
#[derive(Args)]
pub struct Options {
    /// Axis file of X
    #[arg(
        long,
        value_name = "FILE",
        required_unless_present = "machine",
        requires = "y"
    )]
    x: Option<PathBuf>,
    /// Axis file of Y
    #[arg(
        long,
        value_name = "FILE",
        required_unless_present = "machine",
        requires = "x"
    )]
    y: Option<PathBuf>,
    #[command(flatten)]
    laps: LapOptions,
    #[command(flatten)]
    path: PathOptions,
    /// Radius of the circle, mm
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 50.0,
        allow_negative_numbers = true
    )]
    radius: f64,
    /// Feed along the circle, m/min
    #[arg(
        long,
        value_name = "M_PER_MIN",
        default_value_t = 3.0,
        allow_negative_numbers = true
    )]
    feed: f64,
    /// Greatest acceleration of each axis, m/s²
    #[arg(
        long,
        value_name = "M_PER_S2",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    acceleration: f64,
    /// Greatest jerk of each axis, m/s³
    #[arg(
        long,
        value_name = "M_PER_S3",
        default_value_t = 20.0,
        allow_negative_numbers = true
    )]
    jerk: f64,
    /// Compensation of all axes; one that needs a network, transfer functions or friction takes them from --runs
    #[arg(long, value_parser = strategy_name(), default_value = "none")]
    compensation: &'static StrategyKind,
    #[arg(long, help = NOISE, value_name = "FACTOR", default_value_t = 0.0, value_parser = factor, allow_negative_numbers = true)]
    noise: f64,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Where to write a page of both turns
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let (Some(x), Some(y)) = (&options.x, &options.y) else {
        return on_machine(options);
    };
    let needs = !options.compensation.needs.is_empty();
    if needs || options.laps.are_given() || options.path.are_given() {
        return on_machine(options);
    }
    let axes = [read(x, "--x")?, read(y, "--y")?];
    let turns = [Direction::Clockwise, Direction::Counterclockwise];
    let turns = turns.map(|direction| turn(options, &axes, direction));
    let [clockwise, counterclockwise] = turns;
    let turns = [clockwise?, counterclockwise?];
    let nominal = options.nominal();
    let [there, back] = turns.each_ref().map(|t| t.counted.as_slice());
    let figures = figures(&nominal, there, back).into_diagnostic()?;
    let [x, y] = axes.each_ref().map(|axis| axis.name.as_str());
    let value = Contoured {
        x,
        y,
        compensation: options.compensation.name,
        radius_mm: options.radius,
        feed_m_per_min: options.feed,
        fastest_m_per_min: turns[1].fastest,
        duration_s: turns[1].duration,
        clockwise: Turned::of(&turns[0], &figures.clockwise, &nominal)?,
        counterclockwise: Turned::of(&turns[1], &figures.counterclockwise, &nominal)?,
        both: Both::of(&figures),
        report: options.report.as_deref(),
    };
    if let Some(path) = &options.report {
        let page = contour_page::page(&value, &nominal, [there, back]);
        axis_report::write_atomic(path, &page).into_diagnostic()?;
    }
    print("contour", &value)
}

/// A machine, or another path than a circle.
fn on_machine(options: &Options) -> Result<()> {
    let file = match (&options.laps.machine, &options.x, &options.y) {
        (Some(file), ..) => MachineFile::read(file),
        (_, Some(x), Some(y)) => {
            let mut file = MachineFile::of_axes(read(x, "--x")?, read(y, "--y")?);
            (file.text.axes.x, file.text.axes.y) = (x.clone(), y.clone());
            Ok(file)
        }
        _ => {
            return Err(wrong_use(
                "give --machine FILE, or --x FILE and --y FILE".to_owned(),
            ));
        }
    };
    let file = file.map_err(|error| match error {
        MachineFileError::Axis(error) => miette::Report::new(*error),
        other => miette::miette!("{other}"),
    })?;
    let path = options.path.choice(1e-3 * options.radius)?;
    let results = ResultFolders {
        runs: &options.laps.runs,
        quick: options.laps.quick,
        makes: false,
    };
    let kind = options.compensation;
    let compensation = results
        .compensation(kind, &file)
        .wrap_err("--compensation")?;
    let networks = results.networks(kind, &file)?;
    let per_s = |feeds: &[f64]| feeds.iter().map(|feed| feed / 60.0).collect();
    let run = Run {
        file: &file,
        path: &path,
        laps: options.laps.laps,
        wanted: options.path.wanted(Wanted {
            feed: options.feed / 60.0,
            acceleration: options.acceleration,
            jerk: options.jerk,
            ..Wanted::default()
        }),
        identify: per_s(&options.laps.identify),
        correct: match options.laps.correct {
            true => ReferenceCorrection::FileOrFound,
            false => ReferenceCorrection::Nothing,
        },
        feeds: per_s(&options.laps.feeds),
        compensation,
        noise: options.noise,
        seed: options.seed,
        each: &|| (),
    };
    let found = contour_laps::run(&run).map_err(worded)?;
    let mut found = found.reported(options.report.as_deref());
    found.networks = networks;
    if let Some(file) = &options.report {
        let page = laps_page::page(&found, path.radius());
        axis_report::write_atomic(file, &page).into_diagnostic()?;
    }
    print("contour", &found)
}

/// An error of a run, with the options that it is about.
fn worded(error: ContourError) -> miette::Report {
    match &error {
        ContourError::NoCircle => wrong_use(
            "--identify takes circles in the plane of X and Y; give --radius alone".to_owned(),
        ),
        ContourError::Circles(_) => miette::miette!("{error}").wrap_err("--identify"),
        ContourError::Path(_) => miette::miette!("{error}")
            .wrap_err("--feed, --acceleration, --jerk, --acceleration-step, --radius or --tilt"),
        _ => miette::miette!("{error}"),
    }
}

fn read(file: &Path, option: &str) -> Result<Axis> {
    let axis = read_axis(file)?;
    match axis.freedom() {
        Freedom::Linear => Ok(axis),
        Freedom::Rotary => Err(wrong_use(format!(
            "{option}: the load of {} turns; a circle needs two axes that move along lines",
            file.display()
        ))),
    }
}

impl Options {
    fn nominal(&self) -> NominalCircle {
        NominalCircle {
            centre: [0.0; 2],
            radius: 1e-3 * self.radius,
        }
    }

    fn circle(&self, direction: Direction) -> Result<CirclePath<2>> {
        // Between two reversals, so that all four lie in the counted turn.
        let circle = CircleTest {
            start: FRAC_PI_4,
            direction,
            ..CircleTest::new(1e-3 * self.radius)
        };
        circle.path().into_diagnostic().wrap_err("--radius")
    }
}

/// Instants at which the greatest speed of a turn is looked for.
const INSTANTS: u32 = 2000;

/// One direction, as it was run.
struct Turn {
    duration: f64,
    /// Greatest speed along the path, m/min.
    fastest: f64,
    /// Greatest contour error of the counted turn, m.
    worst: f64,
    /// Positions of it, m.
    counted: Vec<[f64; 2]>,
}

fn turn(options: &Options, axes: &[Axis; 2], direction: Direction) -> Result<Turn> {
    let circle = options.circle(direction)?;
    let feed = options.feed / 60.0;
    // What an axis has to do at the feed wanted is not limited further.
    let limits = FeedLimits::equal(feed, feed, options.acceleration, options.jerk);
    let profile = FeedProfile::plan(&circle.path, &limits)
        .into_diagnostic()
        .wrap_err("--feed, --acceleration or --jerk")?;
    let profile = Arc::new(profile);
    let [x, y] = axes.each_ref().map(ClosedLoop::new);
    let loops = [x.into_diagnostic()?, y.into_diagnostic()?];
    let driven = |i: usize| -> Result<Driven<'_>> {
        let motion = AxisMotion::new(profile.clone(), i, axes[i].stroke.start);
        let law = (options.compensation)
            .compensator(&Predictors::of(&axes[i]), Arc::new(motion))
            .into_diagnostic()?;
        let mut sensors = NoiseLevels::good(&axes[i])
            .scaled(options.noise)
            .sensors(options.seed.wrapping_mul(2).wrapping_add(i as u64));
        let noisy = options.noise > 0.0;
        let sense = move |seen: &mut Measured| {
            if noisy {
                sensors(seen);
            }
        };
        Ok(Driven::new(&loops[i], law).sensing(sense))
    };
    let traced = trace(&profile, [driven(0)?, driven(1)?]).into_diagnostic()?;
    let errors = traced.contour_error_between(circle.counted);
    let at = |k: u32| profile.at(profile.duration() * f64::from(k) / f64::from(INSTANTS));
    let speeds = (0..=INSTANTS).map(|k| 60.0 * at(k).feed);
    Ok(Turn {
        duration: profile.duration(),
        fastest: speeds.fold(0.0, f64::max),
        worst: errors.map(|foot| foot.length()).fold(0.0, f64::max),
        counted: traced.between(circle.counted).to_vec(),
    })
}

impl Turned {
    fn of(turn: &Turn, found: &DirectionFigures, nominal: &NominalCircle) -> Result<Self> {
        let glitches = quadrant_glitches(nominal, &turn.counted, AFTER_REVERSAL);
        Ok(Self {
            contour_error_um: 1e6 * turn.worst,
            g_um: 1e6 * found.g,
            f_max_um: 1e6 * found.f_max,
            f_min_um: 1e6 * found.f_min,
            reversals: glitches
                .into_diagnostic()?
                .iter()
                .map(Reversal::of)
                .collect(),
        })
    }
}
