//! Steps one after another, as one motion.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::error::{check, position};
use crate::{
    Extremes, Motion, Oscillation, Real, SCurve, Setpoint, Step, TrajectoryError, maximum,
};

/// A motion made of [`Step`]s, planned once; evaluation finds the step by binary search.
///
/// ```
/// use trajectories::{Limits, Motion, Program, Sine, Step};
///
/// let limits = Limits::new(0.1, 0.225, 1.2)?;
/// let program = Program::new(
///     0.6,
///     vec![
///         Step::Move { to: 0.9, limits },
///         Step::Dwell { duration: 0.5 },
///         Step::Sine(Sine { amplitude: 1e-3, frequency: 5.0, cycles: 10 }),
///     ],
/// )?;
/// assert_eq!(program.at(program.duration()).position, 0.9);
/// assert_eq!(program.extremes().position_max, 0.901);
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Program<T = f64> {
    unit: ProgramUnit,
    start: T,
    steps: Vec<Step<T>>,
    pieces: Vec<Piece<T>>,
    /// Start of each piece, s; kept apart from the pieces so that the search touches little memory.
    times: Vec<T>,
    duration: T,
    extremes: Extremes<T>,
}

/// In which unit a program stands in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgramUnit {
    /// Of an axis that moves along a line: `to_mm`, `velocity_mm_s`, and so on.
    #[default]
    Millimetres,
    /// Of an axis that turns: `to_deg`, `velocity_deg_s`, and so on; radians stand in the place of
    /// all metres then.
    Degrees,
}

impl ProgramUnit {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Millimetres => "millimetres",
            Self::Degrees => "degrees",
        }
    }
}

/// A planned step.
#[derive(Clone, Debug, PartialEq)]
enum Piece<T> {
    // Boxed: it is far larger than the others.
    Curve(Box<SCurve<T>>),
    Rest { position: T, duration: T },
    Oscillation(Oscillation<T>),
}

impl<T: Real> Program<T> {
    /// Plans `steps` from rest at `start` (m). No steps at all is a program of no duration.
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a start beyond [`maximum::POSITION`] or more steps than
    /// [`maximum::STEPS`]; [`TrajectoryError::Step`] with the number of the step and what is wrong
    /// with it, such as a program that lasts longer than [`maximum::DURATION`] by its end.
    pub fn new(start: T, steps: Vec<Step<T>>) -> Result<Self, TrajectoryError> {
        let mut present = position("start", start)?;
        let count = steps.len() as f64;
        let few = steps.len() <= maximum::STEPS;
        check(few, "number of steps", count, "", "at most 100000")?;
        let mut pieces = Vec::with_capacity(steps.len());
        let mut times = Vec::with_capacity(steps.len());
        let mut clock = Clock::default();
        let mut extremes = Extremes::at_rest(start);
        for (i, step) in steps.iter().enumerate() {
            let piece = Piece::plan(present, step)
                .and_then(|piece| clock.advance(piece.duration()).map(|begin| (begin, piece)));
            let (begin, piece) = piece.map_err(|source| TrajectoryError::Step {
                number: i + 1,
                kind: step.kind(),
                source: Box::new(source),
            })?;
            present = piece.end();
            extremes = extremes.union(piece.extremes());
            times.push(begin);
            pieces.push(piece);
        }
        Ok(Self {
            unit: ProgramUnit::default(),
            start,
            steps,
            pieces,
            times,
            duration: clock.now(),
            extremes,
        })
    }

    /// The same steps planned in another scalar, from the nearest numbers to theirs.
    ///
    /// # Errors
    /// As [`new`](Self::new), where a number has left its range by rounding.
    pub fn cast<U: Real>(&self) -> Result<Program<U>, TrajectoryError> {
        let steps = self
            .steps
            .iter()
            .map(Step::cast)
            .collect::<Result<_, _>>()?;
        let program = Program::new(U::of(self.start.to_f64()), steps)?;
        Ok(program.with_unit(self.unit))
    }

    /// The same program, that stands in files in this unit; in millimetres where nothing is said.
    #[must_use]
    pub fn with_unit(self, unit: ProgramUnit) -> Self {
        Self { unit, ..self }
    }

    /// In which unit it stands, or stood, in a file.
    pub const fn unit(&self) -> ProgramUnit {
        self.unit
    }

    /// Position at the start, m.
    pub const fn start(&self) -> T {
        self.start
    }

    /// Position at the end, m.
    pub fn end(&self) -> T {
        self.pieces.last().map_or(self.start, Piece::end)
    }

    /// The steps, as given.
    pub fn steps(&self) -> &[Step<T>] {
        &self.steps
    }

    /// Time at which each step begins, s; as many as there are steps.
    pub fn step_times(&self) -> &[T] {
        &self.times
    }

    /// Bounds on position, velocity, acceleration and jerk: exact for moves and dwells, safe for
    /// sines and chirps.
    pub const fn extremes(&self) -> Extremes<T> {
        self.extremes
    }
}

impl<T: Real> Motion<T> for Program<T> {
    #[inline]
    fn duration(&self) -> T {
        self.duration
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        if t >= self.duration {
            return Setpoint::at_rest(self.end());
        }
        // Steps that have begun; of steps of no length the last counts.
        let begun = self.times.partition_point(|&begin| begin <= t);
        let Some(i) = begun.checked_sub(1) else {
            return Setpoint::at_rest(self.start);
        };
        self.pieces[i].at(t - self.times[i])
    }
}

impl<T: Real> Piece<T> {
    /// Plans one step from rest at `present`.
    fn plan(present: T, step: &Step<T>) -> Result<Self, TrajectoryError> {
        Ok(match step {
            Step::Move { to, limits } => Self::Curve(Box::new(SCurve::plan(present, *to, limits)?)),
            Step::MoveBy { by, limits } => {
                position("by", *by)?;
                let to = position("end of the step", present + *by)?;
                Self::Curve(Box::new(SCurve::plan(present, to, limits)?))
            }
            Step::Dwell { duration } => {
                let inside = (T::ZERO..=T::of(maximum::DURATION)).contains(duration);
                check(inside, "duration", *duration, "s", "from 0 to 1e7")?;
                Self::Rest {
                    position: present,
                    duration: *duration,
                }
            }
            Step::Sine(sine) => Self::Oscillation(Oscillation::sine(present, sine)?),
            Step::Chirp(chirp) => Self::Oscillation(Oscillation::chirp(present, chirp)?),
        })
    }

    fn duration(&self) -> T {
        match self {
            Self::Curve(curve) => curve.duration(),
            Self::Rest { duration, .. } => *duration,
            Self::Oscillation(oscillation) => oscillation.duration(),
        }
    }

    #[inline]
    fn at(&self, t: T) -> Setpoint<T> {
        match self {
            Self::Curve(curve) => curve.at(t),
            Self::Rest { position, .. } => Setpoint::at_rest(*position),
            Self::Oscillation(oscillation) => oscillation.at(t),
        }
    }

    fn end(&self) -> T {
        match self {
            Self::Curve(curve) => curve.to(),
            Self::Rest { position, .. } => *position,
            Self::Oscillation(oscillation) => oscillation.about(),
        }
    }

    fn extremes(&self) -> Extremes<T> {
        match self {
            Self::Curve(curve) => curve.extremes(),
            Self::Rest { position, .. } => Extremes::at_rest(*position),
            Self::Oscillation(oscillation) => oscillation.extremes(),
        }
    }
}

/// Sum of durations by Neumaier's compensated summation: after ten thousand steps the time is
/// still right to rounding.
#[derive(Default)]
struct Clock<T> {
    sum: T,
    lost: T,
}

impl<T: Real> Clock<T> {
    fn now(&self) -> T {
        self.sum + self.lost
    }

    /// Adds a duration (≥ 0) and returns the time before it.
    fn advance(&mut self, duration: T) -> Result<T, TrajectoryError> {
        let begin = self.now();
        let sum = self.sum + duration;
        let (large, small) = if self.sum >= duration {
            (self.sum, duration)
        } else {
            (duration, self.sum)
        };
        self.lost += (large - sum) + small;
        self.sum = sum;
        let short = self.now() <= T::of(maximum::DURATION);
        let valid = "at most 1e7";
        check(short, "time at the end of the step", self.now(), "s", valid)?;
        Ok(begin)
    }
}
