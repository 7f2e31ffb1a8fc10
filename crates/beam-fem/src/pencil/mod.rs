//! The lowest modes of a banded pencil, at a cost linear in its order.
//!
//! 1. Split the pencil into independent parts ([`components`]).
//! 2. Bisect, by counting negative pivots of K − μM, for a limit μ below which
//!    there are at least as many eigenvalues as wanted, and not many more.
//!    Each part then knows how many of them it must find. Where a count is not
//!    reliable ([`ldlt`]), one a little above takes its place.
//! 3. Find them: block Lanczos on (K + sM)⁻¹ M with s = μ/64 ([`krylov`]).
//!    s > 0 keeps the matrix positive definite though a free beam's K is
//!    singular.

mod block;
mod components;
mod krylov;
mod ldlt;

use nalgebra::DMatrix;

use crate::banded::{BandedMatrices, SymmetricBanded};
use crate::error::check_size;
use crate::modes::frequency;
use crate::{BeamError, Modes, natural_modes};
pub(crate) use block::Block;
use components::{Component, split};
use ldlt::Ldlt;

/// A part of order below 4 × (modes wanted) + this is solved densely: a
/// Krylov space would fill it.
const SMALL: usize = 40;

/// The least shift s, in units of max K_ii / M_ii: so far above rounding that
/// K + sM is positive definite though K is singular.
const SHIFT: f64 = 2e-13;

/// Rounding of an eigenvalue, in units of 2⁻⁵² max K_ii / M_ii.
const ROUNDING: f64 = 32.0;

/// How often a limit is moved to where the count is reliable: each move finds
/// such a place far more often than not.
const MOST_MOVES: usize = 32;

/// The `count` lowest modes of a banded pencil. Time and memory grow
/// linearly with the order; the result does not depend on threads or runs.
///
/// Eigenvalues ω² at or below 32 · 2⁻⁵² · max K_ii / M_ii (the maximum over
/// the rows of the independent part that the mode belongs to) are rounding
/// and are reported as 0. Equal frequencies are all found, since their number
/// is known from a count beforehand.
///
/// # Errors
/// [`BeamError::Shape`], [`BeamError::NotFinite`], [`BeamError::ModeCount`],
/// [`BeamError::TooLarge`], [`BeamError::MassNotPositiveDefinite`], [`BeamError::StiffnessNegative`],
/// [`BeamError::NotConverged`].
pub fn lowest_modes(matrices: &BandedMatrices, count: usize) -> Result<Modes, BeamError> {
    let (mass, stiffness) = (&matrices.mass, &matrices.stiffness);
    check(matrices, count)?;
    let mut parts = split(mass, stiffness)
        .into_iter()
        .map(Part::new)
        .collect::<Result<Vec<_>, _>>()?;
    let limit = limit(&mut parts, count)?;
    let mut found = Vec::new();
    for (index, part) in parts.iter_mut().enumerate() {
        let shapes = part.modes_below(limit)?;
        for (column, eigenvalue) in part.quotients(&shapes).into_iter().enumerate() {
            if !eigenvalue.is_finite() {
                return Err(BeamError::NotConverged);
            }
            let frequency = frequency(eigenvalue, part.rounding());
            found.push((frequency, index, shapes.column(column).into_owned()));
        }
    }
    if found.len() < count {
        return Err(BeamError::NotConverged);
    }
    // Stable: equal frequencies stay in the order of their parts.
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(count);
    let mut shapes = DMatrix::zeros(mass.order(), count);
    for (mode, (_, index, shape)) in found.iter().enumerate() {
        for (&dof, &value) in parts[*index].component.dofs.iter().zip(shape.iter()) {
            shapes[(dof, mode)] = value;
        }
    }
    Ok(Modes {
        frequencies_rad_s: found.iter().map(|mode| mode.0).collect(),
        shapes,
    })
}

fn check(matrices: &BandedMatrices, count: usize) -> Result<(), BeamError> {
    matrices.check_orders()?;
    let order = matrices.mass.order();
    for (field, matrix) in [("mass", &matrices.mass), ("stiffness", &matrices.stiffness)] {
        if !matrix.is_finite() {
            return Err(BeamError::NotFinite { field });
        }
    }
    if !(1..=order).contains(&count) {
        return Err(BeamError::ModeCount { count, order });
    }
    check_size("shapes", order, count)
}

/// A limit with at least `count` eigenvalues below it: down in steps of 256
/// from above the spectrum, then four bisections of the last step. Stops
/// well above rounding, where counts mean nothing.
fn limit(parts: &mut [Part], count: usize) -> Result<f64, BeamError> {
    let mut high = above(parts, count)?;
    let (mut low, floor) = (high / 256.0, high * 1e-12);
    while low > floor {
        let (mu, found) = below(parts, low)?;
        if found < count {
            break;
        }
        high = mu;
        low /= 256.0;
    }
    for _ in 0..4 {
        let (mu, found) = below(parts, (high * low).sqrt())?;
        if found >= count {
            high = mu;
        } else {
            low = mu;
        }
    }
    Ok(high)
}

/// A start for the bisection. The largest K_ii / M_ii is a Rayleigh quotient,
/// so the spectrum reaches at least that far; it is doubled until enough
/// eigenvalues lie below.
fn above(parts: &mut [Part], count: usize) -> Result<f64, BeamError> {
    let scale = parts.iter().fold(0.0_f64, |m, part| m.max(part.scale));
    let mut top = if scale > 0.0 { scale } else { 1.0 };
    while top.is_finite() {
        let (mu, found) = below(parts, top)?;
        if found >= count {
            return Ok(mu);
        }
        top *= 2.0;
    }
    Err(BeamError::NotConverged)
}

/// `mu`, or the first value above it in steps of a 64th at which every part can
/// be counted reliably, and the number of eigenvalues of all parts below it.
fn below(parts: &mut [Part], mu: f64) -> Result<(f64, usize), BeamError> {
    let mut at = mu;
    for _ in 0..MOST_MOVES {
        let counts = parts.iter_mut().map(|part| part.count(at));
        if let Some(sum) = counts.sum() {
            return Ok((at, sum));
        }
        at *= 1.0 + 1.0 / 64.0;
    }
    Err(BeamError::NotConverged)
}

/// An independent part with its working memory.
struct Part {
    component: Component,
    factor: Ldlt,
    /// Largest K_ii / M_ii: the size of the largest eigenvalues.
    scale: f64,
}

impl Part {
    fn new(component: Component) -> Result<Self, BeamError> {
        let (mass, stiffness) = (&component.mass, &component.stiffness);
        let mut scale = 0.0_f64;
        for j in 0..mass.order() {
            let (m, k) = (mass.column(j)[0], stiffness.column(j)[0]);
            if m <= 0.0 {
                return Err(BeamError::MassNotPositiveDefinite);
            }
            scale = scale.max(k.abs() / m);
        }
        if !scale.is_finite() {
            return Err(BeamError::NotFinite { field: "reduced" });
        }
        let mut factor = Ldlt::new(mass, stiffness);
        // No pivot of a positive definite matrix is small beside its row.
        if factor.factorise(mass, mass, 0.0) != Some(0) {
            return Err(BeamError::MassNotPositiveDefinite);
        }
        Ok(Self {
            component,
            factor,
            scale,
        })
    }

    /// Number of eigenvalues below `mu`; none where it is not reliable.
    fn count(&mut self, mu: f64) -> Option<usize> {
        let (mass, stiffness) = (&self.component.mass, &self.component.stiffness);
        self.factor.factorise(mass, stiffness, mu)
    }

    fn rounding(&self) -> f64 {
        ROUNDING * f64::EPSILON * self.scale
    }

    /// Shapes of all modes with eigenvalues below `limit`, one a column.
    fn modes_below(&mut self, limit: f64) -> Result<DMatrix<f64>, BeamError> {
        let order = self.component.dofs.len();
        let wanted = self.count(limit).ok_or(BeamError::NotConverged)?;
        if wanted == 0 {
            return Ok(DMatrix::zeros(order, 0));
        }
        if order < 4 * wanted + SMALL {
            let (mass, stiffness) = (&self.component.mass, &self.component.stiffness);
            let modes = natural_modes(&mass.to_dense()?, &stiffness.to_dense()?)?;
            return Ok(modes.shapes.columns(0, wanted).into_owned());
        }
        let s = (limit / 64.0).max(SHIFT * self.scale);
        // Where it is positive definite, the count is reliable too.
        if self.count(-s) != Some(0) {
            return Err(BeamError::StiffnessNegative);
        }
        krylov::lowest(&self.component, &self.factor, s, limit, wanted)
    }

    /// Rayleigh quotients of the shapes, two at a time: their errors are
    /// squares of the shapes' errors.
    fn quotients(&self, shapes: &DMatrix<f64>) -> Vec<f64> {
        let (order, count) = shapes.shape();
        let mut pair = vec![[0.0; 2]; order];
        let mut product = pair.clone();
        let mut quotients = Vec::with_capacity(count + 1);
        for first in (0..count).step_by(2) {
            let second = (first + 1).min(count - 1);
            let (left, right) = (shapes.column(first), shapes.column(second));
            for ((row, l), r) in pair.iter_mut().zip(&left).zip(&right) {
                *row = [*l, *r];
            }
            let mut energies = |a: &SymmetricBanded| {
                block::multiply(a, &pair, &mut product);
                [0, 1].map(|c| block::dot(&pair, c, &product, c))
            };
            let potential = energies(&self.component.stiffness);
            let kinetic = energies(&self.component.mass);
            quotients.extend([0, 1].map(|c| potential[c] / kinetic[c]));
        }
        quotients.truncate(count);
        quotients
    }
}
