//! States, saved and restored in memory.

use safer_ffi::prelude::*;

use crate::call::call;
use crate::instance::{Instance, State, StateAt};

/// `fmi3GetFMUState`: into the state that is there, or a new one.
#[ffi_export(rename = "fmi3GetFMUState")]
pub fn get_fmu_state(instance: Option<&mut Instance>, state: StateAt<'_>) -> i32 {
    call(instance, "fmi3GetFMUState", |instance| instance.save(state))
}

/// `fmi3SetFMUState`, also of an instance that was stopped by an error.
#[ffi_export(rename = "fmi3SetFMUState")]
pub fn set_fmu_state(instance: Option<&mut Instance>, state: Option<&State>) -> i32 {
    call(instance, "fmi3SetFMUState", |instance| {
        instance.restore(state)
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
