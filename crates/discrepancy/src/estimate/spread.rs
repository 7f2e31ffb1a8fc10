//! How far noise moves an estimate.

use axis_sim::ReplayError;
use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::interval::Spread;
use crate::estimate::known::{known_deviations, tolerances};
use crate::estimate::projector::Projector;
use crate::noise::{log_noise, noise_on, turned};
use crate::spectrum::Amplitudes;

/// Noise runs in which parameters' spread is seen.
const DRAWN: u64 = 16;

/// Times that the rest of a torque balance is drawn anew: there they cost nothing.
const TURNED: u64 = 64;

/// The 97.5 % point of Student's t with that many degrees of freedom, over that of
/// the normal distribution.
const OF_DRAWN: f64 = 2.120 / 1.960;

/// Share of what a channel shows of the dynamics in a band by which a simulation may be off
/// there. Between this program and a second one (`tests/independent`) it is 1e-6 to 1.2e-4
/// in currents and voltages where a chirp excites them, and a test holds it below this.
const INEXACT: f64 = 1.5e-4;

/// By how much simulations may be off, with one phase all over a log, so that it does not
/// average out: in each channel and band by a share of what is there, in phase with it and a
/// quarter turn from it.
fn inexact(fitter: &Fitter<'_>) -> Vec<Amplitudes> {
    let set = fitter.set;
    let whole = set.amplitudes(&set.dynamics(fitter.machine));
    let (channels, bands) = (set.layout.channels(), set.layout.counts().len());
    let part = |band: usize, channel: usize, phase: Complex<f64>| {
        let mut part = whole.clone();
        set.layout.keep(&mut part, band, channel);
        let all = part.iter_mut().flatten();
        all.for_each(|a| *a *= INEXACT * phase);
        part
    };
    let phases = [Complex::new(1.0, 0.0), Complex::new(0.0, 1.0)];
    let all = (0..bands).flat_map(|b| (0..channels).map(move |c| (b, c)));
    all.flat_map(|(b, c)| phases.map(|by| part(b, c, by)))
        .collect()
}

/// Runs with simulated noise alone, as noisy as the logs show; of a torque balance,
/// what it leaves, drawn anew. None of a rigid machine, whose sensors are not in its logs.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
pub(crate) fn drawn(fitter: &Fitter<'_>, fit: &Fit) -> Result<Vec<Amplitudes>, ReplayError> {
    let (machine, set) = (fitter.machine, fitter.set);
    if set.is_balanced() {
        let rest = set.rest(&fit.traces);
        let run = |seed| set.amplitudes(&turned(&rest, seed));
        return Ok((0..TURNED).into_par_iter().map(run).collect());
    }
    let Some(noise) = log_noise(machine, set, &fit.state, &fit.traces) else {
        return Ok(Vec::new());
    };
    let run = |seed| noise_on(machine, &fit.state, set, &fit.traces, &noise, 100 + seed);
    (0..DRAWN).into_par_iter().map(run).collect()
}

/// How far parameters, of which the `columns` are the derivatives, may be from the
/// truth: by the fit's answer to runs with noise, by the known ones' tolerance, and by what
/// simulations may be off.
///
/// Below 25 Hz the spectrum of noise is steep, sensors shake dry friction loose,
/// and noise at a standstill is another than in motion: with one spectral matrix a
/// band, the inverse of the normal matrix gave deviations of a steady load, a gap and
/// dry friction that were 2 to 3.6 times too small. So what the estimate makes of
/// noise is seen in runs, mean and all (the sandwich of P. J. Huber, Proc. 5th
/// Berkeley Symp. 1 (1967) 221–233); without runs it is as the weights have it.
pub(crate) fn spreads(
    fitter: &Fitter<'_>,
    fit: &Fit,
    columns: &Columns,
    covariance: &DMatrix<f64>,
    runs: &[Amplitudes],
) -> Vec<Spread> {
    let layout = &fitter.set.layout;
    let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
    let jacobian: Vec<DVector<f64>> = columns
        .iter()
        .map(|c| layout.whiten(&whitener, c))
        .collect();
    let answer = |run: &Amplitudes| {
        let run = layout.whiten(&whitener, run);
        let along = DVector::from_iterator(jacobian.len(), jacobian.iter().map(|c| c.dot(&run)));
        covariance * along
    };
    let answers: Vec<DVector<f64>> = runs.par_iter().map(answer).collect();
    let of_simulation: Vec<DVector<f64>> = inexact(fitter).par_iter().map(answer).collect();
    let deviations = known_deviations(fitter.machine);
    let most = tolerances(fitter.machine);
    let one = |i: usize| {
        // An estimate leans on the prior's mean by so much of a known parameter.
        let leans = (0..fit.state.shares.len()).map(|j| covariance[(i, j)] / deviations[j].powi(2));
        let leans: Vec<f64> = leans.collect();
        let squares_of = |all: &[DVector<f64>]| all.iter().map(|a| a[i] * a[i]).sum::<f64>();
        let of_known: f64 = {
            let pairs = leans.iter().zip(&deviations);
            pairs.map(|(l, deviation)| (l * deviation).powi(2)).sum()
        };
        let of_noise = match answers.len() {
            0 => (covariance[(i, i)] - of_known).max(0.0).sqrt(),
            n => OF_DRAWN * (squares_of(&answers) / n as f64).sqrt(),
        };
        Spread {
            of_noise: of_noise.hypot(squares_of(&of_simulation).sqrt()),
            of_known: leans.iter().zip(&most).map(|(l, m)| l * m).collect(),
        }
    };
    (0..columns.len()).map(one).collect()
}

/// Size of an effect of a fit in deviations, of what the fit of its size alone
/// makes of runs with noise: shapes held, all else fitted out but known parameters that
/// are `pinned`.
pub(crate) fn over_noise(
    fitter: &Fitter<'_>,
    fit: &Fit,
    columns: &Columns,
    runs: &[Amplitudes],
    effect: usize,
    pinned: &[bool],
) -> f64 {
    let layout = &fitter.set.layout;
    let whitener = layout.whitener(&layout.spectral_matrices(&fit.rest));
    let white = |a: &Amplitudes| layout.whiten(&whitener, a);
    let columns: Vec<DVector<f64>> = columns.par_iter().map(white).collect();
    let runs: Vec<DVector<f64>> = runs.par_iter().map(white).collect();
    let (known, effects) = columns.split_at(fit.state.shares.len());
    let free = free_parameters(&fit.state);
    let all = || free.iter().zip(effects);
    let others = all().filter(|((e, _), _)| *e != effect).map(|(_, c)| c);
    let others: Vec<DVector<f64>> = known.iter().chain(others).cloned().collect();
    let active = &fit.state.effects[effect];
    let sizes = all().filter(|((e, p), _)| *e == effect && active.effect.parameters[*p].is_size());
    let nothing = DVector::zeros(layout.size());
    let does = sizes.fold(nothing, |sum, ((_, p), c)| sum + c * active.values[*p]);
    let projector = Projector::new(fitter.machine, &others, pinned);
    size_over_noise(&projector.reject(&does), &runs)
}

/// Size of what is seen in deviations, of what a fit of it makes of runs with noise.
pub(crate) fn size_over_noise(seen: &DVector<f64>, runs: &[DVector<f64>]) -> f64 {
    let along =
        |run: &DVector<f64>| -> f64 { seen.iter().zip(run.iter()).map(|(s, n)| s * n).sum() };
    let squares: f64 = runs.iter().map(|run| along(run).powi(2)).sum();
    match seen.norm_squared() {
        // Of nothing there is no ratio.
        0.0 => 0.0,
        size => size / (squares / runs.len() as f64).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::size_over_noise;

    #[test]
    fn what_is_not_seen_stands_out_by_nothing() {
        let of = |x: f64, y: f64| DVector::from_vec(vec![x, y]);
        let runs = [of(0.3, 0.0), of(-0.1, 2.0)];
        assert_eq!(size_over_noise(&of(0.0, 0.0), &runs), 0.0);
        // A deviation along the first of √((0.3² + 0.1²)/2).
        let along = size_over_noise(&of(2.0, 0.0), &runs);
        assert!((along - 2.0 / 0.05_f64.sqrt()).abs() < 1e-12, "{along}");
    }
}
