//! The lowest modes of a banded pencil, at a cost linear in its order.
//!
//! 1. Split the pencil into independent parts ([`components`]).
//! 2. Count the rigid motions of each, and refuse what has motions of negative
//!    energy or such that cannot be told from rigid ones ([`part`]).
//! 3. Bisect, by counting negative pivots of K − μM, for a limit μ below which
//!    there are at least as many eigenvalues as wanted, and not many more.
//!    Each part then knows how many of them it must find. Where a count is not
//!    reliable ([`ldlt`]), one a little above takes its place.
//! 4. Find them: block Lanczos on (K + sM)⁻¹ M with s = μ/64 ([`krylov`]).
//!    s > 0 keeps the matrix positive definite though a free beam's K is
//!    singular.

mod block;
mod components;
mod krylov;
mod ldlt;
mod part;

use nalgebra::DMatrix;

use crate::banded::BandedMatrices;
use crate::error::check_size;
use crate::{BeamError, Modes};
pub(crate) use block::Block;
use components::split;
use part::Part;

/// How often a limit is moved to where the count is reliable: each move finds
/// such a place far more often than not.
const MOST_MOVES: usize = 32;

/// The `count` lowest modes of a banded pencil. Time and memory grow
/// linearly with the order; the result does not depend on threads or runs.
///
/// The rigid modes, of frequency 0, are as many as motions whose spring energy is
/// rounding: at most τ Σ K_ii x_i², τ = (2p + 1)(4p + 13) 2⁻⁵³ for a half bandwidth p of
/// the independent part that they belong to (the theory page derives it). This and what
/// is refused is decided by K alone, whatever `count`. Equal frequencies are all found,
/// since their number is known from a count beforehand.
///
/// # Errors
/// [`BeamError::Shape`], [`BeamError::NotFinite`], [`BeamError::ModeCount`],
/// [`BeamError::TooLarge`], [`BeamError::MassNotPositiveDefinite`];
/// [`BeamError::StiffnessNegative`] if a motion has an energy below −τ Σ K_ii x_i²,
/// [`BeamError::Unresolved`] if one has one between τ and 10 τ times that sum, so that
/// a tenth of its ω² may be rounding, or where rounding could hide, as a rigid mode, an ω²
/// of a thousandth of the lowest one of its part; [`BeamError::NotConverged`].
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
        let modes = part.modes_below(limit)?;
        for (mode, (eigenvalue, shape)) in modes.into_iter().enumerate() {
            let frequency = if mode < part.rigid.count {
                0.0
            } else {
                eigenvalue.sqrt()
            };
            if !frequency.is_finite() {
                return Err(BeamError::NotConverged);
            }
            found.push((frequency, index, shape));
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
/// from above the spectrum, then four bisections of the last step. Not below a limit
/// under which there are rigid motions alone.
///
/// Within the spectrum of a long mesh some pivot is always small, so that no count
/// stands there: such places are passed over on the way down, and count as too high in
/// a bisection, which then goes on until one stands.
fn limit(parts: &mut [Part], count: usize) -> Result<f64, BeamError> {
    let rigid: usize = parts.iter().map(|part| part.rigid.count).sum();
    let mut top = above(parts, count)?;
    let mut high = below(parts, top).ok().map(|(mu, _)| mu);
    let mut low = high.unwrap_or(top) / 256.0;
    while low > f64::MIN_POSITIVE {
        match below(parts, low).ok() {
            Some((_, found)) if found < count => break,
            Some((mu, found)) if found <= rigid => return Ok(mu),
            Some((mu, _)) => (top, high) = (mu, Some(mu)),
            None => (top, high) = (low, None),
        }
        low /= 256.0;
    }
    for round in 0..MOST_MOVES {
        if let Some(high) = high.filter(|_| round >= 4) {
            return Ok(high);
        }
        let middle = (top * low).sqrt();
        match below(parts, middle) {
            Ok((mu, found)) if found >= count => (top, high) = (mu, Some(mu)),
            Ok((mu, _)) => low = mu,
            Err(_) => (top, high) = (middle, None),
        }
    }
    high.ok_or(BeamError::NotConverged)
}

/// A start for the bisection. The largest K_ii / M_ii is a Rayleigh quotient,
/// so the spectrum reaches at least that far; it is doubled until enough
/// eigenvalues lie below, or no count stands.
fn above(parts: &mut [Part], count: usize) -> Result<f64, BeamError> {
    let scale = parts.iter().fold(0.0_f64, |m, part| m.max(part.scale));
    let mut top = if scale > 0.0 { scale } else { 1.0 };
    while top.is_finite() {
        match below(parts, top) {
            Ok((_, found)) if found < count => top *= 2.0,
            _ => return Ok(top),
        }
    }
    Err(BeamError::NotConverged)
}

/// `mu`, or the first value above it in steps of a 64th at which every part can
/// be counted reliably, and the number of eigenvalues of all parts below it.
fn below(parts: &mut [Part], mu: f64) -> Result<(f64, usize), BeamError> {
    reliable(mu, |at| parts.iter_mut().map(|part| part.count(at)).sum())
}

/// `at`, or the first value beyond it in steps of a 64th at which there is a count,
/// and the count.
fn reliable(
    mut at: f64,
    mut count: impl FnMut(f64) -> Option<usize>,
) -> Result<(f64, usize), BeamError> {
    for _ in 0..MOST_MOVES {
        if let Some(found) = count(at) {
            return Ok((at, found));
        }
        at *= 1.0 + 1.0 / 64.0;
    }
    Err(BeamError::NotConverged)
}
