//! Figures of a circular test in the manner of ISO 230-4.
//!
//! | figure | meaning |
//! |---|---|
//! | G | circular deviation: least radial distance of two concentric circles that hold the path (minimum zone) |
//! | G(b) | bidirectional circular deviation: the same of both paths together |
//! | H | circular hysteresis: greatest radial difference of the two directions at one angle |
//! | D | mean bidirectional radial deviation: radius of the least-squares circle of both paths less the nominal radius |
//! | F max, F min | radial deviation: extremes of the distance from the nominal centre, less the nominal radius |
//!
//! The scope of the later editions names G(b), D, G and F; the symbols and H, of an earlier
//! edition, are as generally cited, not compared with the standard's own text.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::error::{ToolpathError, coordinates, positive};
use crate::vector::sub;

/// The circle that was programmed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct NominalCircle {
    /// Centre, m.
    pub centre: [f64; 2],
    /// Radius, m.
    pub radius: f64,
}

/// Radial deviations of one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DirectionFigures {
    /// Circular deviation G, m.
    pub g: f64,
    /// Greatest radial deviation F, m.
    pub f_max: f64,
    /// Least radial deviation F, m.
    pub f_min: f64,
    /// Centre of the minimum zone, m.
    pub zone_centre: [f64; 2],
}

/// Figures of a circle that was run in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CircleFigures {
    /// Clockwise.
    pub clockwise: DirectionFigures,
    /// Counterclockwise.
    pub counterclockwise: DirectionFigures,
    /// Bidirectional circular deviation G(b), m.
    pub g_bidirectional: f64,
    /// Circular hysteresis H, m.
    pub h: f64,
    /// Mean bidirectional radial deviation D, m.
    pub d: f64,
    /// Centre of the least-squares circle of both paths, m.
    pub least_squares_centre: [f64; 2],
}

/// A circle by centre and radius, and how far the points lie off it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FittedCircle {
    /// Centre, m.
    pub centre: [f64; 2],
    /// Radius, m; of a minimum zone, the mean of its two circles.
    pub radius: f64,
    /// Greatest less least distance of a point from the centre, m.
    pub range: f64,
}

/// All figures of a circle that was run in both directions.
///
/// `clockwise` and `counterclockwise` are the positions (m) of the counted turn, in any order and
/// number.
///
/// # Errors
/// [`ToolpathError::Invalid`] for a value that is not finite or a radius that is not from 1e-9 to
/// 1e9 m; [`ToolpathError::Count`] if a direction has fewer than 8 points or leaves out more than
/// an eighth of the circle.
pub fn figures(
    nominal: &NominalCircle,
    clockwise: &[[f64; 2]],
    counterclockwise: &[[f64; 2]],
) -> Result<CircleFigures, ToolpathError> {
    let (there, back) = (
        polar("clockwise", nominal, clockwise)?,
        polar("counterclockwise", nominal, counterclockwise)?,
    );
    let both: Vec<[f64; 2]> = clockwise.iter().chain(counterclockwise).copied().collect();
    let squares = least_squares_circle(nominal, &both)?;
    Ok(CircleFigures {
        clockwise: direction(nominal, clockwise, &there)?,
        counterclockwise: direction(nominal, counterclockwise, &back)?,
        g_bidirectional: minimum_zone_circle(nominal, &both)?.range,
        h: hysteresis(&there, &back),
        d: squares.radius - nominal.radius,
        least_squares_centre: squares.centre,
    })
}

fn direction(
    nominal: &NominalCircle,
    points: &[[f64; 2]],
    polar: &[(f64, f64)],
) -> Result<DirectionFigures, ToolpathError> {
    let zone = minimum_zone_circle(nominal, points)?;
    let radii = polar.iter().map(|p| p.1 - nominal.radius);
    let (f_min, f_max) = radii.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| {
        (a.min(r), b.max(r))
    });
    Ok(DirectionFigures {
        g: zone.range,
        f_max,
        f_min,
        zone_centre: zone.centre,
    })
}

/// Angle (rad, 0 to 2π) and distance (m) of each point from the nominal centre, by angle.
fn polar(
    field: &'static str,
    nominal: &NominalCircle,
    points: &[[f64; 2]],
) -> Result<Vec<(f64, f64)>, ToolpathError> {
    coordinates("centre", nominal.centre)?;
    positive("radius", nominal.radius, "m")?;
    let mut polar = Vec::with_capacity(points.len());
    for point in points {
        coordinates(field, *point)?;
        let [x, y] = sub(point, &nominal.centre);
        let angle = libm::atan2(y, x);
        let r = positive(
            "distance of a point from the nominal centre",
            libm::hypot(x, y),
            "m",
        )?;
        polar.push((if angle < 0.0 { angle + TAU } else { angle }, r));
    }
    polar.sort_by(|a, b| a.0.total_cmp(&b.0));
    let round = polar.first().map(|p| (p.0 + TAU, p.1));
    let gap = polar
        .iter()
        .skip(1)
        .copied()
        .chain(round)
        .zip(&polar)
        .map(|(b, a)| b.0 - a.0);
    // Eight points evenly spaced are an eighth apart but for rounding.
    if polar.len() < 8 || gap.fold(0.0, f64::max) > TAU / 8.0 * (1.0 + 1e-9) {
        let valid = "at least 8, and no gap of more than an eighth of the circle".to_owned();
        return Err(ToolpathError::Count {
            field,
            count: points.len(),
            valid,
        });
    }
    Ok(polar)
}

/// Greatest |a(θ) − b(θ)|, each linear in θ between its points: at a point of one of the two.
fn hysteresis(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let one = |from: &[(f64, f64)], to: &[(f64, f64)]| {
        from.iter()
            .map(|&(angle, r)| (r - radius_at(to, angle)).abs())
            .fold(0.0, f64::max)
    };
    one(a, b).max(one(b, a))
}

fn radius_at(polar: &[(f64, f64)], angle: f64) -> f64 {
    let n = polar.len();
    let after = polar.partition_point(|p| p.0 <= angle);
    let (mut low, mut high) = (polar[(after + n - 1) % n], polar[after % n]);
    if after == 0 {
        low.0 -= TAU;
    }
    if after == n {
        high.0 += TAU;
    }
    let width = high.0 - low.0;
    let share = if width > 0.0 {
        (angle - low.0) / width
    } else {
        0.0
    };
    low.1 + share * (high.1 - low.1)
}

/// The circle whose squared distances to the points (m) are least in sum.
///
/// Gauss–Newton on r_i − R with r_i the distance from the centre, from the nominal circle on.
///
/// # Errors
/// As [`figures`].
pub fn least_squares_circle(
    nominal: &NominalCircle,
    points: &[[f64; 2]],
) -> Result<FittedCircle, ToolpathError> {
    polar("points", nominal, points)?;
    let mut centre = nominal.centre;
    let mut radius = nominal.radius;
    for _ in 0..100 {
        let mut normal = [[0.0; 4]; 3];
        for point in points {
            let (r, row) = spoke(point, &centre);
            for i in 0..3 {
                for j in 0..3 {
                    normal[i][j] += row[i] * row[j];
                }
                normal[i][3] += row[i] * r;
            }
        }
        let Some([next, x, y]) = solve(normal) else {
            break;
        };
        centre = [centre[0] + x, centre[1] + y];
        radius = next;
        if libm::hypot(x, y) <= 1e-15 * radius {
            break;
        }
    }
    Ok(fitted(points, centre, radius))
}

/// Distance of a point from the centre, and its derivatives by −R, −x and −y of a circle: 1 and the
/// cosine and sine of the point's direction.
fn spoke(point: &[f64; 2], centre: &[f64; 2]) -> (f64, [f64; 3]) {
    let [x, y] = sub(point, centre);
    let r = libm::hypot(x, y).max(f64::MIN_POSITIVE);
    (r, [1.0, x / r, y / r])
}

fn fitted(points: &[[f64; 2]], centre: [f64; 2], radius: f64) -> FittedCircle {
    let radii = points.iter().map(|p| spoke(p, &centre).0);
    let (least, most) = radii.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), r| {
        (a.min(r), b.max(r))
    });
    FittedCircle {
        centre,
        radius,
        range: most - least,
    }
}

/// The two concentric circles of least radial distance that hold the points (m).
///
/// From the least-squares circle on: min over x, y, R of max |r_i − R − x cos θ_i − y sin θ_i|, a
/// linear program, about the last centre, until the centre moves no more. Each is solved exactly
/// by the exchange of one of four active points at a time, in the dual simplex method (Chetwynd,
/// Proceedings of the Institution of Mechanical Engineers 199 B2 (1985) 93). Where it ends, two outer and two inner points alternate by angle: the least zone of a profile that is
/// round within a few per cent.
///
/// # Errors
/// As [`figures`].
pub fn minimum_zone_circle(
    nominal: &NominalCircle,
    points: &[[f64; 2]],
) -> Result<FittedCircle, ToolpathError> {
    let mut best = least_squares_circle(nominal, points)?;
    for _ in 0..100 {
        let spokes: Vec<(f64, [f64; 3])> = points.iter().map(|p| spoke(p, &best.centre)).collect();
        let Some([radius, x, y]) = chebyshev(&spokes) else {
            break;
        };
        let centre = [best.centre[0] + x, best.centre[1] + y];
        let next = fitted(points, centre, radius);
        // Newton's method on the active points: once it brings nothing, rounding is all there is.
        if next.range >= best.range {
            break;
        }
        best = next;
    }
    let radii = points.iter().map(|p| spoke(p, &best.centre).0);
    best.radius = radii.fold(f64::INFINITY, f64::min) + 0.5 * best.range;
    Ok(best)
}

/// `[R, x, y]` of the least greatest |r − (R, x, y)·row|.
fn chebyshev(spokes: &[(f64, [f64; 3])]) -> Option<[f64; 3]> {
    // Four points nearest to the four quarters, with alternating signs: multipliers of one sign,
    // as 1, cos, sin are a Chebyshev system.
    let mut active: [(usize, f64); 4] = std::array::from_fn(|k| {
        let (sin, cos) = libm::sincos(FRAC_PI_2 * k as f64);
        let toward = |i: usize| spokes[i].1[1] * cos + spokes[i].1[2] * sin;
        let best = (1..spokes.len()).fold(0, |a, b| if toward(b) > toward(a) { b } else { a });
        (best, if k % 2 == 0 { 1.0 } else { -1.0 })
    });
    for _ in 0..10_000 {
        // Active: row·x + σ w = r.
        let rows = active.map(|(i, sign)| {
            let (r, [a, b, c]) = spokes[i];
            [a, b, c, sign, r]
        });
        let [radius, x, y, w] = solve(rows)?;
        let x = [radius, x, y];
        let excess = |i: usize| {
            let (r, row) = &spokes[i];
            r - (row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
        };
        let worst = (0..spokes.len()).fold((0, 0.0f64), |a, i| {
            let e = excess(i);
            if e.abs() > a.1.abs() { (i, e) } else { a }
        });
        if worst.1.abs() <= w + 4.0 * f64::EPSILON * radius {
            return Some(x);
        }
        let sign = 1f64.copysign(worst.1);
        let leaves = leaving(spokes, &active, (worst.0, sign))?;
        active[leaves] = (worst.0, sign);
    }
    None
}

/// Which active point leaves when `enters` comes: the multipliers stay at least zero.
///
/// Multipliers λ of the active points: Σ λ = 1, Σ λ σ row = 0; the entering point's column in
/// their basis is μ with Σ μ = 1, Σ μ σ row = σ′ row′. Least λ/μ among μ > 0.
fn leaving(
    spokes: &[(f64, [f64; 3])],
    active: &[(usize, f64); 4],
    enters: (usize, f64),
) -> Option<usize> {
    let row = |(i, sign): (usize, f64), k: usize| sign * spokes[i].1[k];
    let system = |right: [f64; 4]| -> Option<[f64; 4]> {
        solve::<4, 5>(std::array::from_fn(|k| {
            std::array::from_fn(|j| match (k, j) {
                (_, 4) => right[k],
                (3, _) => 1.0,
                _ => row(active[j], k),
            })
        }))
    };
    let lambda = system([0.0, 0.0, 0.0, 1.0])?;
    let mu = system([row(enters, 0), row(enters, 1), row(enters, 2), 1.0])?;
    let ratio = |j: usize| {
        if mu[j] > 1e-12 {
            lambda[j] / mu[j]
        } else {
            f64::INFINITY
        }
    };
    let best = (1..4).fold(0, |a, b| if ratio(b) < ratio(a) { b } else { a });
    ratio(best).is_finite().then_some(best)
}

/// Solution of N equations whose right side is column N, by elimination with row pivots.
fn solve<const N: usize, const M: usize>(mut a: [[f64; M]; N]) -> Option<[f64; N]> {
    for k in 0..N {
        let pivot = (k..N).fold(k, |p, i| if a[i][k].abs() > a[p][k].abs() { i } else { p });
        a.swap(k, pivot);
        let row = a[k];
        // False for a NaN too.
        let holds = row[k].abs() > 1e-14;
        if !holds {
            return None;
        }
        for next in a.iter_mut().skip(k + 1) {
            let factor = next[k] / row[k];
            for (x, y) in next.iter_mut().zip(&row).skip(k) {
                *x -= factor * y;
            }
        }
    }
    let mut x = [0.0; N];
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| a[k][j] * x[j]).sum();
        x[k] = (a[k][N] - known) / a[k][k];
    }
    Some(x)
}

/// A peak of the radial deviation after the velocity of an axis was reversed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct QuadrantGlitch {
    /// Axis that was reversed: 0 for X, 1 for Y.
    pub axis: usize,
    /// Quadrant that was entered, 1 to 4: 1 has X and Y positive.
    pub quadrant: u8,
    /// Angle of the reversal from +X towards +Y, rad, from 0 to 2π.
    pub angle: f64,
    /// Radial deviation (m) of greatest size within the window after the reversal, less the mean
    /// over an equal window before it: positive outward.
    pub peak: f64,
    /// Angle from the reversal to the peak, in the direction of motion, rad.
    pub delay: f64,
}

/// The quadrant glitches of one direction of a circle, in the order in which they were passed.
///
/// `points` (m) in the order of time. On a circle X is reversed at 0 and π and Y at ± π/2 about
/// the nominal centre; `window` (rad, up to π/4) is how far after a reversal its peak is sought.
/// A reversal counts if the points hold the whole window on both of its sides.
///
/// # Errors
/// [`ToolpathError::Invalid`] for a value that is not finite, a radius that is not from 1e-9 to
/// 1e9 m, or a window that is not from 1e-6 to π/4.
pub fn quadrant_glitches(
    nominal: &NominalCircle,
    points: &[[f64; 2]],
    window: f64,
) -> Result<Vec<QuadrantGlitch>, ToolpathError> {
    coordinates("centre", nominal.centre)?;
    positive("radius", nominal.radius, "m")?;
    if !(1e-6..=0.25 * PI).contains(&window) {
        let (field, unit, valid) = ("window", "rad", "from 1e-6 to pi/4");
        return Err(ToolpathError::Invalid {
            field,
            value: window,
            unit,
            valid,
        });
    }
    let trace = unwrapped(nominal, points)?;
    let (Some(first), Some(last)) = (trace.first(), trace.last()) else {
        return Ok(Vec::new());
    };
    let sign = if last.0 >= first.0 { 1.0 } else { -1.0 };
    // In the direction of motion, so that both directions are alike.
    let along: Vec<(f64, f64)> = trace.iter().map(|&(angle, r)| (sign * angle, r)).collect();
    let (begin, end) = (along[0].0 + window, along[along.len() - 1].0 - window);
    let mut glitches = Vec::new();
    let mut k = (begin / FRAC_PI_2 - 1e-9).ceil();
    while k * FRAC_PI_2 <= end + 1e-9 {
        let at = k * FRAC_PI_2;
        let inside = |from: f64, to: f64| along.iter().filter(move |p| p.0 >= from && p.0 <= to);
        let (count, sum) = inside(at - window, at).fold((0.0, 0.0), |(n, s), p| (n + 1.0, s + p.1));
        let base = if count > 0.0 { sum / count } else { 0.0 };
        let peak = inside(at, at + window).map(|p| (p.1 - base, p.0 - at));
        let peak = peak.fold(
            (0.0f64, 0.0),
            |a, b| if b.0.abs() > a.0.abs() { b } else { a },
        );
        let angle = (sign * at).rem_euclid(TAU) + 0.0;
        let entered = (sign * at + sign * 0.25 * PI).rem_euclid(TAU);
        let axis = (k.rem_euclid(2.0)) as usize;
        let quadrant = (entered / FRAC_PI_2) as u8 + 1;
        glitches.push(QuadrantGlitch {
            axis,
            quadrant,
            angle,
            peak: peak.0,
            delay: peak.1,
        });
        k += 1.0;
    }
    Ok(glitches)
}

/// Angle without jumps, and radial deviation, of each point in its order.
fn unwrapped(
    nominal: &NominalCircle,
    points: &[[f64; 2]],
) -> Result<Vec<(f64, f64)>, ToolpathError> {
    let mut trace: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    for point in points {
        coordinates("points", *point)?;
        let [x, y] = sub(point, &nominal.centre);
        let raw = libm::atan2(y, x);
        let angle = match trace.last() {
            Some(before) => raw + TAU * ((before.0 - raw) / TAU).round(),
            None => raw,
        };
        trace.push((angle, libm::hypot(x, y) - nominal.radius));
    }
    Ok(trace)
}
