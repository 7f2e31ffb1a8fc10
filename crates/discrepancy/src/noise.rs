//! How much of a rest is noise.

use axis_sim::{Axis, ClosedLoop, Replay, ReplayError, Trace};
use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use crate::answer::{floor, turned};
use crate::fit::{Columns, Fit, Fitter, free_parameters};
use crate::hidden::Noise;
use crate::interval::Spread;
use crate::known::{known_deviations, tolerances};
use crate::level::{noise_at, shows_noise, upper_level};
use crate::model::{LogSet, State};
use crate::projector::Projector;
use crate::spectrum::{Amplitudes, Layout};

/// Measured minus simulated: per log, per channel.
pub type Rest = Vec<Vec<Vec<f64>>>;

/// Noise of the sensors of an axis, as the fitted logs show it; `None` where they do not.
/// `traces` are their simulations without noise.
pub(crate) fn sensor_noise(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
) -> Option<Noise> {
    let mut axis = machine.with_known(&state.shares);
    axis.effects.extend_from_slice(&state.effects);
    shows_noise(&axis, set).then(|| noise_at(&axis, set, &set.rest(traces), traces))
}

/// Noise alone in a channel.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// Root mean square.
    pub rms: f64,
    /// Independent values that its samples are worth, where what is slow is averaged:
    /// their number times the variance over the spectral density at zero frequency.
    pub independent: f64,
}

/// Parts of a log of which the sums show how noise adds up.
const BATCHES: usize = 32;

impl Floor {
    /// Of noise as it was simulated, one series a log. Sums over a part of a log have its
    /// length times the density near zero frequency as their variance (batch means).
    pub(crate) fn of(series: &[Vec<f64>]) -> Self {
        let (mut squares, mut of_sums, mut samples) = (0.0, 0.0, 0usize);
        for log in series {
            squares += log.iter().map(|v| v * v).sum::<f64>();
            let batches = log.chunks(log.len().div_ceil(BATCHES).max(1));
            of_sums += batches.map(|b| b.iter().sum::<f64>().powi(2)).sum::<f64>();
            samples += log.len();
        }
        let samples = samples.max(1) as f64;
        let worth = if of_sums > 0.0 {
            squares / of_sums
        } else {
            1.0
        };
        Self {
            rms: (squares / samples).sqrt(),
            independent: samples * worth.min(1.0),
        }
    }
}

/// Noise alone in each channel: the loop is simulated with sensors as noisy as its logs
/// show, since most of what they do lies where the loop answers. Where the logs do not show
/// them, the upper spectrum is taken for white.
pub(crate) fn floors(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    best: &Rest,
) -> Result<Vec<Floor>, ReplayError> {
    let mut axis = machine.with_known(&state.shares);
    if set.is_balanced() {
        return Ok(vec![floor(&set.balances())]);
    }
    if !shows_noise(&axis, set) {
        let samples: usize = set.logs.iter().map(|l| l.log.len()).sum();
        let white = |c: usize| Floor {
            rms: upper_level(set, best, c),
            independent: samples as f64,
        };
        return Ok((0..set.channels.len()).map(white).collect());
    }
    axis.effects.extend_from_slice(&state.effects);
    let closed_loop = ClosedLoop::new(&axis)?.without_noise();
    let replays: Vec<&Replay> = set.replays();
    let quiet = |replay: &&Replay| replay.follow(&closed_loop, |_| ());
    let quiet: Vec<Trace> = (replays.par_iter().map(quiet)).collect::<Result<_, _>>()?;
    let noise = noise_at(&axis, set, best, &quiet);
    let mut alone: Vec<Vec<Vec<f64>>> = vec![Vec::new(); set.channels.len()];
    for (seed, (replay, without)) in replays.iter().zip(&quiet).enumerate() {
        let with = replay.follow(&closed_loop, noise.sensors(seed as u64))?;
        for (series, name) in alone.iter_mut().zip(&set.channels) {
            let pair = with.channel(name).zip(without.channel(name));
            let Some((a, b)) = pair else { continue };
            series.push(a.iter().zip(b).map(|(a, b)| a - b).collect());
        }
    }
    Ok(alone.iter().map(|series| Floor::of(series)).collect())
}

/// A band of frequencies in which a rest is not noise.
#[derive(Clone, Debug)]
pub struct Excess {
    /// Edges of all bands, Hz, and power in the direction between the channels
    /// that is the furthest above the noise, as a multiple of it.
    pub bands: Vec<([f64; 2], f64)>,
    /// The worst of them.
    pub worst: usize,
    /// Fall of D, were it given a spectrum of its own.
    pub fall: f64,
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

/// Times the divergence of any noise run from the others, below which a rest may
/// be one more of them. On a move there and back friction sticks or not, and of 96
/// runs three quarters had less than 0.1 in the first band, one in five 0.3 to 2, one
/// 3.4. Were that distributed exponentially, one rest of noise in 560 were beyond
/// twice the greatest of 32.
const SPREAD: f64 = 2.0;

/// Compares the spectrum of a ball-screw loop's rest with that of noise alone,
/// simulated with sensors as noisy as the logs show.
///
/// With λ the eigenvalues of the one relative to the other, the divergence of a
/// band per bin is Σ (λ − 1 − ln λ) over those above 1, that of Kullback and
/// Leibler between two Gaussian rests but for what is quieter than foreseen. What it
/// is between a run with noise and others says how much of it means nothing.
/// `None` where no band stands out.
///
/// # Errors
/// [`ReplayError`] where the machine does not run with noise.
pub(crate) fn excess(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
) -> Result<Option<Excess>, ReplayError> {
    let Some(noise) = sensor_noise(machine, set, state, traces) else {
        return Ok(None);
    };
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
        excess = beside(&seen, &runs, layout);
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
) -> Option<Excess> {
    let mean_but = |band: usize, but: Option<usize>| {
        let kept = runs.iter().enumerate().filter(|(k, _)| Some(*k) != but);
        let kept: Vec<&DMatrix<Complex<f64>>> = kept.map(|(_, r)| &r[band]).collect();
        let share = Complex::new(1.0 / kept.len() as f64, 0.0);
        let zeros = DMatrix::zeros(seen[band].nrows(), seen[band].ncols());
        kept.into_iter().fold(zeros, |sum, r| sum + r * share)
    };
    let mut bands = Vec::new();
    let mut worst = (1.0, None);
    for (i, (edges, values)) in layout.bands().enumerate() {
        let ratios = relative_to(&seen[i], mean_but(i, None));
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
        if own / allowed > worst.0 {
            worst = (own / allowed, Some((i, 2.0 * values * own)));
        }
        bands.push((edges, most));
    }
    worst.1.map(|(worst, fall)| Excess { bands, worst, fall })
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

/// What sensors with this noise do to the logs of a set, as amplitudes; `quiet`
/// are their simulations without noise.
pub(crate) fn noise_on(
    machine: &Axis,
    state: &State,
    set: &LogSet,
    quiet: &[Trace],
    noise: Noise,
    seed: u64,
) -> Result<Amplitudes, ReplayError> {
    let mut axis = machine.with_known(&state.shares);
    axis.effects.extend_from_slice(&state.effects);
    let closed_loop = ClosedLoop::new(&axis)?.without_noise();
    let run = |(log_seed, replay): (usize, &Replay)| {
        let sensors = noise.sensors(1000 * seed + log_seed as u64 + 1);
        replay.follow(&closed_loop, sensors)
    };
    let noisy = set.replays().into_iter().enumerate().map(run);
    let noisy: Vec<Trace> = noisy.collect::<Result<_, ReplayError>>()?;
    Ok(set.difference(&noisy, quiet, 1.0))
}

/// Noise runs in which parameters' spread is seen.
const DRAWN: u64 = 16;

/// Times that the rest of a torque balance is drawn anew: there they cost nothing.
const TURNED: u64 = 64;

/// The 97.5 % point of Student's t with that many degrees of freedom, over that of
/// the normal distribution.
const OF_DRAWN: f64 = 2.120 / 1.960;

/// Runs with simulated noise alone, of sensors as noisy as the logs show; of a torque balance,
/// what it leaves, drawn anew. None of a rigid machine, whose sensors are not in its logs.
///
/// # Errors
/// [`ReplayError`] where the machine does not run with noise.
pub(crate) fn drawn(fitter: &Fitter<'_>, fit: &Fit) -> Result<Vec<Amplitudes>, ReplayError> {
    let (machine, set) = (fitter.machine, fitter.set);
    if set.is_balanced() {
        let rest = set.rest(&fit.traces);
        let run = |seed| set.amplitudes(&turned(&rest, seed));
        return Ok((0..TURNED).into_par_iter().map(run).collect());
    }
    let Some(noise) = sensor_noise(machine, set, &fit.state, &fit.traces) else {
        return Ok(Vec::new());
    };
    let run = |seed| noise_on(machine, &fit.state, set, &fit.traces, noise, 100 + seed);
    (0..DRAWN).into_par_iter().map(run).collect()
}

/// How far parameters, of which the `columns` are the derivatives, may be from the
/// truth: by the fit's answer to runs with noise, and by the known ones' tolerance.
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
    let deviations = known_deviations(fitter.machine);
    let most = tolerances(fitter.machine);
    let one = |i: usize| {
        // An estimate leans on the prior's mean by so much of a known parameter.
        let leans = (0..fit.state.shares.len()).map(|j| covariance[(i, j)] / deviations[j].powi(2));
        let leans: Vec<f64> = leans.collect();
        let squares = answers.iter().map(|a| a[i] * a[i]).sum::<f64>();
        let of_known: f64 = {
            let pairs = leans.iter().zip(&deviations);
            pairs.map(|(l, deviation)| (l * deviation).powi(2)).sum()
        };
        let of_noise = match answers.len() {
            0 => (covariance[(i, i)] - of_known).max(0.0).sqrt(),
            n => OF_DRAWN * (squares / n as f64).sqrt(),
        };
        Spread {
            of_noise,
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
    seen.norm_squared() / (squares / runs.len() as f64).sqrt()
}
