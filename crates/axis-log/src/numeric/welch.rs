//! Power spectral density by Welch's method, with the median over segments.

/// A one-sided density, unit² per 1/sample, at the frequencies k / (2 (length − 1)) per
/// sample.
pub(crate) struct Density(pub Vec<f64>);

/// Samples of a segment: of short sequences the greatest power of two that fits four times.
const LONGEST: usize = 1024;
const SHORTEST: usize = 64;
/// The median of a density's estimate over its mean: ln 2, as a bin of one segment is
/// distributed exponentially.
const MEDIAN: f64 = std::f64::consts::LN_2;

/// Half-overlapping Hann segments without their straight line (P. Welch, IEEE Trans. Audio
/// Electroacoust. 15 (1967) 70–73, doi:10.1109/TAU.1967.1161901); the median over the
/// segments, over ln 2, so that motion in a few of them does not count. Segments in which
/// nothing changes are left out. `None` of fewer than three others.
pub(crate) fn density(samples: &[f64]) -> Option<Density> {
    let fits = (samples.len() / 4).max(1);
    let length = (1 << fits.ilog2()).clamp(SHORTEST, LONGEST);
    let bins = length / 2 + 1;
    let window: Vec<f64> = (0..length)
        .map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * k as f64 / length as f64).cos())
        .collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let fft = axis_fourier::forward(length);
    let mut out = fft.make_output_vec();
    let moving = |s: &&[f64]| s.windows(2).any(|w| w[0] != w[1]);
    let starts = (0..samples.len().saturating_sub(length - 1)).step_by(length / 2);
    let starts: Vec<usize> = starts
        .filter(|&s| moving(&&samples[s..s + length]))
        .collect();
    // So many segments tell a median; more only cost memory.
    let every = starts.len().div_ceil(MOST_SEGMENTS).max(1);
    let mut spectra: Vec<Vec<f64>> = vec![Vec::new(); bins];
    for &start in starts.iter().step_by(every) {
        let mut part = level(&samples[start..start + length]);
        part.iter_mut().zip(&window).for_each(|(v, w)| *v *= w);
        // Fails only on wrong lengths.
        let _ = fft.process(&mut part, &mut out);
        for (all, bin) in spectra.iter_mut().zip(&out) {
            all.push(2.0 * bin.norm_sqr() / power);
        }
    }
    if spectra[0].len() < 3 {
        return None;
    }
    let bins = spectra
        .iter_mut()
        .map(|all| super::order::median(all) / MEDIAN);
    Some(Density(bins.collect()))
}

const MOST_SEGMENTS: usize = 512;

/// A segment without the straight line through its halves' means.
fn level(samples: &[f64]) -> Vec<f64> {
    let n = samples.len();
    let mean = |s: &[f64]| s.iter().sum::<f64>() / s.len() as f64;
    let (a, b) = (mean(&samples[..n / 2]), mean(&samples[n / 2..]));
    let slope = (b - a) / (n as f64 / 2.0);
    let at = |k: usize| 0.5 * (a + b) + slope * (k as f64 - (n as f64 - 1.0) / 2.0);
    samples.iter().enumerate().map(|(k, v)| v - at(k)).collect()
}
