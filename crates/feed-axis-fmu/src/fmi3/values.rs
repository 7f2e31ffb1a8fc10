//! Values of variables: all are `Float64`.

use safer_ffi::prelude::*;

use crate::component::ComponentAt;
use crate::values::{get, set};

/// `fmi3GetFloat64`.
#[ffi_export(rename = "fmi3GetFloat64")]
pub fn get_float64(
    instance: ComponentAt<'_>,
    references: *const u32,
    n_references: usize,
    values: *mut f64,
    n_values: usize,
) -> i32 {
    let (references, values) = ((references, n_references), (values, n_values));
    get(instance, "fmi3GetFloat64", references, values)
}

/// `fmi3SetFloat64`, up to the first that is refused.
#[ffi_export(rename = "fmi3SetFloat64")]
pub fn set_float64(
    instance: ComponentAt<'_>,
    references: *const u32,
    n_references: usize,
    values: *const f64,
    n_values: usize,
) -> i32 {
    let (references, values) = ((references, n_references), (values, n_values));
    set(instance, "fmi3SetFloat64", references, values)
}
