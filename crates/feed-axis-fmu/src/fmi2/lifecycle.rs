//! Instances and their modes, and steps.

use safer_ffi::prelude::*;

use super::Bool;
use crate::call::{call, caught, text};
use crate::component::{Callbacks, ComponentAt, Made, of};
use crate::instance::{Instance, unit};
use crate::log::{Log, To, c_text};
use crate::resource_path::resource_path;
use crate::status::{Address, Status};

/// `fmi2CoSimulation` of `fmi2Type`.
const CO_SIMULATION: i32 = 1;

/// `fmi2GetTypesPlatform`.
#[ffi_export(rename = "fmi2GetTypesPlatform")]
pub fn get_types_platform() -> char_p::Ref<'static> {
    c!("default")
}

/// `fmi2GetVersion`.
#[ffi_export(rename = "fmi2GetVersion")]
pub fn get_version() -> char_p::Ref<'static> {
    c!("2.0")
}

/// `fmi2SetDebugLogging`: of one category, or of all.
#[ffi_export(rename = "fmi2SetDebugLogging")]
pub fn set_debug_logging(
    component: ComponentAt<'_>,
    on: Bool,
    _count: usize,
    _categories: Address,
) -> i32 {
    call(of(component), "fmi2SetDebugLogging", |instance| {
        instance.log.on = on != 0;
        Ok(())
    })
}

/// `fmi2Instantiate`: none for another unit's GUID, an axis that cannot be simulated, or model
/// exchange, which there is not.
#[ffi_export(rename = "fmi2Instantiate")]
pub fn instantiate(
    name: Option<char_p::Ref<'_>>,
    kind: i32,
    guid: Option<char_p::Ref<'_>>,
    resources: Option<char_p::Ref<'_>>,
    functions: Option<&Callbacks>,
    _visible: Bool,
    _logging_on: Bool,
) -> Option<repr_c::Box<Made>> {
    let log = Log::new(functions.and_then(|functions| {
        Some(To::Fmi2 {
            logger: functions.logger?,
            environment: functions.environment,
            name: c_text(&text(name)),
        })
    }));
    let made = caught(|| match kind {
        CO_SIMULATION => unit(&text(guid), &resource_path(&text(resources))?),
        _ => Err("this unit is for co-simulation alone".to_owned()),
    });
    match made.and_then(|made| made) {
        Ok(unit) => Some(Made::of(Instance { unit, log })),
        Err(why) => {
            log.tell(Status::Error, &format!("fmi2Instantiate: {why}"));
            None
        }
    }
}

/// `fmi2FreeInstance`.
#[ffi_export(rename = "fmi2FreeInstance")]
pub fn free_instance(component: Option<repr_c::Box<Made>>) {
    // Nobody is left to be told of what goes wrong.
    let _ = caught(|| drop(component));
}

/// `fmi2SetupExperiment`: where it is not called, the simulation begins at 0 and has no end.
#[ffi_export(rename = "fmi2SetupExperiment")]
pub fn setup_experiment(
    component: ComponentAt<'_>,
    _tolerance_defined: Bool,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Bool,
    stop_time: f64,
) -> i32 {
    let stop = (stop_time_defined != 0).then_some(stop_time);
    call(of(component), "fmi2SetupExperiment", |instance| {
        instance.unit.set_up(start_time, stop)
    })
}

/// `fmi2EnterInitializationMode`.
#[ffi_export(rename = "fmi2EnterInitializationMode")]
pub fn enter_initialization_mode(component: ComponentAt<'_>) -> i32 {
    call(of(component), "fmi2EnterInitializationMode", |instance| {
        instance.unit.begin_initialization()
    })
}

/// `fmi2ExitInitializationMode`.
#[ffi_export(rename = "fmi2ExitInitializationMode")]
pub fn exit_initialization_mode(component: ComponentAt<'_>) -> i32 {
    call(of(component), "fmi2ExitInitializationMode", |instance| {
        instance.unit.exit_initialization()
    })
}

/// `fmi2Terminate`.
#[ffi_export(rename = "fmi2Terminate")]
pub fn terminate(component: ComponentAt<'_>) -> i32 {
    call(of(component), "fmi2Terminate", |instance| {
        instance.unit.terminate()
    })
}

/// `fmi2Reset`.
#[ffi_export(rename = "fmi2Reset")]
pub fn reset(component: ComponentAt<'_>) -> i32 {
    call(of(component), "fmi2Reset", |instance| {
        instance.unit.reset();
        Ok(())
    })
}

/// `fmi2DoStep`: the step is over when it returns.
#[ffi_export(rename = "fmi2DoStep")]
pub fn do_step(
    mut component: ComponentAt<'_>,
    point: f64,
    step: f64,
    _no_set_state_prior: Bool,
) -> i32 {
    let instance = component
        .as_deref_mut()
        .map(|component| &mut component.instance);
    let done = call(instance, "fmi2DoStep", |instance| {
        instance.unit.step(point, step).map(|_| ())
    });
    if let Some(component) = component {
        component.last_step = match done {
            0 => Status::Ok,
            _ => Status::Error,
        };
    }
    done
}
