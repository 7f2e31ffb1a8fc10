//! The 12-dof Timoshenko beam element of the paper's Appendix A.
//!
//! Degrees of freedom, per node: u, v, w (m), θx, θy, θz (rad). Axes are
//! right-handed, so a rigid rotation θz goes with v = x θz and θy with
//! w = −x θy: the couplings of the x–z plane have the opposite sign of those
//! of the x–y plane.
//!
//! Stiffness: Przemieniecki, *Theory of Matrix Structural Analysis*, 1968.
//! Mass: consistent, with rotary inertia, of the same displacement field;
//! Davis, Henshell and Warburton 1972 (doi 10.1016/0022-460X(72)90457-9).

use nalgebra::SMatrix;

use crate::{CrossSection, Material};

/// A 12 × 12 element matrix; rows u1 v1 w1 θx1 θy1 θz1 u2 … θz2.
pub type ElementMatrix = SMatrix<f64, 12, 12>;

/// Element stiffness K (N/m, N, N·m), 12 × 12, for a `length` in m above zero.
pub fn stiffness(section: &CrossSection, material: &Material, length: f64) -> ElementMatrix {
    let entries = Coefficients::new(section, material, length).lower();
    full(entries.map(|e| (e.row, e.column, e.stiffness)))
}

/// Element mass M (kg, kg·m, kg·m²), 12 × 12, for a `length` in m above zero.
pub fn mass(section: &CrossSection, material: &Material, length: f64) -> ElementMatrix {
    let entries = Coefficients::new(section, material, length).lower();
    full(entries.map(|e| (e.row, e.column, e.mass)))
}

/// Shear parameter b = 12 E I / (κ G A l²) of one bending plane
/// (Przemieniecki's Φ): bending over shear stiffness of an element. κ is that
/// of a force along y, so give I_z where a section's two differ.
pub fn shear_parameter(
    section: &CrossSection,
    material: &Material,
    second_moment: f64,
    length: f64,
) -> f64 {
    let kappa = section.shear_coefficient();
    shear_ratio(section, material, [second_moment, kappa], length)
}

/// The same with the second moment and κ of one plane.
#[inline]
fn shear_ratio(section: &CrossSection, material: &Material, plane: [f64; 2], length: f64) -> f64 {
    let [second_moment, kappa] = plane;
    let shear = kappa * material.shear_modulus() * section.area();
    12.0 * material.youngs_modulus() * second_moment / (shear * length * length)
}

/// One entry of the lower triangle, of both matrices.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub row: usize,
    pub column: usize,
    pub stiffness: f64,
    pub mass: f64,
}

/// The different numbers in the two element matrices.
#[derive(Clone, Copy)]
pub(crate) struct Coefficients {
    axial: Rod,
    torsion: Rod,
    plane_z: Bending,
    plane_y: Bending,
}

/// A two-node rod with linear shape functions: stiffness k [1 −1; −1 1],
/// mass m/6 [2 1; 1 2].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rod {
    /// k, N/m or N·m/rad.
    pub stiffness: f64,
    /// m, kg or kg·m².
    pub mass: f64,
}

/// Bending in one plane: the letters are the paper's.
#[derive(Clone, Copy)]
struct Bending {
    k_vv: f64,
    k_vt: f64,
    k_tt: f64,
    k_tt_far: f64,
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
}

impl Coefficients {
    #[inline]
    pub fn new(section: &CrossSection, material: &Material, l: f64) -> Self {
        let in_xy = [section.second_moment_z(), section.shear_coefficient()];
        let in_xz = [section.second_moment_y(), section.shear_coefficient_z()];
        let plane_z = Bending::new(section, material, in_xy, l);
        let plane_y = if in_xy == in_xz {
            plane_z
        } else {
            Bending::new(section, material, in_xz, l)
        };
        Self {
            axial: Rod {
                stiffness: material.youngs_modulus() * section.area() / l,
                mass: material.density() * section.area() * l,
            },
            torsion: torsion_rod(section, material, l),
            plane_z,
            plane_y,
        }
    }

    /// The 26 entries of the lower triangle that are not always zero.
    #[inline]
    pub fn lower(&self) -> [Entry; 26] {
        let mut out = [Entry {
            row: 0,
            column: 0,
            stiffness: 0.0,
            mass: 0.0,
        }; 26];
        out[0..3].copy_from_slice(&self.axial.lower(0));
        out[3..6].copy_from_slice(&self.torsion.lower(3));
        out[6..16].copy_from_slice(&self.plane_z.lower([1, 5, 7, 11], 1.0));
        out[16..26].copy_from_slice(&self.plane_y.lower([2, 4, 8, 10], -1.0));
        out
    }
}

/// Torsion of one element of `length` m above zero: stiffness G J / l
/// (N·m/rad) and mass ρ (I_y + I_z) l (kg·m²). Inertia goes with the polar
/// moment, stiffness with the torsion constant J.
#[inline]
pub fn torsion_rod(section: &CrossSection, material: &Material, length: f64) -> Rod {
    Rod {
        stiffness: material.shear_modulus() * section.torsion_constant() / length,
        mass: material.density() * section.polar_moment() * length,
    }
}

impl Rod {
    #[inline]
    fn lower(&self, first: usize) -> [Entry; 3] {
        let (k, m, second) = (self.stiffness, self.mass, first + 6);
        [
            entry(first, first, k, m / 3.0),
            entry(second, first, -k, m / 6.0),
            entry(second, second, k, m / 3.0),
        ]
    }
}

impl Bending {
    #[inline]
    fn new(section: &CrossSection, material: &Material, plane: [f64; 2], l: f64) -> Self {
        let i = plane[0];
        let b = shear_ratio(section, material, plane, l);
        let ei = material.youngs_modulus() * i / ((1.0 + b) * l);
        let m = material.density() * section.area() * l / ((1.0 + b) * (1.0 + b));
        // (r/l)² with the radius of gyration r = √(I/A).
        let r2 = i / (section.area() * l * l);
        let b2 = b * b;
        let (ml, ml2) = (m * l, m * l * l);
        let lever = (0.1 - 0.5 * b) * r2;
        let near = (2.0 / 15.0 + b / 6.0 + b2 / 3.0) * r2;
        let far = (1.0 / 30.0 + b / 6.0 - b2 / 6.0) * r2;
        Self {
            k_vv: 12.0 * ei / (l * l),
            k_vt: 6.0 * ei / l,
            k_tt: (4.0 + b) * ei,
            k_tt_far: (2.0 - b) * ei,
            a: m * (13.0 / 35.0 + 0.7 * b + b2 / 3.0 + 1.2 * r2),
            b: m * (9.0 / 70.0 + 0.3 * b + b2 / 6.0 - 1.2 * r2),
            c: ml * (11.0 / 210.0 + b * (11.0 / 120.0) + b2 / 24.0 + lever),
            d: ml * (13.0 / 420.0 + b * (3.0 / 40.0) + b2 / 24.0 - lever),
            e: ml2 * (1.0 / 105.0 + b / 60.0 + b2 / 120.0 + near),
            f: -ml2 * (1.0 / 140.0 + b / 60.0 + b2 / 120.0 + far),
        }
    }

    /// `dofs` are deflection and rotation of the first node, then of the
    /// second; `s` is the sign of the rotation in this plane.
    #[inline]
    fn lower(&self, dofs: [usize; 4], s: f64) -> [Entry; 10] {
        let [v1, t1, v2, t2] = dofs;
        let k_vt = s * self.k_vt;
        let (c, d) = (s * self.c, s * self.d);
        [
            entry(v1, v1, self.k_vv, self.a),
            entry(t1, v1, k_vt, c),
            entry(t1, t1, self.k_tt, self.e),
            entry(v2, v1, -self.k_vv, self.b),
            entry(v2, t1, -k_vt, d),
            entry(v2, v2, self.k_vv, self.a),
            entry(t2, v1, k_vt, -d),
            entry(t2, t1, self.k_tt_far, self.f),
            entry(t2, v2, -k_vt, -c),
            entry(t2, t2, self.k_tt, self.e),
        ]
    }
}

#[inline]
fn entry(row: usize, column: usize, stiffness: f64, mass: f64) -> Entry {
    Entry {
        row,
        column,
        stiffness,
        mass,
    }
}

fn full(entries: [(usize, usize, f64); 26]) -> ElementMatrix {
    let mut matrix = ElementMatrix::zeros();
    for (row, column, value) in entries {
        matrix[(row, column)] = value;
        matrix[(column, row)] = value;
    }
    matrix
}
