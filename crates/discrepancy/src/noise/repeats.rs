//! What of a balance's rest repeats over the motor's turn or over the way.
//!
//! Cogging, ripple and errors of a pitch are as fast as noise where an axis goes fast, and one sample says
//! as little of the next. But each comes back at the same place.

use std::f64::consts::{LN_2, TAU};

use nalgebra::{Matrix2, Vector2};

use crate::spectrum::waves;

/// Waves that are taken out at most.
const MOST: usize = 12;

/// Probability with which noise shows any wave.
const BY_CHANCE: f64 = 0.01;

/// Most places of the abscissa.
const LONGEST: usize = 1 << 16;

/// Steps between two frequencies of the grid in which a wave is found more finely.
const FINER: i32 = 8;

/// A rest, without what repeats over `angle` (rad), and the numbers that were fitted for that. Neighbours
/// in time are less than `apart` (s) from each other.
///
/// What is slow is left in: second differences of three neighbours are looked at, which do not see it and
/// do not ask which way the axis goes. A wave is taken for one where it stands so far out of all others, by
/// their median, as noise would once in a hundred times.
pub(super) fn without_repeats(
    rest: &[f64],
    angle: &[f64],
    time: &[f64],
    apart: f64,
) -> (Vec<f64>, usize) {
    let mut left = rest.to_vec();
    let middles: Vec<usize> = (1..rest.len().saturating_sub(1))
        .filter(|&k| time[k + 1] - time[k] < apart && time[k] - time[k - 1] < apart)
        .collect();
    let at: Vec<f64> = middles.iter().map(|&k| angle[k]).collect();
    let bend =
        |series: &dyn Fn(usize) -> f64, k: usize| series(k) - 0.5 * (series(k - 1) + series(k + 1));
    let ends = at.iter();
    let [low, high] = ends.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
    let steps = middles.iter().map(|&k| (angle[k] - angle[k - 1]).powi(2));
    let step = (steps.sum::<f64>() / middles.len().max(1) as f64).sqrt();
    // Waves of two samples and longer, in steps of half of what the way resolves.
    let length = (4.0 * (high - low) / step.max(f64::MIN_POSITIVE)).ceil() as usize;
    let length = length.clamp(8, LONGEST) & !1;
    let place = 2.0 * (high - low) / length as f64;
    if middles.len() < 2 * MOST || place <= 0.0 || !place.is_finite() {
        return (left, 0);
    }
    let mut fitted = 0;
    while fitted < 2 * MOST {
        let bends: Vec<f64> = middles.iter().map(|&k| bend(&|k| left[k], k)).collect();
        let Some(coarse) = standing_out(waves(&at, &bends, place, length).collect()) else {
            break;
        };
        let spacing = 1.0 / (length as f64 * place);
        let wave = |frequency: f64, k: usize| (TAU * frequency * angle[k]).sin_cos();
        let solve = |frequency: f64| -> Option<(f64, Vector2<f64>)> {
            let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
            for (&k, bent) in middles.iter().zip(&bends) {
                let own = Vector2::new(
                    bend(&|k| wave(frequency, k).0, k),
                    bend(&|k| wave(frequency, k).1, k),
                );
                normal += own * own.transpose();
                right += own * *bent;
            }
            let sizes = normal.cholesky()?.solve(&right);
            Some((sizes.dot(&right), sizes))
        };
        let near = (-FINER..=FINER).map(|j| coarse + spacing * f64::from(j) / f64::from(FINER));
        let near = near.filter_map(|frequency| Some((frequency, solve(frequency)?)));
        let Some((frequency, (_, sizes))) = near.max_by(|a, b| a.1.0.total_cmp(&b.1.0)) else {
            break;
        };
        for (k, value) in left.iter_mut().enumerate() {
            let (sin, cos) = wave(frequency, k);
            *value -= sizes[0] * sin + sizes[1] * cos;
        }
        // Its size in either phase, and its frequency.
        fitted += 3;
    }
    (left, fitted)
}

/// Frequency of the wave that takes the most, where it stands out of all.
fn standing_out(all: Vec<(f64, f64)>) -> Option<f64> {
    let mut shares: Vec<f64> = all.iter().map(|(_, share)| *share).collect();
    shares.sort_by(f64::total_cmp);
    let median = *shares.get(shares.len() / 2)?;
    let limit = median / LN_2 * (shares.len() as f64 / BY_CHANCE).ln();
    let best = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (best.1 > COLOUR * limit).then_some(best.0)
}

/// Times by which noise may be stronger in one frequency than in the mean: second differences of white
/// noise have 16/6 of their mean power at half the rate, and rests are not white.
const COLOUR: f64 = 3.0;

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::without_repeats;

    const PERIOD: f64 = 0.01;

    fn power(series: &[f64]) -> f64 {
        series.iter().map(|v| v * v).sum::<f64>() / series.len() as f64
    }

    /// Unit noise over a way there and back, and `size` times a wave that repeats over the way.
    fn left(size: f64, seed: u64) -> (f64, usize) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let time: Vec<f64> = (0..3000).map(|k| PERIOD * f64::from(k)).collect();
        let angle: Vec<f64> = time
            .iter()
            .map(|t| 40.0 * (0.4 * t).sin() + 3.0 * t)
            .collect();
        let wave = |a: &f64| size * (9.3 * a + 0.4).sin();
        let rest: Vec<f64> = angle
            .iter()
            .map(|a| {
                let noise: f64 = StandardNormal.sample(&mut random);
                wave(a) + noise
            })
            .collect();
        let (left, fitted) = without_repeats(&rest, &angle, &time, 1.5 * PERIOD);
        (power(&left), fitted)
    }

    /// Of 3000 samples a variance is known to 3 %.
    #[test]
    fn what_repeats_over_the_way_is_taken_out_and_noise_is_left() {
        let (power, fitted) = left(2.0, 1);
        assert!((power - 1.0).abs() < 0.1 && fitted <= 6, "{power} {fitted}");
        for seed in 2..12 {
            let (power, fitted) = left(0.0, seed);
            assert!((power - 1.0).abs() < 0.1 && fitted == 0, "{power} {fitted}");
        }
    }
}
