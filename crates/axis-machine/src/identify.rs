//! Squareness and cross-talk from circular tests.

use nalgebra::{SMatrix, SymmetricEigen};
use toolpath::iso230_4::NominalCircle;
use toolpath::named::Direction;

use crate::error::CircleFitError;

/// The counted turn of a circular test, as a ball bar or a grid encoder shows it.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredCircle<'a> {
    /// The circle that was programmed.
    pub nominal: NominalCircle,
    /// Feed along it, m/s.
    pub feed: f64,
    /// Its sense.
    pub direction: Direction,
    /// Positions of the tool, m, evenly over the turn.
    pub points: &'a [[f64; 2]],
}

/// A value with its standard error, if the residuals were independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircleEstimate {
    /// The value, SI units.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// What circular tests show of two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CirclesFound {
    /// Centre, less the nominal one, m.
    pub centre: [CircleEstimate; 2],
    /// Radius, less the nominal one, m.
    pub radius: CircleEstimate,
    /// Squareness error φ of both axes, rad: X moves so far per travel of Y.
    pub squareness: CircleEstimate,
    /// Cross-talk k, m/(m/s²): of X by the acceleration of Y and of Y by that of X together, which no circle distinguishes.
    pub crosstalk: CircleEstimate,
    /// Lag of Y less that of X, s; none if all circles had one direction.
    pub lag: Option<CircleEstimate>,
    /// Root mean square of the radial residuals, m.
    pub residual: f64,
}

/// Unknowns, if both directions were run.
const MOST: usize = 6;

/// Smallest eigenvalue of the scaled normal matrix, of which the diagonal is 1, that counts: between feeds that differ by 10⁻⁴
/// (10⁻⁹) and rounding (10⁻¹⁴).
const RANK: f64 = 1e-11;

/// Squareness and cross-talk of two axes from circles at two feeds at least, by least squares of the radial deviations.
///
/// With θ the angle of a point about the nominal centre, σ = 1 counterclockwise and −1 clockwise, the deviation to first order is
///
/// ```text
/// Δr = x₀ cos θ + y₀ sin θ + ΔR + (½ φ R − ½ k v²/R + ½ σ v Δτ) sin 2θ
/// ```
///
/// (a lag Δτ of Y moves the tool by −Δτ v_y = −Δτ σ v cos θ in Y; the sign above is that of a lag of X less that of Y, so that
/// the value returned is its negative). At one v/R the columns of φ and k are one: only 5 of 6 unknowns can be determined. What friction leaves
/// after reversals is opposite in the two directions, as the lag is, and falls out of φ and k where both were run.
///
/// # Errors
/// [`CircleFitError::Rank`] if the circles do not tell the unknowns apart, and for values that cannot be.
pub fn fit_circles(circles: &[MeasuredCircle<'_>]) -> Result<CirclesFound, CircleFitError> {
    check(circles)?;
    let both = circles.iter().any(|c| c.direction != circles[0].direction);
    let unknowns = if both { MOST } else { MOST - 1 };
    let (mut normal, mut right, mut square, mut count) =
        ([[0.0; MOST]; MOST], [0.0; MOST], 0.0, 0.0);
    for circle in circles {
        for point in circle.points {
            let (row, deviation) = row(circle, *point);
            for i in 0..unknowns {
                for j in 0..unknowns {
                    normal[i][j] += row[i] * row[j];
                }
                right[i] += row[i] * deviation;
            }
            square += deviation * deviation;
            count += 1.0;
        }
    }
    let scale: [f64; MOST] = std::array::from_fn(|i| normal[i][i].max(f64::MIN_POSITIVE).sqrt());
    // An unknown that is not asked for is one that is determined, apart from the others.
    let scaled = SMatrix::<f64, MOST, MOST>::from_fn(|i, j| match i == j {
        true => 1.0,
        false => normal[i][j] / (scale[i] * scale[j]),
    });
    let SymmetricEigen {
        eigenvalues: values,
        eigenvectors: vectors,
    } = scaled.symmetric_eigen();
    let determined = values.iter().filter(|value| **value > RANK).count();
    let rank = determined - (MOST - unknowns);
    if rank < unknowns {
        return Err(refuse(circles, rank, unknowns));
    }
    let inverse = |i: usize, j: usize| -> f64 {
        let sum: f64 = (0..MOST)
            .map(|k| vectors[(i, k)] * vectors[(j, k)] / values[k])
            .sum();
        sum / (scale[i] * scale[j])
    };
    let found: [f64; MOST] =
        std::array::from_fn(|i| (0..MOST).map(|j| inverse(i, j) * right[j]).sum());
    let explained: f64 = (0..unknowns).map(|i| found[i] * right[i]).sum();
    let residual = (square - explained).max(0.0);
    let variance = residual / (count - unknowns as f64).max(1.0);
    let of = |i: usize| CircleEstimate {
        value: found[i],
        standard_error: (variance * inverse(i, i)).max(0.0).sqrt(),
    };
    Ok(CirclesFound {
        centre: [of(0), of(1)],
        radius: of(2),
        squareness: of(3),
        crosstalk: of(4),
        lag: both.then(|| of(5)),
        residual: (residual / count).sqrt(),
    })
}

/// Derivatives of a point's radial deviation by the unknowns, and the deviation.
fn row(circle: &MeasuredCircle<'_>, [x, y]: [f64; 2]) -> ([f64; MOST], f64) {
    let NominalCircle { centre, radius } = circle.nominal;
    let (x, y) = (x - centre[0], y - centre[1]);
    let r = libm::hypot(x, y).max(f64::MIN_POSITIVE);
    let (cos, sin) = (x / r, y / r);
    let half = sin * cos; // ½ sin 2θ
    let sense = match circle.direction {
        Direction::Clockwise => -1.0,
        Direction::Counterclockwise => 1.0,
    };
    let v = circle.feed;
    let row = [
        cos,
        sin,
        1.0,
        half * radius,
        -half * v * v / radius,
        // Δx = −τ_x v_x = τ_x σ v sin θ and Δy = −τ_y σ v cos θ: (τ_x − τ_y) σ v sin θ cos θ.
        -half * sense * v,
    ];
    (row, r - radius)
}

fn check(circles: &[MeasuredCircle<'_>]) -> Result<(), CircleFitError> {
    if circles.is_empty() {
        return Err(CircleFitError::None);
    }
    for (i, circle) in circles.iter().enumerate() {
        let refuse = |what, value, valid| {
            Err(CircleFitError::Circle {
                what,
                circle: i + 1,
                value,
                valid,
            })
        };
        if !(1e-6..=1e3).contains(&circle.feed) {
            return refuse("the feed", circle.feed, "from 1e-6 to 1000 m/s");
        }
        if !(1e-6..=1e3).contains(&circle.nominal.radius) {
            return refuse("the radius", circle.nominal.radius, "from 1e-6 to 1000 m");
        }
        if circle.points.len() < 8 {
            let count = circle.points.len() as f64;
            return refuse("the number of points", count, "at least 8");
        }
        let all = circle.points.iter().flatten().chain(&circle.nominal.centre);
        for value in all {
            // False for a NaN too.
            let small = value.abs() <= 1e6;
            if !small {
                return refuse("a coordinate", *value, "from -1e6 to 1e6 m");
            }
        }
    }
    Ok(())
}

fn refuse(circles: &[MeasuredCircle<'_>], rank: usize, unknowns: usize) -> CircleFitError {
    let rates = circles.iter().map(|c| c.feed / c.nominal.radius);
    let (least, most) = rates.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), r| {
        (a.min(r), b.max(r))
    });
    let (why, valid) = match most - least <= 1e-4 * most {
        true => (
            "at one feed squareness and cross-talk deform a circle alike",
            "circles of at least two feeds, or radii, so that feed/radius differs",
        ),
        false => (
            "their points cover too little of the circle",
            "points around the whole circle",
        ),
    };
    CircleFitError::Rank {
        rank,
        unknowns,
        why,
        valid,
    }
}
