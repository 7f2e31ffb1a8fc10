//! φ₁(Z) = Σ Zᵏ/(k+1)! of a 2×2 matrix, for the exact step at constant speed.

type Matrix = [[f64; 2]; 2];

const IDENTITY: Matrix = [[1.0, 0.0], [0.0, 1.0]];

/// φ₁(z) v, so that y(h) = y0 + φ₁(hA) h y'(0) solves y' = A y + b. Unlike
/// A⁻¹(e^{hA} − 1) it neither cancels for small hA nor needs A invertible.
pub(crate) fn exponential_increment(z: Matrix, v: [f64; 2]) -> [f64; 2] {
    let phi = phi1(z);
    [
        phi[0][0] * v[0] + phi[0][1] * v[1],
        phi[1][0] * v[0] + phi[1][1] * v[1],
    ]
}

/// Taylor series of z/2ˢ, then s doublings: φ₁(2x) = φ₁(x)(eˣ + 1)/2 and
/// e²ˣ = eˣ eˣ.
fn phi1(z: Matrix) -> Matrix {
    let (small, doublings) = scaled(z);
    // ‖small‖ ≤ 1/2: the first term left out is below (1/2)¹⁵/16! = 1.5e-18.
    let mut phi = IDENTITY;
    for k in (2..=15).rev() {
        phi = add(IDENTITY, times(1.0 / f64::from(k), product(small, phi)));
    }
    let mut exponential = add(IDENTITY, product(small, phi));
    for _ in 0..doublings {
        phi = times(0.5, product(phi, add(exponential, IDENTITY)));
        exponential = product(exponential, exponential);
    }
    phi
}

/// Halves z until its norm is at most 1/2; the bound on the count ends the
/// loop for infinite entries as well.
fn scaled(z: Matrix) -> (Matrix, u32) {
    let mut small = z;
    let mut doublings = 0;
    while norm(small) > 0.5 && doublings < 1100 {
        small = times(0.5, small);
        doublings += 1;
    }
    (small, doublings)
}

fn norm(a: Matrix) -> f64 {
    let row = |r: [f64; 2]| r[0].abs() + r[1].abs();
    row(a[0]).max(row(a[1]))
}

fn add(a: Matrix, b: Matrix) -> Matrix {
    [
        [a[0][0] + b[0][0], a[0][1] + b[0][1]],
        [a[1][0] + b[1][0], a[1][1] + b[1][1]],
    ]
}

fn times(k: f64, a: Matrix) -> Matrix {
    [[k * a[0][0], k * a[0][1]], [k * a[1][0], k * a[1][1]]]
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |r: usize, c: usize| a[r][0] * b[0][c] + a[r][1] * b[1][c];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}
