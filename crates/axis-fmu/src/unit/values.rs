//! Values of variables.

use super::Unit;
use crate::error::UnitError;
use crate::given::{Inputs, Quantity};
use crate::mode::FmiMode;
use crate::parameters::{Changed, Place};
use crate::variables::VariableKind;

impl Unit {
    /// The value of a variable, in its unit. In initialisation mode outputs are those of the axis
    /// at rest under what has been set so far.
    ///
    /// # Errors
    /// [`UnitError::Reference`]; [`UnitError::Order`] for an output before the initialisation; in
    /// it also as [`Unit::exit_initialization`].
    pub fn get(&mut self, reference: u32) -> Result<f64, UnitError> {
        let output = match &self.file.variables.get(reference)?.kind {
            VariableKind::Time => return Ok(self.time()),
            VariableKind::Output(output) => *output,
            VariableKind::Input(_)
            | VariableKind::Parameter { .. }
            | VariableKind::MachineNumber(_)
            | VariableKind::ExactBetween
            | VariableKind::Compensation
            | VariableKind::StartPosition => {
                return Ok(self
                    .values
                    .get(reference as usize)
                    .copied()
                    .unwrap_or(f64::NAN));
            }
        };
        if self.mode == FmiMode::Initialization {
            self.settled()?;
        }
        match &self.run {
            Some(run) => Ok(run.0.read(&output)),
            None => Err(self.order("reading an output", "from the initialization on")),
        }
    }

    /// Sets an input or, before the end of the initialisation, a parameter, in its unit.
    ///
    /// # Errors
    /// [`UnitError::Reference`]; [`UnitError::Set`] for what cannot be set, or not any more, and
    /// for what is not finite; [`UnitError::Order`] after the end.
    pub fn set(&mut self, reference: u32, value: f64) -> Result<(), UnitError> {
        let (set, is_before) = (
            self.file.variables.get(reference)?,
            self.mode != FmiMode::Step,
        );
        let refused = |why: &str| UnitError::Set {
            name: set.name.clone(),
            why: why.to_owned(),
        };
        let valid = [
            FmiMode::Instantiated,
            FmiMode::Initialization,
            FmiMode::Step,
        ];
        self.in_mode(
            "setting a variable",
            &valid,
            "before the end of the simulation",
        )?;
        match &set.kind {
            VariableKind::Time => return Err(refused("the steps make it")),
            VariableKind::Output(_) => return Err(refused("it is an output")),
            kind if kind.is_parameter() && !is_before => {
                return Err(refused(
                    "it is fixed; valid: before the initialization ends",
                ));
            }
            kind if kind.is_switch() && value != 0.0 && value != 1.0 => {
                return Err(refused(&format!("{value} is neither; valid: 0 or 1")));
            }
            VariableKind::Parameter { .. }
            | VariableKind::MachineNumber(_)
            | VariableKind::ExactBetween
            | VariableKind::Compensation
            | VariableKind::StartPosition
            | VariableKind::Input(_) => {}
        }
        if !value.is_finite() {
            return Err(refused(&format!("{value} is no finite number")));
        }
        if let Some(place) = self.values.get_mut(reference as usize) {
            *place = value;
        }
        if is_before {
            self.run = None;
        }
        Ok(())
    }

    /// Whether outputs show the machine between two samples as it is there.
    pub(super) fn is_exact(&self) -> bool {
        self.is_on(|kind| matches!(kind, VariableKind::ExactBetween))
    }

    /// Whether its correction is switched on; of a unit that has one.
    pub(super) fn is_compensated(&self) -> bool {
        self.is_on(|kind| matches!(kind, VariableKind::Compensation))
    }

    fn is_on(&self, is_it: impl Fn(&VariableKind) -> bool) -> bool {
        let mut all = self.file.variables.iter().zip(&self.values);
        all.any(|(variable, value)| is_it(&variable.kind) && *value != 0.0)
    }

    /// Where the inputs are among the values, in their order.
    pub(super) fn input_places(&self) -> impl Iterator<Item = usize> {
        let all = self.file.variables.iter().enumerate();
        all.filter_map(|(place, variable)| match variable.kind {
            VariableKind::Input(_) => Some(place),
            _ => None,
        })
    }

    /// The inputs as simulations take them.
    pub(super) fn inputs(&self) -> Inputs {
        let mut all = Inputs::default();
        for (variable, value) in self.file.variables.iter().zip(&self.values) {
            let (axis, quantity) = match variable.kind {
                VariableKind::Input(input) => (input.axis, input.quantity),
                VariableKind::StartPosition => (0, Quantity::Position),
                _ => continue,
            };
            if let Some(given) = all.get_mut(axis) {
                given.set(quantity, *value);
            }
        }
        all
    }

    /// The parameters that are not as the files have them.
    pub(super) fn changed(&self) -> Vec<Changed<'_>> {
        let all = self.file.variables.iter().zip(&self.values);
        let changed = all.filter(|(variable, value)| variable.start != Some(**value));
        let placed = changed.filter_map(|(variable, value)| {
            let place = match &variable.kind {
                VariableKind::Parameter { drive, table, key } => Place::Drive {
                    drive: *drive,
                    table,
                    key,
                },
                VariableKind::MachineNumber(i) => Place::Machine(*i),
                _ => return None,
            };
            Some((place, *value))
        });
        placed.collect()
    }
}
