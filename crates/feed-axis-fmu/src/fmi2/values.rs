//! Values of variables: all are `Real`.

use safer_ffi::prelude::*;

use crate::component::ComponentAt;
use crate::values::{get, set};

/// `fmi2GetReal`.
#[ffi_export(rename = "fmi2GetReal")]
pub fn get_real(
    component: ComponentAt<'_>,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> i32 {
    let (references, values) = ((references, count), (values, count));
    get(component, "fmi2GetReal", references, values)
}

/// `fmi2SetReal`, up to the first that is refused.
#[ffi_export(rename = "fmi2SetReal")]
pub fn set_real(
    component: ComponentAt<'_>,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> i32 {
    let (references, values) = ((references, count), (values, count));
    set(component, "fmi2SetReal", references, values)
}
