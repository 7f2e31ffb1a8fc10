//! Values of variables: all are `Real`.

use axis_fmu::{Unit, UnitError};
use safer_ffi::prelude::*;

use super::{ComponentAt, of};
use crate::call::call;

/// Does `work` for each of `count` variables, if there are arrays of them.
fn each(
    component: ComponentAt<'_>,
    name: &str,
    count: usize,
    is_there: bool,
    mut work: impl FnMut(&mut Unit, usize) -> Result<(), UnitError>,
) -> i32 {
    call(of(component), name, |instance| {
        if count > 0 && !is_there {
            return Err(UnitError::Null("array"));
        }
        (0..count).try_for_each(|i| work(&mut instance.unit, i))
    })
}

/// `fmi2GetReal`.
#[ffi_export(rename = "fmi2GetReal")]
pub fn get_real(
    component: ComponentAt<'_>,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> i32 {
    let Some(access) = component.as_ref().map(|component| component.access) else {
        return call(None, "fmi2GetReal", |_| Ok(()));
    };
    let is_there = !references.is_null() && !values.is_null();
    each(component, "fmi2GetReal", count, is_there, |unit, i| {
        access.put(values, i, unit.get(access.reference(references, i))?);
        Ok(())
    })
}

/// `fmi2SetReal`, up to the first that is refused.
#[ffi_export(rename = "fmi2SetReal")]
pub fn set_real(
    component: ComponentAt<'_>,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> i32 {
    let Some(access) = component.as_ref().map(|component| component.access) else {
        return call(None, "fmi2SetReal", |_| Ok(()));
    };
    let is_there = !references.is_null() && !values.is_null();
    each(component, "fmi2SetReal", count, is_there, |unit, i| {
        unit.set(access.reference(references, i), access.number(values, i))
    })
}
