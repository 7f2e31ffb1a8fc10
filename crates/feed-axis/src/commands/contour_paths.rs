//! Paths of `contour`: circles, the butterfly, NURBS from a file, programs in G-code.

use std::f64::consts::FRAC_PI_4;
use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Deserialize;
use toolpath::named::{CircleTest, Direction, butterfly};
use toolpath::{
    FeedLimits, FeedProfile, Line, Nurbs, NurbsData, Path, PathSegment, PathTolerances, gcode,
};

use crate::context::from_toml;

/// Options that name another path than a circle.
#[derive(Args)]
pub struct PathOptions {
    /// Program in G-code (G0 to G3) in place of a circle; its feeds, or --feed before its first F
    #[arg(long, value_name = "FILE", conflicts_with_all = ["nurbs", "butterfly", "tilt"])]
    program: Option<PathBuf>,
    /// NURBS curve in place of a circle: TOML with degree, points_mm, knots and, if wanted, weights
    #[arg(long, value_name = "FILE", conflicts_with_all = ["butterfly", "tilt"])]
    nurbs: Option<PathBuf>,
    /// The butterfly in place of a circle: a NURBS curve of 383 mm with tips of 0.02 mm radius
    #[arg(long, conflicts_with = "tilt")]
    butterfly: bool,
    /// Tilt of the circle about X, degrees: three axes
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    tilt: Option<f64>,
    /// Feed of a program's G0, m/min
    #[arg(
        long,
        value_name = "M_PER_MIN",
        default_value_t = 15.0,
        allow_negative_numbers = true
    )]
    rapid: f64,
    /// Step of each axis' acceleration that is allowed where the curvature jumps, m/s²; with 0 the feed stops there
    #[arg(
        long,
        value_name = "M_PER_S2",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    acceleration_step: f64,
}

/// Feed and limits of the axes, SI units.
#[derive(Clone, Copy)]
pub struct Wanted {
    pub radius: f64,
    pub feed: f64,
    pub acceleration: f64,
    pub jerk: f64,
}

/// A part of a path at one feed, from standstill to standstill.
#[derive(Clone)]
pub struct Leg<const D: usize> {
    pub name: String,
    pub profile: Arc<FeedProfile<D>>,
    /// Arc lengths between which errors count, m.
    pub counted: (f64, f64),
    pub rapid: bool,
}

/// A path in two or three dimensions.
pub enum Route {
    Flat(Vec<Leg<2>>),
    Space(Vec<Leg<3>>),
}

/// A NURBS file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NurbsFile {
    degree: usize,
    points_mm: Vec<Vec<f64>>,
    #[serde(default)]
    weights: Vec<f64>,
    knots: Vec<f64>,
}

impl PathOptions {
    /// Whether the path is a circle.
    pub fn is_circle(&self) -> bool {
        self.program.is_none() && self.nurbs.is_none() && !self.butterfly
    }

    /// Tilt of the circle, rad; none of one in the plane.
    pub fn tilt(&self) -> Option<f64> {
        self.tilt.map(f64::to_radians)
    }

    /// Whether an option was given that circles of two axis files do not have.
    pub fn are_given(&self) -> bool {
        !self.is_circle() || self.tilt.is_some() || self.acceleration_step != 0.0
    }

    /// What the path is called, and at which feed it is run.
    pub fn title(&self, wanted: &Wanted) -> String {
        let before = match self.program {
            Some(_) => " before its first F",
            None => "",
        };
        format!(
            "{}, {} m/min{before}",
            self.name(wanted),
            60.0 * wanted.feed
        )
    }

    /// What the path is called.
    pub fn name(&self, wanted: &Wanted) -> String {
        let file = |path: &FilePath| path.display().to_string();
        match (&self.program, &self.nurbs) {
            (Some(path), _) => format!("program {}", file(path)),
            (_, Some(path)) => format!("curve {}", file(path)),
            _ if self.butterfly => "butterfly".to_owned(),
            _ => {
                let tilt = self.tilt.map(|deg| format!(" tilted by {deg}°"));
                format!(
                    "circle of {} mm{}",
                    1e3 * wanted.radius,
                    tilt.unwrap_or_default()
                )
            }
        }
    }

    /// The path. A circle in the sense of `direction`; others have one sense.
    pub fn route(&self, wanted: &Wanted, direction: Direction) -> Result<Route> {
        if let Some(file) = &self.program {
            return self.of_program(file, wanted);
        }
        if let Some(file) = &self.nurbs {
            return self.of_nurbs(file, wanted);
        }
        if self.butterfly {
            let path = butterfly().into_diagnostic()?;
            return Ok(Route::Flat(vec![self.whole("butterfly", path, wanted)?]));
        }
        let circle = CircleTest {
            // Between two reversals, so that all four lie in the counted turn.
            start: FRAC_PI_4,
            direction,
            ..CircleTest::new(wanted.radius)
        };
        let name = match direction {
            Direction::Clockwise => "clockwise",
            Direction::Counterclockwise => "counterclockwise",
        };
        Ok(match self.tilt() {
            None => {
                let circle = circle.path().into_diagnostic().wrap_err("--radius")?;
                let whole = self.whole(name, circle.path, wanted)?;
                Route::Flat(vec![Leg {
                    counted: circle.counted,
                    ..whole
                }])
            }
            Some(tilt) => {
                let circle = circle.path_tilted(tilt).into_diagnostic();
                let circle = circle.wrap_err("--radius or --tilt")?;
                let whole = self.whole(name, circle.path, wanted)?;
                Route::Space(vec![Leg {
                    counted: circle.counted,
                    ..whole
                }])
            }
        })
    }

    fn whole<const D: usize>(&self, name: &str, path: Path<D>, wanted: &Wanted) -> Result<Leg<D>> {
        // What an axis has to do at the feed wanted is not limited further.
        let limits = FeedLimits {
            acceleration_step: [self.acceleration_step; D],
            ..FeedLimits::equal(wanted.feed, wanted.feed, wanted.acceleration, wanted.jerk)
        };
        let profile = FeedProfile::plan(&path, &limits).into_diagnostic();
        let profile = profile.wrap_err("--feed, --acceleration, --acceleration-step or --jerk")?;
        Ok(Leg {
            name: name.to_owned(),
            counted: (0.0, path.length()),
            profile: Arc::new(profile),
            rapid: false,
        })
    }

    fn of_nurbs(&self, file: &FilePath, wanted: &Wanted) -> Result<Route> {
        let shown = || format!("--nurbs {}", file.display());
        let text = std::fs::read_to_string(file)
            .into_diagnostic()
            .wrap_err_with(shown)?;
        let data: NurbsFile = from_toml(&text).wrap_err_with(shown)?;
        fn points<const D: usize>(data: &NurbsFile) -> Option<Vec<[f64; D]>> {
            let point = |p: &Vec<f64>| {
                <[f64; D]>::try_from(p.as_slice())
                    .ok()
                    .map(|p| p.map(|x| 1e-3 * x))
            };
            data.points_mm.iter().map(point).collect()
        }
        let curve = |name: &str| name.to_owned();
        if let Some(points) = points::<2>(&data) {
            let path = of_points(points, &data).wrap_err_with(shown)?;
            return Ok(Route::Flat(vec![self.whole(
                &curve("curve"),
                path,
                wanted,
            )?]));
        }
        let Some(points) = points::<3>(&data) else {
            let valid = "valid: two, or three, coordinates of each point";
            return Err(
                miette!("points_mm do not have one number of coordinates; {valid}")
                    .wrap_err(shown()),
            );
        };
        let path = of_points(points, &data).wrap_err_with(shown)?;
        Ok(Route::Space(vec![self.whole(
            &curve("curve"),
            path,
            wanted,
        )?]))
    }

    fn of_program(&self, file: &FilePath, wanted: &Wanted) -> Result<Route> {
        let shown = || format!("--program {}", file.display());
        let text = std::fs::read_to_string(file)
            .into_diagnostic()
            .wrap_err_with(shown)?;
        let runs = gcode::read(&text, [0.0; 3], &PathTolerances::default());
        let runs = runs.into_diagnostic().wrap_err_with(shown)?;
        if runs.is_empty() {
            return Err(
                miette!("no motion is in it; valid: G0 to G3 with X, Y, Z").wrap_err(shown())
            );
        }
        let flat: Option<Vec<Path<2>>> = runs.iter().map(|run| flattened(&run.path)).collect();
        let leg = |i: usize| {
            let run = &runs[i];
            let name = match run.lines {
                (a, b) if a == b => format!("line {a}"),
                (a, b) => format!("lines {a} to {b}"),
            };
            let feed = run.feed.unwrap_or(self.rapid / 60.0);
            (name, Wanted { feed, ..*wanted }, run.feed.is_none())
        };
        fn all<const D: usize>(
            options: &PathOptions,
            paths: Vec<Path<D>>,
            leg: impl Fn(usize) -> (String, Wanted, bool),
        ) -> Result<Vec<Leg<D>>> {
            let one = |(i, path)| {
                let (name, wanted, rapid) = leg(i);
                Ok(Leg {
                    rapid,
                    ..options.whole(&name, path, &wanted)?
                })
            };
            paths.into_iter().enumerate().map(one).collect()
        }
        Ok(match flat {
            Some(paths) => Route::Flat(all(self, paths, leg)?),
            None => Route::Space(all(
                self,
                runs.iter().map(|run| run.path.clone()).collect(),
                leg,
            )?),
        })
    }
}

fn of_points<const D: usize>(points: Vec<[f64; D]>, data: &NurbsFile) -> Result<Path<D>> {
    let data = NurbsData {
        degree: data.degree,
        points,
        weights: data.weights.clone(),
        knots: data.knots.clone(),
    };
    let curve = Nurbs::new(&data).into_diagnostic()?;
    Path::new(vec![curve.into()]).into_diagnostic()
}

/// The same path in the plane; none if Z moves.
fn flattened(path: &Path<3>) -> Option<Path<2>> {
    let level = path.at(0.0).position[2];
    let segment = |segment: &PathSegment<3>| -> Option<PathSegment<2>> {
        let [x, y, _] = segment.at(0.0).position;
        Some(match segment {
            PathSegment::Line(line) => {
                let [a, b, z] = line.to();
                (z == level).then_some(())?;
                Line::new([x, y], [a, b]).ok()?.into()
            }
            PathSegment::Arc(arc) => {
                let [cx, cy, cz] = arc.centre();
                let [tx, ty, tz] = arc.at(0.0).tangent;
                (cz == level && tz == 0.0).then_some(())?;
                toolpath::Arc::new([cx, cy], [x, y], [tx, ty], arc.sweep())
                    .ok()?
                    .into()
            }
            _ => return None,
        })
    };
    let segments = path.segments().iter().map(segment).collect::<Option<_>>()?;
    Path::new(segments).ok()
}
