//! Pairs of vectors, stored row by row: what the band operations work on.

use crate::banded::SymmetricBanded;

/// Two vectors side by side, one row an entry.
pub(crate) type Block = [[f64; 2]];

/// A 2 × 2 matrix, row by row.
pub(crate) type Small = [[f64; 2]; 2];

/// y = A x.
pub(crate) fn multiply(a: &SymmetricBanded, x: &Block, y: &mut Block) {
    y.fill([0.0; 2]);
    match a.half_bandwidth() {
        // The bands of rods and of bending, with the loops unrolled.
        1 => a
            .data()
            .as_chunks::<2>()
            .0
            .iter()
            .enumerate()
            .for_each(|(j, c)| spread(c, j, x, y)),
        3 => a
            .data()
            .as_chunks::<4>()
            .0
            .iter()
            .enumerate()
            .for_each(|(j, c)| spread(c, j, x, y)),
        w => a
            .data()
            .chunks_exact(w + 1)
            .enumerate()
            .for_each(|(j, c)| spread(c, j, x, y)),
    }
}

/// What column j of the lower triangle, and its mirror image, add to A x.
#[inline(always)]
fn spread(column: &[f64], j: usize, x: &Block, y: &mut Block) {
    let own = x[j];
    let mut sum = [column[0] * own[0], column[0] * own[1]];
    let below = x[j + 1..].iter().zip(&column[1..]);
    for ((row, value), target) in below.zip(&mut y[j + 1..]) {
        sum[0] += value * row[0];
        sum[1] += value * row[1];
        target[0] += value * own[0];
        target[1] += value * own[1];
    }
    y[j][0] += sum[0];
    y[j][1] += sum[1];
}

/// xᵀ y, 2 × 2.
pub(crate) fn inner(x: &Block, y: &Block) -> Small {
    let mut sum = [[0.0; 2]; 2];
    for (a, b) in x.iter().zip(y) {
        sum[0][0] += a[0] * b[0];
        sum[0][1] += a[0] * b[1];
        sum[1][0] += a[1] * b[0];
        sum[1][1] += a[1] * b[1];
    }
    sum
}

/// y −= x c.
pub(crate) fn subtract(y: &mut Block, x: &Block, c: &Small) {
    for (target, a) in y.iter_mut().zip(x) {
        target[0] -= a[0] * c[0][0] + a[1] * c[1][0];
        target[1] -= a[0] * c[0][1] + a[1] * c[1][1];
    }
}

/// xᵀ y of one column each. Four sums side by side: one alone would wait for
/// each addition to end.
pub(crate) fn dot(x: &Block, i: usize, y: &Block, j: usize) -> f64 {
    let ((xs, x_rest), (ys, y_rest)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in xs.iter().zip(ys) {
        for k in 0..4 {
            sums[k] += a[k][i] * b[k][j];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(a, b)| a[i] * b[j]).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
