//! Arithmetic of points in `D` dimensions.

pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(crate) fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// `a + k b`.
pub(crate) fn add_scaled<const D: usize>(a: &[f64; D], k: f64, b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| a[i] + k * b[i])
}

pub(crate) fn sub<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    add_scaled(a, -1.0, b)
}

pub(crate) fn scaled<const D: usize>(k: f64, a: &[f64; D]) -> [f64; D] {
    a.map(|x| k * x)
}

/// `k x³` and the like, without `powi`, whose rounding is not specified.
pub(crate) fn cube(x: f64) -> f64 {
    x * x * x
}
