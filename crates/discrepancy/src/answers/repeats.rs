//! With what period a drive moves its axis to and fro in a log, and what repeats with it.
//!
//! A load that repeats with the machine's cycle is told from what the motion itself does by the
//! moments at which it acts. Where the motion repeats as well, what repeats with it may be any law over speed,
//! position or acceleration, and says nothing of time. So what acts in time is looked at beside
//! everything that repeats with the drive: of series x at the instants t of a log with the drive's period T
//!
//! ```text
//! x − P x,   P x the nearest function of t mod T, but for its mean
//! ```
//!
//! The function is piecewise linear; P x is found by least squares, so that instants may have gaps. A constant
//! has no period and stays.

/// Power of a speed's change over one period, beside that over shorter times, below which it repeats: YIN's
/// threshold (de Cheveigné, Kawahara, J. Acoust. Soc. Am. 111 (2002) 1917, doi:10.1121/1.1458024).
const APERIODIC: f64 = 0.1;

/// Periods that a log must hold.
const PERIODS: usize = 2;

/// Slots of time in which a period is looked for.
const SLOTS: usize = 4000;

/// Knots of a function over a period at most.
const KNOTS: usize = 1000;

/// Steps, to either side, in which a period is made finer.
const FINER: i32 = 40;

/// The period of a log's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// s.
    period: f64,
    knots: usize,
}

impl Repeats {
    /// Of a motion with this speed at these times (s), which lie `step` apart or have gaps; `None` where it
    /// does not repeat twice, or goes one way for the most: then the drive does not move it to and fro, and
    /// what repeats in its speed may be a load.
    pub fn of(times: &[f64], speed: &[f64], step: f64) -> Option<Self> {
        let [first, .., last] = times else {
            return None;
        };
        let width = step.max((last - first) / SLOTS as f64);
        let slots = slots(times, speed, width);
        let lag = lag(&slots)?;
        // The same many periods later tells it as much finer.
        let most = slots.len() - slots.len() / (2 * PERIODS);
        let many = (most / lag).max(1);
        let power = |at: usize| change(&slots, at).unwrap_or(f64::INFINITY);
        let near = (many * lag).saturating_sub(lag / 4)..=(many * lag + lag / 4).min(most);
        let best = near.min_by(|a, b| power(*a).total_cmp(&power(*b)))?;
        let coarse = best as f64 * width / many as f64;
        let tried = |k: i32| coarse + width / many as f64 * f64::from(k) / f64::from(FINER);
        let left = |period: &f64| {
            let mut left = speed.to_vec();
            Self::with(*period, step).take_out(times, &mut left);
            about_mean(&left)
        };
        let mut all = (-FINER..=FINER).map(|k| (tried(k), left(&tried(k))));
        let (period, least) = all.by_ref().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let own = about_mean(speed);
        let whole: f64 = speed.iter().map(|v| v * v).sum();
        let moves = own - least >= APERIODIC * whole;
        (own > 0.0 && least <= APERIODIC * own && moves).then(|| Self::with(period, step))
    }

    fn with(period: f64, step: f64) -> Self {
        let knots = (period / step).round() as usize;
        Self {
            period,
            knots: knots.clamp(4, KNOTS),
        }
    }

    /// Period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Takes what repeats with it out of a series, but for its mean.
    pub fn take_out(&self, times: &[f64], series: &mut [f64]) {
        let n = self.knots;
        let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
        let hats = |t: &f64| {
            let along = (t / self.period).rem_euclid(1.0) * n as f64;
            let at = along as usize % n;
            (at, (at + 1) % n, along - along.floor())
        };
        // Normal equations of the values at the knots: each has neighbours alone, the last one the first.
        let (mut own, mut next, mut right) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for (t, value) in times.iter().zip(series.iter()) {
            let (a, b, share) = hats(t);
            own[a] += (1.0 - share).powi(2);
            own[b] += share * share;
            next[a] += share * (1.0 - share);
            right[a] += (1.0 - share) * (value - mean);
            right[b] += share * (value - mean);
        }
        let most = own.iter().fold(0.0_f64, |most, d| most.max(*d));
        own.iter_mut()
            .for_each(|d| *d += 1e-9 * most + f64::MIN_POSITIVE);
        let values = cyclic(&own, &next, &right);
        let repeats = |t: &f64| {
            let (a, b, share) = hats(t);
            (1.0 - share) * values[a] + share * values[b]
        };
        let of_mean = times.iter().map(repeats).sum::<f64>() / times.len().max(1) as f64;
        for (t, value) in times.iter().zip(series) {
            *value -= repeats(t) - of_mean;
        }
    }
}

/// Means of a series in slots of this width; `None` of those without samples.
fn slots(times: &[f64], series: &[f64], width: f64) -> Vec<Option<f64>> {
    let first = times.first().copied().unwrap_or(0.0);
    let at = |t: &f64| ((t - first) / width).round() as usize;
    let mut sums = vec![(0.0, 0usize); times.last().map_or(0, at) + 1];
    for (t, value) in times.iter().zip(series) {
        let slot = &mut sums[at(t)];
        *slot = (slot.0 + value, slot.1 + 1);
    }
    let mean = |(sum, count): (f64, usize)| (count > 0).then(|| sum / count as f64);
    sums.into_iter().map(mean).collect()
}

/// Mean square of the change over so many slots; `None` where hardly any pair of slots shows it.
fn change(slots: &[Option<f64>], lag: usize) -> Option<f64> {
    let later = slots.get(lag..)?;
    let pairs = slots.iter().zip(later);
    let squares = pairs.filter_map(|(a, b)| Some(((*b)? - (*a)?).powi(2)));
    let (sum, count) = squares.fold((0.0, 0usize), |(sum, n), s| (sum + s, n + 1));
    (4 * count >= later.len() && count > 0).then(|| sum / count as f64)
}

/// The first lag, in slots, after which a series is as before.
fn lag(slots: &[Option<f64>]) -> Option<usize> {
    let most = slots.len() / PERIODS;
    let mut sum = 0.0;
    let normalised = (1..=most).map(|lag| {
        let own = change(slots, lag);
        sum += own.unwrap_or(0.0);
        own.map_or(1.0, |own| {
            own * lag as f64 / f64::max(sum, f64::MIN_POSITIVE)
        })
    });
    let all: Vec<f64> = normalised.collect();
    let first = all.iter().position(|d| *d < APERIODIC)?;
    let falls = all[first..].windows(2).take_while(|pair| pair[1] < pair[0]);
    Some(first + falls.count() + 1)
}

/// Sum of squares about the mean.
fn about_mean(series: &[f64]) -> f64 {
    let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
    series.iter().map(|v| (v - mean).powi(2)).sum()
}

/// Solves symmetric equations of which each has its neighbours, `next` the one after it, and the last one the
/// first: a tridiagonal matrix and one of rank one (Sherman, Morrison).
fn cyclic(own: &[f64], next: &[f64], right: &[f64]) -> Vec<f64> {
    let last = own.len() - 1;
    let (corner, pivot) = (next[last], -own[0]);
    let mut main = own.to_vec();
    main[0] -= pivot;
    main[last] -= corner * corner / pivot;
    let mut beside = vec![0.0; own.len()];
    (beside[0], beside[last]) = (pivot, corner);
    let mut solution = tridiagonal(&main, next, right);
    let other = tridiagonal(&main, next, &beside);
    let of = |x: &[f64]| x[0] + corner / pivot * x[last];
    let by = of(&solution) / (1.0 + of(&other));
    solution
        .iter_mut()
        .zip(other)
        .for_each(|(x, z)| *x -= by * z);
    solution
}

/// Gauss' elimination of a positive definite tridiagonal matrix.
fn tridiagonal(main: &[f64], next: &[f64], right: &[f64]) -> Vec<f64> {
    let n = main.len();
    let (mut pivots, mut x) = (main.to_vec(), right.to_vec());
    for i in 1..n {
        let by = next[i - 1] / pivots[i - 1];
        pivots[i] -= by * next[i - 1];
        x[i] -= by * x[i - 1];
    }
    x[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        x[i] = (x[i] - next[i] * x[i + 1]) / pivots[i];
    }
    x
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Repeats, about_mean};

    const STEP: f64 = 2e-3;

    fn series(law: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..6000).map(|k| STEP * f64::from(k)).collect();
        let values = times.iter().map(|t| law(*t)).collect();
        (times, values)
    }

    /// A triangle of 0.7313 s, which is no whole number of samples.
    fn to_and_fro(t: f64) -> f64 {
        (TAU * t / 0.7313).sin() + 0.11 * (3.0 * TAU * t / 0.7313 + 1.0).sin()
    }

    #[test]
    fn the_period_of_a_motion_is_found_and_what_repeats_with_it_goes() {
        let (times, speed) = series(to_and_fro);
        let repeats = Repeats::of(&times, &speed, STEP).unwrap();
        assert!(
            (repeats.period() / 0.7313 - 1.0).abs() < 1e-4,
            "{repeats:?}"
        );
        let (_, mut law) = series(|t| 3.0 + 2.0 * to_and_fro(t - 0.1).powi(3));
        let before = about_mean(&law);
        repeats.take_out(&times, &mut law);
        assert!(about_mean(&law) < 1e-4 * before);
        let mean = law.iter().sum::<f64>() / law.len() as f64;
        assert!((mean - 3.0).abs() < 0.05, "{mean}");
        // What has a period of its own stays, but for what a log of 16 periods cannot tell.
        let (_, mut load) = series(|t| (TAU * t / 0.41).sin());
        let before = about_mean(&load);
        repeats.take_out(&times, &mut load);
        assert!(about_mean(&load) > 0.85 * before);
    }

    #[test]
    fn gaps_do_not_hide_a_period() {
        let (times, speed) = series(to_and_fro);
        let kept = |k: &usize| k % 700 < 450;
        let times: Vec<f64> = (0..6000).filter(kept).map(|k| times[k]).collect();
        let speed: Vec<f64> = (0..6000).filter(kept).map(|k| speed[k]).collect();
        let repeats = Repeats::of(&times, &speed, STEP).unwrap();
        assert!(
            (repeats.period() / 0.7313 - 1.0).abs() < 1e-3,
            "{repeats:?}"
        );
    }

    /// A sweep, a single way there and back, and a load that shakes an axis on its way.
    #[test]
    fn what_does_not_repeat_or_goes_one_way_has_no_period() {
        let sweep = |t: f64| (TAU * (0.3 + 0.4 * t) * t).sin();
        let once = |t: f64| (TAU * t / 12.0).sin();
        let shaken = |t: f64| 1.0 + 0.2 * (TAU * t / 0.5).sin();
        for law in [sweep, once, shaken] {
            let (times, speed) = series(law);
            assert_eq!(Repeats::of(&times, &speed, STEP), None);
        }
        assert_eq!(Repeats::of(&[], &[], STEP), None);
        assert_eq!(Repeats::of(&[0.0, 1.0], &[1.0, 1.0], 1.0), None);
    }
}
