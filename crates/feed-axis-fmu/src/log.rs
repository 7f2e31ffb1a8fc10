//! Where messages go: the environment's logger, of either version.

use std::ffi::CString;

use crate::status::{Address, Status};

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessage = extern "C" fn(Address, i32, *const u8, *const u8);

/// `fmi2CallbackLogger`: environment, name of the instance, status, category, format, and what the
/// format asks for. Rust calls variadic functions as C does, which a processor's calling convention
/// may do otherwise than those of a fixed number of arguments (Apple's on AArch64 does).
pub type Logger = extern "C" fn(Address, *const u8, i32, *const u8, *const u8, ...);

/// Where messages go.
#[derive(Clone)]
pub struct Log {
    pub to: Option<To>,
    /// Errors are logged whether or not debugging was asked for, until they are switched off.
    pub on: bool,
}

/// A logger and what it is called with.
#[derive(Clone)]
pub enum To {
    Fmi2 {
        logger: Logger,
        environment: Address,
        name: CString,
    },
    Fmi3 {
        message: LogMessage,
        environment: Address,
    },
}

impl Log {
    /// A log that is on.
    pub fn new(to: Option<To>) -> Self {
        Self { to, on: true }
    }

    /// Tells the environment.
    pub fn tell(&self, status: Status, text: &str) {
        let Some(to) = self.to.as_ref().filter(|_| self.on) else {
            return;
        };
        let text = c_text(text);
        let [category, text] = [status.category(), &text].map(|text| text.as_ptr().cast::<u8>());
        match to {
            // The text is no format: it may have a percent sign.
            To::Fmi2 {
                logger,
                environment,
                name,
            } => logger(
                *environment,
                name.as_ptr().cast(),
                status as i32,
                category,
                c"%s".as_ptr().cast(),
                text,
            ),
            To::Fmi3 {
                message,
                environment,
            } => message(*environment, status as i32, category, text),
        }
    }
}

/// A text of C. One with a NUL cannot be given to C: it ends there.
pub fn c_text(text: &str) -> CString {
    CString::new(text.split('\0').next().unwrap_or_default()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_description_declares_the_categories() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let unit = axis_fmu::Unit::new(file, &std::fs::read_to_string(file).unwrap()).unwrap();
        for version in [axis_fmu::FmiVersion::V2, axis_fmu::FmiVersion::V3] {
            let text = axis_fmu::description(&unit, version);
            for status in [Status::Discard, Status::Error] {
                let category = status.category().to_str().unwrap();
                assert!(text.contains(&format!("<Category name=\"{category}\"")));
            }
        }
    }
}
