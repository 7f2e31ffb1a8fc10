//! Orders of the motor's turn with which an effort repeats.

use super::filter::LowPass;

/// Slots of a turn in which an effort is added up: at the highest order an eighth of a wave.
const SLOTS: usize = 8192;

/// Highest order that is looked at.
const HIGHEST: usize = 1000;

/// Turns that have to be made for anything to repeat.
const TURNS: f64 = 2.0;

/// Probability with which noise shows any order.
const BY_CHANCE: f64 = 0.01;

/// Least share of the effort's power above the low-pass that repeats with one order: 0.18 of what there
/// is, RMS, as is asked of anything that is named.
const LEAST: f64 = 0.03;

/// An order with which an effort repeats, and how often per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Order {
    pub order: f64,
    /// Cycles per sample, at the RMS of the speed.
    pub frequency: f64,
    /// Share of the effort's power above the low-pass.
    pub share: f64,
}

/// Orders of the turn of `angle` (rad) with which the `effort` above `low` (cycles per sample) repeats,
/// up to the frequency `most`: where a wave of the angle takes more of it than of noise, by the median of
/// all orders, and more than the least share.
pub(super) fn orders(effort: &[f64], angle: &[f64], low: f64, most: f64) -> Vec<Order> {
    let n = effort.len().min(angle.len());
    let ends = angle.iter();
    let [from, to] = ends.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
    if n < 2 || to - from < TURNS * std::f64::consts::TAU {
        return Vec::new();
    }
    let steps = angle.windows(2).map(|w| (w[1] - w[0]).powi(2));
    let per_sample = (steps.sum::<f64>() / (n - 1) as f64).sqrt() / std::f64::consts::TAU;
    let slow = LowPass::new(low).apply(effort);
    let fast: Vec<f64> = effort
        .iter()
        .zip(slow)
        .map(|(all, slow)| all - slow)
        .collect();
    let mut slots = vec![0.0; SLOTS];
    for (value, angle) in fast.iter().zip(angle) {
        let turn = (angle / std::f64::consts::TAU).rem_euclid(1.0);
        slots[((turn * SLOTS as f64) as usize).min(SLOTS - 1)] += value;
    }
    let fft = axis_fourier::forward(SLOTS);
    let mut sums = fft.make_output_vec();
    // The lengths agree by construction, so the transform cannot fail.
    let _ = fft.process(&mut slots, &mut sums);
    let last = ((most / per_sample) as usize).min(HIGHEST);
    let powers: Vec<f64> = sums.iter().take(last + 1).map(|c| c.norm_sqr()).collect();
    let total: f64 = fast.iter().map(|v| v * v).sum();
    // A wave's power, of n samples with the sum S in its phase, is 2 |S|²/n².
    let whole = 0.5 * n as f64 * total;
    standing_out(&powers, LEAST * whole)
        .map(|order| Order {
            order: order as f64,
            frequency: order as f64 * per_sample,
            share: powers[order] / whole,
        })
        .collect()
}

/// Places of local maxima, from 1 on, that stand out of the others, and are as large as that at least.
fn standing_out(powers: &[f64], least: f64) -> impl Iterator<Item = usize> {
    let mut sorted = powers.get(1..).unwrap_or_default().to_vec();
    sorted.sort_by(f64::total_cmp);
    // Powers of noise are exponential: their median is ln 2 of their mean.
    let mean = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0) / std::f64::consts::LN_2;
    let chance = mean * (sorted.len().max(1) as f64 / BY_CHANCE).ln();
    let limit = chance.max(least);
    (1..powers.len()).filter(move |&k| {
        let beside = powers[k - 1].max(powers.get(k + 1).copied().unwrap_or(0.0));
        powers[k] > limit && (k == 1 || powers[k] >= beside)
    })
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::orders;

    /// 4000 samples at a speed that swings by a fifth, with waves of some orders and noise.
    fn found(waves: &[(f64, f64)], seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let angle: Vec<f64> = (0..4000)
            .map(|k| 0.03 * f64::from(k) + 3.0 * (0.002 * f64::from(k)).sin())
            .collect();
        let effort: Vec<f64> = angle
            .iter()
            .map(|a| {
                let noise: f64 = StandardNormal.sample(&mut random);
                let waves = waves
                    .iter()
                    .map(|(size, order)| size * (order * a + 1.0).sin());
                noise + waves.sum::<f64>() + 5.0 * (0.01 * a).cos()
            })
            .collect();
        let found = orders(&effort, &angle, 0.04, 0.3);
        found.iter().map(|o| o.order).collect()
    }

    #[test]
    fn what_repeats_with_the_turn_is_found_and_noise_is_not() {
        assert_eq!(found(&[(1.0, 12.0), (0.6, 36.0)], 1), [12.0, 36.0]);
        assert_eq!(found(&[(0.5, 51.0)], 2), [51.0]);
        assert!((3..23).all(|seed| found(&[], seed).is_empty()));
    }

    #[test]
    fn nothing_repeats_within_one_turn() {
        let angle: Vec<f64> = (0..4000).map(|k| 0.001 * f64::from(k)).collect();
        let effort: Vec<f64> = angle.iter().map(|a| (500.0 * a).sin()).collect();
        assert_eq!(orders(&effort, &angle, 0.04, 0.3), []);
    }
}
