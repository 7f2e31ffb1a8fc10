//! The discrete algebraic Riccati equation by structure-preserving doubling.
//!
//! ```text
//! P = Aᵀ P A − Aᵀ P B (R + Bᵀ P B)⁻¹ Bᵀ P A + Q = Q + Aᵀ P (I + G P)⁻¹ A,   G = B R⁻¹ Bᵀ
//!
//! A ← A W⁻¹ A,   G ← G + A W⁻¹ G Aᵀ,   H ← H + Aᵀ H W⁻¹ A,   W = I + G H
//! ```
//!
//! from (A, G, Q), H goes to P, quadratically where the closed loop is stable (E. K.-W. Chu,
//! H.-Y. Fan, W.-W. Lin, C.-S. Wang, "Structure-preserving algorithms for periodic discrete-time
//! algebraic Riccati equations", Int. J. Control 77, 2004).

use nalgebra::DMatrix;

/// Doublings: 2⁶⁰ steps of the recursion are more than any closed loop needs.
const DOUBLINGS: usize = 60;
/// Greatest relative residual of a solution.
pub(super) const RESIDUAL: f64 = 1e-8;

/// P of (A, G = B R⁻¹ Bᵀ, Q), and its relative residual. Err with the residual where that is
/// above [`RESIDUAL`], not a number where the doubling broke down.
pub(super) fn solve(
    a: &DMatrix<f64>,
    g: &DMatrix<f64>,
    q: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, f64), f64> {
    let n = a.nrows();
    let one = DMatrix::<f64>::identity(n, n);
    let (mut ak, mut gk, mut hk) = (a.clone(), g.clone(), q.clone());
    for _ in 0..DOUBLINGS {
        let lu = (&one + &gk * &hk).lu();
        let wa = lu.solve(&ak).ok_or(f64::NAN)?;
        let wg = lu.solve(&gk).ok_or(f64::NAN)?;
        let more = ak.transpose() * &hk * &wa;
        let g_more = &ak * wg * ak.transpose();
        ak *= wa;
        let change = more.norm() / (hk.norm() + f64::MIN_POSITIVE);
        hk = symmetric(hk + more);
        gk = symmetric(gk + g_more);
        if change.is_nan() {
            return Err(f64::NAN);
        }
        if change < f64::EPSILON {
            break;
        }
    }
    let residual = residual(a, g, q, &hk);
    if residual <= RESIDUAL {
        Ok((hk, residual))
    } else {
        Err(residual)
    }
}

fn symmetric(m: DMatrix<f64>) -> DMatrix<f64> {
    let transposed = m.transpose();
    (m + transposed) * 0.5
}

/// ‖Q + Aᵀ P (I + G P)⁻¹ A − P‖ / ‖P‖.
fn residual(a: &DMatrix<f64>, g: &DMatrix<f64>, q: &DMatrix<f64>, p: &DMatrix<f64>) -> f64 {
    let n = a.nrows();
    let w = DMatrix::identity(n, n) + g * p;
    let Some(wa) = w.lu().solve(a) else {
        return f64::NAN;
    };
    (q + a.transpose() * p * wa - p).norm() / p.norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x⁺ = a x + u: P solves p² + p (1 − a² − q) − q = 0 at R = 1.
    #[test]
    fn scalar_equation() {
        for (a, q) in [(1.0, 1e-6), (0.5, 2.0), (1.5, 1e-3), (1.0, 1.0)] {
            let m = |v: f64| DMatrix::from_element(1, 1, v);
            let (p, residual) = solve(&m(a), &m(1.0), &m(q)).unwrap();
            let b = 1.0 - a * a - q;
            let expected = 0.5 * (-b + (b * b + 4.0 * q).sqrt());
            assert!((p[(0, 0)] / expected - 1.0).abs() < 1e-9, "{a} {q} {p}");
            assert!(residual < 1e-12);
        }
    }

    /// What cannot be reached and does not decay has no solution.
    #[test]
    fn an_unstable_state_out_of_reach_is_refused() {
        let a = DMatrix::from_row_slice(2, 2, &[0.5, 0.0, 0.0, 1.1]);
        let g = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.0]);
        let q = DMatrix::identity(2, 2);
        assert!(solve(&a, &g, &q).is_err());
    }
}
