//! Non-uniform rational B-splines, by parameter and by arc length.

use crate::PathPoint;
use crate::error::{ToolpathError, coordinates, positive};
use crate::quadrature::{Panels, gauss};
use crate::vector::{add_scaled, norm};

/// Greatest degree.
pub const MAX_DEGREE: usize = 15;

/// What makes a [`Nurbs`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredNurbs",
        into = "crate::stored::StoredNurbs"
    )
)]
pub struct NurbsData<const D: usize> {
    /// Degree p, from 1 to [`MAX_DEGREE`].
    pub degree: usize,
    /// Control points, m: n of them, n > p.
    pub points: Vec<[f64; D]>,
    /// A weight for each, from 1e-6 to 1e6; empty: all are 1.
    pub weights: Vec<f64>,
    /// n + p + 1 knots that do not fall; none inside more than p times.
    pub knots: Vec<f64>,
}

/// One polynomial piece in Bézier form, homogeneous: numerator and weight of each control point.
#[derive(Clone, Debug, PartialEq)]
struct Piece<const D: usize> {
    from: f64,
    to: f64,
    points: Vec<([f64; D], f64)>,
}

/// A NURBS curve with its arc length.
///
/// Each knot span is kept in Bézier form, found by blossoming (Ramshaw 1989,
/// [doi 10.1016/0167-8396(89)90032-0](https://doi.org/10.1016/0167-8396(89)90032-0)), and
/// evaluated by de Casteljau's scheme, which is stable for every degree; derivatives of the
/// quotient by Piegl and Tiller, The NURBS Book, equation 4.8. Its length is a sum of Gauss rules
/// of 10 points over panels that are halved until two halves agree with the whole within 1e-13 of
/// the length; the parameter of an arc length is found in them by Newton's method.
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs<const D: usize> {
    degree: usize,
    pieces: Vec<Piece<D>>,
    panels: Panels,
}

impl<const D: usize> Nurbs<D> {
    /// The curve of `data`, from knot p to knot n.
    ///
    /// # Errors
    /// [`ToolpathError::Count`] or [`ToolpathError::Element`] if a list does not fit,
    /// [`ToolpathError::Invalid`] for the degree or a length that is not from 1e-9 to 1e9 m,
    /// [`ToolpathError::Cusp`] if the derivative vanishes somewhere.
    pub fn new(data: &NurbsData<D>) -> Result<Self, ToolpathError> {
        let weights = check(data)?;
        let (p, n) = (data.degree, data.points.len());
        let homogeneous: Vec<([f64; D], f64)> = data
            .points
            .iter()
            .zip(&weights)
            .map(|(x, &w)| (x.map(|x| w * x), w))
            .collect();
        let pieces: Vec<Piece<D>> = (p..n)
            .filter(|&k| data.knots[k + 1] > data.knots[k])
            .map(|k| piece(k, p, &data.knots, &homogeneous))
            .collect();
        let mut curve = Self {
            degree: p,
            pieces,
            panels: Panels::default(),
        };
        curve.panels = curve.measure()?;
        positive("length of a NURBS", curve.length(), "m")?;
        Ok(curve)
    }

    /// Control points (m) and weights of its pieces in Bézier form.
    pub(crate) fn bezier_pieces(&self) -> impl Iterator<Item = (Vec<[f64; D]>, Vec<f64>)> {
        self.pieces.iter().map(|piece| {
            let point = |(x, w): &([f64; D], f64)| x.map(|x| x / w);
            let weights = piece.points.iter().map(|(_, w)| *w).collect();
            (piece.points.iter().map(point).collect(), weights)
        })
    }

    /// Degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Arc length of the whole curve, m.
    pub fn length(&self) -> f64 {
        self.panels.total()
    }

    /// First and last parameter.
    pub fn range(&self) -> (f64, f64) {
        let last = self.pieces.len() - 1;
        (self.pieces[0].from, self.pieces[last].to)
    }

    /// Arc lengths (m) of the knots inside, where the third derivative may jump, and the second
    /// and the first too if the knot is repeated.
    pub fn knots(&self) -> Vec<f64> {
        self.pieces[1..]
            .iter()
            .map(|piece| self.length_at(piece.from))
            .collect()
    }

    /// Position and derivatives by the parameter, `[C, C′, C″, C‴]`, at `u`; outside of the
    /// range, those of the nearer end.
    pub fn derivatives(&self, u: f64) -> [[f64; D]; 4] {
        let (first, last) = self.range();
        let u = if u > first { u.min(last) } else { first };
        self.piece(u).derivatives(u)
    }

    /// The parameter at arc length `s` (m), between the ends.
    pub fn parameter(&self, s: f64) -> f64 {
        self.panels
            .invert(s, |a, b| self.arc(a, b), |u| self.speed(u))
    }

    /// Arc length (m) from the beginning to `u`.
    pub fn length_at(&self, u: f64) -> f64 {
        self.panels.value(u, |a, b| self.arc(a, b))
    }

    /// The point at arc length `s` (m), between the ends; at a knot, of the span after it.
    pub fn at(&self, s: f64) -> PathPoint<D> {
        PathPoint::from_parameter(&self.derivatives(self.parameter(s)))
    }

    /// The point just before or just after inside knot `index` (from 0).
    pub(crate) fn beside_knot(&self, index: usize, after: bool) -> PathPoint<D> {
        let u = self.pieces[index + 1].from;
        let piece = &self.pieces[index + usize::from(after)];
        PathPoint::from_parameter(&piece.derivatives(u))
    }

    fn speed(&self, u: f64) -> f64 {
        self.piece(u).speed(u)
    }

    fn piece(&self, u: f64) -> &Piece<D> {
        let after = self.pieces.partition_point(|piece| piece.from <= u);
        &self.pieces[after.saturating_sub(1)]
    }

    fn arc(&self, a: f64, b: f64) -> f64 {
        gauss(a, b, |u| self.speed(u))
    }

    fn measure(&self) -> Result<Panels, ToolpathError> {
        let mut edges: Vec<f64> = self.pieces.iter().map(|piece| piece.from).collect();
        edges.push(self.range().1);
        // In one piece: the sum of its rules would do, but knots are where smoothness ends.
        let rough: f64 = edges.windows(2).map(|e| self.arc(e[0], e[1])).sum();
        let mean = rough / (self.range().1 - self.range().0);
        for piece in &self.pieces {
            for u in [piece.from, piece.to] {
                // False for a NaN too.
                let holds = norm(&piece.derivatives(u)[1]) > 1e-9 * mean;
                if !holds {
                    return Err(ToolpathError::Cusp { u });
                }
            }
        }
        Panels::adaptive(&edges, 1e-13 * rough, 1e-9 * mean, |u| self.speed(u))
            .map_err(|u| ToolpathError::Cusp { u })
    }
}

impl<const D: usize> Piece<D> {
    /// |C′| alone: most of what an arc length asks for.
    fn speed(&self, u: f64) -> f64 {
        let width = self.to - self.from;
        let t = (u - self.from) / width;
        let p = self.points.len() - 1;
        let mut b = [([0.0; D], 0.0); MAX_DEGREE + 1];
        b[..=p].copy_from_slice(&self.points);
        for row in (1..p).rev() {
            for i in 0..=row {
                b[i] = mix(&b[i], &b[i + 1], t);
            }
        }
        // C′ = p w₀ w₁ (C₁ − C₀)/(w² width), with C₀ and C₁ the last two points of the scheme.
        let ((a0, w0), (a1, w1)) = (b[0], b[1]);
        let w = (1.0 - t) * w0 + t * w1;
        let across: [f64; D] = std::array::from_fn(|i| a1[i] * w0 - a0[i] * w1);
        p as f64 * norm(&across) / (w * w * width)
    }

    fn derivatives(&self, u: f64) -> [[f64; D]; 4] {
        let width = self.to - self.from;
        let t = (u - self.from) / width;
        let p = self.points.len() - 1;
        let mut b = [([0.0; D], 0.0); MAX_DEGREE + 1];
        b[..=p].copy_from_slice(&self.points);
        // Differences of the scheme's last rows are the derivatives: f⁽ᵏ⁾ = p!/(p − k)! Δᵏ b.
        let mut a = [([0.0; D], 0.0); 4];
        for row in (0..=p).rev() {
            if row <= 3 {
                a[row] = difference(&b, row, p, width);
            }
            for i in 0..row {
                b[i] = mix(&b[i], &b[i + 1], t);
            }
        }
        quotient(&a)
    }
}

/// `Δᵏ b₀ · p (p − 1) … (p − k + 1) / widthᵏ`; zero above the degree.
fn difference<const D: usize>(
    b: &[([f64; D], f64); MAX_DEGREE + 1],
    k: usize,
    p: usize,
    width: f64,
) -> ([f64; D], f64) {
    const BINOMIAL: [[f64; 4]; 4] = [
        [1.0, 0.0, 0.0, 0.0],
        [-1.0, 1.0, 0.0, 0.0],
        [1.0, -2.0, 1.0, 0.0],
        [-1.0, 3.0, -3.0, 1.0],
    ];
    let factor: f64 = (0..k).map(|i| (p - i) as f64 / width).product();
    let mut sum = ([0.0; D], 0.0);
    for (i, point) in b.iter().enumerate().take(k + 1) {
        let c = factor * BINOMIAL[k][i];
        sum = (add_scaled(&sum.0, c, &point.0), sum.1 + c * point.1);
    }
    sum
}

fn mix<const D: usize>(a: &([f64; D], f64), b: &([f64; D], f64), t: f64) -> ([f64; D], f64) {
    (
        std::array::from_fn(|i| (1.0 - t) * a.0[i] + t * b.0[i]),
        (1.0 - t) * a.1 + t * b.1,
    )
}

/// `C = A/w` and its derivatives: C⁽ᵏ⁾ = (A⁽ᵏ⁾ − Σ binom(k, i) w⁽ⁱ⁾ C⁽ᵏ⁻ⁱ⁾)/w.
fn quotient<const D: usize>(a: &[([f64; D], f64); 4]) -> [[f64; D]; 4] {
    const BINOMIAL: [[f64; 4]; 4] = [
        [1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0],
        [1.0, 3.0, 3.0, 1.0],
    ];
    let mut c = [[0.0; D]; 4];
    for k in 0..4 {
        let mut x = a[k].0;
        for i in 1..=k {
            x = add_scaled(&x, -BINOMIAL[k][i] * a[i].1, &c[k - i]);
        }
        c[k] = x.map(|x| x / a[0].1);
    }
    c
}

/// Bézier points of span `k` (between knots k and k + 1): the blossom at p − j times the span's
/// begin and j times its end.
fn piece<const D: usize>(
    k: usize,
    p: usize,
    knots: &[f64],
    points: &[([f64; D], f64)],
) -> Piece<D> {
    let (from, to) = (knots[k], knots[k + 1]);
    let bezier = (0..=p)
        .map(|j| {
            let mut d: Vec<_> = points[k - p..=k].to_vec();
            for r in 1..=p {
                let argument = if r <= j { to } else { from };
                for i in (r..=p).rev() {
                    let (low, high) = (knots[k - p + i], knots[k + 1 + i - r]);
                    d[i] = mix(&d[i - 1], &d[i], (argument - low) / (high - low));
                }
            }
            d[p]
        })
        .collect();
    Piece {
        from,
        to,
        points: bezier,
    }
}

/// The weights, if all of `data` is valid.
fn check<const D: usize>(data: &NurbsData<D>) -> Result<Vec<f64>, ToolpathError> {
    let (p, n) = (data.degree, data.points.len());
    if !(1..=MAX_DEGREE).contains(&p) {
        let (field, valid) = ("degree", "from 1 to 15");
        return Err(ToolpathError::Invalid {
            field,
            value: p as f64,
            unit: "",
            valid,
        });
    }
    if n <= p {
        let valid = format!("at least degree + 1 = {}", p + 1);
        return Err(ToolpathError::Count {
            field: "points",
            count: n,
            valid,
        });
    }
    if data.knots.len() != n + p + 1 {
        let (field, count) = ("knots", data.knots.len());
        let valid = format!("points + degree + 1 = {}", n + p + 1);
        return Err(ToolpathError::Count {
            field,
            count,
            valid,
        });
    }
    if !data.weights.is_empty() && data.weights.len() != n {
        let (field, count) = ("weights", data.weights.len());
        let valid = format!("one for each of the {n} points, or none");
        return Err(ToolpathError::Count {
            field,
            count,
            valid,
        });
    }
    for point in &data.points {
        coordinates("points", *point)?;
    }
    let element = |field, i: usize, value, valid| {
        Err(ToolpathError::Element {
            field,
            number: i + 1,
            value,
            valid,
        })
    };
    for (i, &w) in data.weights.iter().enumerate() {
        if !(1e-6..=1e6).contains(&w) {
            return element("weights", i, w, "from 1e-6 to 1e6");
        }
    }
    check_knots(p, n, &data.knots)?;
    if data.weights.is_empty() {
        Ok(vec![1.0; n])
    } else {
        Ok(data.weights.clone())
    }
}

fn check_knots(p: usize, n: usize, knots: &[f64]) -> Result<(), ToolpathError> {
    let field = "knots";
    let range = knots[n] - knots[p];
    for (i, &value) in knots.iter().enumerate() {
        let number = i + 1;
        let sized = value.abs() <= 1e9;
        let valid = if !sized {
            "from -1e9 to 1e9"
        } else if i > 0 && value < knots[i - 1] {
            "at least the one before"
        } else if i > 0 && value > knots[i - 1] && value - knots[i - 1] < 1e-9 * range {
            "equal to the one before, or greater by 1e-9 of the range"
        } else if i > p && i < n && value == knots[i - p] {
            "greater than the one `degree` places before: the curve would break here"
        } else if i == n && range <= 0.0 {
            "greater than the knot number degree + 1"
        } else {
            continue;
        };
        return Err(ToolpathError::Element {
            field,
            number,
            value,
            valid,
        });
    }
    Ok(())
}
