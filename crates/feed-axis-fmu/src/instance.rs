//! An instance: a unit and the environment's logger.

use std::path::Path;

use axis_fmu::{AXIS_FILE, CORRECTION_FILE, LIBRARY_MARK, MACHINE_FILE, Unit, UnitError, UnitKind};
use safer_ffi::prelude::*;

use crate::log::Log;

/// What `fmi3Instance` and `fmi2Component` hold.
pub struct Instance {
    pub(crate) unit: Unit,
    pub(crate) log: Log,
}

/// What `fmi3FMUState` and `fmi2FMUstate` point to.
#[derive_ReprC]
#[repr(opaque)]
pub struct State {
    pub(crate) unit: Unit,
}

/// What `fmi3FMUState*` and `fmi2FMUstate*` point to: an address that is null before the first save.
pub type StateAt<'a> = Option<&'a mut Option<repr_c::Box<State>>>;

impl Instance {
    /// Saves its state into the one that is there, or a new one.
    pub fn save(&self, state: StateAt<'_>) -> Result<(), UnitError> {
        let unit = self.unit.clone();
        *state.ok_or(NO_STATE)? = Some(Box::new(State { unit }).into());
        Ok(())
    }

    /// Goes back to a state.
    pub fn restore(&mut self, state: Option<&State>) -> Result<(), UnitError> {
        self.unit = state.ok_or(NO_STATE)?.unit.clone();
        Ok(())
    }
}

impl State {
    /// Tells how many bytes it takes.
    pub fn size(state: Option<&Self>, size: Option<&mut usize>) -> Result<(), UnitError> {
        *size.ok_or(UnitError::Null("size"))? = Self::bytes(state)?.len();
        Ok(())
    }

    /// Its bytes.
    pub fn bytes(state: Option<&Self>) -> Result<Vec<u8>, UnitError> {
        state.ok_or(NO_STATE)?.unit.to_bytes()
    }
}

impl Instance {
    /// Makes a state of bytes, in the one that is there, or a new one.
    pub fn read(&self, from: &[u8], state: StateAt<'_>) -> Result<(), UnitError> {
        let unit = self.unit.from_bytes(from)?;
        *state.ok_or(NO_STATE)? = Some(Box::new(State { unit }).into());
        Ok(())
    }
}

const NO_STATE: UnitError = UnitError::Null("state");

/// The unit of the resources, if it is the one that the environment means by `token`.
pub fn unit(token: &str, resources: &str) -> Result<Unit, String> {
    let path = |file: &str| Path::new(resources).join(file);
    let read = |file: &str| {
        let file = path(file);
        let name = file.display().to_string();
        match std::fs::read_to_string(&file) {
            Ok(text) => Ok((name, text)),
            Err(error) => Err(format!("{name}: {error}")),
        }
    };
    let unit = match UnitKind::of_token(token) {
        UnitKind::Machine => Unit::machine(&path(MACHINE_FILE)),
        kind => {
            let (name, text) = read(AXIS_FILE)?;
            match kind {
                UnitKind::Compensated => Unit::compensated(&name, &text, &read(CORRECTION_FILE)?.1),
                _ => Unit::of(kind, &name, &text),
            }
        }
    };
    let unit = unit.map_err(|error: UnitError| error.to_string())?;
    if token != unit.token() {
        return Err(format!(
            "the instantiation token (in FMI 2.0 the GUID) is \"{token}\"; valid: \"{}\", of {resources} and the {LIBRARY_MARK}",
            unit.token()
        ));
    }
    Ok(unit)
}
