//! An instance: a unit and the environment's logger.

use std::ffi::CString;
use std::path::Path;

use axis_fmu::{AXIS_FILE, LIBRARY_MARK, Unit, UnitError};
use safer_ffi::derive_ReprC;

use crate::call::{Address, Status};

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessage = extern "C" fn(Address, i32, *const u8, *const u8);

/// The only category of messages.
pub const CATEGORY: &str = "logStatusError";

/// What `fmi3Instance` points to.
#[derive_ReprC]
#[repr(opaque)]
pub struct Instance {
    pub(crate) unit: Unit,
    pub(crate) log: Log,
}

/// What `fmi3FMUState` points to.
#[derive_ReprC]
#[repr(opaque)]
pub struct State {
    pub(crate) unit: Unit,
}

/// Where messages go.
#[derive(Clone, Copy)]
pub struct Log {
    pub environment: Address,
    pub message: Option<LogMessage>,
    /// Errors are told whether or not debugging was asked for, until they are switched off.
    pub on: bool,
}

impl Log {
    /// Tells the environment.
    pub fn tell(&self, status: Status, text: &str) {
        let Some(message) = self.message.filter(|_| self.on) else {
            return;
        };
        // A text with a NUL cannot be given to C: it ends there.
        let until = text.split('\0').next().unwrap_or_default();
        if let (Ok(category), Ok(text)) = (CString::new(CATEGORY), CString::new(until)) {
            let [category, text] = [&category, &text].map(|text| text.as_ptr().cast::<u8>());
            message(self.environment, status as i32, category, text);
        }
    }
}

/// The unit of the resources, if it is the one that the environment means by `token`.
pub fn unit(token: &str, resources: &str) -> Result<Unit, String> {
    let file = Path::new(resources).join(AXIS_FILE);
    let name = file.display().to_string();
    let text = std::fs::read_to_string(&file).map_err(|error| format!("{name}: {error}"))?;
    let unit = Unit::new(&name, &text).map_err(|error: UnitError| error.to_string())?;
    if token != unit.token() {
        return Err(format!(
            "the instantiation token is \"{token}\"; valid: \"{}\", of {name} and the {LIBRARY_MARK}",
            unit.token()
        ));
    }
    Ok(unit)
}
