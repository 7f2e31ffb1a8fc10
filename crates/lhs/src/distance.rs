//! The distance of two points.

/// Euclidean distance; in units of the greatest difference where squares would leave
/// the range of f64, or the digits of its least numbers.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let sum_of_squares = |unit: f64| -> f64 {
        let square = |(x, y): (&f64, &f64)| ((x - y) / unit) * ((x - y) / unit);
        a.iter().zip(b).map(square).sum()
    };
    let plain = sum_of_squares(1.0);
    if (1e-280..=1e280).contains(&plain) {
        return plain.sqrt();
    }
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    let greatest = differences.fold(0.0, f64::max);
    if greatest == 0.0 || greatest.is_infinite() {
        return greatest;
    }
    greatest * sum_of_squares(greatest).sqrt()
}
