//! Options of `contour` that name a path, laps and a machine.

use std::path::{Path as FilePath, PathBuf};

use clap::{Args, ValueEnum};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Deserialize;
use toolpath::named::butterfly;
use toolpath::{Blend, Nurbs, NurbsData, Path, PathTolerances, gcode};

use super::contour_results::RUNS;
use super::contour_route::{AnyPath, PathChoice, Wanted};
use crate::context::{from_toml, read_text};
use crate::exit::wrong_use;

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
    /// Blend the corners of a program (between lines, arcs, or both) within this distance of each, as after G64 P (mm); without, the feed stops at
    /// corners until a G64 P of the program
    #[arg(
        long,
        value_name = "MM",
        requires = "program",
        allow_negative_numbers = true
    )]
    blend: Option<f64>,
    /// Shape of blends, of G64 too: quintic, whose curvature does not jump; arc or parabola, as LinuxCNC has them, at whose ends the feed
    /// stops unless --acceleration-step allows a step
    #[arg(
        long,
        value_name = "SHAPE",
        default_value = "quintic",
        requires = "program"
    )]
    blend_shape: Shape,
    /// Step of each axis' acceleration that is allowed where the curvature jumps, m/s²; with 0 the feed stops there
    #[arg(
        long,
        value_name = "M_PER_S2",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    acceleration_step: f64,
}

/// Options of machines and laps.
#[derive(Args)]
pub struct LapOptions {
    /// Machine file: names the axis files and the couplings between them (docs/two-axes.md)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["x", "y"])]
    pub machine: Option<PathBuf>,
    /// Laps one after the other; a compensation that learns goes on from lap to lap
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub laps: u32,
    /// Find squareness and cross-talk from circles at these feeds, m/min: two at least
    #[arg(long, value_name = "M_PER_MIN", num_args = 1.., value_delimiter = ',')]
    pub identify: Vec<f64>,
    /// Subtract squareness, straightness and cross-talk errors from the references: those of the machine file, or found by --identify
    #[arg(long)]
    pub correct: bool,
    /// Folder with results of `train` and `identify` of each axis (one folder an axis, by its name), for a compensation that needs them
    #[arg(long, value_name = "DIR", default_value = RUNS)]
    pub runs: PathBuf,
    /// Take results that were made with --quick
    #[arg(long)]
    pub quick: bool,
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

/// Shapes of blends.
#[derive(Clone, Copy, ValueEnum)]
enum Shape {
    /// A Bézier curve of degree 5
    Quintic,
    /// A circular arc
    Arc,
    /// A parabola
    Parabola,
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
    /// Whether an option was given that circles of two axis files do not have.
    pub fn are_given(&self) -> bool {
        let other = self.program.is_some() || self.nurbs.is_some() || self.butterfly;
        other || self.tilt.is_some() || self.acceleration_step != 0.0
    }

    /// With feeds and limits of these options in place of the defaults.
    pub fn wanted(&self, wanted: Wanted) -> Wanted {
        Wanted {
            rapid: self.rapid / 60.0,
            acceleration_step: self.acceleration_step,
            ..wanted
        }
    }

    /// The path; a circle has `radius` (m) if no other path is named.
    pub fn choice(&self, radius: f64) -> Result<PathChoice> {
        if let Some(file) = &self.program {
            return self.program_of(file);
        }
        if let Some(file) = &self.nurbs {
            return nurbs(file);
        }
        if self.butterfly {
            return Ok(PathChoice::Whole {
                name: "butterfly".to_owned(),
                part: "butterfly".to_owned(),
                path: AnyPath::Flat(butterfly().into_diagnostic()?),
            });
        }
        Ok(PathChoice::Circle {
            radius,
            tilt: self.tilt.map(f64::to_radians),
        })
    }

    fn program_of(&self, file: &FilePath) -> Result<PathChoice> {
        let shown = || format!("--program {}", file.display());
        let text = read_text(file).wrap_err_with(shown)?;
        let shape = match self.blend_shape {
            Shape::Quintic => Blend::Quintic,
            Shape::Arc => Blend::Arc,
            Shape::Parabola => Blend::Parabola,
        };
        if let Some(mm) = self.blend.filter(|mm| !(1e-6..=1e3).contains(mm)) {
            return Err(wrong_use(format!(
                "--blend is {mm} mm; valid: from 1e-6 to 1000"
            )));
        }
        let blending = (shape, self.blend.map(|mm| 1e-3 * mm));
        let runs = gcode::read_blended(&text, [0.0; 3], &PathTolerances::default(), blending);
        let runs = runs.into_diagnostic().wrap_err_with(shown)?;
        if runs.is_empty() {
            return Err(
                miette!("no motion is in it; valid: G0 to G3 with X, Y, Z").wrap_err(shown())
            );
        }
        Ok(PathChoice::Program {
            name: format!("program {}", file.display()),
            runs,
        })
    }
}

fn nurbs(file: &FilePath) -> Result<PathChoice> {
    let shown = || format!("--nurbs {}", file.display());
    let text = read_text(file).wrap_err_with(shown)?;
    let data: NurbsFile = from_toml(&text).wrap_err_with(shown)?;
    fn points<const D: usize>(data: &NurbsFile) -> Option<Vec<[f64; D]>> {
        let point = |p: &Vec<f64>| {
            <[f64; D]>::try_from(p.as_slice())
                .ok()
                .map(|p| p.map(|x| 1e-3 * x))
        };
        data.points_mm.iter().map(point).collect()
    }
    let path = match (points::<2>(&data), points::<3>(&data)) {
        (Some(points), _) => of_points(points, &data).map(AnyPath::Flat),
        (_, Some(points)) => of_points(points, &data).map(AnyPath::Space),
        _ => Err(miette!(
            "points_mm do not have one number of coordinates; valid: two, or three, coordinates of each point"
        )),
    };
    Ok(PathChoice::Whole {
        name: format!("curve {}", file.display()),
        part: "curve".to_owned(),
        path: path.wrap_err_with(shown)?,
    })
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
