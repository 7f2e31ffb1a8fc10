//! Stretches of a log at constant speed.

use std::ops::Range;

use axis_sim::Axis;
use axis_sim::balance::ObservedMotion;
use lugre::identify::ConstantSpeedRun;

use super::found::SpeedRun;

/// Lengths over which speeds are compared, s: the longest first, over which a vibration
/// averages out; the shortest for fast runs on short strokes.
const WINDOWS: [f64; 3] = [0.4, 0.2, 0.1];

/// Fewest samples of a window, and of a stretch.
const FEWEST_IN_WINDOW: usize = 16;
const FEWEST: usize = 64;

/// Shortest stretch, s. A vibration shows in the autocovariance of the speed at lags above 32 ms, of
/// which a quarter of a record is looked at: shorter pieces of a run that vibrates would pass for quiet.
const SHORTEST: f64 = 0.25;

/// Largest change of the mean speed from one window to the next, as a share. The speed's curve is
/// straight over so little: at most exp(−1/2) √2 · 1 % of T_S − T_C lie between its ends.
const EVEN: f64 = 0.02;

/// Deviations of noise that are taken for noise.
const SURE: f64 = 5.0;

/// Share by which an axis file's inertia may be off. What it takes of a torque at a speed
/// that is nearly constant is corrected, and so much of the correction goes to the standard error.
const INERTIA_OFF: f64 = 0.1;

/// Most of the friction that inertia may take in a stretch of constant speed, so that its part
/// of the error stays below half a percent.
const MOST_INERTIA: f64 = 0.05;

/// Blocks into which a stretch is cut to see where its torque has settled.
const BLOCKS: usize = 40;

/// Steps in which a motion is followed back to where it turned, s; and the share of its way by which it
/// must come back to have turned, and not to have vibrated.
const STEP_BACK: f64 = 5e-3;
const TURNED: f64 = 0.1;

/// A log, ready to be cut into stretches. Positions and forces are the load's.
pub(super) struct Record<'a> {
    pub axis: &'a Axis,
    /// Index of the log.
    pub log: usize,
    /// Time of the first sample, s.
    pub start: f64,
    pub shown: ObservedMotion,
    pub position: Vec<f64>,
    pub speed: Vec<f64>,
    /// Motor's force less the axis' own loads; inertia is still in it.
    pub force: Vec<f64>,
    /// Samples that no stretch may hold.
    pub taken: Vec<bool>,
}

impl<'a> Record<'a> {
    pub fn of(axis: &'a Axis, log: usize, start: f64, shown: ObservedMotion) -> Self {
        let position = shown.positions();
        let r = axis.travel_per_radian();
        let pairs = shown.torque().iter().zip(&position);
        let force = pairs.map(|(torque, &x)| torque / r - axis.load_at(x));
        let mut taken = vec![false; position.len()];
        for hole in shown.holes() {
            let end = hole.end.min(taken.len());
            taken[hole.start.min(end)..end].fill(true);
        }
        Self {
            force: force.collect(),
            speed: shown.speeds(),
            position,
            taken,
            axis,
            log,
            start,
            shown,
        }
    }

    /// Mean speed from a sample to another.
    pub fn mean_speed(&self, from: usize, to: usize) -> f64 {
        (self.position[to] - self.position[from]) / ((to - from) as f64 * self.shown.period())
    }

    /// Inertia of all that moves, at the load.
    pub fn inertia(&self) -> f64 {
        let r = self.axis.travel_per_radian();
        self.axis.mechanism.total_inertia() / (r * r)
    }

    /// Acceleration over a stretch, by the mean speeds of its first and last third.
    pub fn acceleration(&self, samples: &Range<usize>) -> f64 {
        let (from, to) = (samples.start, samples.end - 1);
        let third = ((to - from) / 3).max(1);
        let change = self.mean_speed(to - third, to) - self.mean_speed(from, from + third);
        change / ((to - from - third).max(1) as f64 * self.shown.period())
    }

    /// Whether a speed is told from rest over `time` seconds, and is not below what the axis
    /// file asks for.
    pub fn moves(&self, speed: f64, time: f64) -> bool {
        let slowest = self.axis.balance.slowest.unwrap_or(0.0);
        speed.abs() > (SURE * self.shown.speed_uncertainty(time)).max(slowest)
    }

    /// Way of the load from where it last turned to a sample.
    fn way_before(&self, sample: usize) -> f64 {
        let step = ((STEP_BACK / self.shown.period()).round() as usize).max(1);
        let here = self.position[sample];
        let noise = SURE * self.shown.speed_uncertainty(1.0);
        let mut farthest = here;
        for k in (0..sample).rev().step_by(step) {
            let x = self.position[k];
            let way = (farthest - here).abs();
            // On the other side of the turn it comes nearer again.
            if (x - here).abs() < way - noise.max(TURNED * way) {
                break;
            }
            if (x - here).abs() > way {
                farthest = x;
            }
        }
        (farthest - here).abs()
    }

    pub fn time(&self, samples: &Range<usize>) -> [f64; 2] {
        let at = |k: usize| self.start + k as f64 * self.shown.period();
        [at(samples.start), at(samples.end.saturating_sub(1))]
    }
}

/// The constant-speed runs of a record; their samples are taken afterwards.
pub(super) fn runs(record: &mut Record<'_>) -> Vec<SpeedRun> {
    let mut found = Vec::new();
    for window in WINDOWS {
        let samples = (window / record.shown.period()).round() as usize;
        if samples < FEWEST_IN_WINDOW {
            break;
        }
        for stretch in stretches(record, samples) {
            let run = run(record, &stretch);
            record.taken[stretch].fill(true);
            found.extend(run);
        }
    }
    found.sort_by(|a, b| a.time[0].total_cmp(&b.time[0]));
    found
}

/// Stretches in which the mean speed of each window is that of the next, their ends trimmed by half a
/// window, into which a ramp may still reach.
fn stretches(record: &Record<'_>, window: usize) -> Vec<Range<usize>> {
    let n = record.position.len();
    let step = (window / 8).max(1);
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut open: Option<Range<usize>> = None;
    let last = n.saturating_sub(2 * window + 1);
    for k in (0..last).step_by(step) {
        if is_even(record, k, window) {
            let end = k + 2 * window;
            let begun = open.take().map_or(k, |stretch| stretch.start);
            open = Some(begun..end);
        } else {
            found.extend(open.take());
        }
    }
    found.extend(open.take());
    let trimmed = found.into_iter().map(|stretch| {
        let half = window / 2;
        stretch.start + half..stretch.end - half
    });
    trimmed.flat_map(|s| split(record, s, window)).collect()
}

/// Whether two neighbouring windows have one speed, are free and move.
fn is_even(record: &Record<'_>, k: usize, window: usize) -> bool {
    let time = window as f64 * record.shown.period();
    let [first, second] = [0, window].map(|at| record.mean_speed(k + at, k + at + window));
    let noise = SURE * record.shown.speed_uncertainty(time);
    let mean = 0.5 * (first + second);
    (second - first).abs() <= EVEN * mean.abs() + noise
        && record.moves(mean, time)
        && first * second > 0.0
        && record.taken[k..k + 2 * window].iter().all(|taken| !taken)
}

/// A stretch cut into halves until its ends have one speed.
fn split(record: &Record<'_>, stretch: Range<usize>, window: usize) -> Vec<Range<usize>> {
    let length = stretch.end.saturating_sub(stretch.start);
    if length < FEWEST.max(window) {
        return Vec::new();
    }
    let (from, to) = (stretch.start, stretch.end - 1);
    let part = window.min(length / 2);
    let ends = [(from, from + part), (to - part, to)];
    let [first, last] = ends.map(|(a, b)| record.mean_speed(a, b));
    let time = part as f64 * record.shown.period();
    let noise = SURE * record.shown.speed_uncertainty(time);
    if (last - first).abs() <= 2.0 * EVEN * (0.5 * (first + last)).abs() + noise {
        return vec![stretch];
    }
    let middle = stretch.start + length / 2;
    [stretch.start..middle, middle..stretch.end]
        .into_iter()
        .flat_map(|half| split(record, half, window))
        .collect()
}

/// A stretch as a run: where its torque has settled, over whole turns of the motor, less what
/// inertia takes. `None` if inertia takes too much, or the torque goes on changing.
fn run(record: &Record<'_>, stretch: &Range<usize>) -> Option<SpeedRun> {
    let settled = whole_turns(record, settled(record, stretch));
    if settled.len() < FEWEST || (settled.len() as f64) * record.shown.period() < SHORTEST {
        return None;
    }
    let lever = record.axis.friction.lever(record.axis.travel_per_radian());
    let inertia = record.inertia() * record.acceleration(&settled);
    let friction: Vec<f64> = record.force[settled.clone()]
        .iter()
        .map(|force| lever * (force - inertia))
        .collect();
    let speeds: Vec<f64> = record.speed[settled.clone()]
        .iter()
        .map(|speed| speed / lever)
        .collect();
    let rate = 1.0 / record.shown.period();
    let mut run = ConstantSpeedRun::from_record(&speeds, &friction, rate).ok()?;
    let taken = lever * inertia;
    if taken.abs() > MOST_INERTIA * run.torque.abs() || drifts(&friction, &run) {
        return None;
    }
    run.torque_standard_error = run
        .torque_standard_error
        .map(|error| error.hypot(INERTIA_OFF * taken));
    Some(SpeedRun {
        log: record.log,
        time: record.time(&settled),
        run,
        steady: true,
        distance: record.way_before(settled.start) / lever,
        left_out: None,
    })
}

/// The part of a stretch in which its torque has settled: what is left after the start whose
/// removal makes the mean's standard error least (K. P. White, Simulation 69 (1997) 323–334,
/// doi:10.1177/003754979706900601), and once more as much cut; half of the stretch at least.
fn settled(record: &Record<'_>, stretch: &Range<usize>) -> Range<usize> {
    let block = (stretch.len() / BLOCKS).max(1);
    let means: Vec<f64> = record.force[stretch.clone()]
        .chunks_exact(block)
        .map(|part| part.iter().sum::<f64>() / block as f64)
        .collect();
    let error = |cut: usize| {
        let rest = &means[cut..];
        let count = rest.len() as f64;
        let mean = rest.iter().sum::<f64>() / count;
        rest.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (count * count)
    };
    // Twice as much again: what decays is then below the noise by as much as it was at first above.
    let most = means.len() / 2;
    let best = (0..=most / 2).min_by(|&a, &b| error(a).total_cmp(&error(b)));
    stretch.start + 2 * best.unwrap_or(0) * block..stretch.end
}

/// The end of a stretch that is a whole number of the motor's turns, over which what repeats
/// with them averages out; all of it where it is less than one.
fn whole_turns(record: &Record<'_>, stretch: Range<usize>) -> Range<usize> {
    let turn = std::f64::consts::TAU * record.axis.travel_per_radian();
    let last = record.position[stretch.end - 1];
    let way = |k: usize| (last - record.position[k]).abs();
    let turns = (way(stretch.start) / turn).floor();
    if turns < 1.0 {
        return stretch;
    }
    let end = stretch.end;
    let begin = stretch.rev().find(|&k| way(k) >= turns * turn);
    begin.unwrap_or(end - 1)..end
}

/// Whether friction differs between the halves of a run by more than their noise, and by more
/// than a fiftieth: of bristles that still bend, or a machine that warms up.
fn drifts(friction: &[f64], run: &ConstantSpeedRun) -> bool {
    let (a, b) = friction.split_at(friction.len() / 2);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len().max(1) as f64;
    let change = (mean(a) - mean(b)).abs();
    // Each half has √2 times the error of the whole, and their difference twice that.
    let noise = 2.0 * run.torque_standard_error.unwrap_or(0.0);
    change > SURE * noise && change > EVEN * run.torque.abs()
}
