//! How a step ended. None goes on after `fmi2DoStep` has returned.

use axis_fmu::{FmiMode, UnitError};
use safer_ffi::prelude::*;

use super::Bool;
use crate::call::call;
use crate::component::{Component, ComponentAt, of};
use crate::status::{Address, Status};

// Of `fmi2StatusKind`.
const DO_STEP_STATUS: i32 = 0;
const LAST_SUCCESSFUL_TIME: i32 = 2;
const TERMINATED: i32 = 3;

/// Writes what is asked for; `fmi2Discard` of another kind of status.
fn inquired<T>(
    component: ComponentAt<'_>,
    name: &str,
    is_known: bool,
    value: Option<&mut T>,
    read: impl FnOnce(&Component) -> T,
) -> i32 {
    match (component, value) {
        (Some(component), Some(value)) if is_known => {
            *value = read(component);
            Status::Ok as i32
        }
        (component, _) => unknown(component, name),
    }
}

fn unknown(component: ComponentAt<'_>, name: &str) -> i32 {
    let Some(component) = component else {
        return Status::Error as i32;
    };
    let why = "no step goes on after fmi2DoStep has returned; valid: fmi2DoStepStatus as fmi2Status, \
         fmi2LastSuccessfulTime as fmi2Real, fmi2Terminated as fmi2Boolean, at an address";
    let log = &component.instance.log;
    log.tell(Status::Discard, &format!("{name}: {why}"));
    Status::Discard as i32
}

/// `fmi2GetStatus`: of the last step.
#[ffi_export(rename = "fmi2GetStatus")]
pub fn get_status(component: ComponentAt<'_>, kind: i32, value: Option<&mut i32>) -> i32 {
    let is_known = kind == DO_STEP_STATUS;
    inquired(component, "fmi2GetStatus", is_known, value, |component| {
        component.last_step as i32
    })
}

/// `fmi2GetRealStatus`: the time reached.
#[ffi_export(rename = "fmi2GetRealStatus")]
pub fn get_real_status(component: ComponentAt<'_>, kind: i32, value: Option<&mut f64>) -> i32 {
    let is_known = kind == LAST_SUCCESSFUL_TIME;
    inquired(
        component,
        "fmi2GetRealStatus",
        is_known,
        value,
        |component| component.instance.unit.time(),
    )
}

/// `fmi2GetIntegerStatus`: there is none.
#[ffi_export(rename = "fmi2GetIntegerStatus")]
pub fn get_integer_status(component: ComponentAt<'_>, _kind: i32, _value: Address) -> i32 {
    unknown(component, "fmi2GetIntegerStatus")
}

/// `fmi2GetBooleanStatus`: whether the run had to be given up.
#[ffi_export(rename = "fmi2GetBooleanStatus")]
pub fn get_boolean_status(component: ComponentAt<'_>, kind: i32, value: Option<&mut Bool>) -> i32 {
    let is_known = kind == TERMINATED;
    inquired(
        component,
        "fmi2GetBooleanStatus",
        is_known,
        value,
        |component| Bool::from(component.instance.unit.mode() == FmiMode::Failed),
    )
}

/// `fmi2GetStringStatus`: there is none, as no step is pending.
#[ffi_export(rename = "fmi2GetStringStatus")]
pub fn get_string_status(component: ComponentAt<'_>, _kind: i32, _value: Address) -> i32 {
    unknown(component, "fmi2GetStringStatus")
}

/// `fmi2CancelStep`: there is none to cancel.
#[ffi_export(rename = "fmi2CancelStep")]
pub fn cancel_step(component: ComponentAt<'_>) -> i32 {
    call(of(component), "fmi2CancelStep", |_| {
        let why = "a step is over when fmi2DoStep returns (canRunAsynchronuously is false)";
        Err(UnitError::Absent(why.to_owned()))
    })
}
