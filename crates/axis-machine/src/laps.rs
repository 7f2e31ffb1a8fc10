//! Laps along one path, the strategies of all drives kept from lap to lap.

use std::sync::Arc;

use axis_pipeline::strategies::{Continued, LearnedValues, NextMove, SharedMotion, Strategy};
use axis_sim::Measured;
use compensator::HomedAt;
use toolpath::FeedProfile;
use trajectories::Motion;

use crate::coupling::Coupling;
use crate::error::MachineError;
use crate::machine::CoupledMachine;
use crate::motion::AxisMotion;
use crate::run::{DriveLaw, Lap, MachineState};

/// What the sensors of a drive make of what they see.
pub type DriveSensors<'a> = Box<dyn FnMut(&mut Measured) + 'a>;

/// A machine on which laps are run one after the other.
///
/// A lap that begins where the one before has ended goes on from the state that the machine was left in; before any other
/// the machine is settled anew. Paths of later laps lie where the first one's coordinates put them.
pub struct Laps<'a, const D: usize> {
    machine: &'a CoupledMachine<D>,
    strategies: Vec<Box<dyn Strategy + 'a>>,
    sensors: Vec<DriveSensors<'a>>,
    correction: Option<Arc<Coupling>>,
    /// Where the first path begins, m.
    origin: Option<[f64; D]>,
    left: Option<Left>,
}

struct Left {
    state: MachineState,
    continued: Vec<Continued>,
    /// Where each drive's motion has ended, m.
    ends: Vec<f64>,
}

/// A lap, and what the strategies have learned from it.
#[derive(Clone, Debug)]
pub struct LearnedLap<const D: usize> {
    /// The lap.
    pub lap: Lap<D>,
    /// Of each drive.
    pub learned: Vec<LearnedValues>,
}

/// Positions nearer than this count as one, m.
const SAME_PLACE: f64 = 1e-9;

impl<'a, const D: usize> Laps<'a, D> {
    /// With one strategy for each drive, and the sensors of the axis files.
    ///
    /// # Errors
    /// [`MachineError::Laws`] if there is not one for each.
    pub fn new(
        machine: &'a CoupledMachine<D>,
        strategies: Vec<Box<dyn Strategy + 'a>>,
    ) -> Result<Self, MachineError> {
        let drives = machine.drives().len();
        if strategies.len() != drives {
            return Err(MachineError::Laws {
                laws: strategies.len(),
                drives,
            });
        }
        let own = |_| -> DriveSensors<'a> { Box::new(|_: &mut Measured| ()) };
        Ok(Self {
            machine,
            strategies,
            sensors: (0..drives).map(own).collect(),
            correction: None,
            origin: None,
            left: None,
        })
    }

    /// With sensors that show something else besides, one for each drive; those that are missing are the axis' own.
    #[must_use]
    pub fn sensing(mut self, sensors: Vec<DriveSensors<'a>>) -> Self {
        for (own, other) in self.sensors.iter_mut().zip(sensors) {
            *own = other;
        }
        self
    }

    /// With references that take away what this coupling does to the tool ([`AxisMotion::correcting`]).
    #[must_use]
    pub fn correcting(self, coupling: Coupling) -> Self {
        Self {
            correction: Some(Arc::new(coupling)),
            ..self
        }
    }

    /// Runs a lap and lets the strategies learn from it.
    ///
    /// # Errors
    /// [`MachineError`] of the run, and what a strategy refuses.
    pub fn lap(&mut self, profile: &Arc<FeedProfile<D>>) -> Result<LearnedLap<D>, MachineError> {
        let begin = profile.path().at(0.0).position;
        let origin = *self.origin.get_or_insert(begin);
        let motions = self
            .machine
            .motions(profile, &origin, self.correction.as_ref());
        let axis = |d: usize| self.machine.drives()[d].axis + 1;
        let place = |motion: &Arc<AxisMotion<D>>, t| motion.at(t).position;
        let goes_on = |left: &Left| {
            let begins = motions.iter().map(|motion| place(motion, 0.0));
            begins
                .zip(&left.ends)
                .all(|(begin, end)| (begin - end).abs() < SAME_PLACE)
        };
        let left = self.left.take().filter(goes_on);
        let (mut state, before) = match left {
            Some(left) => (left.state.at_rest(), Some(left.continued)),
            None => (self.machine.start(&motions)?, None),
        };
        let mut laws = Vec::new();
        for (d, strategy) in self.strategies.iter_mut().enumerate() {
            let next = NextMove {
                motion: motions[d].clone() as SharedMotion,
                continued: before.as_ref().map(|all| all[d]),
                learned: None,
            };
            let law = strategy.compensator(&next);
            laws.push(law.map_err(|source| MachineError::Strategy {
                axis: axis(d),
                source,
            })?);
        }
        let both = laws.iter_mut().zip(&mut self.sensors);
        let mut driven: Vec<DriveLaw<'_>> = both
            .map(|(law, sense)| DriveLaw {
                compensator: &mut **law,
                sense: &mut **sense,
            })
            .collect();
        let lap = self.machine.run(&motions, &mut driven, &mut state)?;
        let homed = |d: usize, here: HomedAt| before.as_ref().map_or(here, |all| all[d].homed);
        self.left = Some(Left {
            state,
            continued: (lap.left.iter().enumerate())
                .map(|(d, &(own, here))| Continued {
                    own,
                    homed: homed(d, here),
                })
                .collect(),
            ends: motions.iter().map(|m| place(m, f64::INFINITY)).collect(),
        });
        let mut learned = Vec::new();
        for (d, strategy) in self.strategies.iter_mut().enumerate() {
            let values = strategy.learn(&lap.records[d]);
            learned.push(values.map_err(|source| MachineError::Strategy {
                axis: axis(d),
                source,
            })?);
        }
        Ok(LearnedLap { lap, learned })
    }
}
