//! Amplitudes as numbers of unit variance.

use std::f64::consts::SQRT_2;

use nalgebra::{Complex, DMatrix, DVector};

use super::Amplitudes;
use super::layout::Layout;

/// Inverse Cholesky factors of the spectral matrices.
#[derive(Clone, Debug)]
pub struct Whitener {
    factors: Vec<DMatrix<Complex<f64>>>,
}

impl Layout {
    /// What makes the residual white, for the spectral matrices given.
    pub fn whitener(&self, matrices: &[DMatrix<Complex<f64>>]) -> Whitener {
        let identity = DMatrix::<Complex<f64>>::identity(self.channels, self.channels);
        let inverse = |s: &DMatrix<Complex<f64>>| {
            let factor = s.clone().cholesky().map(|c| c.l());
            let inverse = factor.and_then(|l| l.solve_lower_triangular(&identity));
            inverse.unwrap_or_else(|| identity.clone())
        };
        Whitener {
            factors: matrices.iter().map(inverse).collect(),
        }
    }

    /// Whitened amplitudes as one vector of real numbers of unit variance.
    pub fn whiten(&self, whitener: &Whitener, amplitudes: &Amplitudes) -> DVector<f64> {
        let m = self.channels;
        let mut out = Vec::with_capacity(self.size());
        for (bands, bins) in self.bands.iter().zip(amplitudes) {
            for (k, (&band, r)) in bands.iter().zip(bins.chunks_exact(m)).enumerate() {
                let factor = &whitener.factors[band];
                for i in 0..m {
                    let mut sum = Complex::new(0.0, 0.0);
                    for j in 0..=i {
                        sum += factor[(i, j)] * r[j];
                    }
                    out.push(SQRT_2 * sum.re);
                    if k > 0 {
                        out.push(SQRT_2 * sum.im);
                    }
                }
            }
        }
        DVector::from_vec(out)
    }
}
