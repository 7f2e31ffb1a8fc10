//! A residual's spectrum beside that of noise alone.

use axis_sim::{Axis, ReplayError, Trace};
use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use super::{LogNoise, SlowNoise, noise_on};
use crate::answers::{LogSet, State};
use crate::spectrum::Layout;

/// A band of frequencies in which a residual is not noise.
#[derive(Clone, Debug)]
pub struct Excess {
    /// Edges of all bands, Hz, and power in the direction between the channels
    /// that is the furthest above the noise, as a multiple of it.
    pub bands: Vec<([f64; 2], f64)>,
    /// Those that stand out, the worst first, and the fall of D, were the residual there given a
    /// spectrum of its own.
    pub out: Vec<(usize, f64)>,
}

impl Excess {
    /// The same of the bands that stand out with these edges (Hz); none if none is left.
    pub(crate) fn only(&self, mut keep: impl FnMut([f64; 2]) -> bool) -> Option<Self> {
        let mut only = self.clone();
        only.out.retain(|(band, _)| keep(self.bands[*band].0));
        (!only.out.is_empty()).then_some(only)
    }

    /// What must be known of it where it does not follow the motion.
    pub(crate) fn note(&self) -> String {
        let ([low, high], times) = self.bands[self.out[0].0];
        format!(
            "from {low:.0} to {high:.0} Hz the residual has up to {times:.1} times the power of the noise that the sensors show at high frequency, and does not follow the motion; it is taken for noise"
        )
    }
}

/// Noise runs of which the spectrum is the mean: a few, and more where a band stands
/// out beside these.
const RUNS: [u64; 2] = [4, 32];

/// Divergence of a bin above which a band is not noise. In seven simulated cases
/// in which all was named it reached 0.2 above the first band, as the sensors'
/// levels are known to a tenth; a body of 14 kg that swung at 40 Hz, beside a
/// named mass, had 0.7.
const UNLIKE: f64 = 0.5;

/// In the first band the spectrum of noise is steep, and not one number.
const UNLIKE_FIRST: f64 = 2.0;

/// Times the divergence of any noise run from the others, below which a residual may
/// be one more of them. On a move there and back friction sticks or not, and of 96
/// runs three quarters had less than 0.1 in the first band, one in five 0.3 to 2, one
/// 3.4. Were that distributed exponentially, one rest of noise in 560 were beyond
/// twice the greatest of 32.
const SPREAD: f64 = 2.0;

/// Compares the spectrum of a loop's rest with that of noise alone, simulated with sensors as noisy
/// as the logs show (`noise`), and slow noise of the logger.
///
/// With λ the eigenvalues of the one relative to the other, the divergence of a
/// band per bin is Σ (λ − 1 − ln λ) over those above 1, that of Kullback and
/// Leibler between two Gaussian residuals but for what is quieter than predicted. What it
/// is between a run with noise and others says how much of it means nothing.
/// `None` if no band stands out.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
pub(crate) fn excess(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
    noise: &LogNoise,
    slow: &SlowNoise,
) -> Result<Option<Excess>, ReplayError> {
    let layout = &set.layout;
    let seen = layout.spectral_matrices(&set.amplitudes(&set.rest(traces)));
    let run = |run: u64| -> Result<Vec<DMatrix<Complex<f64>>>, ReplayError> {
        let amplitudes = noise_on(machine, state, set, traces, noise, run + 1)?;
        Ok(layout.spectral_matrices(&amplitudes))
    };
    let mut runs = Vec::new();
    let mut excess = None;
    for count in RUNS {
        let more = (runs.len() as u64..count).into_par_iter().map(run);
        runs.extend(more.collect::<Result<Vec<_>, ReplayError>>()?);
        excess = beside(&seen, &runs, layout, slow);
        if excess.is_none() {
            break;
        }
    }
    Ok(excess)
}

/// The bands of what is seen beside those of noise runs, where one stands out.
fn beside(
    seen: &[DMatrix<Complex<f64>>],
    runs: &[Vec<DMatrix<Complex<f64>>>],
    layout: &Layout,
    slow: &SlowNoise,
) -> Option<Excess> {
    let mean_but = |band: usize, but: Option<usize>| {
        let kept = runs.iter().enumerate().filter(|(k, _)| Some(*k) != but);
        let kept: Vec<&DMatrix<Complex<f64>>> = kept.map(|(_, r)| &r[band]).collect();
        let share = Complex::new(1.0 / kept.len() as f64, 0.0);
        let zeros = DMatrix::zeros(seen[band].nrows(), seen[band].ncols());
        kept.into_iter().fold(zeros, |sum, r| sum + r * share)
    };
    let mut bands = Vec::new();
    let mut out = Vec::new();
    for (i, (edges, values)) in layout.bands().enumerate() {
        let ratios = relative_to(&seen[i], slow.beside(i, mean_but(i, None)));
        let own = divergence(&ratios);
        let most = ratios.iter().copied().fold(0.0, f64::max);
        let of_noise = runs.iter().enumerate();
        let of_noise =
            of_noise.map(|(k, run)| divergence(&relative_to(&run[i], mean_but(i, Some(k)))));
        let of_noise = of_noise.fold(0.0, f64::max);
        let allowed = if i == 0 { UNLIKE_FIRST } else { UNLIKE };
        let allowed = f64::max(allowed, SPREAD * of_noise);
        tracing::debug!(
            ?edges,
            divergence = own,
            of_noise,
            most,
            "rest beside noise"
        );
        if own > allowed {
            out.push((own / allowed, (i, 2.0 * values * own)));
        }
        bands.push((edges, most));
    }
    out.sort_by(|a, b| b.0.total_cmp(&a.0));
    let out: Vec<(usize, f64)> = out.into_iter().map(|(_, band)| band).collect();
    (!out.is_empty()).then_some(Excess { bands, out })
}

/// Σ (λ − 1 − ln λ) over those above 1.
fn divergence(ratios: &[f64]) -> f64 {
    let above = ratios.iter().filter(|r| **r > 1.0);
    above.map(|r| r - 1.0 - r.ln()).sum()
}

/// Eigenvalues of one spectral matrix relative to another.
fn relative_to(seen: &DMatrix<Complex<f64>>, noise: DMatrix<Complex<f64>>) -> Vec<f64> {
    let factor = noise.cholesky().map(|c| c.l());
    let left = |l: &DMatrix<Complex<f64>>, m: &DMatrix<Complex<f64>>| l.solve_lower_triangular(m);
    let whitened = factor.and_then(|l| left(&l, &left(&l, seen)?.adjoint()));
    whitened.map_or_else(Vec::new, |w| {
        let hermitian = (&w + w.adjoint()) / Complex::new(2.0, 0.0);
        hermitian.symmetric_eigenvalues().iter().copied().collect()
    })
}
