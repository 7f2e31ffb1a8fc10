//! States, saved and restored in memory.

use axis_fmu::UnitError;
use safer_ffi::prelude::*;

use crate::call::call;
use crate::instance::{Instance, State};

/// What `fmi3FMUState*` points to: an address that is null before the first save.
type StateAt<'a> = Option<&'a mut Option<repr_c::Box<State>>>;

/// `fmi3GetFMUState`: into the state that is there, or a new one.
#[ffi_export(rename = "fmi3GetFMUState")]
pub fn get_fmu_state(instance: Option<&mut Instance>, state: StateAt<'_>) -> i32 {
    call(instance, "fmi3GetFMUState", |instance| {
        let unit = instance.unit.clone();
        *state.ok_or(UnitError::NoState)? = Some(Box::new(State { unit }).into());
        Ok(())
    })
}

/// `fmi3SetFMUState`, also of an instance that was stopped by an error.
#[ffi_export(rename = "fmi3SetFMUState")]
pub fn set_fmu_state(instance: Option<&mut Instance>, state: Option<&State>) -> i32 {
    call(instance, "fmi3SetFMUState", |instance| {
        instance.unit = state.ok_or(UnitError::NoState)?.unit.clone();
        Ok(())
    })
}

/// `fmi3FreeFMUState`; one that is null is nothing to free.
#[ffi_export(rename = "fmi3FreeFMUState")]
pub fn free_fmu_state(instance: Option<&mut Instance>, state: StateAt<'_>) -> i32 {
    call(instance, "fmi3FreeFMUState", |_| {
        drop(state.and_then(Option::take));
        Ok(())
    })
}
