//! Least times, taken in turn so that a disturbance meets all alike.

use std::time::Instant;

/// A piece of work to be timed.
pub type Work<'a> = &'a mut dyn FnMut();

/// The least time of each work in seconds; the works take turns.
pub fn least<const N: usize>(repetitions: usize, mut works: [Work<'_>; N]) -> [f64; N] {
    let mut best = [f64::INFINITY; N];
    for _ in 0..repetitions.max(1) {
        for (work, best) in works.iter_mut().zip(&mut best) {
            let start = Instant::now();
            work();
            // A clock that has not moved says only that it was quick.
            *best = best.min(start.elapsed().as_secs_f64().max(1e-9));
        }
    }
    best
}

/// The least time of one call among `calls` calls in a row, in seconds. The
/// rows are short, so that some fall between disturbances, and therefore many.
pub fn least_of_calls<const N: usize>(
    repetitions: usize,
    calls: usize,
    mut works: [Work<'_>; N],
) -> [f64; N] {
    let mut rows = works.each_mut().map(|work| {
        || {
            for _ in 0..calls {
                work();
            }
        }
    });
    least(
        100 * repetitions,
        rows.each_mut().map(|row| row as Work<'_>),
    )
    .map(|t| t / calls as f64)
}

/// A number to three significant digits.
pub fn digits(value: f64) -> String {
    let above = value.abs().log10().floor();
    if (-3.0..6.0).contains(&above) {
        format!("{value:.0$}", (2.0 - above).max(0.0) as usize)
    } else {
        format!("{value:.2e}")
    }
}

/// A number with its unit; times in the unit that suits them.
pub fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "s" if value < 1e-6 => format!("{} ns", digits(value * 1e9)),
        "s" if value < 1e-3 => format!("{} µs", digits(value * 1e6)),
        "s" if value < 1.0 => format!("{} ms", digits(value * 1e3)),
        _ => format!("{} {unit}", digits(value)),
    }
}
