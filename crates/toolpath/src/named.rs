//! Paths that tests of machines use.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::error::{ToolpathError, coordinates, positive, within};
use crate::{Arc, Blend, Line, Nurbs, NurbsData, Path, PathSegment};

/// Sense of a circle, seen against the third axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Direction {
    /// From +X towards −Y (G2).
    Clockwise,
    /// From +X towards +Y (G3).
    Counterclockwise,
}

/// A circular test in the manner of ISO 230-4: a run-in, counted turns, a run-out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CircleTest {
    /// Centre, m.
    pub centre: [f64; 2],
    /// Radius, m.
    pub radius: f64,
    /// Angle of the first counted point from +X towards +Y, rad.
    pub start: f64,
    /// Sense of motion.
    pub direction: Direction,
    /// Angle before the first counted point, rad; the feed is reached in it.
    pub run_in: f64,
    /// Counted turns, from 1e-3 to 1e3.
    pub turns: f64,
    /// Angle after the last counted point, rad.
    pub run_out: f64,
}

/// A path of which a part is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct CirclePath<const D: usize> {
    /// The whole path.
    pub path: Path<D>,
    /// Arc lengths (m) between which it is counted.
    pub counted: (f64, f64),
}

impl CircleTest {
    /// A test of one counted turn, counterclockwise from +X about the origin, with half a turn
    /// before and after, on a circle of `radius` (m).
    pub fn new(radius: f64) -> Self {
        let half = 0.5 * TAU;
        Self {
            centre: [0.0; 2],
            radius,
            start: 0.0,
            direction: Direction::Counterclockwise,
            run_in: half,
            turns: 1.0,
            run_out: half,
        }
    }

    /// The path: one arc.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] for a value that is not finite or out of its range.
    pub fn path(&self) -> Result<CirclePath<2>, ToolpathError> {
        self.placed(|p| p)
    }

    /// The same circle in three dimensions, turned about an axis through its centre parallel to
    /// +X by `tilt` (rad): at a quarter turn it lies in the XZ plane.
    ///
    /// # Errors
    /// As [`CircleTest::path`].
    pub fn path_tilted(&self, tilt: f64) -> Result<CirclePath<3>, ToolpathError> {
        within("tilt", tilt, "rad", 1e3, "from -1e3 to 1e3")?;
        let (sin, cos) = libm::sincos(tilt);
        self.placed(|[x, y]| [x, cos * y, sin * y])
    }

    fn placed<const D: usize>(
        &self,
        place: impl Fn([f64; 2]) -> [f64; D],
    ) -> Result<CirclePath<D>, ToolpathError> {
        coordinates("centre", self.centre)?;
        positive("radius", self.radius, "m")?;
        within("start", self.start, "rad", 1e3, "from -1e3 to 1e3")?;
        within("run_in", self.run_in - 500.0, "rad", 500.0, "from 0 to 1e3")?;
        within(
            "turns",
            self.turns - 500.0005,
            "",
            499.9995,
            "from 1e-3 to 1e3",
        )?;
        within(
            "run_out",
            self.run_out - 500.0,
            "rad",
            500.0,
            "from 0 to 1e3",
        )?;
        let sign = match self.direction {
            Direction::Clockwise => -1.0,
            Direction::Counterclockwise => 1.0,
        };
        let (sin, cos) = libm::sincos(self.start - sign * self.run_in);
        let spoke = place([self.radius * cos, self.radius * sin]);
        let towards = place([-sign * sin, sign * cos]);
        let mut centre = [0.0; D];
        centre[..2].copy_from_slice(&self.centre);
        let start = std::array::from_fn(|i| centre[i] + spoke[i]);
        let sweep = self.run_in + self.turns * TAU + self.run_out;
        let path = Path::new(vec![Arc::new(centre, start, towards, sweep)?.into()])?;
        let from = self.radius * self.run_in;
        Ok(CirclePath {
            path,
            counted: (from, from + self.radius * self.turns * TAU),
        })
    }
}

/// A rectangle of `size` (m) about the origin, counterclockwise from the middle of its lower
/// side, whose corners are arcs of `radius` (m; [`Blend::Arc`]) or other blends that begin at
/// the same places.
///
/// # Errors
/// [`ToolpathError::Invalid`] if a size is not positive or the radius not less than half of the
/// shorter side.
pub fn rounded_rectangle(
    size: [f64; 2],
    radius: f64,
    corners: Blend,
) -> Result<Path<2>, ToolpathError> {
    let half = [
        0.5 * positive("size", size[0], "m")?,
        0.5 * positive("size", size[1], "m")?,
    ];
    positive("radius", radius, "m")?;
    // False for a NaN too.
    let holds = radius <= 0.999 * half[0].min(half[1]);
    if !holds {
        let (field, valid) = ("radius", "at most 0.999 of half of the shorter side");
        return Err(ToolpathError::Invalid {
            field,
            value: radius,
            unit: "m",
            valid,
        });
    }
    let [a, b] = half;
    let ring = [[0.0, -b], [a, -b], [a, b], [-a, b], [-a, -b], [0.0, -b]];
    let mut segments: Vec<PathSegment<2>> = Vec::new();
    let mut from = ring[0];
    for i in 1..5 {
        let corner = ring[i];
        let along = |p: [f64; 2]| -> [f64; 2] {
            let size = libm::hypot(p[0] - corner[0], p[1] - corner[1]);
            std::array::from_fn(|k| corner[k] + (p[k] - corner[k]) * (radius / size))
        };
        let (begin, end) = (along(ring[i - 1]), along(ring[i + 1]));
        segments.push(Line::new(from, begin)?.into());
        segments.push(match corners {
            Blend::Arc => {
                let centre = [begin[0] + end[0] - corner[0], begin[1] + end[1] - corner[1]];
                let towards = [corner[0] - begin[0], corner[1] - begin[1]];
                Arc::new(centre, begin, towards, FRAC_PI_2)?.into()
            }
            Blend::Parabola => PathSegment::bezier(vec![begin, corner, end])?,
            Blend::Quintic => {
                let half = |p: [f64; 2]| [0.5 * (p[0] + corner[0]), 0.5 * (p[1] + corner[1])];
                PathSegment::bezier(vec![begin, half(begin), corner, corner, half(end), end])?
            }
        });
        from = end;
    }
    segments.push(Line::new(from, ring[5])?.into());
    Path::new(segments)
}

/// The butterfly: a cubic NURBS of 51 control points, 383 mm long with tips down to a radius of
/// about 0.02 mm, on which feed planners are compared.
///
/// Points (mm), weights and knots as in Hu, Jiang, Huo et al. 2023,
/// [doi 10.1007/s00170-023-12427-5](https://doi.org/10.1007/s00170-023-12427-5), except that the
/// last point is the first, as others print it (there its x is 54.492).
///
/// # Errors
/// None that is known: the data are fixed.
pub fn butterfly() -> Result<Path<2>, ToolpathError> {
    let data = NurbsData {
        degree: 3,
        points: BUTTERFLY
            .iter()
            .map(|&[x, y, _]| [1e-3 * x, 1e-3 * y])
            .collect(),
        weights: BUTTERFLY.iter().map(|&[_, _, w]| w).collect(),
        knots: [0.0; 3]
            .into_iter()
            .chain(BUTTERFLY_KNOTS)
            .chain([1.0; 3])
            .collect(),
    };
    Path::new(vec![Nurbs::new(&data)?.into()])
}

/// x, y in mm and weight of each control point.
const BUTTERFLY: [[f64; 3]; 51] = [
    [54.493, 52.139, 1.0],
    [55.507, 52.139, 1.0],
    [56.082, 49.615, 1.0],
    [56.78, 44.971, 1.2],
    [69.575, 51.358, 1.0],
    [77.786, 58.573, 1.0],
    [90.526, 67.081, 1.0],
    [105.973, 63.801, 1.0],
    [100.4, 47.326, 1.0],
    [94.567, 39.913, 1.0],
    [92.369, 30.485, 1.0],
    [83.44, 33.757, 2.0],
    [91.892, 28.509, 1.0],
    [89.444, 20.393, 1.0],
    [83.218, 15.446, 5.0],
    [87.621, 4.83, 3.0],
    [80.945, 9.267, 1.0],
    [79.834, 14.535, 1.1],
    [76.074, 8.522, 1.0],
    [70.183, 12.55, 1.0],
    [64.171, 16.865, 1.0],
    [59.993, 22.122, 1.0],
    [55.68, 36.359, 1.0],
    [56.925, 24.995, 1.0],
    [59.765, 19.828, 1.0],
    [54.493, 14.94, 1.0],
    [49.22, 19.828, 1.0],
    [52.06, 24.994, 1.0],
    [53.305, 36.359, 1.0],
    [48.992, 22.122, 1.0],
    [44.814, 16.865, 1.0],
    [38.802, 12.551, 1.0],
    [32.911, 8.521, 1.0],
    [29.152, 14.535, 1.1],
    [28.04, 9.267, 1.0],
    [21.364, 4.83, 3.0],
    [25.768, 15.447, 5.0],
    [19.539, 20.391, 1.0],
    [17.097, 28.512, 1.0],
    [25.537, 33.75, 2.0],
    [16.602, 30.496, 1.0],
    [14.199, 39.803, 1.0],
    [8.668, 47.408, 1.0],
    [3.0, 63.794, 1.0],
    [18.465, 67.084, 1.0],
    [31.197, 58.572, 1.0],
    [39.411, 51.358, 1.0],
    [52.204, 44.971, 1.2],
    [52.904, 49.614, 1.0],
    [53.478, 52.139, 1.0],
    [54.493, 52.139, 1.0],
];

/// Its knots; the first and the last stand four times.
const BUTTERFLY_KNOTS: [f64; 49] = [
    0.0, 0.0083, 0.015, 0.0361, 0.0855, 0.1293, 0.1509, 0.1931, 0.2273, 0.2435, 0.2561, 0.2692,
    0.2889, 0.317, 0.3316, 0.3482, 0.3553, 0.3649, 0.3837, 0.4005, 0.4269, 0.451, 0.466, 0.4891,
    0.5, 0.5109, 0.534, 0.5489, 0.5731, 0.5994, 0.6163, 0.6351, 0.6447, 0.6518, 0.6683, 0.683,
    0.7111, 0.7307, 0.7439, 0.7565, 0.7729, 0.8069, 0.8491, 0.8707, 0.9145, 0.9639, 0.985, 0.9917,
    1.0,
];
