//! States, in memory and as bytes.

use safer_ffi::prelude::*;

use crate::call::call;
use crate::component::{ComponentAt, of};
use crate::instance::{State, StateAt};
use crate::state_bytes::{read, write};

/// `fmi2GetFMUstate`: into the state that is there, or a new one.
#[ffi_export(rename = "fmi2GetFMUstate")]
pub fn get_fmu_state(component: ComponentAt<'_>, state: StateAt<'_>) -> i32 {
    call(of(component), "fmi2GetFMUstate", |instance| {
        instance.save(state)
    })
}

/// `fmi2SetFMUstate`, also of an instance that was stopped by an error.
#[ffi_export(rename = "fmi2SetFMUstate")]
pub fn set_fmu_state(component: ComponentAt<'_>, state: Option<&State>) -> i32 {
    call(of(component), "fmi2SetFMUstate", |instance| {
        instance.restore(state)
    })
}

/// `fmi2FreeFMUstate`; one that is null is nothing to free.
#[ffi_export(rename = "fmi2FreeFMUstate")]
pub fn free_fmu_state(component: ComponentAt<'_>, state: StateAt<'_>) -> i32 {
    call(of(component), "fmi2FreeFMUstate", |_| {
        drop(state.and_then(Option::take));
        Ok(())
    })
}

/// `fmi2SerializedFMUstateSize`.
#[ffi_export(rename = "fmi2SerializedFMUstateSize")]
pub fn serialized_fmu_state_size(
    component: ComponentAt<'_>,
    state: Option<&State>,
    size: Option<&mut usize>,
) -> i32 {
    call(of(component), "fmi2SerializedFMUstateSize", |_| {
        State::size(state, size)
    })
}

/// `fmi2SerializeFMUstate`.
#[ffi_export(rename = "fmi2SerializeFMUstate")]
pub fn serialize_fmu_state(
    component: ComponentAt<'_>,
    state: Option<&State>,
    bytes: *mut u8,
    size: usize,
) -> i32 {
    write(component, "fmi2SerializeFMUstate", state, (bytes, size))
}

/// `fmi2DeSerializeFMUstate`: simulates again what led to the state.
#[ffi_export(rename = "fmi2DeSerializeFMUstate")]
pub fn deserialize_fmu_state(
    component: ComponentAt<'_>,
    bytes: *const u8,
    size: usize,
    state: StateAt<'_>,
) -> i32 {
    read(component, "fmi2DeSerializeFMUstate", (bytes, size), state)
}
