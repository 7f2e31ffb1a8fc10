//! Moves one after the other under a strategy, which learns between them.

use std::sync::Arc;

use axis_sim::{ClosedLoop, LoopState, Measured, Outcome, Start};
use compensator::{Compensator, Correction, HomedAt, LearnedMove, Sample};

use crate::heat::HeatAhead;
use crate::strategies::{Continued, LearnedValues, NextMove, SharedMotion, Strategy};
use crate::{Figures, PipelineError};

/// Positions nearer than this count as one, m or rad: the same place in two programs.
const SAME_PLACE: f64 = 1e-9;

/// A motion with a name.
#[derive(Clone)]
pub struct NamedMotion {
    /// As it was asked for: a trajectory's number or a program's file.
    pub name: String,
    /// The motion.
    pub motion: SharedMotion,
    /// What was learned from its repetitions before, where something was.
    pub learned: Option<Arc<LearnedMove>>,
}

/// How a move went.
#[derive(Clone, Debug)]
pub struct MoveRun {
    /// Tracking error at every control cycle, m or rad.
    pub errors: Vec<f64>,
    /// Its figures, µm or µrad.
    pub figures: Figures,
    /// What the strategy knew after it.
    pub learned: LearnedValues,
}

/// An axis on which moves are made one after the other.
pub struct Moves<'a, S> {
    closed_loop: &'a ClosedLoop,
    sense: S,
    left: Option<Left>,
    heat: Option<Arc<HeatAhead>>,
    grown: Option<TableOffset<'a>>,
}

/// By how far the table is from where the controller's measuring has it, m, over the time since the move's begin (s) and
/// the position.
pub type TableOffset<'a> = Box<dyn Fn(f64, f64) -> f64 + 'a>;

/// How the last move has left the axis.
struct Left {
    state: LoopState,
    /// What was added to its command, and where it was homed.
    continued: Continued,
    /// Where its motion ended.
    end: f64,
}

impl<'a, S: FnMut(&mut Measured)> Moves<'a, S> {
    /// On the axis of a closed loop; `sense` makes of what its sensors show what the drive
    /// gets to read ([`ClosedLoop::run_sensed`]).
    pub fn new(closed_loop: &'a ClosedLoop, sense: S) -> Self {
        Self {
            closed_loop,
            sense,
            left: None,
            heat: None,
            grown: None,
        }
    }

    /// Goes on with an axis that has warmed up: its loop, by how far its table is off by growth, and what the
    /// strategy predicts of both. On another loop the axis is settled anew, relaxed and homed where it stands, as
    /// a state holds the friction that it was made with.
    pub fn warmed(
        &mut self,
        closed_loop: &'a ClosedLoop,
        grown: TableOffset<'a>,
        heat: Option<Arc<HeatAhead>>,
    ) {
        if !std::ptr::eq(self.closed_loop, closed_loop) {
            self.left = None;
        }
        self.closed_loop = closed_loop;
        self.grown = Some(grown);
        self.heat = heat;
    }

    /// Makes a move and lets the strategy learn from it. A move that begins where the last
    /// has ended goes on from the state that the axis was left in; before any other the
    /// axis is settled anew, its friction relaxed.
    ///
    /// # Errors
    /// [`PipelineError::Run`] if the move does not come to its end, and what the
    /// strategy refuses.
    pub fn make(
        &mut self,
        strategy: &mut dyn Strategy,
        planned: &NamedMotion,
    ) -> Result<MoveRun, PipelineError> {
        let (errors, samples) = self.run(strategy, planned)?;
        let learned = strategy.learn(&samples)?;
        Ok(MoveRun {
            figures: Figures::of_si(&errors)?,
            errors,
            learned,
        })
    }

    /// The same, and the strategy learns nothing from it.
    ///
    /// # Errors
    /// As [`Moves::make`].
    pub fn try_out(
        &mut self,
        strategy: &mut dyn Strategy,
        planned: &NamedMotion,
    ) -> Result<MoveRun, PipelineError> {
        let (errors, _) = self.run(strategy, planned)?;
        Ok(MoveRun {
            figures: Figures::of_si(&errors)?,
            errors,
            learned: LearnedValues::new(),
        })
    }

    /// Errors and samples of a move.
    fn run(
        &mut self,
        strategy: &mut dyn Strategy,
        planned: &NamedMotion,
    ) -> Result<(Vec<f64>, Vec<Sample>), PipelineError> {
        let begin = planned.motion.at(0.0).position;
        let left = self.left.take();
        let (mut state, continued) = match left.filter(|l| (l.end - begin).abs() < SAME_PLACE) {
            Some(left) => (left.state.at_rest(), Some(left.continued)),
            None => (self.closed_loop.start(&Start::at(begin))?, None),
        };
        strategy.warmed(self.heat.clone());
        let mut compensator = strategy.compensator(&NextMove {
            motion: planned.motion.clone(),
            continued,
            learned: planned.learned.clone(),
        })?;
        let mut recording = Recording {
            inner: &mut *compensator,
            samples: Vec::new(),
            last: Correction::default(),
        };
        let mut errors = Vec::new();
        let outcome = self.closed_loop.run_from(
            &mut state,
            &*planned.motion,
            &mut recording,
            &mut self.sense,
            |cycle| {
                let grown = self.grown.as_ref();
                let off = grown.map_or(0.0, |growth| growth(cycle.time, cycle.position));
                errors.push(cycle.error() - off);
            },
        );
        let Recording { samples, last, .. } = recording;
        if let Outcome::Completed = outcome {
            let end = planned.motion.at(f64::INFINITY).position;
            // An axis that was settled anew was homed there.
            let homed = continued.map(|before| before.homed);
            let here = samples
                .first()
                .map_or_else(HomedAt::default, |first| HomedAt {
                    position: first.reference.position,
                    effort: first.last_command,
                });
            self.left = Some(Left {
                state,
                continued: Continued {
                    own: last,
                    homed: homed.unwrap_or(here),
                },
                end,
            });
        }
        outcome.completed().map_err(|source| PipelineError::Run {
            what: format!("move {}", planned.name),
            source,
        })?;
        Ok((errors, samples))
    }
}

/// A compensator whose samples are kept: what a controller logs.
struct Recording<'a> {
    inner: &'a mut dyn Compensator,
    samples: Vec<Sample>,
    last: Correction,
}

impl Compensator for Recording<'_> {
    fn reset(&mut self) {
        self.inner.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.samples.push(*sample);
        self.last = self.inner.correct(sample);
        self.last
    }

    fn surprise(&self) -> f64 {
        self.inner.surprise()
    }
}
