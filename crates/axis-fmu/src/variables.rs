//! The variables of a unit: one table, made of the axis.

use axis_sim::Axis;
use axis_sim::mechanism::Freedom;

use crate::error::UnitError;
use crate::kind::UnitKind;
use crate::measure::UnitDefinition;
use crate::outputs::{Source, is_force, outputs};
use crate::parameters::parameters;

/// The parameter of what outputs show between two samples.
const EXACT_BETWEEN: &str = "unit.exact_between_samples";
const EXACT_MEANING: &str = "0 or 1: at a communication point between two samples of the controller, \
     machine outputs are those of the last sample (0) or of that point (1)";

/// The parameter of whether a compensated unit corrects.
const COMPENSATION: &str = "unit.compensation";
const COMPENSATION_MEANING: &str = "0 or 1: without (0) or with (1) the correction; references are \
     followed equally late";

const START_MEANING: &str = "position of the load at the start, at rest";

/// The table of the axis file that a plant does without.
const CONTROL: &str = "control";

/// A variable of a unit; all are 64-bit floating-point numbers.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Value reference: its place in the table.
    pub reference: u32,
    /// Name.
    pub name: String,
    /// What it is, for people.
    pub description: String,
    /// Unit of its value; none of a plain number.
    pub measure: Option<UnitDefinition>,
    /// What it is to the unit.
    pub kind: VariableKind,
    /// Value before anybody sets it, in its unit; none of what is computed.
    pub start: Option<f64>,
    /// Least and greatest value, in its unit; none of what has no limits of its own. Whether values
    /// inside fit together is checked at the end of the initialisation.
    pub limits: Option<[f64; 2]>,
}

/// What a variable is to the unit.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum VariableKind {
    /// Time, s.
    Time,
    /// Set by the environment, held over each control cycle.
    Input(Input),
    /// Computed by the unit.
    Output(Output),
    /// A number of the axis file, set before the initialisation ends.
    Parameter {
        /// Table of the axis file.
        table: String,
        /// Key in it, with its unit.
        key: String,
    },
    /// A parameter: 1 where outputs at a point between two samples show the machine as it is there,
    /// 0 where they show it as of the last sample. Set before the initialisation ends.
    ExactBetween,
    /// A parameter of a compensated unit: 1 where it corrects, 0 where it follows its references as
    /// late without. Set before the initialisation ends.
    Compensation,
    /// A parameter of a plant: where it begins, m or rad. Set before the initialisation ends.
    StartPosition,
}

impl VariableKind {
    /// Whether it is a parameter: set before the initialisation ends.
    pub fn is_parameter(&self) -> bool {
        match self {
            Self::Parameter { .. }
            | Self::ExactBetween
            | Self::Compensation
            | Self::StartPosition => true,
            Self::Time | Self::Input(_) | Self::Output(_) => false,
        }
    }

    /// Whether it is a switch: 0 or 1.
    pub(crate) fn is_switch(&self) -> bool {
        matches!(self, Self::ExactBetween | Self::Compensation)
    }
}

/// An input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Reference of the position, m or rad.
    Position,
    /// Of the speed, m/s or rad/s.
    Velocity,
    /// Of the acceleration, m/s² or rad/s².
    Acceleration,
    /// Torque (N·m) or force (N) of the motor; in a closed loop, what is added to the controller's.
    Motor,
    /// Current of a plant's motor, A, whose torque is added.
    Current,
    /// Force on the load, N or N·m, positive against positive motion.
    Load,
}

/// How an output is read.
#[derive(Clone, Copy, Debug)]
pub struct Output(pub(crate) Source);

impl Output {
    /// Whether it changes with control cycles alone, and not in between.
    pub fn is_sampled(&self) -> bool {
        matches!(self.0, Source::Drive(_))
    }
}

/// All variables of a unit, by their value references.
#[derive(Clone, Debug)]
pub struct Variables(Vec<Variable>);

impl Variables {
    /// The variables of such a unit of an axis, made of its file's text; `name` stands for it in
    /// messages.
    ///
    /// # Errors
    /// [`UnitError::Axis`], [`UnitError::Text`] if the text is no axis file.
    pub fn of(kind: UnitKind, axis: &Axis, name: &str, text: &str) -> Result<Self, UnitError> {
        let mut all = Self(Vec::new());
        all.push("time", "", "s", VariableKind::Time, None);
        for (name, meaning, unit, input, start) in inputs(axis, kind) {
            all.push(name, meaning, unit, VariableKind::Input(input), Some(start));
        }
        for output in outputs(axis, kind) {
            let kind = VariableKind::Output(Output(output.source));
            all.push(&output.name, output.meaning, output.unit, kind, None);
        }
        let takes = |table: &str| kind != UnitKind::Plant || table != CONTROL;
        let numbers = parameters(name, text)?;
        for parameter in numbers.into_iter().filter(|p| takes(&p.table)) {
            let kind = VariableKind::Parameter {
                table: parameter.table.clone(),
                key: parameter.key.clone(),
            };
            let name = format!("{}.{}", parameter.table, parameter.key);
            all.push(&name, &parameter.valid, "", kind, Some(parameter.value));
            if let Some(last) = all.0.last_mut() {
                last.measure = UnitDefinition::spelled(parameter.unit);
                last.limits = parameter.limits;
            }
        }
        all.push_own(kind, axis);
        Ok(all)
    }

    /// The unit's own parameters.
    fn push_own(&mut self, kind: UnitKind, axis: &Axis) {
        if kind == UnitKind::Compensated {
            let own = VariableKind::Compensation;
            self.push(COMPENSATION, COMPENSATION_MEANING, "", own, Some(1.0));
            self.limit([0.0, 1.0]);
        }
        let stroke = &axis.stroke;
        let (name, meaning, unit, own, start, limits) = match (kind, axis.freedom()) {
            (UnitKind::ClosedLoop | UnitKind::Compensated, _) => {
                let own = VariableKind::ExactBetween;
                (EXACT_BETWEEN, EXACT_MEANING, "", own, 0.0, [0.0, 1.0])
            }
            (UnitKind::Plant, freedom) => {
                let [name, unit] = match freedom {
                    Freedom::Linear => ["unit.start_position_m", "m"],
                    Freedom::Rotary => ["unit.start_position_rad", "rad"],
                };
                let (own, limits) = (
                    VariableKind::StartPosition,
                    [stroke.minimum, stroke.maximum],
                );
                (name, START_MEANING, unit, own, stroke.start, limits)
            }
        };
        self.push(name, meaning, unit, own, Some(start));
        self.limit(limits);
    }

    /// Limits of the last one.
    fn limit(&mut self, limits: [f64; 2]) {
        if let Some(last) = self.0.last_mut() {
            last.limits = Some(limits);
        }
    }

    fn push(
        &mut self,
        name: &str,
        meaning: &str,
        unit: &str,
        kind: VariableKind,
        start: Option<f64>,
    ) {
        self.0.push(Variable {
            reference: self.0.len() as u32,
            name: name.to_owned(),
            description: meaning.to_owned(),
            measure: UnitDefinition::of_channel(unit),
            kind,
            start,
            limits: None,
        });
    }

    /// All of them.
    pub fn iter(&self) -> std::slice::Iter<'_, Variable> {
        self.0.iter()
    }

    /// The variable of that name.
    pub fn named(&self, name: &str) -> Option<&Variable> {
        self.iter().find(|variable| variable.name == name)
    }

    /// The variable with that value reference.
    ///
    /// # Errors
    /// [`UnitError::Reference`] if there is none.
    pub fn get(&self, reference: u32) -> Result<&Variable, UnitError> {
        let last = self.0.len().saturating_sub(1) as u32;
        let found = self.0.get(reference as usize);
        found.ok_or(UnitError::Reference { reference, last })
    }

    /// Start values, by value reference.
    pub(crate) fn starts(&self) -> Vec<f64> {
        self.iter()
            .map(|variable| variable.start.unwrap_or(0.0))
            .collect()
    }
}

/// Name, meaning, unit, input, start.
type Line = (&'static str, &'static str, &'static str, Input, f64);

#[rustfmt::skip]
fn inputs(axis: &Axis, kind: UnitKind) -> Vec<Line> {
    use Input::{Acceleration, Current, Load, Motor, Position, Velocity};
    const LOAD: &str = "on the load from outside, positive against positive motion";
    let at = axis.stroke.start;
    let load = match axis.freedom() {
        Freedom::Linear => ("load_force_n", LOAD, "N", Load, 0.0),
        Freedom::Rotary => ("load_torque_n_m", LOAD, "N·m", Load, 0.0),
    };
    if kind == UnitKind::Plant {
        let motor = match is_force(axis) {
            true => ("motor_force_n", "force of the motor on the load", "N", Motor, 0.0),
            false => ("motor_torque_n_m", "torque of the motor", "N·m", Motor, 0.0),
        };
        let current = ("motor_iq_a", "q current of the motor, whose torque is added", "A", Current, 0.0);
        let current = axis.actuator.has_currents().then_some(current);
        return [Some(motor), current, Some(load)].into_iter().flatten().collect();
    }
    let motor = "added to what the controller asks of the motor";
    let motor = match is_force(axis) {
        true => ("force_offset_n", motor, "N", Motor, 0.0),
        false => ("torque_offset_n_m", motor, "N·m", Motor, 0.0),
    };
    match axis.freedom() {
        Freedom::Linear => vec![
            ("position_ref_m", "reference of the position", "m", Position, at),
            ("velocity_ref_m_s", "reference of the speed", "m/s", Velocity, 0.0),
            ("acceleration_ref_m_s2", "reference of the acceleration", "m/s²", Acceleration, 0.0),
            motor,
            load,
        ],
        Freedom::Rotary => vec![
            ("position_ref_rad", "reference of the position", "rad", Position, at),
            ("velocity_ref_rad_s", "reference of the speed", "rad/s", Velocity, 0.0),
            ("acceleration_ref_rad_s2", "reference of the acceleration", "rad/s²", Acceleration, 0.0),
            motor,
            load,
        ],
    }
}
