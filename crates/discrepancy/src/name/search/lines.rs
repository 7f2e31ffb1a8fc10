//! Frequencies at which the rest stands out.

use nalgebra::{Complex, DMatrix};

use super::state::Search;
use crate::answers::Prepared;

/// Lines that are tried.
const LINES: usize = 3;

/// A frequency, Hz, and how far it stands out there.
pub(super) type Line = (f64, f64);

/// Spectral matrix between channels, of a band.
pub(super) type Spectral = DMatrix<Complex<f64>>;

impl Search<'_> {
    /// Power of the rest in each bin beside that of these matrices in its band, over all channels.
    pub(super) fn lines_of_replays(&self, matrices: &[Spectral]) -> Vec<Line> {
        let layout = &self.fit_logs.layout;
        let bands: Vec<[f64; 2]> = layout.bands().map(|(edges, _)| edges).collect();
        let of_bin = |(frequency, bin): (f64, &[Complex<f64>])| {
            let band = bands.iter().position(|[_, high]| frequency < *high)?;
            let power = |c: usize| matrices[band][(c, c)].re.max(f64::MIN_POSITIVE);
            let all = bin.iter().enumerate();
            let stands_out: f64 = all.map(|(c, value)| value.norm_sqr() / power(c)).sum();
            Some((frequency, stands_out))
        };
        layout.bins(&self.fit.rest).filter_map(of_bin).collect()
    }
}

/// Adds lines of the same frequencies, or of the same orders, to those of other series.
pub(super) fn add(lines: &mut Vec<Line>, more: impl Iterator<Item = Line>) {
    match lines.is_empty() {
        true => lines.extend(more),
        false => (lines.iter_mut().zip(more)).for_each(|(all, one)| all.1 += one.1),
    }
}

/// From the first sample to the last, s.
pub(super) fn duration(log: &Prepared) -> f64 {
    match log.log.time() {
        [first, .., last] => last - first,
        _ => 0.0,
    }
}

/// The best few lines from the `slowest` frequency on, none nearer to a better one than that asks.
pub(super) fn strongest(
    mut lines: Vec<Line>,
    slowest: f64,
    apart: impl Fn(f64) -> f64,
) -> Vec<Line> {
    lines.retain(|(frequency, _)| *frequency >= slowest);
    lines.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut best: Vec<Line> = Vec::new();
    for line in lines {
        if best.iter().all(|b| (b.0 - line.0).abs() > apart(b.0)) {
            best.push(line);
        }
        if best.len() == LINES {
            break;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::strongest;

    #[test]
    fn lines_are_the_strongest_that_are_fast_enough_and_apart() {
        let lines = [
            (0.1, 9.0),
            (1.0, 5.0),
            (1.05, 4.0),
            (2.0, 1.0),
            (3.0, 2.0),
            (4.0, 0.5),
        ];
        let best = strongest(lines.to_vec(), 0.2, |_| 0.1);
        assert_eq!(best, [(1.0, 5.0), (3.0, 2.0), (2.0, 1.0)]);
    }
}
