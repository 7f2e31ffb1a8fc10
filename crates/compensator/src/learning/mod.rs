//! Iterative learning: the same move again, led by what it was off by before.
//!
//! ```text
//! δ ← Gauss(σ) * (δ + e)       e = S_ref − S of the move that was made with δ
//! ```
//!
//! δ is where the load is to be led besides, relative to the set point ([`Target::shift`]);
//! the plan takes it in with its speed and acceleration, friction staying that of the
//! reference. The Gaussian lets through what the plan's own smoothing passes: with a
//! narrower one the loop gain of learning exceeds 1 near the resonance, and δ diverges
//! (D. A. Bristow, M. Tharayil, A. G. Alleyne, A survey of iterative learning control,
//! IEEE Control Systems 26(3), 2006, doi:10.1109/MCS.2006.1636313).
//!
//! A move has been learned when what is left of e behind the Gaussian is noise, as most of
//! a move shows it.
//!
//! [`Target::shift`]: crate::Target::shift

mod gauss;

use alloc::vec::Vec;

use axis_scalar::Scalar;

use crate::error::{self, require, within};
use crate::{CompensatorError, Reference};
pub use gauss::Gauss;

/// How a move is learned.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LearningSettings {
    /// Deviation σ of the Gaussian, s.
    pub smoothing: f64,
    /// Rounds after which learning ends: later ones learn noise.
    pub most_rounds: u32,
    /// Greatest |δ|, m or rad.
    pub limit: f64,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            smoothing: 3e-3,
            most_rounds: 6,
            limit: 1e-3,
        }
    }
}

/// What a round of learning came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Round {
    /// Rounds so far, this one included.
    pub rounds: u32,
    /// Greatest |e| of the move, m or rad.
    pub peak: f64,
    /// What can be learned of it: RMS behind the Gaussian over the worst while of the move,
    /// five of its deviations long.
    pub learnable: f64,
    /// What noise leaves there: by the median of e behind the Gaussian.
    pub floor: f64,
    /// What to do now.
    pub advice: Advice,
}

/// What to do after a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Advice {
    /// Make the move again: more can be learned.
    Again,
    /// What is left is noise.
    Done,
    /// Enough rounds, or the last one hardly helped: more would learn noise.
    Enough,
    /// The move has become worse than without δ: something has changed. δ is dropped, and the
    /// next move is the first again.
    Restarted,
}

/// The correction of one move, learned from its repetitions. The sampling instants are
/// those of the controller, from the start of the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LearnedMove {
    period: f64,
    settings: LearningSettings,
    shift: Vec<f64>,
    rounds: u32,
    /// Learnable part of the first move and of the best one so far.
    first: f64,
    best: f64,
}

/// Median of the magnitude of a normal variable of deviation 1.
const NORMAL_MEDIAN: f64 = 0.6745;
/// Width of the second Gaussian, in widths of the first: the noise is estimated from their difference.
const WIDER: f64 = 3.0;
/// What G − G·H has of the deviation that G has of white noise, H of three times G's width:
/// √(1 − 2√2/√(1 + 1 + 9) + √2/√(2 + 18)), from ∫ of products of Gaussians.
const FAST: f64 = 0.6808;
/// Length of the window in which a move is judged, in deviations of the Gaussian.
const WHILE: f64 = 5.0;
/// Multiple of the noise that noise itself reaches in the worst window of a move.
const STANDS_OUT: f64 = 2.0;

impl LearnedMove {
    /// Nothing learned yet, of a move sampled every `period` seconds.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] names what is out of range.
    pub fn new(period: f64, settings: &LearningSettings) -> Result<Self, CompensatorError> {
        error::period(period)?;
        let inside = within(settings.smoothing / period, 1.0, 1e5);
        let valid = "from 1 to 1e5 control periods";
        require(inside, "smoothing", settings.smoothing, valid)?;
        require(settings.limit > 0.0, "limit", settings.limit, "above 0")?;
        Ok(Self {
            period,
            settings: *settings,
            shift: Vec::new(),
            rounds: 0,
            first: f64::INFINITY,
            best: f64::INFINITY,
        })
    }

    /// A correction as it was stored: δ at each sampling instant, and the rounds in which
    /// it was learned with the learnable parts of the first and the best of them.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] if a value is not finite or beyond the limit.
    pub fn stored(
        period: f64,
        settings: &LearningSettings,
        shift: Vec<f64>,
        rounds: u32,
        [first, best]: [f64; 2],
    ) -> Result<Self, CompensatorError> {
        let mut learned = Self::new(period, settings)?;
        let most = shift.iter().fold(0.0_f64, |most, d| match d.is_nan() {
            true => f64::INFINITY,
            false => most.max(d.abs()),
        });
        require(most <= settings.limit, "shift", most, "within its limit")?;
        require(first >= 0.0 && best >= 0.0, "best", best, "at least 0")?;
        learned.shift = shift;
        learned.rounds = rounds;
        learned.first = first;
        learned.best = best;
        Ok(learned)
    }

    /// Learns from the errors e of the move, m or rad, one a control cycle; none if a
    /// sample is missing: there the errors beside it count. Before the first sample and
    /// after the last nothing is learned.
    ///
    /// Where the move is off by more than noise for a while, the error is learned; elsewhere
    /// not.
    pub fn learn(&mut self, errors: &[Option<f64>]) -> Round {
        let gauss = Gauss::new(self.settings.smoothing / self.period);
        let filled = fill(errors);
        let smooth = gauss.pass(&filled);
        let power = power(&smooth, WHILE * self.settings.smoothing / self.period);
        let learnable = Scalar::sqrt(power.iter().fold(0.0_f64, |most, p| most.max(*p)));
        let floor = self.floor(&smooth);
        let peak = filled.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        let stands_out = self.rounds > 0 && learnable > 3.0 * floor;
        if stands_out && learnable > self.first {
            return self.dropped(peak, learnable, floor);
        }
        // Better than without δ, but not what it was: there is more to learn again. What this
        // move is off by was left by δ, which stays.
        if stands_out && learnable > 2.0 * self.best {
            self.rounds = 1;
            self.best = learnable;
        }
        let advice = match () {
            () if learnable <= STANDS_OUT * floor => Advice::Done,
            // It gets hardly better: what is left varies faster than the Gaussian passes.
            () if self.rounds > 1 && learnable > 0.8 * self.best => Advice::Enough,
            () if self.rounds >= self.settings.most_rounds => Advice::Enough,
            () => Advice::Again,
        };
        if self.rounds == 0 {
            self.first = learnable;
            self.best = learnable;
        }
        self.best = self.best.min(learnable);
        if advice == Advice::Again {
            self.shift.resize(filled.len().max(self.shift.len()), 0.0);
            // 1 − 2 floor²/power of the error at an instant is no noise.
            let share = |power: &f64| match *power > 0.0 {
                true => (1.0 - 2.0 * floor * floor / power).max(0.0),
                false => 0.0,
            };
            let learned = filled.iter().zip(&power).map(|(e, power)| e * share(power));
            let mut sum = self.shift.clone();
            sum.iter_mut().zip(learned).for_each(|(d, e)| *d += e);
            let limit = self.settings.limit;
            let next = gauss.pass(&sum);
            self.shift = next.into_iter().map(|d| d.clamp(-limit, limit)).collect();
        }
        self.rounds += 1;
        Round {
            rounds: self.rounds,
            peak,
            learnable,
            floor,
            advice,
        }
    }

    /// Noise behind the Gaussian: the less of two figures, each of which an error that repeats
    /// only makes greater.
    ///
    /// - The median of what is left behind it. Most of a move from rest to rest is noise alone
    ///   there, whatever the noise's spectrum.
    /// - The same of the faster part of it, what a second Gaussian three times as wide takes
    ///   away, as the share of white noise that this is. Of a lap that is off all the way the
    ///   first is the error itself, which is slower than this.
    fn floor(&self, smooth: &[f64]) -> f64 {
        let width = WIDER * self.settings.smoothing / self.period;
        let slow = Gauss::new(width).pass(smooth);
        let fast: Vec<f64> = smooth.iter().zip(slow).map(|(a, b)| a - b).collect();
        median(smooth).min(median(&fast) / FAST) / NORMAL_MEDIAN
    }

    /// Nothing learned, of a move that became worse with δ: what it was off by is that of δ as
    /// well, and says nothing of the move without.
    fn dropped(&mut self, peak: f64, learnable: f64, floor: f64) -> Round {
        self.shift.fill(0.0);
        self.rounds = 0;
        (self.first, self.best) = (f64::INFINITY, f64::INFINITY);
        Round {
            rounds: 0,
            peak,
            learnable,
            floor,
            advice: Advice::Restarted,
        }
    }

    /// δ with its speed and acceleration at a sampling instant.
    #[must_use]
    pub fn at(&self, cycle: usize) -> Reference {
        let last = self.shift.len().saturating_sub(1);
        let value = |k: usize| self.shift.get(k.min(last)).copied().unwrap_or(0.0);
        let (before, at, after) = (
            value(cycle.saturating_sub(1)),
            value(cycle),
            value(cycle + 1),
        );
        Reference {
            position: at,
            velocity: 0.5 * (after - before) / self.period,
            acceleration: (after - 2.0 * at + before) / (self.period * self.period),
        }
    }

    /// δ at each sampling instant, m or rad.
    pub fn shift(&self) -> &[f64] {
        &self.shift
    }

    /// Rounds so far.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Learnable parts of the first and of the best move, m or rad.
    pub fn history(&self) -> [f64; 2] {
        [self.first, self.best]
    }
}

/// Missing samples from those beside them, linear between; before the first and after the
/// last nothing is known to be off.
fn fill(errors: &[Option<f64>]) -> Vec<f64> {
    let known = |e: &Option<f64>| e.filter(|e| e.is_finite());
    let mut filled: Vec<f64> = errors.iter().map(|e| known(e).unwrap_or(0.0)).collect();
    let mut last: Option<usize> = None;
    for k in 0..errors.len() {
        let Some(value) = known(&errors[k]) else {
            continue;
        };
        if let Some(last) = last {
            let (before, gap) = (filled[last], (k - last) as f64);
            for (i, at) in filled[last + 1..k].iter_mut().enumerate() {
                *at = before + (value - before) * (i + 1) as f64 / gap;
            }
        }
        last = Some(k);
    }
    filled
}

/// Mean square over a while around each instant.
fn power(smooth: &[f64], samples: f64) -> Vec<f64> {
    let squares: Vec<f64> = smooth.iter().map(|e| e * e).collect();
    Gauss::new(samples).pass(&squares)
}

/// Median of the magnitudes.
fn median(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(0.0)
}
