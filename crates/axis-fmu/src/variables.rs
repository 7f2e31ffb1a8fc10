//! The variables of a unit: one table, made of the axis.

use axis_machine::MachineNumber;
use axis_sim::Axis;
use axis_sim::mechanism::Freedom;

use crate::error::UnitError;
use crate::given::Quantity;
use crate::kind::UnitKind;
use crate::measure::UnitDefinition;
use crate::outputs::{Output, Source, is_force, outputs};
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
        /// Whose axis file: which drive of the unit, from 0.
        drive: usize,
        /// Table of the axis file.
        table: String,
        /// Key in it, with its unit.
        key: String,
    },
    /// A number of the machine file, by its place among them. Set before the initialisation ends.
    MachineNumber(usize),
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
            | Self::MachineNumber(_)
            | Self::ExactBetween
            | Self::Compensation
            | Self::StartPosition => true,
            Self::Time | Self::Input(_) | Self::Output(_) => false,
        }
    }

    /// Whether it is a number of an axis or machine file.
    pub fn is_of_file(&self) -> bool {
        matches!(self, Self::Parameter { .. } | Self::MachineNumber(_))
    }

    /// Whether it is a switch: 0 or 1.
    pub(crate) fn is_switch(&self) -> bool {
        matches!(self, Self::ExactBetween | Self::Compensation)
    }
}

/// An input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// Of which axis of the unit, from 0.
    pub axis: usize,
    /// What of it.
    pub quantity: Quantity,
}

/// All variables of a unit, by their value references.
#[derive(Clone, Debug)]
pub struct Variables(Vec<Variable>);

/// An axis file of a unit.
#[derive(Clone, Copy)]
pub(crate) struct DriveFile<'a> {
    /// What stands before the names of its variables.
    pub prefix: &'a str,
    /// Which drive of the unit it is, from 0.
    pub drive: usize,
    pub axis: &'a Axis,
    /// Stands for the file in messages.
    pub name: &'a str,
    pub text: &'a str,
}

impl Variables {
    /// The variables of such a unit of an axis, made of its file's text; `name` stands for it in
    /// messages.
    ///
    /// # Errors
    /// [`UnitError::Axis`], [`UnitError::Text`] if the text is no axis file.
    pub fn of(kind: UnitKind, axis: &Axis, name: &str, text: &str) -> Result<Self, UnitError> {
        let (prefix, drive) = ("", 0);
        let file = DriveFile {
            prefix,
            drive,
            axis,
            name,
            text,
        };
        let mut all = Self::begin();
        all.push_inputs(kind, prefix, 0, axis);
        all.push_outputs(kind, &file);
        all.push_parameters(kind, &file)?;
        all.push_own(kind, axis);
        Ok(all)
    }

    /// Time alone.
    pub(crate) fn begin() -> Self {
        let mut all = Self(Vec::new());
        all.push(["time", "", "s"], VariableKind::Time, None);
        all
    }

    /// The inputs of an axis of the unit.
    pub(crate) fn push_inputs(&mut self, kind: UnitKind, prefix: &str, axis: usize, of: &Axis) {
        for (name, meaning, unit, quantity, start) in inputs(of, kind) {
            let input = VariableKind::Input(Input { axis, quantity });
            let name = format!("{prefix}{name}");
            self.push([&name, meaning, unit], input, Some(start));
        }
    }

    /// The outputs of a drive.
    pub(crate) fn push_outputs(&mut self, kind: UnitKind, file: &DriveFile<'_>) {
        for column in outputs(file.axis, kind) {
            let name = format!("{}{}", file.prefix, column.name);
            self.push_output(
                &name,
                column.meaning,
                column.unit,
                (column.source, file.drive),
            );
        }
    }

    /// One output, and of what it is.
    pub(crate) fn push_output(
        &mut self,
        name: &str,
        meaning: &str,
        unit: &str,
        (source, of): (Source, usize),
    ) {
        let kind = VariableKind::Output(Output { source, of });
        self.push([name, meaning, unit], kind, None);
    }

    /// The numbers of an axis file.
    pub(crate) fn push_parameters(
        &mut self,
        kind: UnitKind,
        file: &DriveFile<'_>,
    ) -> Result<(), UnitError> {
        let takes = |table: &str| kind != UnitKind::Plant || table != CONTROL;
        let numbers = parameters(file.name, file.text)?;
        for parameter in numbers.into_iter().filter(|p| takes(&p.table)) {
            let name = format!("{}{}.{}", file.prefix, parameter.table, parameter.key);
            let (valid, value) = (parameter.valid, parameter.value);
            let kind = VariableKind::Parameter {
                drive: file.drive,
                table: parameter.table,
                key: parameter.key,
            };
            self.push([&name, &valid, ""], kind, Some(value));
            self.measure(parameter.unit, parameter.limits);
        }
        Ok(())
    }

    /// A number of a machine file.
    pub(crate) fn push_number(&mut self, place: usize, number: &MachineNumber) {
        let kind = VariableKind::MachineNumber(place);
        let [least, most] = number.limits;
        let valid = format!("a number from {least} to {most}");
        self.push([&number.name, &valid, ""], kind, Some(number.value));
        self.measure(number.unit, Some(number.limits));
    }

    /// The parameter of what outputs show between two samples.
    pub(crate) fn push_exact(&mut self) {
        let own = VariableKind::ExactBetween;
        self.push([EXACT_BETWEEN, EXACT_MEANING, ""], own, Some(0.0));
        self.limit([0.0, 1.0]);
    }

    /// Unit as files spell it, and limits, of the last one.
    fn measure(&mut self, unit: &str, limits: Option<[f64; 2]>) {
        if let Some(last) = self.0.last_mut() {
            last.measure = UnitDefinition::spelled(unit);
            last.limits = limits;
        }
    }

    /// The parameters of a unit of one axis.
    fn push_own(&mut self, kind: UnitKind, axis: &Axis) {
        if kind == UnitKind::Compensated {
            let own = VariableKind::Compensation;
            self.push([COMPENSATION, COMPENSATION_MEANING, ""], own, Some(1.0));
            self.limit([0.0, 1.0]);
        }
        if kind != UnitKind::Plant {
            return self.push_exact();
        }
        let stroke = &axis.stroke;
        let [name, unit] = match axis.freedom() {
            Freedom::Linear => ["unit.start_position_m", "m"],
            Freedom::Rotary => ["unit.start_position_rad", "rad"],
        };
        let own = VariableKind::StartPosition;
        self.push([name, START_MEANING, unit], own, Some(stroke.start));
        self.limit([stroke.minimum, stroke.maximum]);
    }

    /// Limits of the last one.
    fn limit(&mut self, limits: [f64; 2]) {
        if let Some(last) = self.0.last_mut() {
            last.limits = Some(limits);
        }
    }

    fn push(&mut self, [name, meaning, unit]: [&str; 3], kind: VariableKind, start: Option<f64>) {
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

/// Name, meaning, unit, what of the axis, start.
type Line = (&'static str, &'static str, &'static str, Quantity, f64);

#[rustfmt::skip]
fn inputs(axis: &Axis, kind: UnitKind) -> Vec<Line> {
    use Quantity::{Acceleration, Current, Load, Motor, Position, Velocity};
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
