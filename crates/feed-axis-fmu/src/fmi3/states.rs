//! States, in memory and as bytes.

use safer_ffi::prelude::*;

use crate::call::call;
use crate::component::{ComponentAt, of};
use crate::instance::{State, StateAt};
use crate::state_bytes::{read, write};

/// `fmi3GetFMUState`: into the state that is there, or a new one.
#[ffi_export(rename = "fmi3GetFMUState")]
pub fn get_fmu_state(instance: ComponentAt<'_>, state: StateAt<'_>) -> i32 {
    call(of(instance), "fmi3GetFMUState", |instance| {
        instance.save(state)
    })
}

/// `fmi3SetFMUState`, also of an instance that was stopped by an error.
#[ffi_export(rename = "fmi3SetFMUState")]
pub fn set_fmu_state(instance: ComponentAt<'_>, state: Option<&State>) -> i32 {
    call(of(instance), "fmi3SetFMUState", |instance| {
        instance.restore(state)
    })
}

/// `fmi3FreeFMUState`; one that is null is nothing to free.
#[ffi_export(rename = "fmi3FreeFMUState")]
pub fn free_fmu_state(instance: ComponentAt<'_>, state: StateAt<'_>) -> i32 {
    call(of(instance), "fmi3FreeFMUState", |_| {
        drop(state.and_then(Option::take));
        Ok(())
    })
}

/// `fmi3SerializedFMUStateSize`.
#[ffi_export(rename = "fmi3SerializedFMUStateSize")]
pub fn serialized_fmu_state_size(
    instance: ComponentAt<'_>,
    state: Option<&State>,
    size: Option<&mut usize>,
) -> i32 {
    call(of(instance), "fmi3SerializedFMUStateSize", |_| {
        State::size(state, size)
    })
}

/// `fmi3SerializeFMUState`.
#[ffi_export(rename = "fmi3SerializeFMUState")]
pub fn serialize_fmu_state(
    instance: ComponentAt<'_>,
    state: Option<&State>,
    bytes: *mut u8,
    size: usize,
) -> i32 {
    write(instance, "fmi3SerializeFMUState", state, (bytes, size))
}

/// `fmi3DeserializeFMUState`: simulates again what led to the state.
#[ffi_export(rename = "fmi3DeserializeFMUState")]
pub fn deserialize_fmu_state(
    instance: ComponentAt<'_>,
    bytes: *const u8,
    size: usize,
    state: StateAt<'_>,
) -> i32 {
    read(instance, "fmi3DeserializeFMUState", (bytes, size), state)
}
