//! What was learned of a move from its logs, as it is kept between repetitions.

use axis_log::Log;
use axis_sim::{Axis, position_shown};
use compensator::{CompensatorError, LearnedMove, LearningSettings, Round};
use serde::{Deserialize, Serialize};
use thiserror::Error;
use trajectories::Motion;

/// Layout of a stored correction.
const SCHEMA: u32 = 1;
/// References that differ by more than this are of two moves, m or rad: a log's rounding
/// to six digits on an axis of a metre.
const SAME_REFERENCE: f64 = 2e-6;
/// Cycles of reference that tell a move: fewer hold for any.
const LEAST: usize = 64;
/// Time over which a correction that begins or ends inside a motion comes and goes, s.
const TAPER: f64 = 0.01;

/// A learned correction of one move, on the control cycles of its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredCorrection {
    schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Hash of its parameters; they may change between repetitions.
    pub axis_fingerprint: String,
    /// Control period, s.
    pub period_s: f64,
    /// Rounds of learning so far.
    pub rounds: u32,
    /// Learnable part of the first move and of the best one, m or rad (RMS).
    history: [f64; 2],
    /// Reference at each cycle, m or rad: what other logs are aligned by.
    reference: Vec<f64>,
    /// Where the load is to be led besides, m or rad.
    shift: Vec<f64>,
}

/// Why a log cannot be learned from, or a correction not be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LearningError {
    /// A channel is missing.
    #[error("{0}")]
    Log(#[from] axis_log::LogError),
    /// Samples that are not the controller's.
    #[error("{what}; valid: {valid}")]
    Samples {
        /// What is wrong.
        what: String,
        /// What would do.
        valid: &'static str,
    },
    /// Another move.
    #[error(
        "the reference is not that of the move on which the correction was learned: however the two are aligned, they differ by at least {0:.3e} {1}; valid: a log or motion of the same move, or a new correction file"
    )]
    OtherMove(f64, &'static str),
    /// A stored correction that nothing can be made of.
    #[error("the correction is not valid: {0}")]
    Correction(#[from] CompensatorError),
    /// Of another layout or control period.
    #[error("the correction {0}; valid: a correction that this version has written for this axis")]
    Foreign(String),
}

/// A log on the control cycles.
struct Cycles {
    reference: Vec<f64>,
    errors: Vec<Option<f64>>,
}

impl Cycles {
    fn of(axis: &Axis, log: &Log) -> Result<Self, LearningError> {
        let reference = log.channel(axis.reference_channel())?;
        let position = position_shown(log, axis)?;
        let (time, period) = (log.time(), axis.period);
        let begin = time.first().copied().unwrap_or(0.0);
        let index = |t: f64| ((t - begin) / period).round();
        let last = time.last().map_or(0.0, |t| index(*t));
        if time.len() < LEAST || last.is_nan() || last >= 1e8 {
            return Err(LearningError::Samples {
                what: format!(
                    "the log has {} samples over {last} control cycles",
                    time.len()
                ),
                valid: "at least 64 samples, over at most 1e8 cycles",
            });
        }
        let mut cycles = Self {
            reference: vec![f64::NAN; last as usize + 1],
            errors: vec![None; last as usize + 1],
        };
        for ((t, r), p) in time.iter().zip(reference).zip(&*position) {
            let k = index(*t) as usize;
            cycles.reference[k] = *r;
            cycles.errors[k] = Some(r - p);
        }
        // Linear where samples are missing.
        let mut before = 0;
        for k in 1..cycles.reference.len() {
            if cycles.reference[k].is_nan() {
                continue;
            }
            let (a, b) = (cycles.reference[before], cycles.reference[k]);
            for i in before + 1..k {
                let share = (i - before) as f64 / (k - before) as f64;
                cycles.reference[i] = a + share * (b - a);
            }
            before = k;
        }
        Ok(cycles)
    }
}

impl StoredCorrection {
    /// Nothing learned yet, of the move of a log.
    ///
    /// # Errors
    /// [`LearningError`] if the log lacks a channel or is too short.
    pub fn of(axis: &Axis, log: &Log) -> Result<Self, LearningError> {
        let Cycles { reference, .. } = Cycles::of(axis, log)?;
        Ok(Self {
            schema: SCHEMA,
            axis: axis.name.clone(),
            axis_fingerprint: axis.fingerprint.clone(),
            period_s: axis.period,
            rounds: 0,
            history: [f64::MAX; 2],
            shift: vec![0.0; reference.len()],
            reference,
        })
    }

    /// Learns from the log of a repetition that was made with this correction. It may start
    /// late, end early or lack samples.
    ///
    /// # Errors
    /// [`LearningError::OtherMove`] if its reference is another; [`LearningError`]
    /// if it lacks a channel or is too short.
    pub fn learn(&mut self, axis: &Axis, log: &Log) -> Result<Round, LearningError> {
        self.check(axis)?;
        let cycles = Cycles::of(axis, log)?;
        let offset = align(axis, &cycles.reference, &self.reference)?;
        let mut errors = vec![None; self.reference.len()];
        for (k, error) in cycles.errors.iter().enumerate() {
            let at = usize::try_from(k as i64 + offset).ok();
            if let Some(slot) = at.and_then(|at| errors.get_mut(at)) {
                *slot = *error;
            }
        }
        let mut learned = self.learned()?;
        let round = learned.learn(&errors);
        self.shift = learned.shift().to_vec();
        self.rounds = learned.rounds();
        // JSON has no infinity.
        self.history = learned.history().map(|part| part.min(f64::MAX));
        self.axis_fingerprint.clone_from(&axis.fingerprint);
        Ok(round)
    }

    /// The correction on the cycles of a motion; before and after the part that was
    /// learned it fades out.
    ///
    /// # Errors
    /// [`LearningError::OtherMove`] if the motion is another.
    pub fn on(&self, axis: &Axis, motion: &dyn Motion) -> Result<LearnedMove, LearningError> {
        self.check(axis)?;
        let period = self.period_s;
        let count = (motion.duration() / period).ceil() as usize + 1;
        let reference: Vec<f64> = (0..count)
            .map(|k| motion.at(k as f64 * period).position)
            .collect();
        let offset = align(axis, &reference, &self.reference)?;
        let (length, taper) = (self.shift.len() as i64, (TAPER / period).ceil());
        let whole = offset == 0;
        let shift = (0..count as i64).map(|k| {
            let at = k + offset;
            let Some(d) = usize::try_from(at).ok().and_then(|at| self.shift.get(at)) else {
                return 0.0;
            };
            let from_end = at.min(length - 1 - at) as f64;
            let share = if whole {
                1.0
            } else {
                (from_end / taper).min(1.0)
            };
            d * (0.5 * std::f64::consts::PI * share).sin().powi(2)
        });
        let settings = LearningSettings::default();
        let shift = shift.collect();
        Ok(LearnedMove::stored(
            period,
            &settings,
            shift,
            self.rounds,
            self.history,
        )?)
    }

    fn check(&self, axis: &Axis) -> Result<(), LearningError> {
        if self.schema != SCHEMA {
            let found = format!("has schema {}, this program reads {SCHEMA}", self.schema);
            return Err(LearningError::Foreign(found));
        }
        if (self.period_s - axis.period).abs() > 1e-9 * axis.period {
            let found = format!(
                "was learned at a control period of {} s, that of the axis is {} s",
                self.period_s, axis.period
            );
            return Err(LearningError::Foreign(found));
        }
        if self.shift.len() != self.reference.len() || self.reference.len() < LEAST {
            return Err(LearningError::Foreign("is not whole".to_owned()));
        }
        Ok(())
    }

    fn learned(&self) -> Result<LearnedMove, CompensatorError> {
        let settings = LearningSettings::default();
        if self.rounds == 0 {
            return LearnedMove::new(self.period_s, &settings);
        }
        let shift = self.shift.clone();
        LearnedMove::stored(self.period_s, &settings, shift, self.rounds, self.history)
    }
}

/// Cycles by which `new` begins after `known`, found where both references are the same.
fn align(axis: &Axis, new: &[f64], known: &[f64]) -> Result<i64, LearningError> {
    // A sample in the fastest part of the one is where the other passes the same place.
    let steps = new.windows(2).map(|w| (w[1] - w[0]).abs());
    let (fast, step) = steps.enumerate().fold(
        (0, 0.0),
        |best, (i, s)| if s > best.1 { (i, s) } else { best },
    );
    if new.len() < LEAST || step == 0.0 {
        return Err(LearningError::Samples {
            what: "the reference does not move".to_owned(),
            valid: "a log or motion of at least 64 control cycles in which it does",
        });
    }
    let place = new[fast];
    let near = |k: &usize| (known[*k] - place).abs() <= step;
    // Where nothing was off, the log began with the motion.
    let candidates = std::iter::once(fast).chain((0..known.len()).filter(near));
    let mut best = (f64::INFINITY, 0);
    let mut tried = i64::MIN;
    for at in candidates {
        let offset = at as i64 - fast as i64;
        if offset == tried {
            continue;
        }
        tried = offset;
        let off = difference(new, known, offset);
        if off < best.0 {
            best = (off, offset);
        }
    }
    match best {
        (off, offset) if off <= SAME_REFERENCE => Ok(offset),
        (off, _) => Err(LearningError::OtherMove(off, axis.freedom().unit())),
    }
}

/// Greatest difference of two references where both are, the first moved by `offset`.
fn difference(new: &[f64], known: &[f64], offset: i64) -> f64 {
    let mut most = 0.0_f64;
    let mut count = 0;
    for (k, r) in new.iter().enumerate().step_by(8) {
        let at = usize::try_from(k as i64 + offset).ok();
        if let Some(known) = at.and_then(|at| known.get(at)) {
            most = most.max((r - known).abs());
            count += 1;
        }
    }
    if 8 * count < LEAST {
        f64::INFINITY
    } else {
        most
    }
}
