//! States as bytes at addresses of the environment.

use axis_fmu::UnitError;

use crate::arrays::call_with_access;
use crate::component::ComponentAt;
use crate::instance::{State, StateAt};

/// Writes a state to an array of so many bytes.
pub fn write(
    component: ComponentAt<'_>,
    name: &str,
    state: Option<&State>,
    (to, size): (*mut u8, usize),
) -> i32 {
    call_with_access(component, name, |_, access| {
        let bytes = State::bytes(state)?;
        let least = bytes.len();
        if to.is_null() {
            return Err(UnitError::Null("bytes"));
        }
        if size < least {
            return Err(UnitError::State(format!(
                "it takes {least} bytes, and there is room for {size}; valid: as many or more"
            )));
        }
        let bytes = bytes.into_iter().enumerate();
        bytes.for_each(|(i, byte)| access.put_byte(to, i, byte));
        Ok(())
    })
}

/// Makes a state of an array of so many bytes.
pub fn read(
    component: ComponentAt<'_>,
    name: &str,
    (from, size): (*const u8, usize),
    state: StateAt<'_>,
) -> i32 {
    call_with_access(component, name, |instance, access| {
        if from.is_null() {
            return Err(UnitError::Null("bytes"));
        }
        let bytes: Vec<u8> = (0..size).map(|i| access.byte(from, i)).collect();
        instance.read(&bytes, state)
    })
}
