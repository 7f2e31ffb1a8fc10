//! Values of variables.

use trajectories::Setpoint;

use super::Unit;
use crate::error::UnitError;
use crate::mode::FmiMode;
use crate::run::Given;
use crate::variables::{Input, VariableKind};

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
            VariableKind::Output(output) => output.0,
            VariableKind::Input(_)
            | VariableKind::Parameter { .. }
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
            Some(run) => Ok(run.read(output)),
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

    /// The inputs as the loop takes them.
    pub(super) fn given(&self) -> Given {
        let of = |is_it: &dyn Fn(&VariableKind) -> bool| {
            let mut all = self.file.variables.iter().zip(&self.values);
            let found = all.find(|(variable, _)| is_it(&variable.kind));
            found.map(|(_, value)| *value)
        };
        let input = |input: Input| {
            let is_it = |kind: &VariableKind| matches!(kind, VariableKind::Input(i) if *i == input);
            of(&is_it).unwrap_or(0.0)
        };
        let start = of(&|kind| matches!(kind, VariableKind::StartPosition));
        Given {
            reference: Setpoint {
                position: start.unwrap_or_else(|| input(Input::Position)),
                velocity: input(Input::Velocity),
                acceleration: input(Input::Acceleration),
                jerk: 0.0,
            },
            motor: input(Input::Motor),
            current: input(Input::Current),
            load: input(Input::Load),
        }
    }

    /// The parameters that are not as the file has them: table, key, number.
    pub(super) fn changed(&self) -> Vec<(&str, &str, f64)> {
        let all = self.file.variables.iter().zip(&self.values);
        let changed = all.filter_map(|(variable, value)| match &variable.kind {
            VariableKind::Parameter { table, key } if variable.start != Some(*value) => {
                Some((table.as_str(), key.as_str(), *value))
            }
            _ => None,
        });
        changed.collect()
    }
}
