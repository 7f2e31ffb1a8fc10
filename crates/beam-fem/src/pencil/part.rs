//! An independent part of the pencil: its rigid motions and its lowest modes.

use nalgebra::{DMatrix, DVector};

use super::components::Component;
use super::ldlt::Ldlt;
use super::{block, krylov, reliable};
use crate::BeamError;
use crate::banded::SymmetricBanded;
use crate::dense::{self, HIDDEN, MOST_RAISES, RESOLVED, Rigid, SPAN};

/// A part of order below 4 × (modes wanted) + this is solved densely: a
/// Krylov space would fill it.
const SMALL: usize = 40;

/// Most growth of the factorisations that rigid motions are counted by. Where there are
/// only positive pivots it is 1 at most.
const GROWTH: f64 = 4.0;

/// An independent part with its working memory.
pub(super) struct Part {
    pub component: Component,
    pub rigid: Rigid,
    /// Largest K_ii / M_ii: the size of the largest eigenvalues.
    pub scale: f64,
    factor: Ldlt,
}

impl Part {
    pub fn new(component: Component) -> Result<Self, BeamError> {
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
        let rigid = rigid_motions(&component, &mut factor)?;
        Ok(Self {
            component,
            rigid,
            scale,
            factor,
        })
    }

    /// Number of eigenvalues below `mu`; none if it is not reliable.
    pub fn count(&mut self, mu: f64) -> Option<usize> {
        let (mass, stiffness) = (&self.component.mass, &self.component.stiffness);
        self.factor.factorise(mass, stiffness, mu)
    }

    /// ω² and shape of all modes below `limit`, the lowest first. A span at a time: a
    /// shift that suits the highest of them hides the lowest where they are far apart.
    pub fn modes_below(&mut self, limit: f64) -> Result<Vec<(f64, DVector<f64>)>, BeamError> {
        let mut spans = vec![(limit, self.count(limit).ok_or(BeamError::NotConverged)?)];
        let mut low = limit / SPAN;
        while low > f64::MIN_POSITIVE {
            if let Ok((at, below)) = reliable(low, |mu| self.count(mu)) {
                if below <= self.rigid.count {
                    break;
                }
                spans.push((at, below));
            }
            low /= SPAN;
        }
        let mut modes = Vec::with_capacity(spans[0].1);
        for (at, below) in spans.into_iter().rev() {
            let found = self
                .lowest(at, below)
                .map_err(|error| self.explained(error, at))?;
            modes.extend(found.into_iter().skip(modes.len()));
        }
        self.check_rigid(&modes)?;
        Ok(modes)
    }

    /// The error that names rounding as the cause, if `limit` is below what rounding leaves.
    fn explained(&self, error: BeamError, limit: f64) -> BeamError {
        let rounding = self.rigid.rounding * self.scale;
        if error == BeamError::NotConverged && limit < HIDDEN * rounding {
            return unresolved(&self.component);
        }
        error
    }

    /// Refuses rigid modes that may be others.
    fn check_rigid(&mut self, modes: &[(f64, DVector<f64>)]) -> Result<(), BeamError> {
        let shapes = modes.iter().take(self.rigid.count);
        let hidden = self.rigid.hidden(shapes.map(|(_, shape)| shape.as_slice()));
        if hidden > 0.0 {
            // Where no count stands there are modes.
            let below = reliable(HIDDEN * hidden, |at| self.count(at));
            if below.map_or(true, |(_, found)| found > self.rigid.count) {
                return Err(unresolved(&self.component));
            }
        }
        Ok(())
    }

    /// The `wanted` lowest modes, which are those below `limit`.
    fn lowest(&mut self, limit: f64, wanted: usize) -> Result<Vec<(f64, DVector<f64>)>, BeamError> {
        if wanted == 0 {
            return Ok(Vec::new());
        }
        let (mass, stiffness) = (&self.component.mass, &self.component.stiffness);
        if self.component.dofs.len() < 4 * wanted + SMALL {
            let (mass, stiffness) = (mass.to_dense()?, stiffness.to_dense()?);
            let pairs = dense::lowest(&mass, &stiffness, limit / 64.0, wanted)?;
            let shapes = pairs.shapes.column_iter().map(|shape| shape.into_owned());
            return Ok(pairs.values.into_iter().zip(shapes).collect());
        }
        let s = self.shift(limit / 64.0)?;
        let shapes = krylov::lowest(&self.component, &self.factor, s, limit, wanted)?;
        let values = self.quotients(&shapes).into_iter();
        let shapes = shapes.column_iter().map(|shape| shape.into_owned());
        let mut modes: Vec<_> = values.zip(shapes).collect();
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(modes)
    }

    /// `s`, raised until rounding leaves K + sM positive definite; the factor is that.
    fn shift(&mut self, s: f64) -> Result<f64, BeamError> {
        let mut raised = std::iter::successors(Some(s), |s| Some(8.0 * s)).take(MOST_RAISES);
        // Where it is positive definite, the count is reliable too.
        raised
            .find(|s| self.count(-s) == Some(0))
            .ok_or(BeamError::NotConverged)
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

/// The number of rigid motions, those whose energy is rounding: eigenvalues of K against
/// W = diag(K) that are not above τ.
///
/// An entry of K has a handful of roundings, of its element and of the sum, and a row up
/// to 2p + 1 entries: xᵀδKx is at most 5 (2p + 1) 2⁻⁵³ Σ K_ii x_i². The factorisation adds
/// (p + 2) 2⁻⁵³ times its growth ([`Ldlt`]) for each entry.
fn rigid_motions(component: &Component, factor: &mut Ldlt) -> Result<Rigid, BeamError> {
    let (mass, stiffness) = (&component.mass, &component.stiffness);
    let weights = dense::weights(rows(component));
    let mut terms = SymmetricBanded::zeros(mass.order(), 0)?;
    for (row, weight) in weights.iter().enumerate() {
        terms.add(row, row, *weight)?;
    }
    let p = mass.half_bandwidth().max(stiffness.half_bandwidth()) as f64;
    let rounding = (2.0 * p + 1.0) * (5.0 + GROWTH * (p + 2.0)) * 0.5 * f64::EPSILON;
    // The factors of a positive definite matrix do not grow: none is negative too.
    if factor.factorise_within(GROWTH, &terms, stiffness, -rounding) != Some(0) {
        return Err(BeamError::StiffnessNegative);
    }
    let mut below = |share: f64| {
        let count = |at| factor.factorise_within(GROWTH, &terms, stiffness, at);
        // Where no count stands there are motions in plenty.
        reliable(share, count).map_err(|_| unresolved(component))
    };
    let (rounding, count) = below(rounding)?;
    if below(RESOLVED * rounding)?.1 > count {
        return Err(unresolved(component));
    }
    Ok(Rigid {
        count,
        rounding,
        weights,
    })
}

fn rows(component: &Component) -> impl Iterator<Item = (f64, f64)> + Clone {
    let (mass, stiffness) = (&component.mass, &component.stiffness);
    (0..mass.order()).map(|j| (stiffness.column(j)[0], mass.column(j)[0]))
}

fn unresolved(component: &Component) -> BeamError {
    let row = dense::stiffest(rows(component));
    BeamError::Unresolved {
        row: component.dofs[row],
        stiffness: component.stiffness.column(row)[0],
    }
}
