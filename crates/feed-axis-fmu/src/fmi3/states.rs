//! States, in memory and as bytes.

use safer_ffi::prelude::*;

use crate::call::call;
use crate::instance::{BytesIn, BytesOut, Instance, State, StateAt};

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

/// `fmi3SerializedFMUStateSize`.
#[ffi_export(rename = "fmi3SerializedFMUStateSize")]
pub fn serialized_fmu_state_size(
    instance: Option<&mut Instance>,
    state: Option<&State>,
    size: Option<&mut usize>,
) -> i32 {
    call(instance, "fmi3SerializedFMUStateSize", |_| {
        State::size(state, size)
    })
}

/// `fmi3SerializeFMUState`.
#[ffi_export(rename = "fmi3SerializeFMUState")]
pub fn serialize_fmu_state(
    instance: Option<&mut Instance>,
    state: Option<&State>,
    bytes: BytesOut<'_>,
) -> i32 {
    call(instance, "fmi3SerializeFMUState", |_| {
        State::write(state, bytes)
    })
}

/// `fmi3DeserializeFMUState`: simulates again what led to the state.
#[ffi_export(rename = "fmi3DeserializeFMUState")]
pub fn deserialize_fmu_state(
    instance: Option<&mut Instance>,
    bytes: BytesIn<'_>,
    state: StateAt<'_>,
) -> i32 {
    call(instance, "fmi3DeserializeFMUState", |instance| {
        instance.read(bytes, state)
    })
}
