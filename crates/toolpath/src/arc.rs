//! A circular arc in any plane, or a helix.

use crate::PathPoint;
use crate::error::{ToolpathError, coordinates, positive, within};
use crate::vector::{add_scaled, cube, dot, norm, scaled, sub};

/// A circular arc: `centre + radius (cos φ u + sin φ v) + φ rise`, φ from 0 to `sweep`.
///
/// `u` and `v` are perpendicular unit vectors that span its plane; it may turn more than once.
/// With a rise, which is perpendicular to the plane, it is a helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc<const D: usize> {
    centre: [f64; D],
    radius: f64,
    u: [f64; D],
    v: [f64; D],
    rise: [f64; D],
    /// rad, greater than zero.
    sweep: f64,
    /// Length per rad, m.
    speed: f64,
}

impl<const D: usize> Arc<D> {
    /// The arc that begins at `start`, at first in the direction of `towards`, about `centre`,
    /// and turns by `sweep` (rad).
    ///
    /// `towards` is any vector whose part perpendicular to the radius at `start` shows where the
    /// arc goes; with that radius it spans the arc's plane.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] if a value is not finite, the radius is not from 1e-9 to 1e9 m,
    /// the sweep is not from 1e-9 to 1e6 rad, or `towards` points along the radius.
    pub fn new(
        centre: [f64; D],
        start: [f64; D],
        towards: [f64; D],
        sweep: f64,
    ) -> Result<Self, ToolpathError> {
        coordinates("centre", centre)?;
        coordinates("start", start)?;
        coordinates("towards", towards)?;
        if !(1e-9..=1e6).contains(&sweep) {
            let (field, unit, valid) = ("sweep", "rad", "from 1e-9 to 1e6");
            return Err(ToolpathError::Invalid {
                field,
                value: sweep,
                unit,
                valid,
            });
        }
        let spoke = sub(&start, &centre);
        let radius = positive("radius of an arc", norm(&spoke), "m")?;
        let u = scaled(1.0 / radius, &spoke);
        let across = add_scaled(&towards, -dot(&towards, &u), &u);
        let size = norm(&across);
        let share = size / norm(&towards);
        // False for a NaN too.
        let holds = share > 1e-9;
        if !holds {
            let field = "part of `towards` across the radius";
            let valid = "greater than 1e-9 of its length";
            return Err(ToolpathError::Invalid {
                field,
                value: share,
                unit: "",
                valid,
            });
        }
        // Twice, for a right angle to the last bit.
        let v = scaled(1.0 / size, &across);
        let v = add_scaled(&v, -dot(&v, &u), &u);
        Ok(Self {
            centre,
            radius,
            u,
            v,
            rise: [0.0; D],
            sweep,
            speed: radius,
        })
    }

    /// The same as a helix that advances by `advance` (m) over its whole sweep.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] if the advance is not finite or not perpendicular to the arc's
    /// plane (a part of 1e-9 of its length in the plane is dropped).
    pub fn helix(self, advance: [f64; D]) -> Result<Self, ToolpathError> {
        coordinates("advance", advance)?;
        let inside = libm::hypot(dot(&advance, &self.u), dot(&advance, &self.v));
        let share = inside / norm(&advance).max(f64::MIN_POSITIVE);
        let valid = "at most 1e-9 of its length";
        within(
            "part of `advance` in the plane of the arc",
            share,
            "",
            1e-9,
            valid,
        )?;
        let rise = scaled(1.0 / self.sweep, &advance);
        let speed = libm::hypot(self.radius, norm(&rise));
        Ok(Self {
            rise,
            speed,
            ..self
        })
    }

    /// Centre of its beginning, m.
    pub fn centre(&self) -> [f64; D] {
        self.centre
    }

    /// Radius of the circle, m; that of a helix's curvature is greater.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// How far it turns, rad.
    pub fn sweep(&self) -> f64 {
        self.sweep
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.sweep * self.speed
    }

    /// Greatest |x′|, |x″| and |x‴| of axis `i` over a whole turn.
    pub(crate) fn amplitudes(&self, i: usize) -> [f64; 3] {
        let planar = libm::hypot(self.u[i], self.v[i]) * self.radius / self.speed;
        let k = 1.0 / self.speed;
        let along = planar + (self.rise[i] * k).abs();
        [along, planar * k, planar * k * k]
    }

    /// The part between two arc lengths, m.
    pub(crate) fn part(&self, [from, to]: [f64; 2]) -> Self {
        let phi = from / self.speed;
        let (sin, cos) = libm::sincos(phi);
        Self {
            centre: add_scaled(&self.centre, phi, &self.rise),
            u: add_scaled(&scaled(cos, &self.u), sin, &self.v),
            v: add_scaled(&scaled(cos, &self.v), -sin, &self.u),
            sweep: (to - from) / self.speed,
            ..*self
        }
    }

    /// The point at arc length `s` (m), also beyond the ends.
    pub fn at(&self, s: f64) -> PathPoint<D> {
        let k = 1.0 / self.speed;
        let phi = s * k;
        let (sin, cos) = libm::sincos(phi);
        let out: [f64; D] = std::array::from_fn(|i| cos * self.u[i] + sin * self.v[i]);
        let round: [f64; D] = std::array::from_fn(|i| cos * self.v[i] - sin * self.u[i]);
        let rk = self.radius * k;
        let position = add_scaled(&self.centre, self.radius, &out);
        PathPoint {
            position: add_scaled(&position, phi, &self.rise),
            tangent: add_scaled(&scaled(rk, &round), k, &self.rise),
            curvature: scaled(-rk * k, &out),
            third: scaled(-self.radius * cube(k), &round),
        }
    }
}
