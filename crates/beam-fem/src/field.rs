//! Element matrices by integration of the exact static displacements of an element
//! whose section may vary: stiffness, mass, gyroscopic and geometric matrix.
//!
//! With no load between the nodes the shear force V is constant and the moment
//! linear, M = M_c + V (x − l/2), whatever the section does. So in each plane
//!
//! ```text
//! θ(x) = θ1 + ∫ M/EI ds,   v(x) = v1 + ∫ (θ − V/κGA) ds
//! ```
//!
//! and M_c, V follow from v2 and θ2. The integrals are Gauss's; for a uniform
//! element they are exact.

use nalgebra::{Matrix2, Matrix2x4, RowVector4, SMatrix, Vector4};

use crate::element::{self, ElementMatrix};
use crate::shaft::ShaftElement;
use crate::{BeamError, CrossSection};

/// Gauss–Legendre, 8 points on (−1, 1): abscissa and weight (Abramowitz and Stegun 1964,
/// table 25.4); exact to degree 15.
const GAUSS: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// The matrices of one element, rows u1 v1 w1 θx1 θy1 θz1 u2 … θz2.
pub(crate) struct ElementMatrices {
    pub stiffness: ElementMatrix,
    pub mass: ElementMatrix,
    /// Of a spin of 1 rad/s about x.
    pub gyroscopic: ElementMatrix,
    /// Of a tension of 1 N.
    pub geometric: ElementMatrix,
}

/// Rows v1, θz1, v2, θz2 of bending in x–y.
const XY: [usize; 4] = [1, 5, 7, 11];
/// Rows w1, θy1, w2, θy2 of bending in x–z, whose rotation is −θy.
const XZ: [usize; 4] = [2, 4, 8, 10];
const SIGNS: [f64; 4] = [1.0, -1.0, 1.0, -1.0];

impl ElementMatrices {
    pub fn new(element: &ShaftElement) -> Result<Self, BeamError> {
        let xy = Plane::new(element, |s| (s.second_moment_z(), s.shear_coefficient()))?;
        let xz = Plane::new(element, |s| (s.second_moment_y(), s.shear_coefficient_z()))?;
        let mut out = Self {
            stiffness: ElementMatrix::zeros(),
            mass: ElementMatrix::zeros(),
            gyroscopic: ElementMatrix::zeros(),
            geometric: ElementMatrix::zeros(),
        };
        add_plane(&mut out.geometric, &xy.geometric, XY, [1.0; 4]);
        add_plane(&mut out.geometric, &xz.geometric, XZ, SIGNS);
        let density = element.material.density();
        for (a, b) in xy.stations.iter().zip(&xz.stations) {
            // H = J Ω (0, θz, −θy): J Ω θz' acts on θy, −J Ω θy' on θz.
            let polar = density * a.section.polar_moment() * a.weight;
            for (i, row) in XZ.into_iter().enumerate() {
                for (j, column) in XY.into_iter().enumerate() {
                    let theta_y = -b.theta[i] * SIGNS[i];
                    let entry = polar * theta_y * a.theta[j];
                    out.gyroscopic[(row, column)] += entry;
                    out.gyroscopic[(column, row)] -= entry;
                }
            }
        }
        if let Some(section) = element.uniform() {
            out.stiffness = element::stiffness(section, &element.material, element.length);
            out.mass = element::mass(section, &element.material, element.length);
            return Ok(out);
        }
        add_plane(&mut out.stiffness, &xy.stiffness, XY, [1.0; 4]);
        add_plane(&mut out.stiffness, &xz.stiffness, XZ, SIGNS);
        add_plane(&mut out.mass, &xy.mass, XY, [1.0; 4]);
        add_plane(&mut out.mass, &xz.mass, XZ, SIGNS);
        let (e, g) = (
            element.material.youngs_modulus(),
            element.material.shear_modulus(),
        );
        add_rod(&mut out, element, 0, |s| (e * s.area(), s.area()))?;
        add_rod(&mut out, element, 3, |s| {
            (g * s.torsion_constant(), s.polar_moment())
        })?;
        Ok(out)
    }
}

/// Adds a plane's matrix into rows `rows`, the sign of each row and column turned.
fn add_plane(
    into: &mut ElementMatrix,
    plane: &SMatrix<f64, 4, 4>,
    rows: [usize; 4],
    signs: [f64; 4],
) {
    for i in 0..4 {
        for j in 0..4 {
            into[(rows[i], rows[j])] += signs[i] * signs[j] * plane[(i, j)];
        }
    }
}

/// A place of an element: the rotation there for unit v1, θ1, v2, θ2.
struct Station {
    weight: f64,
    section: CrossSection,
    theta: RowVector4<f64>,
}

struct Plane {
    stations: Vec<Station>,
    stiffness: SMatrix<f64, 4, 4>,
    mass: SMatrix<f64, 4, 4>,
    geometric: SMatrix<f64, 4, 4>,
}

/// Integrals from 0 to x, s the distance from the middle.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// ∫ 1/EI, ∫ s/EI, ∫ s²/EI.
    bend: [f64; 3],
    /// Integrals over x of the first two.
    twice: [f64; 2],
    /// ∫ 1/κGA.
    shear: f64,
}

impl Plane {
    /// `of` gives the plane's second moment and κ.
    fn new(
        element: &ShaftElement,
        of: impl Fn(&CrossSection) -> (f64, f64),
    ) -> Result<Self, BeamError> {
        let l = element.length;
        let (e, g) = (
            element.material.youngs_modulus(),
            element.material.shear_modulus(),
        );
        let flexible = |x: f64| -> Result<(f64, f64), BeamError> {
            let section = element.section_at(x / l)?;
            let (i, kappa) = of(&section);
            Ok((1.0 / (e * i), 1.0 / (kappa * g * section.area())))
        };
        let mut sums = Sums::default();
        let mut before = 0.0;
        let mut partial = Vec::with_capacity(GAUSS.len());
        for (point, weight) in GAUSS {
            let x = 0.5 * l * (1.0 + point);
            sums = sums.advance(before, x, 0.5 * l, &flexible)?;
            partial.push((x, 0.5 * l * weight, sums));
            before = x;
        }
        let whole = sums.advance(before, l, 0.5 * l, &flexible)?;
        let inner = whole.forces(l)?;
        let [a0, a1, a2] = whole.bend;
        let energy = Matrix2::new(a0, a1, a1, a2 + whole.shear);
        let stiffness = inner.transpose() * energy * inner;
        let mut plane = Self {
            stations: Vec::with_capacity(GAUSS.len()),
            // Symmetric to the bit.
            stiffness: (stiffness + stiffness.transpose()) * 0.5,
            mass: SMatrix::zeros(),
            geometric: SMatrix::zeros(),
        };
        for (x, weight, sums) in partial {
            let section = element.section_at(x / l)?;
            let (i, _) = of(&section);
            let (moment, force) = (inner.row(0), inner.row(1));
            let theta =
                RowVector4::new(0.0, 1.0, 0.0, 0.0) + moment * sums.bend[0] + force * sums.bend[1];
            let deflection = RowVector4::new(1.0, x, 0.0, 0.0)
                + moment * sums.twice[0]
                + force * (sums.twice[1] - sums.shear);
            let slope = theta - force * flexible(x)?.1;
            let line = element.material.density() * weight;
            plane.mass += deflection.transpose() * deflection * (line * section.area())
                + theta.transpose() * theta * (line * i);
            plane.geometric += slope.transpose() * slope * weight;
            plane.stations.push(Station {
                weight,
                section,
                theta,
            });
        }
        Ok(plane)
    }
}

impl Sums {
    /// Goes on from `x` to `end`; `middle` is where s is zero.
    fn advance(
        self,
        x: f64,
        end: f64,
        middle: f64,
        flexible: &impl Fn(f64) -> Result<(f64, f64), BeamError>,
    ) -> Result<Self, BeamError> {
        let mut out = self;
        let h = end - x;
        for k in 0..2 {
            out.twice[k] += h * self.bend[k];
        }
        for (point, weight) in GAUSS {
            let at = x + 0.5 * h * (1.0 + point);
            let (bend, shear) = flexible(at)?;
            let (w, s) = (0.5 * h * weight, at - middle);
            for (k, power) in [1.0, s, s * s].into_iter().enumerate() {
                out.bend[k] += w * bend * power;
                if k < 2 {
                    out.twice[k] += w * bend * power * (end - at);
                }
            }
            out.shear += w * shear;
        }
        Ok(out)
    }

    /// Moment in the middle and shear force for unit v1, θ1, v2, θ2.
    fn forces(&self, l: f64) -> Result<Matrix2x4<f64>, BeamError> {
        let [d0, d1] = self.twice;
        let ends = Matrix2::new(self.bend[0], self.bend[1], d0, d1 - self.shear);
        let inverse = ends
            .try_inverse()
            .ok_or(BeamError::NotFinite { field: "stiffness" })?;
        let turn = Vector4::new(0.0, -1.0, 0.0, 1.0).transpose();
        let offset = Vector4::new(-1.0, -l, 1.0, 0.0).transpose();
        Ok(inverse * Matrix2x4::from_rows(&[turn, offset]))
    }
}

/// Stretch (`first` = 0) or twist (3): `of` gives stiffness and inertia per density.
fn add_rod(
    out: &mut ElementMatrices,
    element: &ShaftElement,
    first: usize,
    of: impl Fn(&CrossSection) -> (f64, f64),
) -> Result<(), BeamError> {
    let l = element.length;
    // Flexibility from `x` to `end`.
    let part = |x: f64, end: f64| -> Result<f64, BeamError> {
        let mut sum = 0.0;
        for (point, weight) in GAUSS {
            let at = x + 0.5 * (end - x) * (1.0 + point);
            sum += 0.5 * (end - x) * weight / of(&element.section_at(at / l)?).0;
        }
        Ok(sum)
    };
    let (mut partial, mut sum, mut before) = (Vec::new(), 0.0, 0.0);
    for (point, weight) in GAUSS {
        let x = 0.5 * l * (1.0 + point);
        sum += part(before, x)?;
        before = x;
        let line = element.material.density() * of(&element.section_at(x / l)?).1;
        partial.push((sum, 0.5 * l * weight * line));
    }
    let whole = sum + part(before, l)?;
    let k = 1.0 / whole;
    let rows = [first, first + 6];
    let mut mass = [[0.0; 2]; 2];
    for (sum, weight) in partial {
        let n = [1.0 - sum / whole, sum / whole];
        for i in 0..2 {
            for j in 0..2 {
                mass[i][j] += weight * n[i] * n[j];
            }
        }
    }
    for i in 0..2 {
        for j in 0..2 {
            out.stiffness[(rows[i], rows[j])] += if i == j { k } else { -k };
            out.mass[(rows[i], rows[j])] += mass[i][j];
        }
    }
    Ok(())
}
