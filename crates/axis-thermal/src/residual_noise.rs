//! How far readings are off by noise, and by a model whose laws are others.

/// Standard deviations of a residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ResidualNoise {
    /// Of what differs from reading to reading.
    pub white: f64,
    /// Of all of it, with the unknowns that were fitted to it and its correlation from reading to reading.
    pub all: f64,
}

/// Greatest correlation that is counted: of a longer one a log of hours shows too little.
const MOST: f64 = 0.8;

/// Of series of readings one after the other; `increase` for unknowns that were fitted to them; at least `least`.
pub(crate) fn residual_noise(series: &[Vec<f64>], increase: f64, least: f64) -> ResidualNoise {
    let all = || series.iter().flatten();
    let count = all().count();
    if count == 0 {
        return ResidualNoise {
            white: least,
            all: least,
        };
    }
    let squares: f64 = all().map(|r| r * r).sum();
    let rms = increase * (squares / count as f64).sqrt();
    let both = series.iter().flat_map(|s| s.windows(2));
    let products: f64 = both.map(|w| w[0] * w[1]).sum();
    let correlation = (products / squares.max(f64::MIN_POSITIVE)).clamp(0.0, MOST);
    // Second differences leave out what is slow; the median what jumps.
    let second = series.iter().flat_map(|s| s.windows(3));
    let mut second: Vec<f64> = second
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs() / 6.0_f64.sqrt())
        .collect();
    second.sort_by(f64::total_cmp);
    let white = match second.len() {
        // Too few for a median.
        0..5 => rms,
        n => increase * second[n / 2] / 0.6745,
    };
    ResidualNoise {
        white: white.min(rms).max(least),
        all: (rms * ((1.0 + correlation) / (1.0 - correlation)).sqrt()).max(least),
    }
}

#[cfg(test)]
mod tests {
    use super::residual_noise;

    /// Noise that alternates has no correlation that counts; a slow residual beside it is not white.
    #[test]
    fn a_slow_residual_counts_more_than_noise() {
        let noise: Vec<f64> = (0..40)
            .map(|k| if k % 3 == 0 { 1.0 } else { -0.5 })
            .collect();
        let alone = residual_noise(std::slice::from_ref(&noise), 1.0, 0.0);
        let slow = noise.iter().enumerate();
        let slow: Vec<f64> = slow
            .map(|(k, n)| n + 5.0 * (0.1 * k as f64).sin())
            .collect();
        let both = residual_noise(&[slow], 1.0, 0.0);
        assert!((alone.all - 0.5_f64.sqrt()).abs() < 0.02, "{alone:?}");
        assert!(both.white < 1.5 * alone.white && both.all > 8.0, "{both:?}");
        assert_eq!(residual_noise(&[], 1.0, 0.3).white, 0.3);
    }
}
