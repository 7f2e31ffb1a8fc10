//! Eigenvalues of dense pencils whose highest and lowest are far apart.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};

use crate::BeamError;

/// Eigenvalues this far below the highest have lost half their digits in a
/// decomposition that is right to the rounding of the highest.
pub(crate) const SPAN: f64 = (1_u64 << 26) as f64;

/// A motion whose energy is below this many times rounding is refused: a tenth of it
/// may be rounding then. As measured it is below a thousandth (the tests' nodes that
/// come closer and closer), since few roundings are the worst and of one sign.
pub(crate) const RESOLVED: f64 = 10.0;

/// Where rounding can hide an ω² within this factor of the lowest one that is seen, a
/// rigid motion is not trusted: it may be a mode whose stiffness is lost. The lowest
/// two ω² of a beam are 39 apart at most (a cantilever's).
pub(crate) const HIDDEN: f64 = 1e3;

/// Eigenvalues, ascending, and their vectors, one a column.
pub(crate) struct Pairs {
    pub values: Vec<f64>,
    pub shapes: DMatrix<f64>,
}

/// Eigenpairs of A x = λ B x, ascending, with Bᵀ-orthonormal vectors, from the factor
/// L of B: those of L⁻¹ A L⁻ᵀ. A is symmetric, in both triangles.
pub(crate) fn reduced(
    factor: &Cholesky<f64, Dyn>,
    matrix: &DMatrix<f64>,
) -> Result<Pairs, BeamError> {
    let (factor, order) = (factor.l_dirty(), matrix.nrows());
    let mut reduced = matrix.clone();
    // Two solves with L, on the columns and then, transposed, on the rows:
    // the diagonal of L is above zero, so neither can fail.
    factor.solve_lower_triangular_mut(&mut reduced);
    reduced.transpose_mut();
    factor.solve_lower_triangular_mut(&mut reduced);
    let symmetric = (&reduced + reduced.transpose()) * 0.5;
    if !symmetric.iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotFinite { field: "reduced" });
    }
    let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, 1000 * order)
        .ok_or(BeamError::NotConverged)?;
    let mut shapes = eigen.eigenvectors;
    factor.tr_solve_lower_triangular_mut(&mut shapes);
    let numbers = eigen.eigenvalues.iter().chain(&shapes);
    if !numbers.into_iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotConverged);
    }
    let mut ranks: Vec<usize> = (0..order).collect();
    ranks.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    Ok(Pairs {
        values: ranks.iter().map(|&i| eigen.eigenvalues[i]).collect(),
        shapes: DMatrix::from_fn(order, order, |row, column| shapes[(row, ranks[column])]),
    })
}

/// The lowest modes of (K, M) with φᵀMφ = 1: eigenpairs of M x = θ (K + sM) x,
/// the greatest θ = 1/(ω² + s) first, and ω² as the quotients of their vectors. Right
/// to rounding for all ω² that are not far below `s`.
pub(crate) fn lowest(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    s: f64,
    wanted: usize,
) -> Result<Pairs, BeamError> {
    let factor = shifted(mass, stiffness, s).ok_or(BeamError::NotConverged)?;
    let inverse = reduced(&factor, mass)?;
    let last = mass.nrows() - 1;
    let mut modes: Vec<(f64, DVector<f64>)> = (0..wanted)
        .map(|mode| {
            let x = inverse.shapes.column(last - mode);
            let shape = x / x.dot(&(mass * x)).sqrt();
            (shape.dot(&(stiffness * &shape)), shape)
        })
        .collect();
    if !modes.iter().all(|(value, _)| value.is_finite()) {
        return Err(BeamError::NotConverged);
    }
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (values, shapes): (_, Vec<_>) = modes.into_iter().unzip();
    let shapes = DMatrix::from_fn(last + 1, wanted, |row, column| shapes[column][row]);
    Ok(Pairs { values, shapes })
}

/// L of K + sM, with s raised until rounding leaves that positive definite.
fn shifted(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>, s: f64) -> Option<Cholesky<f64, Dyn>> {
    let raised = std::iter::successors(Some(s), |s| Some(8.0 * s));
    raised
        .take(MOST_RAISES)
        .find_map(|s| Cholesky::new(stiffness + mass * s))
}

/// Raises of a shift by 8: from rounding to the highest eigenvalue.
pub(crate) const MOST_RAISES: usize = 24;

/// Replaces the modes that lie further than [`SPAN`] below the highest by better ones,
/// a span at a time, until only the `rigid` ones would be left.
pub(crate) fn refine_low(
    pairs: &mut Pairs,
    rigid: usize,
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Result<(), BeamError> {
    let mut limit = pairs.values[pairs.values.len() - 1].abs() / SPAN;
    loop {
        let below = pairs.values.partition_point(|value| *value < limit);
        if below <= rigid {
            return Ok(());
        }
        let low = lowest(mass, stiffness, limit / 64.0, below)?;
        pairs.values[..below].copy_from_slice(&low.values);
        pairs.shapes.columns_mut(0, below).copy_from(&low.shapes);
        limit /= SPAN;
        if limit < f64::MIN_POSITIVE {
            return Err(BeamError::NotConverged);
        }
    }
}

/// The rigid motions of (K, M): those whose energy is rounding, that is at most
/// τ Σ w_i x_i².
pub(crate) struct Rigid {
    pub count: usize,
    /// τ.
    pub rounding: f64,
    /// The w_i.
    pub weights: Vec<f64>,
}

impl Rigid {
    /// The greatest ω² that rounding can hide in these shapes, φᵀMφ = 1 each.
    pub fn hidden<'a>(&self, shapes: impl Iterator<Item = &'a [f64]>) -> f64 {
        let square = |(w, x): (&f64, &f64)| w * x * x;
        let terms = |shape: &[f64]| self.weights.iter().zip(shape).map(square).sum::<f64>();
        self.rounding * shapes.map(terms).sum::<f64>()
    }
}

/// Counts the rigid motions: eigenvalues of K scaled to a diagonal of ones that are not
/// above τ.
///
/// An entry of K has a handful of roundings, of its element and of the sum; a row has up
/// to n entries, so xᵀδKx is at most 5n · 2⁻⁵³ Σ K_ii x_i². The decomposition of the
/// scaled matrix adds about n · 2⁻⁵³ times its norm, that is a few.
pub(crate) fn rigid_motions(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Result<Rigid, BeamError> {
    let order = mass.nrows();
    let weights = weights((0..order).map(|i| (stiffness[(i, i)], mass[(i, i)])));
    let scaled = DMatrix::from_fn(order, order, |i, j| {
        stiffness[(i, j)] / (weights[i].sqrt() * weights[j].sqrt())
    });
    if !scaled.iter().all(|v| v.is_finite()) {
        return Err(BeamError::NotFinite { field: "scaled" });
    }
    let values = SymmetricEigen::try_new(scaled, f64::EPSILON, 1000 * order)
        .ok_or(BeamError::NotConverged)?
        .eigenvalues;
    let rounding = 4.0 * order as f64 * f64::EPSILON;
    if values.iter().any(|value| *value < -rounding) {
        return Err(BeamError::StiffnessNegative);
    }
    let count = values.iter().filter(|value| **value <= rounding).count();
    let soft = values.iter().filter(|v| **v <= RESOLVED * rounding).count();
    if soft > count {
        return Err(unresolved(mass, stiffness));
    }
    Ok(Rigid {
        count,
        rounding,
        weights,
    })
}

/// Refuses rigid modes that may be others.
pub(crate) fn check_rigid(
    pairs: &Pairs,
    rigid: &Rigid,
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Result<(), BeamError> {
    let order = pairs.values.len();
    let shapes = pairs
        .shapes
        .as_slice()
        .chunks_exact(order)
        .take(rigid.count);
    let seen = pairs.values.get(rigid.count);
    if seen.is_some_and(|lowest| *lowest < HIDDEN * rigid.hidden(shapes)) {
        return Err(unresolved(mass, stiffness));
    }
    Ok(())
}

fn unresolved(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> BeamError {
    let row = stiffest((0..mass.nrows()).map(|i| (stiffness[(i, i)], mass[(i, i)])));
    let stiffness = stiffness[(row, row)];
    BeamError::Unresolved { row, stiffness }
}

/// Σ w_i x_i² is the size of the terms of xᵀKx, of which rounding is a share: |K_ii|,
/// and for a row without stiffness one as soft as its mass on the stiffest row.
pub(crate) fn weights(rows: impl Iterator<Item = (f64, f64)> + Clone) -> Vec<f64> {
    let ratio = |(k, m): (f64, f64)| k.abs() / m;
    let scale = rows.clone().map(ratio).fold(0.0, f64::max);
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let weight = |(k, m): (f64, f64)| if k == 0.0 { scale * m } else { k.abs() };
    rows.map(weight).collect()
}

/// The row of the greatest ratio of stiffness to mass.
pub(crate) fn stiffest(rows: impl Iterator<Item = (f64, f64)>) -> usize {
    let ratios = rows.map(|(k, m)| k / m).enumerate();
    ratios
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(row, _)| row)
}
