//! Least squares with some coordinates kept between bounds.

use nalgebra::{DMatrix, DVector};

/// The minimum of xᵀNx/2 − bᵀx with some coordinates kept in their `room`,
/// which holds 0: a primal active-set method (Nocedal and Wright, Numerical
/// Optimization, 2nd ed., Algorithm 16.3).
pub fn bounded(
    normal: &DMatrix<f64>,
    right: &DVector<f64>,
    room: impl Fn(usize) -> Option<[f64; 2]>,
) -> DVector<f64> {
    let n = right.len();
    let (scale, scaled) = scaled(normal);
    let rooms: Vec<[f64; 2]> = (0..n)
        .map(|i| match room(i) {
            Some(edges) => edges.map(|edge| edge / scale[i]),
            None => [f64::NEG_INFINITY, f64::INFINITY],
        })
        .collect();
    active_set(&scaled, &right.component_mul(&scale), &rooms).component_mul(&scale)
}

fn active_set(normal: &DMatrix<f64>, right: &DVector<f64>, rooms: &[[f64; 2]]) -> DVector<f64> {
    let n = right.len();
    let mut x = DVector::zeros(n);
    let mut fixed = vec![false; n];
    // Every round fixes or releases one; it ends far earlier.
    for _ in 0..20 * n {
        let free: Vec<usize> = (0..n).filter(|&i| !fixed[i]).collect();
        let wanted = solve_free(normal, right, &x, &free);
        // As far towards the free minimum as the first edge in the way.
        let mut reach = (1.0, None);
        for (&i, &to) in free.iter().zip(wanted.iter()) {
            let [low, high] = rooms[i];
            let edge = to.clamp(low, high);
            if edge != to {
                let share = ((edge - x[i]) / (to - x[i])).clamp(0.0, 1.0);
                if share < reach.0 || reach.1.is_none() {
                    reach = (share, Some((i, edge)));
                }
            }
        }
        for (&i, &to) in free.iter().zip(wanted.iter()) {
            x[i] += reach.0 * (to - x[i]);
        }
        if let Some((i, edge)) = reach.1 {
            x[i] = edge;
            fixed[i] = true;
            continue;
        }
        // At the minimum of the free ones: does any other pull inward?
        let slope = right - normal * &x;
        let pull = |&i: &usize| {
            if x[i] <= rooms[i][0] {
                slope[i]
            } else {
                -slope[i]
            }
        };
        let inward = (0..n)
            .filter(|&i| fixed[i])
            .filter(|i| pull(i) > 1e-9 * (1.0 + right[*i].abs()))
            .max_by(|a, b| pull(a).total_cmp(&pull(b)));
        match inward {
            Some(i) => fixed[i] = false,
            None => break,
        }
    }
    x
}

/// The factors that give a normal matrix a diagonal of ones, and that matrix: or
/// sizes of many units would not be told from 0.
fn scaled(normal: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let n = normal.nrows();
    let scale = DVector::from_fn(n, |i, _| {
        let own = normal[(i, i)];
        if own > 0.0 { own.sqrt().recip() } else { 1.0 }
    });
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        normal[(i, j)] * scale[i] * scale[j] + if i == j { 1e-12 } else { 0.0 }
    });
    (scale, scaled)
}

/// The inverse of a normal matrix whose rows are of many sizes.
pub fn inverse_of(normal: &DMatrix<f64>) -> DMatrix<f64> {
    let n = normal.nrows();
    let (scale, scaled) = scaled(normal);
    let inverse = scaled.cholesky().map(|c| c.inverse());
    let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(n, n));
    DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j])
}

/// The minimum over some coordinates, the others as they are.
fn solve_free(
    normal: &DMatrix<f64>,
    right: &DVector<f64>,
    x: &DVector<f64>,
    free: &[usize],
) -> DVector<f64> {
    let held: Vec<usize> = (0..x.len()).filter(|i| !free.contains(i)).collect();
    let matrix = DMatrix::from_fn(free.len(), free.len(), |a, b| normal[(free[a], free[b])]);
    let side = DVector::from_fn(free.len(), |a, _| {
        let of_held = held.iter().map(|&j| normal[(free[a], j)] * x[j]);
        right[free[a]] - of_held.sum::<f64>()
    });
    let solved = matrix.cholesky().map(|c| c.solve(&side));
    solved.unwrap_or_else(|| DVector::from_fn(free.len(), |a, _| x[free[a]]))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::bounded;

    /// The conditions of Karush, Kuhn and Tucker, which a minimum of a convex
    /// problem satisfies and nothing else does.
    #[test]
    fn bounded_minimum_is_one() {
        for seed in 0..200 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let n = 2 + (seed as usize % 12);
            let a = DMatrix::from_fn(n + 3, n, |_, _| random.random::<f64>() - 0.3);
            let normal = a.tr_mul(&a) + DMatrix::identity(n, n) * 1e-3;
            let right = DVector::from_fn(n, |_, _| 4.0 * (random.random::<f64>() - 0.5));
            let edges: Vec<[f64; 2]> = (0..n)
                .map(|_| [-0.3 * random.random::<f64>(), 0.3 * random.random::<f64>()])
                .collect();
            let free = |i: usize| i % 3 == 2;
            let x = bounded(&normal, &right, |i| (!free(i)).then_some(edges[i]));
            let slope = &right - &normal * &x;
            for i in 0..n {
                let [low, high] = edges[i];
                // Edges come back through the scaling.
                let (low, high) = (low + 1e-14, high - 1e-14);
                if free(i) || (low < x[i] && x[i] < high) {
                    assert!(slope[i].abs() < 1e-7, "seed {seed}: {x} {slope}");
                } else if x[i] <= low {
                    assert!(x[i] >= edges[i][0] - 1e-14);
                    assert!(slope[i] < 1e-7, "seed {seed}: {x} {slope}");
                } else {
                    assert!(slope[i] > -1e-7, "seed {seed}: {x} {slope}");
                }
            }
        }
    }
}
