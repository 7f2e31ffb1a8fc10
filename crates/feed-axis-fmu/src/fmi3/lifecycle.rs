//! Instances and their modes, and steps.

use safer_ffi::prelude::*;

use super::Bool;
use crate::call::{call, caught, text};
use crate::component::{ComponentAt, Made, of};
use crate::instance::{Instance, unit};
use crate::log::{Log, LogMessage, To};
use crate::status::{Address, Status};

fn log(environment: Address, message: Option<LogMessage>) -> Log {
    Log::new(message.map(|message| To::Fmi3 {
        message,
        environment,
    }))
}

/// `fmi3GetVersion`.
#[ffi_export(rename = "fmi3GetVersion")]
pub fn get_version() -> char_p::Ref<'static> {
    c!("3.0")
}

/// `fmi3SetDebugLogging`: of the one category, or of all.
#[ffi_export(rename = "fmi3SetDebugLogging")]
pub fn set_debug_logging(
    instance: ComponentAt<'_>,
    on: Bool,
    _count: usize,
    _categories: Address,
) -> i32 {
    call(of(instance), "fmi3SetDebugLogging", |instance| {
        instance.log.on = on != 0;
        Ok(())
    })
}

/// `fmi3InstantiateCoSimulation`: none for another unit's token, an axis that cannot be simulated,
/// or event mode, which there is not.
#[ffi_export(rename = "fmi3InstantiateCoSimulation")]
pub fn instantiate_co_simulation(
    _name: Option<char_p::Ref<'_>>,
    token: Option<char_p::Ref<'_>>,
    resources: Option<char_p::Ref<'_>>,
    _visible: Bool,
    _logging_on: Bool,
    event_mode_used: Bool,
    _early_return_allowed: Bool,
    _intermediate: Address,
    _intermediate_count: usize,
    environment: Address,
    message: Option<LogMessage>,
    _intermediate_update: Address,
) -> Option<repr_c::Box<Made>> {
    let log = log(environment, message);
    let made = caught(|| match event_mode_used {
        0 => unit(&text(token), &text(resources)),
        _ => Err("there is no event mode (hasEventMode is false)".to_owned()),
    });
    match made.and_then(|made| made) {
        Ok(unit) => Some(Made::of(Instance { unit, log })),
        Err(why) => {
            log.tell(
                Status::Error,
                &format!("fmi3InstantiateCoSimulation: {why}"),
            );
            None
        }
    }
}

/// `fmi3InstantiateModelExchange`: none, and the logger is told.
#[ffi_export(rename = "fmi3InstantiateModelExchange")]
pub fn instantiate_model_exchange(
    _name: Address,
    _token: Address,
    _resources: Address,
    _visible: Bool,
    _logging_on: Bool,
    environment: Address,
    message: Option<LogMessage>,
) -> Option<repr_c::Box<Made>> {
    only_co_simulation("fmi3InstantiateModelExchange", environment, message)
}

/// `fmi3InstantiateScheduledExecution`: none, and the logger is told.
#[ffi_export(rename = "fmi3InstantiateScheduledExecution")]
pub fn instantiate_scheduled_execution(
    _name: Address,
    _token: Address,
    _resources: Address,
    _visible: Bool,
    _logging_on: Bool,
    environment: Address,
    message: Option<LogMessage>,
    _clock_update: Address,
    _lock_preemption: Address,
    _unlock_preemption: Address,
) -> Option<repr_c::Box<Made>> {
    only_co_simulation("fmi3InstantiateScheduledExecution", environment, message)
}

fn only_co_simulation(
    name: &str,
    environment: Address,
    message: Option<LogMessage>,
) -> Option<repr_c::Box<Made>> {
    let log = log(environment, message);
    log.tell(
        Status::Error,
        &format!("{name}: this unit is for co-simulation alone"),
    );
    None
}

/// `fmi3FreeInstance`.
#[ffi_export(rename = "fmi3FreeInstance")]
pub fn free_instance(instance: Option<repr_c::Box<Made>>) {
    // Nobody is left to be told of what goes wrong.
    let _ = caught(|| drop(instance));
}

/// `fmi3EnterInitializationMode`.
#[ffi_export(rename = "fmi3EnterInitializationMode")]
pub fn enter_initialization_mode(
    instance: ComponentAt<'_>,
    _tolerance_defined: Bool,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Bool,
    stop_time: f64,
) -> i32 {
    let stop = (stop_time_defined != 0).then_some(stop_time);
    call(of(instance), "fmi3EnterInitializationMode", |instance| {
        instance.unit.enter_initialization(start_time, stop)
    })
}

/// `fmi3ExitInitializationMode`.
#[ffi_export(rename = "fmi3ExitInitializationMode")]
pub fn exit_initialization_mode(instance: ComponentAt<'_>) -> i32 {
    call(of(instance), "fmi3ExitInitializationMode", |instance| {
        instance.unit.exit_initialization()
    })
}

/// `fmi3Terminate`.
#[ffi_export(rename = "fmi3Terminate")]
pub fn terminate(instance: ComponentAt<'_>) -> i32 {
    call(of(instance), "fmi3Terminate", |instance| {
        instance.unit.terminate()
    })
}

/// `fmi3Reset`.
#[ffi_export(rename = "fmi3Reset")]
pub fn reset(instance: ComponentAt<'_>) -> i32 {
    call(of(instance), "fmi3Reset", |instance| {
        instance.unit.reset();
        Ok(())
    })
}

/// `fmi3DoStep`. The time that was reached is told also where the step failed.
#[ffi_export(rename = "fmi3DoStep")]
pub fn do_step(
    instance: ComponentAt<'_>,
    point: f64,
    step: f64,
    _no_set_state_prior: Bool,
    event_handling_needed: Option<&mut Bool>,
    terminate_simulation: Option<&mut Bool>,
    early_return: Option<&mut Bool>,
    last_successful_time: Option<&mut f64>,
) -> i32 {
    let flags = [event_handling_needed, terminate_simulation, early_return];
    for flag in flags.into_iter().flatten() {
        *flag = 0;
    }
    call(of(instance), "fmi3DoStep", |instance| {
        let done = instance.unit.step(point, step);
        if let Some(time) = last_successful_time {
            *time = instance.unit.time();
        }
        done.map(|_| ())
    })
}
