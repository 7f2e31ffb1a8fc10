//! Values of a curve as a Gaussian process: near places have like values.
//!
//! ```text
//! v ~ N(0, σ² K)      ln Z(σ) = ½ [bᵀ (A + K⁻¹/σ²)⁻¹ b − ln |1 + σ² K A|] + const.
//! ```
//!
//! A is the information that the logs hold on the values v beside all other parameters, A⁻¹b where they are most probable
//! without the process, and σ is where the marginal likelihood Z is greatest (Rasmussen and Williams, Gaussian Processes for Machine
//! Learning, 2006, section 5.4). Where logs hold little, or what another parameter does as well, a value is as its neighbours say.

use nalgebra::{DMatrix, DVector};

use super::bounded::inverse_of;

/// Ratio of successive σ² that are tried, and how many.
const STEP: f64 = 2.0;
const STEPS: i32 = 50;

/// A curve among the parameters of a linearised problem.
#[derive(Debug)]
pub(crate) struct Smooth<'a> {
    /// Place of its first value among the parameters.
    pub(crate) first: usize,
    /// K.
    pub(crate) correlation: &'a DMatrix<f64>,
    /// The values about which the problem is linearised.
    pub(crate) values: &'a [f64],
}

impl Smooth<'_> {
    /// Adds the process to a problem of least squares: xᵀNx/2 − bᵀx of the step x.
    pub(crate) fn add_to(&self, normal: &mut DMatrix<f64>, right: &mut DVector<f64>) {
        let count = self.values.len();
        let values = DVector::from_column_slice(self.values);
        let (information, pull) = self.beside_others(normal, right);
        let Some(root) = self.correlation.clone().cholesky() else {
            return;
        };
        // With v = L w, L Lᵀ = K, the process of w has no correlation.
        let inverse = root.inverse();
        let root = root.l();
        let eigen = (root.transpose() * &information * &root).symmetric_eigen();
        let pulled = eigen
            .eigenvectors
            .tr_mul(&root.tr_mul(&(pull + &information * &values)));
        let strengths = eigen.eigenvalues.map(|m| m.max(0.0));
        let strongest = strengths.max();
        if strongest.is_nan() || strongest <= 0.0 {
            return;
        }
        let evidence = |variance: f64| -> f64 {
            let each = strengths.iter().zip(pulled.iter());
            each.map(|(m, p)| p * p / (m + 1.0 / variance) - (variance * m).ln_1p())
                .sum()
        };
        let tried = (0..STEPS).map(|i| STEP.powi(i) / strongest);
        let most_probable = tried.max_by(|a, b| evidence(*a).total_cmp(&evidence(*b)));
        let precision = inverse / most_probable.unwrap_or(1.0 / strongest);
        let back = &precision * &values;
        for i in 0..count {
            for j in 0..count {
                normal[(self.first + i, self.first + j)] += precision[(i, j)];
            }
            right[self.first + i] -= back[i];
        }
    }

    /// A, and the right-hand side of the step in the values alone, all other parameters at their best.
    fn beside_others(
        &self,
        normal: &DMatrix<f64>,
        right: &DVector<f64>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let own: Vec<usize> = (self.first..self.first + self.values.len()).collect();
        let others: Vec<usize> = (0..right.len()).filter(|i| !own.contains(i)).collect();
        let part = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                normal[(rows[i], columns[j])]
            })
        };
        let side = |rows: &[usize]| DVector::from_fn(rows.len(), |i, _| right[rows[i]]);
        let across = part(&own, &others) * inverse_of(&part(&others, &others));
        (
            part(&own, &own) - &across * part(&others, &own),
            side(&own) - across * side(&others),
        )
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::Smooth;

    /// Values that rise evenly, one of which is hardly measured: it comes out between its neighbours, where least squares alone give
    /// what noise says.
    #[test]
    fn a_value_that_is_hardly_measured_is_as_its_neighbours_say() {
        let count = 7;
        let correlation = DMatrix::from_fn(count, count, |i, j| {
            let r = 3.0_f64.sqrt() * (i as f64 - j as f64).abs() / 3.0;
            (1.0 + r) * (-r).exp()
        });
        let truth = DVector::from_fn(count, |i, _| 1.0 + i as f64);
        let weight = |i: usize| if i == 3 { 1e-6 } else { 1e6 };
        let mut normal = DMatrix::from_diagonal(&DVector::from_fn(count, |i, _| weight(i)));
        let mut right = &normal * &truth;
        // Noise of three standard deviations of what is hardly measured.
        right[3] += 3e-3;
        let alone = right[3] / normal[(3, 3)];
        assert!(alone > 1000.0);
        let values = vec![0.0; count];
        Smooth {
            first: 0,
            correlation: &correlation,
            values: &values,
        }
        .add_to(&mut normal, &mut right);
        let found = normal.cholesky().unwrap().solve(&right);
        assert!((found - truth).amax() < 0.3);
    }

    /// The same from values that are there already: the process is of the values, not of the step.
    #[test]
    fn the_place_of_the_linearisation_does_not_matter() {
        let correlation = DMatrix::from_fn(4, 4, |i, j| (-(i as f64 - j as f64).abs()).exp());
        let information = DMatrix::from_fn(5, 5, |i, j| if i == j { 3.0 } else { 0.5 });
        let pull = DVector::from_fn(5, |i, _| 1.0 - 0.3 * i as f64);
        let at = |values: [f64; 4]| {
            let there = DVector::from_fn(5, |i, _| i.checked_sub(1).map_or(0.0, |j| values[j]));
            let mut normal = information.clone();
            let mut right = &pull - &information * &there;
            Smooth {
                first: 1,
                correlation: &correlation,
                values: &values,
            }
            .add_to(&mut normal, &mut right);
            there + normal.cholesky().unwrap().solve(&right)
        };
        assert!((at([0.0; 4]) - at([0.2, -0.5, 1.0, 0.3])).amax() < 1e-12);
    }
}
