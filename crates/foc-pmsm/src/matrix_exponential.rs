//! φ₁(Z) = Σ Zᵏ/(k+1)! of a 2×2 matrix, for the exact step at constant speed.

use axis_scalar::Scalar;

type Matrix<T> = [[T; 2]; 2];

fn identity<T: Scalar>() -> Matrix<T> {
    [[T::ONE, T::ZERO], [T::ZERO, T::ONE]]
}

/// φ₁(z) v, so that y(h) = y0 + φ₁(hA) h y'(0) solves y' = A y + b. Unlike
/// A⁻¹(e^{hA} − 1) it neither cancels for small hA nor needs A invertible.
pub(crate) fn exponential_increment<T: Scalar>(z: Matrix<T>, v: [T; 2]) -> [T; 2] {
    let phi = phi1(z);
    [
        phi[0][0] * v[0] + phi[0][1] * v[1],
        phi[1][0] * v[0] + phi[1][1] * v[1],
    ]
}

/// Taylor series of z/2ˢ, then s doublings: φ₁(2x) = φ₁(x)(eˣ + 1)/2 and
/// e²ˣ = eˣ eˣ.
fn phi1<T: Scalar>(z: Matrix<T>) -> Matrix<T> {
    let (small, doublings) = scaled(z);
    // ‖small‖ ≤ 1/2: the first term left out is below (1/2)¹⁵/16! = 1.5e-18.
    let mut phi = identity();
    let mut k = T::of(15.0);
    while k > T::ONE {
        phi = add(identity(), times(T::ONE / k, product(small, phi)));
        k -= T::ONE;
    }
    let mut exponential = add(identity(), product(small, phi));
    for _ in 0..doublings {
        phi = times(T::HALF, product(phi, add(exponential, identity())));
        exponential = product(exponential, exponential);
    }
    phi
}

/// Halves z until its norm is at most 1/2; the bound on the count ends the
/// loop for infinite entries as well.
fn scaled<T: Scalar>(z: Matrix<T>) -> (Matrix<T>, u32) {
    let mut small = z;
    let mut doublings = 0;
    while norm(small) > T::HALF && doublings < 1100 {
        small = times(T::HALF, small);
        doublings += 1;
    }
    (small, doublings)
}

fn norm<T: Scalar>(a: Matrix<T>) -> T {
    let row = |r: [T; 2]| r[0].abs() + r[1].abs();
    row(a[0]).max(row(a[1]))
}

fn add<T: Scalar>(a: Matrix<T>, b: Matrix<T>) -> Matrix<T> {
    [
        [a[0][0] + b[0][0], a[0][1] + b[0][1]],
        [a[1][0] + b[1][0], a[1][1] + b[1][1]],
    ]
}

fn times<T: Scalar>(k: T, a: Matrix<T>) -> Matrix<T> {
    [[k * a[0][0], k * a[0][1]], [k * a[1][0], k * a[1][1]]]
}

fn product<T: Scalar>(a: Matrix<T>, b: Matrix<T>) -> Matrix<T> {
    let entry = |r: usize, c: usize| a[r][0] * b[0][c] + a[r][1] * b[1][c];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}
