//! How far an estimate may be from the truth.

use statrs::distribution::{ContinuousCDF, Normal};

/// What an estimate owes to noise, to known parameters that are known to a tolerance
/// only, and to simulations that are not exact. All in the unit of the parameter.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Standard deviation of what noise makes of it, and what simulations may be off by.
    pub of_noise: f64,
    /// By how much it moves at most with each known parameter inside its tolerance.
    pub of_known: Vec<f64>,
}

/// Cells of the distribution.
const CELLS: usize = 4000;

/// Deviations of noise that the distribution holds.
const REACH: f64 = 6.0;

impl Spread {
    /// Half width of the 95 % interval; `deviation` is added to that of noise, as of
    /// one independent of it.
    ///
    /// Noise is Gaussian, each known parameter uniform over its tolerance. Where one
    /// of these is most of it, 95 % lie within 0.95 of what it does at its tolerance,
    /// and 1.96 standard deviations would lie beyond that.
    pub fn half_width(&self, deviation: f64) -> f64 {
        let noise = self.of_noise.hypot(deviation);
        let uniform: f64 = self.of_known.iter().map(|a| a.abs()).sum();
        let reach = uniform + REACH * noise;
        if reach.is_nan() || reach <= 0.0 {
            return 0.0;
        }
        let step = 2.0 * reach / CELLS as f64;
        let at = |i: usize| -reach + step * i as f64;
        // What is narrower than a few cells is as good as Gaussian.
        let (narrow, wide): (Vec<f64>, Vec<f64>) = (self.of_known.iter())
            .map(|a| a.abs())
            .partition(|a| *a < 4.0 * step);
        let narrow: f64 = narrow.iter().map(|a| a * a / 3.0).sum();
        let noise = (noise * noise + narrow).sqrt().max(step);
        let Ok(normal) = Normal::new(0.0, noise) else {
            return 0.0;
        };
        let mut below: Vec<f64> = (0..=CELLS).map(|i| normal.cdf(at(i))).collect();
        for half in wide {
            below = averaged(&below, half / step);
        }
        let upper = below.partition_point(|&p| p < UPPER).clamp(1, CELLS);
        let [p, q] = [below[upper - 1], below[upper]];
        let share = if q > p { (UPPER - p) / (q - p) } else { 0.0 };
        at(upper - 1) + share.clamp(0.0, 1.0) * step
    }
}

/// Where the 95 % interval of what is symmetric ends.
const UPPER: f64 = 0.975;

/// A distribution function once a uniform variable of this half width, in cells, is
/// added: its mean over as far to both sides.
fn averaged(below: &[f64], half: f64) -> Vec<f64> {
    let last = below.len() - 1;
    let mut integral = vec![0.0; below.len()];
    for i in 1..=last {
        integral[i] = integral[i - 1] + 0.5 * (below[i - 1] + below[i]);
    }
    let up_to = |x: f64| {
        if x <= 0.0 {
            0.0
        } else if x >= last as f64 {
            integral[last] + x - last as f64
        } else {
            let (i, share) = (x as usize, x.fract());
            let slope = below[i] + share * (below[i + 1] - below[i]);
            integral[i] + 0.5 * share * (below[i] + slope)
        }
    };
    let one = |i: usize| (up_to(i as f64 + half) - up_to(i as f64 - half)) / (2.0 * half);
    (0..=last).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::Spread;

    fn half_width(of_noise: f64, of_known: &[f64]) -> f64 {
        let of_known = of_known.to_vec();
        Spread { of_noise, of_known }.half_width(0.0)
    }

    #[test]
    fn one_alone_has_its_own_quantile() {
        assert!((half_width(2.0, &[]) - 3.91993).abs() < 2e-3);
        assert!((half_width(0.0, &[3.0]) - 2.85).abs() < 3e-3);
        // Two equal ones make a triangle: 1 - (1 - q/2)² = 0.95.
        let triangle = 2.0 * (1.0 - 0.05_f64.sqrt());
        assert!((half_width(0.0, &[1.0, -1.0]) - triangle).abs() < 3e-3);
        assert!(half_width(0.0, &[0.0]).abs() < 1e-12);
    }

    #[test]
    fn many_small_ones_are_gaussian() {
        let half = half_width(0.0, &[0.1; 60]);
        let deviation = (60.0 * 0.01 / 3.0_f64).sqrt();
        assert!((half / (1.95996 * deviation) - 1.0).abs() < 5e-3, "{half}");
    }
}
