//! How much of a residual's spectrum each source of noise makes.
//!
//! Sensors' noise goes round the loop and shows in many channels; what a logger adds (its
//! own converter, an unshielded line) shows in one, and there as white noise. With the
//! powers O(c, b) of a residual in channel c and band b, the powers G(s, c, b) that source s
//! of unit variance makes there, and variances p(s) ≥ 0, the powers' likelihood is that of
//! Whittle,
//!
//! ```text
//! Σ n(b) [ O / P − ln(O / P) − 1 ],      P(c, b) = Σ p(s) G(s, c, b)
//! ```
//!
//! Two things are asked for besides. Below the upper half of the bands the residual may hold
//! what the model lacks, so more power than predicted hardly counts there, while less of it
//! says that the noise is not there. And of two explanations that are equally good, the one
//! with fewer sources is taken by steps that shrink what nothing asks for
//! (multiplicative updates for the Itakura–Saito divergence: Févotte, Bertin, Durrieu,
//! Neural Comput. 21 (2009) 793–830, doi:10.1162/neco.2008.04-08-771).

/// Powers by channel and band.
pub(super) type Powers = Vec<Vec<f64>>;

/// Weight of a band below the upper half, unless there is clearly less than predicted.
const MAY_BE_MORE: f64 = 0.05;

/// Times what is there that may be predicted: both come of one run, and below 25 Hz the
/// spectrum is steep.
const SCATTER: f64 = 1.5;

/// Share with which a source begins that is taken last: it grows where no other does.
const LAST: f64 = 1e-2;

/// Times what is predicted beyond which power in such a band does not count.
const BEYOND: f64 = 2.0;

/// Rounds of updates: powers of ten in a variance are gained in a few dozen, and two sources
/// that look alike are told apart in a thousand.
const ROUNDS: usize = 3000;

/// Variances of the sources, from a residual's powers. `values` are the independent values of
/// each band; bands from `upper` on hold noise alone. Of sources that explain as much, those
/// from `last` on are taken last.
pub(super) fn variances(
    observed: &Powers,
    sources: &[Powers],
    values: &[f64],
    upper: usize,
    last: usize,
) -> Vec<f64> {
    let cells: Vec<(usize, usize)> = (0..observed.len())
        .flat_map(|c| (0..values.len()).map(move |b| (c, b)))
        .filter(|&(c, b)| observed[c][b] > 0.0)
        .collect();
    let begin = |(place, source): (usize, &Powers)| {
        let share = if place < last { 1.0 } else { LAST };
        share * most(observed, source, &cells)
    };
    let mut all: Vec<f64> = sources.iter().enumerate().map(begin).collect();
    for _ in 0..ROUNDS {
        let predicted = |&(c, b): &(usize, usize)| -> f64 {
            let each = all.iter().zip(sources).map(|(p, s)| p * s[c][b]);
            each.sum::<f64>().max(1e-12 * observed[c][b])
        };
        let predicted: Vec<f64> = cells.iter().map(predicted).collect();
        let weight = |(&(c, b), &by): (&(usize, usize), &f64)| {
            let may_be = b < upper && by < SCATTER * observed[c][b];
            if may_be {
                MAY_BE_MORE * values[b]
            } else {
                values[b]
            }
        };
        let weights: Vec<f64> = cells.iter().zip(&predicted).map(weight).collect();
        for (p, source) in all.iter_mut().zip(sources) {
            let (mut asked, mut given) = (0.0, 0.0);
            for ((&(c, b), by), w) in cells.iter().zip(&predicted).zip(&weights) {
                // Far more than predicted is of no noise, and asks for nothing.
                let seen = match b < upper && observed[c][b] > BEYOND * by {
                    true => *by,
                    false => observed[c][b],
                };
                asked += w * source[c][b] * seen / (by * by);
                given += w * source[c][b] / by;
            }
            if given > 0.0 {
                *p *= asked / given;
            }
        }
    }
    all
}

/// The most of a source that no cell of the upper bands contradicts by itself.
fn most(observed: &Powers, source: &Powers, cells: &[(usize, usize)]) -> f64 {
    let ratios = cells.iter().filter(|&&(c, b)| source[c][b] > 0.0);
    let ratios = ratios.map(|&(c, b)| observed[c][b] / source[c][b]);
    let least = ratios.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{Powers, variances};

    const VALUES: [f64; 4] = [50.0, 30.0, 60.0, 120.0];

    /// A sensor that three channels show through a loop, a second one that two show, and a
    /// logger at each channel.
    fn sources() -> Vec<Powers> {
        let mut all = vec![
            vec![
                vec![0.1, 1.0, 1.2, 1.0],
                vec![3.0, 4.0, 4.0, 4.0],
                vec![0.0; 4],
            ],
            vec![
                vec![0.0; 4],
                vec![0.2, 0.3, 0.1, 0.1],
                vec![0.05, 0.5, 2.0, 2.0],
            ],
        ];
        for c in 0..3 {
            let mut logger = vec![vec![0.0; 4]; 3];
            logger[c] = vec![1.0; 4];
            all.push(logger);
        }
        all
    }

    fn powers(variances: &[f64]) -> Powers {
        let sources = sources();
        let cell = |c: usize, b: usize| {
            let each = variances.iter().zip(&sources).map(|(p, s)| p * s[c][b]);
            each.sum::<f64>()
        };
        (0..3)
            .map(|c| (0..4).map(|b| cell(c, b)).collect())
            .collect()
    }

    /// Two sources may look alike in the upper bands, where alone noise is told; there what is
    /// found is what is seen, and below it is of its size.
    #[test]
    fn what_is_found_makes_what_is_seen() {
        for truth in [
            [2.0, 3.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 4.0, 1.0, 7.0],
            [1.0, 0.0, 0.0, 9.0, 0.0],
        ] {
            let found = variances(&powers(&truth), &sources(), &VALUES, 2, 2);
            let predicted = powers(&found);
            for (asked, given) in powers(&truth).iter().zip(&predicted) {
                // Nothing is asked of a channel without any power.
                for (b, (a, g)) in asked
                    .iter()
                    .zip(given)
                    .enumerate()
                    .filter(|(_, (a, _))| **a > 0.0)
                {
                    let within = if b < 2 { 0.25 } else { 0.01 };
                    assert!((a - g).abs() <= within * a, "{truth:?} {found:?}");
                }
            }
        }
    }

    #[test]
    fn what_a_model_lacks_at_low_frequency_is_not_noise() {
        let truth = powers(&[2.0, 3.0, 0.0, 0.0, 0.0]);
        let mut observed = truth.clone();
        observed[0][0] *= 1e4;
        observed[1][0] *= 1e4;
        let found = variances(&observed, &sources(), &VALUES, 2, 2);
        let predicted = powers(&found);
        assert!(predicted[0][0] < 1.2 * truth[0][0], "{found:?}");
        assert!(predicted[1][0] < 1.05 * truth[1][0], "{found:?}");
        for (asked, given) in truth.iter().zip(&predicted) {
            for (a, g) in asked.iter().zip(given).skip(2) {
                assert!((a - g).abs() <= 0.002 * a, "{found:?}");
            }
        }
    }
}
