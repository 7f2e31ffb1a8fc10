//! An axis: everything that the simulation of a machine needs, checked.

use std::path::PathBuf;

use axis_log::Mapping;
use feed_dynamics::{DriveError, FeedDrive, NutCoupling};
use foc_pmsm::{Pmsm, Servo};
use lugre::LuGre;
use trajectories::{Limits, SCurve, TrajectoryError};

use crate::effects::{self, ActiveEffect, Hooks, MachineMut};

/// Tracking error at which a run is given up where the axis file does not say, m.
pub const FOLLOWING_ERROR_LIMIT: f64 = 0.02;

/// A ball-screw axis with its motor, drive controller and friction. SI units.
///
/// Made from an axis file by [`Axis::read`]. Immutable while it is simulated;
/// a variant is a clone with other fields.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Short name, also of the folder of its results.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// Mechanics.
    pub drive: FeedDrive,
    /// Friction between table and guides, on the equivalent screw speed
    /// `table speed / r` (rad/s), as torque at the screw (N·m): the force on
    /// the table is that torque divided by r.
    pub friction: LuGre,
    /// Motor.
    pub motor: Pmsm,
    /// Torque constant K_t at i_d = 0, N·m/A.
    pub torque_constant: f64,
    /// Position, speed and current controllers.
    pub servo: Servo,
    /// Share of the reference velocity that is added to the position
    /// controller's output; 1 is all of it.
    pub velocity_feedforward: f64,
    /// Control period, s.
    pub period: f64,
    /// Tracking error at which a run is given up, m.
    pub following_error_limit: f64,
    /// How the nut meets the screw's mesh.
    pub coupling: NutCoupling,
    /// Settings of the simulation.
    pub simulation: Simulation,
    /// Where the table may be.
    pub stroke: Stroke,
    /// Ranges of the one-cycle samples.
    pub samples: SampleRanges,
    /// The motions on which the axis is judged, in their order from 1.
    pub trajectories: Vec<MoveSpec>,
    /// What its results are compared with, if anything.
    pub experiment: Option<Experiment>,
    /// Effects beyond the model above: the file's `[[effects]]`.
    pub effects: Vec<ActiveEffect>,
    /// How far a known parameter may be off, as a share of its value.
    pub tolerance: f64,
    /// How the columns of logs of this axis are called.
    pub log: Mapping,
    /// Hash of every value in SI units: the same for files that differ only
    /// in comments, units or order.
    pub fingerprint: String,
}

/// Settings of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Simulation {
    /// Longest internal step of the plant, s; the control period is divided
    /// into the fewest equal steps that are no longer.
    pub step: f64,
}

/// Table positions, m from the driven end of the screw.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Least position.
    pub minimum: f64,
    /// Greatest position.
    pub maximum: f64,
    /// Where motions start.
    pub start: f64,
}

/// A closed interval, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub least: f64,
    /// Upper end.
    pub most: f64,
}

/// The design space of the one-cycle samples: Table 5 of the paper.
#[derive(Clone, Copy, Debug)]
pub struct SampleRanges {
    /// S(k), m from the driven end.
    pub position: Range,
    /// Ṡ(k), m/s.
    pub speed: Range,
    /// S̈(k), m/s².
    pub acceleration: Range,
    /// I_qr(k), A.
    pub current: Range,
}

/// One rest-to-rest move.
#[derive(Clone, Copy, Debug)]
pub struct MoveSpec {
    /// From the stroke's start, m.
    pub displacement: f64,
    /// Greatest speed, acceleration and jerk.
    pub limits: Limits,
}

/// What results are compared with.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Axis file of what stands for the measured machine.
    pub machine: PathBuf,
    /// Folder with the paper's tables.
    pub paper_tables: Option<PathBuf>,
}

impl Axis {
    /// The axis with its effects' changes made, and their hooks.
    ///
    /// # Errors
    /// [`DriveError`] where an effect carries a parameter out of its range.
    pub(crate) fn with_effects(&self) -> Result<(Self, Hooks), DriveError> {
        let mut axis = self.clone();
        let hooks = effects::install(&self.effects, MachineMut::BallScrew(&mut axis))?;
        Ok((axis, hooks))
    }

    /// Table travel per radian of the screw, r = lead / 2π, m/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.drive.travel_per_radian()
    }

    /// The S-curve of a move that begins at the stroke's start.
    ///
    /// # Errors
    /// [`TrajectoryError`] where the move has no S-curve.
    pub fn plan(&self, spec: &MoveSpec) -> Result<SCurve, TrajectoryError> {
        let start = self.stroke.start;
        SCurve::plan(start, start + spec.displacement, &spec.limits)
    }
}
