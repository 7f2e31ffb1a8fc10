//! An axis: the parts of a machine and how it is run, checked.

use std::collections::BTreeMap;
use std::path::PathBuf;

use axis_log::Mapping;
use trajectories::{Limits, Program, ProgramUnit, SCurve, TrajectoryError};

use crate::actuator::{Actuator, Surroundings};
use crate::control::{Control, absent};
use crate::cycle::Cycle;
use crate::data_sheets::DataSheets;
use crate::effects::{ActiveEffect, TableState};
use crate::error::SetupError;
use crate::friction::{self, Friction};
use crate::load::Load;
use crate::mechanism::{Freedom, Mechanism, SolutionMethod};
use crate::part::{Known, Part, PartError, Role, Values};
use crate::sensor::Sensor;
use crate::value_range::ValueRange;

/// Tracking error at which a run is given up where the axis file does not say, m.
pub const FOLLOWING_ERROR_LIMIT: f64 = 0.02;

/// A feed axis: a composition of parts. SI units; positions, speeds and forces are
/// those of the load, in m and N or in rad and N·m ([`Freedom`]).
///
/// Made from an axis file by [`Axis::read`]. Immutable while it is simulated; a
/// variant is a clone with other parts.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Short name, also of the folder of its results.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// What carries the motor's rotation to the load.
    pub mechanism: Part<dyn Mechanism>,
    /// What makes a torque of the controller's command.
    pub actuator: Part<dyn Actuator>,
    /// Position and speed control ([`Axis::has_control`]).
    pub control: Part<dyn Control>,
    /// Whether its gains are estimates from logs: `gains = "estimated"` in the file.
    pub control_estimated: bool,
    /// Friction between load and guides.
    pub friction: Part<Friction>,
    /// Loads besides it.
    pub loads: Vec<Part<dyn Load>>,
    /// Position sensors.
    pub sensors: Sensors,
    /// Control period, s; 1 ms where there is no control.
    pub period: f64,
    /// Tracking error at which a run is given up, m or rad; infinite for none.
    pub following_error_limit: f64,
    /// Settings of the simulation.
    pub simulation: Simulation,
    /// Where the load may be.
    pub stroke: Stroke,
    /// Ranges of the one-cycle samples, where there are some.
    pub samples: Option<SampleRanges>,
    /// The motions on which the axis is judged, in their order from 1.
    pub trajectories: Vec<MoveSpec>,
    /// Greatest speed in logs of it, m/s or rad/s, which stands for that of the trajectories if there are none; `None` after reading
    /// a file.
    pub fastest: Option<f64>,
    /// What its results are compared with, if anything.
    pub experiment: Option<Experiment>,
    /// Effects beyond the model above: the file's `[[effects]]`.
    pub effects: Vec<ActiveEffect>,
    /// How far known parameters may be off.
    pub tolerances: Tolerances,
    /// How the columns of logs of this axis are called.
    pub log: Mapping,
    /// Settings of its torque balance.
    pub balance: BalanceSettings,
    /// What the file's `[thermal]` says, of which the rest is assumed ([`Axis::thermal_model`]).
    pub thermal: Values,
    /// What the file's `[rating]` says ([`Axis::checked`]).
    pub rating: DataSheets,
    /// Hash of every value in SI units: the same for files that differ only
    /// in comments, units or order.
    pub fingerprint: String,
}

/// The position sensors of an axis.
#[derive(Clone, Debug, Default)]
pub struct Sensors {
    /// At the load.
    pub load: LoadSensor,
    /// At the motor; a perfect one if there is none in the file.
    pub motor: Option<Part<dyn Sensor>>,
}

/// The sensor at the load.
#[derive(Clone, Debug, Default)]
pub enum LoadSensor {
    /// Without any error.
    #[default]
    Perfect,
    /// None: the load's position is the motor's, times the travel per radian.
    Missing,
    /// One with errors.
    Fitted(Part<dyn Sensor>),
}

/// Settings of the torque balance of logs ([`crate::balance`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BalanceSettings {
    /// Cut-off frequency of what is compared, Hz; taken from each log if there is none.
    pub cutoff: Option<f64>,
    /// Speed of the load up to which nothing is compared, m/s or rad/s; if there is none,
    /// that which a log's sensor tells from rest.
    pub slowest: Option<f64>,
}

/// Settings of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Simulation {
    /// Longest internal step of the plant, s; the control period is divided
    /// into the fewest equal steps that are no longer.
    pub step: f64,
    /// How the mechanism's equations are solved.
    pub method: SolutionMethod,
}

/// Positions of the load, m or rad.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Least position.
    pub minimum: f64,
    /// Greatest position.
    pub maximum: f64,
    /// Where motions start.
    pub start: f64,
}

/// The design space of the one-cycle samples: Table 5 of the paper.
#[derive(Clone, Copy, Debug)]
pub struct SampleRanges {
    /// S(k), m or rad.
    pub position: ValueRange,
    /// Ṡ(k), per second.
    pub speed: ValueRange,
    /// S̈(k), per second squared.
    pub acceleration: ValueRange,
    /// The actuator's command: I_qr(k), A, in the paper.
    pub effort: ValueRange,
}

/// One rest-to-rest move.
#[derive(Clone, Copy, Debug)]
pub struct MoveSpec {
    /// From the stroke's start, m or rad.
    pub displacement: f64,
    /// Greatest speed, acceleration and jerk.
    pub limits: Limits,
}

/// What results are compared with.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Axis file of the simulated machine that stands for the real one.
    pub machine: PathBuf,
    /// Folder with the paper's tables.
    pub paper_tables: Option<PathBuf>,
}

/// How far known parameters may be off, as shares of their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerances {
    /// Of all that are not named.
    pub default: f64,
    /// By the name of the parameter ([`Axis::known`]).
    pub by_name: BTreeMap<&'static str, f64>,
}

impl Tolerances {
    /// Of a parameter of which nothing is known but what it is.
    pub const UNKNOWN: f64 = 0.9;

    /// All the same.
    pub fn all(share: f64) -> Self {
        Self {
            default: share,
            by_name: BTreeMap::new(),
        }
    }

    fn of_known(&self, known: &Known) -> f64 {
        let own = self.by_name.get(known.name).copied();
        let usual = known.own_tolerance().map(|(share, _)| share);
        own.or(usual).unwrap_or(self.default)
    }

    /// Of one parameter.
    pub fn of(&self, name: &str) -> f64 {
        self.by_name.get(name).copied().unwrap_or(self.default)
    }
}

impl Axis {
    /// How the load moves.
    pub fn freedom(&self) -> Freedom {
        self.mechanism.freedom()
    }

    /// Whether its controller is known. One whose file leaves `[control]` out can be balanced
    /// ([`crate::balance`]), and not simulated in a closed loop.
    pub fn has_control(&self) -> bool {
        !std::ptr::eq(self.control.kind(), &absent::KIND)
    }

    /// The same axis as if its controller were not known.
    ///
    /// # Errors
    /// None that a file's axis can have.
    pub fn without_control(mut self) -> Result<Self, PartError> {
        self.control = Part::new(&absent::KIND, Values::default())?;
        Ok(self)
    }

    /// The same axis with a dry friction of this level at the load, N or N·m, in the place of its own, that comes on over the same
    /// way.
    ///
    /// # Errors
    /// [`PartError`] if the level is not finite or below 0.
    pub fn with_dry_friction(mut self, level: f64) -> Result<Self, PartError> {
        let lever = self.friction.lever(self.travel_per_radian());
        let way = (self.friction.unit.bristle_limit() * lever).abs();
        let mut values = Values::default();
        values.set("viscous", 0.0);
        values.set("coulomb", level);
        values.set("presliding", way);
        self.friction = Part::new(friction::dry(self.freedom()), values)?;
        Ok(self)
    }

    /// Travel of the load per radian of the motor, r, m/rad or rad/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.mechanism.travel_per_radian()
    }

    /// Motor torque per unit of the actuator's command, N·m per A, V or N·m.
    pub fn torque_constant(&self) -> f64 {
        self.actuator.torque_constant(self.travel_per_radian())
    }

    /// Whether the drive derives the motor's speed from what a sensor with errors shows:
    /// the motor's, or the load's where motor and load are one.
    pub fn derives_speed(&self) -> bool {
        let of_load = matches!(self.sensors.load, LoadSensor::Fitted(_));
        self.sensors.motor.is_some() || of_load && !self.mechanism.has_motor_encoder()
    }

    /// Name of the load's position in logs.
    pub fn position_channel(&self) -> &'static str {
        match self.freedom() {
            Freedom::Linear => "position_m",
            Freedom::Rotary => "position_rad",
        }
    }

    /// Name of its reference in logs.
    pub fn reference_channel(&self) -> &'static str {
        match self.freedom() {
            Freedom::Linear => "position_ref_m",
            Freedom::Rotary => "position_ref_rad",
        }
    }

    /// Motor torque as the drive knows it in a cycle, from its current, or from its command
    /// where it has none, N·m.
    pub fn torque_shown(&self, cycle: &Cycle) -> f64 {
        let effort = match self.actuator.has_currents() {
            true => cycle.current.q,
            false => cycle.command.effort,
        };
        self.torque_constant() * effort
    }

    /// Force of the axis' own loads at rest at `position`, N or N·m, against positive motion.
    pub fn load_at(&self, position: f64) -> f64 {
        let at = TableState {
            position,
            ..TableState::default()
        };
        self.loads.iter().map(|load| load.force(&at)).sum()
    }

    /// What actuator and control are told of this axis.
    pub(crate) fn surroundings(&self) -> Surroundings {
        Surroundings {
            period: self.period,
            travel_per_radian: self.travel_per_radian(),
        }
    }

    /// The S-curve of a move that begins at the stroke's start.
    ///
    /// # Errors
    /// [`TrajectoryError`] if the move has no S-curve.
    pub fn plan(&self, spec: &MoveSpec) -> Result<SCurve, TrajectoryError> {
        let start = self.stroke.start;
        SCurve::plan(start, start + spec.displacement, &spec.limits)
    }

    /// In which unit files of motion programs for it are.
    pub fn unit_of_programs(&self) -> ProgramUnit {
        match self.freedom() {
            Freedom::Linear => ProgramUnit::Millimetres,
            Freedom::Rotary => ProgramUnit::Degrees,
        }
    }

    /// Whether a program that was read from a file is in the unit of this axis, or else why not.
    ///
    /// # Errors
    /// The reason, with the keys that would be right, as a sentence without its stop.
    pub fn takes(&self, program: &Program) -> Result<(), String> {
        let unit = self.unit_of_programs();
        if program.unit() == unit {
            return Ok(());
        }
        let (moves, end) = match unit {
            ProgramUnit::Millimetres => ("moves along a line", "mm"),
            ProgramUnit::Degrees => ("turns", "deg"),
        };
        Err(format!(
            "the program is in {}, and the axis \"{}\" {moves}; its keys would be start_{end}, to_{end}, by_{end}, amplitude_{end}, velocity_{end}_s, acceleration_{end}_s2 and jerk_{end}_s3",
            program.unit().name(),
            self.name
        ))
    }

    /// The parameters that the file gives and that may be off by its tolerances:
    /// those of mechanism, actuator, control, friction and loads, in that order. One that is
    /// exact by itself ([`Known::exact`]) is among them where the tolerances name it.
    pub fn known(&self) -> Vec<&'static str> {
        let all = self.may_be_known().into_iter();
        let free = all.filter(|known| self.may_differ(known));
        free.map(|known| known.name).collect()
    }

    /// How far each of [`Axis::known`] may be off, as a share of its value.
    pub fn known_tolerances(&self) -> Vec<f64> {
        let all = self.may_be_known().into_iter();
        let free = all.filter(|known| self.may_differ(known));
        free.map(|known| self.tolerances.of_known(known)).collect()
    }

    /// Which of [`Axis::known`] are angles: off by an angle in rad, and not by a share of their value.
    pub fn known_angles(&self) -> Vec<bool> {
        let all = self.may_be_known().into_iter();
        let free = all.filter(|known| self.may_differ(known));
        free.map(Known::is_angle).collect()
    }

    /// Whether a parameter may be off at all.
    fn may_differ(&self, known: &Known) -> bool {
        let named = self.tolerances.by_name.contains_key(known.name);
        named
            || !known.is_exact()
                && known.own_tolerance().is_none_or(|(share, role)| {
                    let of_role = role.map_or_else(Vec::new, |role| self.keys_of(role));
                    of_role
                        .into_iter()
                        .all(|key| self.tolerances.of(key) < share)
                })
    }

    /// Names of the parameters of that role.
    fn keys_of(&self, role: Role) -> Vec<&'static str> {
        let parts = [
            self.mechanism.kind().keys,
            self.actuator.kind().keys,
            self.control.kind().keys,
            self.friction.kind().keys,
        ];
        let keys = parts.into_iter().flatten();
        let of_role = keys.filter(|key| key.role == Some(role));
        of_role.map(|key| key.name).collect()
    }

    /// Whether the tolerances say of a parameter of that role that nothing is known but what it is.
    pub fn is_unknown(&self, role: Role) -> bool {
        let mut keys = self.keys_of(role).into_iter();
        keys.any(|key| self.tolerances.of(key) >= Tolerances::UNKNOWN)
    }

    /// As [`Axis::known`], with all that are exact unless the tolerances name them.
    pub(crate) fn may_be_known(&self) -> Vec<&'static Known> {
        let of_loads = self.loads.iter().flat_map(Part::known);
        let all = (self.mechanism.known())
            .chain(self.actuator.known())
            .chain(self.control.known())
            .chain(self.friction.known())
            .chain(of_loads);
        all.collect()
    }

    /// The axis with its known parameters off by `shares` of their values, in the
    /// order of [`Axis::known`]. A share that would make no axis is passed over.
    #[must_use]
    pub fn with_known(&self, shares: &[f64]) -> Self {
        let mut axis = self.clone();
        let free = |known: &Known| self.may_differ(known);
        let mut shares = shares.iter();
        off(&mut axis.mechanism, &free, &mut shares);
        off(&mut axis.actuator, &free, &mut shares);
        off(&mut axis.control, &free, &mut shares);
        off(&mut axis.friction, &free, &mut shares);
        for load in &mut axis.loads {
            off(load, &free, &mut shares);
        }
        axis
    }

    /// Whether a part of this axis has a parameter of that role.
    pub fn has(&self, role: Role) -> bool {
        self.mechanism.has(role)
            || self.actuator.has(role)
            || self.control.has(role)
            || self.friction.has(role)
    }

    /// Applies `to` to every parameter of that role.
    ///
    /// # Errors
    /// [`SetupError::Part`] if a part refuses the new value.
    pub(crate) fn change(&mut self, role: Role, to: impl Fn(f64) -> f64) -> Result<(), SetupError> {
        self.mechanism.change_role(role, &to)?;
        self.actuator.change_role(role, &to)?;
        self.control.change_role(role, &to)?;
        self.friction.change_role(role, &to)?;
        Ok(())
    }
}

/// Changes the known parameters of a part by the next shares.
fn off<'a, P: ?Sized>(
    part: &mut Part<P>,
    is_free: &impl Fn(&Known) -> bool,
    shares: &mut impl Iterator<Item = &'a f64>,
) {
    let known: Vec<&Known> = part.known().filter(|known| is_free(known)).collect();
    for (known, share) in known.into_iter().zip(shares) {
        if *share != 0.0 {
            // What would make no part is passed over: the part stays as it was.
            let _ = part.change(|values| known.scale(values, 1.0 + share));
        }
    }
}
