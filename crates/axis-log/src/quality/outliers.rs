//! Isolated outliers.

use crate::numeric::holes::{bridge, runs};
use crate::numeric::order::{SIGMA_OF_MAD, median};

/// Half the window of the running median, samples.
const HALF: usize = 5;
/// Most samples in a row: what a mechanism does takes longer.
const MOST: usize = 2;
/// Half the window in which the usual distance is taken once more.
const AROUND: usize = 25;
/// Distance from the median, in standard deviations, from which on a sample is out.
const SIGMAS: f64 = 8.0;

/// A sample that does not belong where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlier {
    /// Its index.
    pub index: usize,
    /// Its distance from the median of the samples around, in their unit.
    pub distance: f64,
}

/// Isolated outliers: at most two samples in a row that lie off the samples before and
/// after them, to one side, by Hampel's test.
///
/// A sample is out where it lies more than 8 σ from the median of the eleven samples around
/// it, with σ the median of such distances times 1.4826 (that of Gaussian noise), both over
/// the whole and over the 51 samples around, and none of the 15 samples before and after is
/// half as far, so that what swings is kept (F. Hampel, J. Am. Stat. Assoc. 69 (1974)
/// 383–393, doi:10.1080/01621459.1974.10482962; R. Pearson, IEEE Trans. Control Syst.
/// Technol. 10 (2002) 55–63, doi:10.1109/87.974338). A step, a ramp and the end of a motion
/// stay, as a median keeps them. NaN is passed over.
pub fn outliers(samples: &[f64]) -> Vec<Outlier> {
    let mut bridged;
    let holes = runs(samples);
    let x = if holes.is_empty() {
        samples
    } else {
        bridged = samples.to_vec();
        bridge(&mut bridged, &holes);
        &bridged
    };
    if x.len() < 4 * HALF {
        return Vec::new();
    }
    let off: Vec<f64> = (0..x.len()).map(|k| off_median(x, k)).collect();
    let mut sizes: Vec<f64> = off.iter().map(|d| d.abs()).filter(|d| *d > 0.0).collect();
    let usual = SIGMAS * SIGMA_OF_MAD * median(&mut sizes);
    drop(sizes);
    if usual == 0.0 {
        return Vec::new();
    }
    let far = |k: usize| off[k].abs() > usual && off[k].abs() > around(&off, k);
    let mut found: Vec<Outlier> = Vec::new();
    let mut k = 0;
    while k < x.len() {
        let from = k;
        while k < x.len() && far(k) {
            k += 1;
        }
        let alone = (1..=MOST).contains(&(k - from)) && quiet(&off, from, k, usual);
        if alone && apart(x, from, k, usual) {
            let index = (from..k).filter(|&i| !samples[i].is_nan());
            found.extend(index.map(|index| Outlier {
                index,
                distance: off[index],
            }));
        }
        k = k.max(from + 1);
    }
    found
}

fn off_median(x: &[f64], k: usize) -> f64 {
    let from = k.saturating_sub(HALF).min(x.len() - 2 * HALF - 1);
    let mut window = [0.0; 2 * HALF + 1];
    window.copy_from_slice(&x[from..from + 2 * HALF + 1]);
    x[k] - median(&mut window)
}

/// What is far among the samples around.
fn around(off: &[f64], k: usize) -> f64 {
    let from = k.saturating_sub(AROUND);
    let to = (k + AROUND + 1).min(off.len());
    let mut sizes: Vec<f64> = off[from..to].iter().map(|d| d.abs()).collect();
    SIGMAS * SIGMA_OF_MAD * median(&mut sizes)
}

/// Whether no others around the run are half as far: what swings is no outlier.
fn quiet(off: &[f64], from: usize, to: usize, usual: f64) -> bool {
    let before = &off[from.saturating_sub(3 * HALF)..from];
    let after = &off[to..(to + 3 * HALF).min(off.len())];
    before.iter().chain(after).all(|d| 2.0 * d.abs() < usual)
}

/// Whether all samples of the run lie to one side of both its neighbours, far from them and
/// farther than these are from each other.
fn apart(x: &[f64], from: usize, to: usize, usual: f64) -> bool {
    let (Some(before), Some(&after)) = (from.checked_sub(1).map(|k| x[k]), x.get(to)) else {
        return false;
    };
    let least = usual.max(2.0 * (after - before).abs());
    let (low, high) = (before.min(after), before.max(after));
    let run = &x[from..to];
    run.iter().all(|v| *v > high + least) || run.iter().all(|v| *v < low - least)
}
