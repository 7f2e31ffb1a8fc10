//! Paths that a machine is run along: circles, curves, points, programs, each with its feeds.

use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

use toolpath::gcode::ProgramRun;
use toolpath::named::{CirclePath, CircleTest, Direction};
use toolpath::{FeedLimits, FeedProfile, Path, PathBlending, ToolpathError};

/// Feed and limits of the axes, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Feed along the path, m/s; of a program, before its first F.
    pub feed: f64,
    /// Greatest acceleration of each axis, m/s².
    pub acceleration: f64,
    /// Greatest jerk of each axis, m/s³.
    pub jerk: f64,
    /// Feed of a program's rapids, m/s.
    pub rapid: f64,
    /// Step of each axis' acceleration that is allowed where the curvature jumps, m/s²; with 0 the feed stops there.
    pub acceleration_step: f64,
}

impl Default for Wanted {
    /// 3 m/min, 1 m/s², 20 m/s³; rapids of 15 m/min; no step.
    fn default() -> Self {
        Self {
            feed: 0.05,
            acceleration: 1.0,
            jerk: 20.0,
            rapid: 0.25,
            acceleration_step: 0.0,
        }
    }
}

/// A path in two or three dimensions.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyPath {
    /// In the plane of X and Y.
    Flat(Path<2>),
    /// In space.
    Space(Path<3>),
}

/// A path to run.
#[derive(Clone, Debug, PartialEq)]
pub enum PathChoice {
    /// A circular test of this radius (m) in both senses, begun between two reversals; tilted about X (rad) it needs three axes.
    Circle {
        /// Radius, m.
        radius: f64,
        /// Tilt, rad; none of one in the plane.
        tilt: Option<f64>,
    },
    /// One path, in its one sense.
    Whole {
        /// What it is called.
        name: String,
        /// Its name as a part, in tables of corners.
        part: String,
        /// The path.
        path: AnyPath,
    },
    /// A program: parts of a path, each at its feed.
    Program {
        /// What it is called.
        name: String,
        /// Its parts.
        runs: Vec<ProgramRun>,
    },
}

/// A part of a path at one feed, from standstill to standstill.
#[derive(Clone, Debug)]
pub struct Leg<const D: usize> {
    /// What it is called.
    pub name: String,
    /// Its motion.
    pub profile: Arc<FeedProfile<D>>,
    /// Arc lengths between which errors count, m.
    pub counted: (f64, f64),
    /// Whether it is a rapid, whose error does not count.
    pub rapid: bool,
}

/// The legs of a path in two or three dimensions.
#[derive(Clone, Debug)]
pub enum Route {
    /// In the plane of X and Y.
    Flat(Vec<Leg<2>>),
    /// In space.
    Space(Vec<Leg<3>>),
}

impl PathChoice {
    /// The same with the corners of its lines blended; a program is blended where it is read.
    ///
    /// # Errors
    /// As [`Path::blended`].
    pub fn blended(self, blending: &PathBlending) -> Result<Self, ToolpathError> {
        Ok(match self {
            Self::Whole { name, part, path } => Self::Whole {
                name,
                part,
                path: match path {
                    AnyPath::Flat(path) => AnyPath::Flat(path.blended(blending)?),
                    AnyPath::Space(path) => AnyPath::Space(path.blended(blending)?),
                },
            },
            other => other,
        })
    }

    /// Whether it is a circular test.
    pub fn is_circle(&self) -> bool {
        matches!(self, Self::Circle { .. })
    }

    /// Radius of a circular test, m.
    pub fn radius(&self) -> Option<f64> {
        match self {
            Self::Circle { radius, .. } => Some(*radius),
            _ => None,
        }
    }

    /// Tilt of a circular test about X, rad; none in the plane.
    pub fn tilt(&self) -> Option<f64> {
        match self {
            Self::Circle { tilt, .. } => *tilt,
            _ => None,
        }
    }

    /// Both senses of a circle, or the one of another path.
    pub fn senses(&self) -> Vec<Direction> {
        match self.is_circle() {
            true => vec![Direction::Clockwise, Direction::Counterclockwise],
            false => vec![Direction::Counterclockwise],
        }
    }

    /// Refuses a circle that is none. Other paths were checked when they were made.
    ///
    /// # Errors
    /// [`ToolpathError`] for a radius or a tilt out of its range.
    pub fn check(&self) -> Result<(), ToolpathError> {
        match self {
            Self::Circle { radius, tilt } => {
                let test = CircleTest::new(*radius);
                match tilt {
                    None => test.path().map(drop),
                    Some(tilt) => test.path_tilted(*tilt).map(drop),
                }
            }
            _ => Ok(()),
        }
    }

    /// `count` positions (m) at even steps of the arc length, one after the other, and the coordinates of each; of a circle one
    /// turn.
    ///
    /// # Errors
    /// As [`PathChoice::check`].
    pub fn positions(&self, count: usize) -> Result<(Vec<f64>, usize), ToolpathError> {
        fn along<const D: usize>(
            paths: &[&Path<D>],
            (from, to): (f64, f64),
            count: usize,
        ) -> Vec<f64> {
            let step = (to - from) / count.saturating_sub(1).max(1) as f64;
            let at = |k: usize| {
                let mut s = from + step * k as f64;
                let mut here = paths.iter();
                let last = paths.len().saturating_sub(1);
                let path = here.by_ref().take(last).find(|path| {
                    let within = s <= path.length();
                    s -= if within { 0.0 } else { path.length() };
                    within
                });
                let path = path.or(paths.last());
                path.map_or([0.0; D], |path| path.at(s).position)
            };
            (0..count).flat_map(at).collect()
        }
        Ok(match self {
            Self::Circle { radius, tilt } => {
                let test = CircleTest::new(*radius);
                match tilt {
                    None => {
                        let circle = test.path()?;
                        (along(&[&circle.path], circle.counted, count), 2)
                    }
                    Some(tilt) => {
                        let circle = test.path_tilted(*tilt)?;
                        (along(&[&circle.path], circle.counted, count), 3)
                    }
                }
            }
            Self::Whole { path, .. } => match path {
                AnyPath::Flat(path) => (along(&[path], (0.0, path.length()), count), 2),
                AnyPath::Space(path) => (along(&[path], (0.0, path.length()), count), 3),
            },
            Self::Program { runs, .. } => {
                let paths: Vec<&Path<3>> = runs.iter().map(|run| &run.path).collect();
                let length = paths.iter().map(|path| path.length()).sum();
                (along(&paths, (0.0, length), count), 3)
            }
        })
    }

    /// What it is called.
    pub fn name(&self) -> String {
        match self {
            Self::Circle { radius, tilt } => {
                // 35° as radians and back are not 35.
                let degrees = |tilt: &f64| (1e9 * tilt.to_degrees()).round() / 1e9;
                let tilt = tilt.as_ref().map(degrees);
                let tilt = tilt.map(|deg| format!(" tilted by {deg}°"));
                let radius = (1e12 * radius).round() / 1e9;
                format!("circle of {radius} mm{}", tilt.unwrap_or_default())
            }
            Self::Whole { name, .. } | Self::Program { name, .. } => name.clone(),
        }
    }

    /// What it is called, and at which feed it is run.
    pub fn title(&self, wanted: &Wanted) -> String {
        let before = match self {
            Self::Program { .. } => " before its first F",
            _ => "",
        };
        format!("{}, {} m/min{before}", self.name(), 60.0 * wanted.feed)
    }

    /// Its legs. A circle in the sense of `direction`; others have one sense.
    ///
    /// # Errors
    /// [`ToolpathError`] for a value out of its range, or a feed that cannot be planned.
    pub fn route(&self, wanted: &Wanted, direction: Direction) -> Result<Route, ToolpathError> {
        match self {
            Self::Circle { radius, tilt } => circle(*radius, *tilt, wanted, direction),
            Self::Whole { part, path, .. } => Ok(match path {
                AnyPath::Flat(path) => Route::Flat(vec![leg(part, path, wanted)?]),
                AnyPath::Space(path) => Route::Space(vec![leg(part, path, wanted)?]),
            }),
            Self::Program { runs, .. } => program(runs, wanted),
        }
    }
}

fn circle(
    radius: f64,
    tilt: Option<f64>,
    wanted: &Wanted,
    direction: Direction,
) -> Result<Route, ToolpathError> {
    let test = CircleTest {
        // Between two reversals, so that all four lie in the counted turn.
        start: FRAC_PI_4,
        direction,
        ..CircleTest::new(radius)
    };
    fn counted<const D: usize>(
        circle: CirclePath<D>,
        wanted: &Wanted,
        direction: Direction,
    ) -> Result<Vec<Leg<D>>, ToolpathError> {
        let name = match direction {
            Direction::Clockwise => "clockwise",
            Direction::Counterclockwise => "counterclockwise",
        };
        Ok(vec![Leg {
            counted: circle.counted,
            ..leg(name, &circle.path, wanted)?
        }])
    }
    Ok(match tilt {
        None => Route::Flat(counted(test.path()?, wanted, direction)?),
        Some(tilt) => Route::Space(counted(test.path_tilted(tilt)?, wanted, direction)?),
    })
}

fn leg<const D: usize>(
    name: &str,
    path: &Path<D>,
    wanted: &Wanted,
) -> Result<Leg<D>, ToolpathError> {
    // What an axis has to do at the feed wanted is not limited further.
    let limits = FeedLimits {
        acceleration_step: [wanted.acceleration_step; D],
        ..FeedLimits::equal(wanted.feed, wanted.feed, wanted.acceleration, wanted.jerk)
    };
    Ok(Leg {
        name: name.to_owned(),
        counted: (0.0, path.length()),
        profile: Arc::new(FeedProfile::plan(path, &limits)?),
        rapid: false,
    })
}

/// The legs of a program: in the plane if Z does not move.
fn program(runs: &[ProgramRun], wanted: &Wanted) -> Result<Route, ToolpathError> {
    fn legs<const D: usize>(
        runs: &[ProgramRun],
        paths: &[Path<D>],
        wanted: &Wanted,
    ) -> Result<Vec<Leg<D>>, ToolpathError> {
        let one = |(run, path): (&ProgramRun, &Path<D>)| {
            let name = match run.lines {
                (a, b) if a == b => format!("line {a}"),
                (a, b) => format!("lines {a} to {b}"),
            };
            let wanted = Wanted {
                feed: run.feed.unwrap_or(wanted.rapid),
                ..*wanted
            };
            Ok(Leg {
                rapid: run.feed.is_none(),
                ..leg(&name, path, &wanted)?
            })
        };
        runs.iter().zip(paths).map(one).collect()
    }
    let flat: Option<Vec<Path<2>>> = runs.iter().map(|run| run.path.flattened()).collect();
    Ok(match flat {
        Some(paths) => Route::Flat(legs(runs, &paths, wanted)?),
        None => {
            let paths: Vec<Path<3>> = runs.iter().map(|run| run.path.clone()).collect();
            Route::Space(legs(runs, &paths, wanted)?)
        }
    })
}
