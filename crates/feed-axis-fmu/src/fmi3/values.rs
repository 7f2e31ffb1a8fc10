//! Values of variables: all are `Float64`.

use axis_fmu::UnitError;
use safer_ffi::prelude::*;

use crate::call::call;
use crate::instance::Instance;

/// Value references.
type References<'a> = Option<c_slice::Ref<'a, u32>>;

fn lengths(variables: usize, values: usize) -> Result<(), UnitError> {
    match variables == values {
        true => Ok(()),
        false => Err(UnitError::Lengths { variables, values }),
    }
}

/// `fmi3GetFloat64`.
#[ffi_export(rename = "fmi3GetFloat64")]
pub fn get_float64(
    instance: Option<&mut Instance>,
    references: References<'_>,
    values: Option<c_slice::Mut<'_, f64>>,
) -> i32 {
    call(instance, "fmi3GetFloat64", |instance| {
        let (Some(references), Some(mut values)) = (references, values) else {
            return Ok(());
        };
        lengths(references.len(), values.len())?;
        for (reference, value) in references.iter().zip(values.iter_mut()) {
            *value = instance.unit.get(*reference)?;
        }
        Ok(())
    })
}

/// `fmi3SetFloat64`, up to the first that is refused.
#[ffi_export(rename = "fmi3SetFloat64")]
pub fn set_float64(
    instance: Option<&mut Instance>,
    references: References<'_>,
    values: Option<c_slice::Ref<'_, f64>>,
) -> i32 {
    call(instance, "fmi3SetFloat64", |instance| {
        let (Some(references), Some(values)) = (references, values) else {
            return Ok(());
        };
        lengths(references.len(), values.len())?;
        for (reference, value) in references.iter().zip(values.iter()) {
            instance.unit.set(*reference, *value)?;
        }
        Ok(())
    })
}
