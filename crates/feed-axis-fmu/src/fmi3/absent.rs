//! Functions of what FMI offers and this does not: each is there, as the standard asks, returns
//! `fmi3Error` and tells the logger why.

use axis_fmu::UnitError;
use safer_ffi::prelude::*;

use super::Bool;
use crate::call::call;
use crate::component::{ComponentAt, of};
use crate::status::Address;

/// Never looked at.
type Count = usize;

fn refused(instance: ComponentAt<'_>, name: &str, why: &str) -> i32 {
    call(of(instance), name, |_| {
        Err(UnitError::Absent(why.to_owned()))
    })
}

/// Functions that are refused whatever they are given.
macro_rules! absent {
    ($($why:literal { $($name:tt $function:ident($($argument:ident: $type:ty),*);)+ })+) => {$($(
        #[doc = concat!("`", $name, "`: ", $why, ".")]
        #[ffi_export(rename = $name)]
        pub fn $function(instance: ComponentAt<'_>, $($argument: $type),*) -> i32 {
            let _ = ($($argument,)*);
            refused(instance, $name, $why)
        }
    )+)+};
}

/// Values of types that no variable has: fine where none is asked for.
macro_rules! other_types {
    ($($name:tt $function:ident($($argument:ident: $type:ty),*);)+) => {$(
        #[doc = concat!("`", $name, "`: all variables are of type Float64.")]
        #[ffi_export(rename = $name)]
        pub fn $function(
            instance: ComponentAt<'_>,
            _references: Address,
            count: Count,
            $($argument: $type),*
        ) -> i32 {
            let _ = ($($argument,)*);
            match count {
                0 => call(of(instance), $name, |_| Ok(())),
                _ => refused(instance, $name, "all variables are of type Float64"),
            }
        }
    )+};
}

other_types! {
    "fmi3GetFloat32" get_float32(_values: Address, _n: Count);
    "fmi3GetInt8" get_int8(_values: Address, _n: Count);
    "fmi3GetUInt8" get_uint8(_values: Address, _n: Count);
    "fmi3GetInt16" get_int16(_values: Address, _n: Count);
    "fmi3GetUInt16" get_uint16(_values: Address, _n: Count);
    "fmi3GetInt32" get_int32(_values: Address, _n: Count);
    "fmi3GetUInt32" get_uint32(_values: Address, _n: Count);
    "fmi3GetInt64" get_int64(_values: Address, _n: Count);
    "fmi3GetUInt64" get_uint64(_values: Address, _n: Count);
    "fmi3GetBoolean" get_boolean(_values: Address, _n: Count);
    "fmi3GetString" get_string(_values: Address, _n: Count);
    "fmi3GetBinary" get_binary(_sizes: Address, _values: Address, _n: Count);
    "fmi3GetClock" get_clock(_values: Address);
    "fmi3SetFloat32" set_float32(_values: Address, _n: Count);
    "fmi3SetInt8" set_int8(_values: Address, _n: Count);
    "fmi3SetUInt8" set_uint8(_values: Address, _n: Count);
    "fmi3SetInt16" set_int16(_values: Address, _n: Count);
    "fmi3SetUInt16" set_uint16(_values: Address, _n: Count);
    "fmi3SetInt32" set_int32(_values: Address, _n: Count);
    "fmi3SetUInt32" set_uint32(_values: Address, _n: Count);
    "fmi3SetInt64" set_int64(_values: Address, _n: Count);
    "fmi3SetUInt64" set_uint64(_values: Address, _n: Count);
    "fmi3SetBoolean" set_boolean(_values: Address, _n: Count);
    "fmi3SetString" set_string(_values: Address, _n: Count);
    "fmi3SetBinary" set_binary(_sizes: Address, _values: Address, _n: Count);
    "fmi3SetClock" set_clock(_values: Address);
    "fmi3GetIntervalDecimal" get_interval_decimal(_intervals: Address, _qualifiers: Address);
    "fmi3GetIntervalFraction" get_interval_fraction(_counters: Address, _resolutions: Address, _qualifiers: Address);
    "fmi3GetShiftDecimal" get_shift_decimal(_shifts: Address);
    "fmi3GetShiftFraction" get_shift_fraction(_counters: Address, _resolutions: Address);
    "fmi3SetIntervalDecimal" set_interval_decimal(_intervals: Address);
    "fmi3SetIntervalFraction" set_interval_fraction(_counters: Address, _resolutions: Address);
    "fmi3SetShiftDecimal" set_shift_decimal(_shifts: Address);
    "fmi3SetShiftFraction" set_shift_fraction(_counters: Address, _resolutions: Address);
}

absent! {
    "there is no event mode (hasEventMode is false)" {
        "fmi3EnterEventMode" enter_event_mode();
        "fmi3EnterStepMode" enter_step_mode();
        "fmi3EvaluateDiscreteStates" evaluate_discrete_states();
        "fmi3UpdateDiscreteStates" update_discrete_states(_update: Address, _terminate: Address, _nominals: Address, _values: Address, _defined: Address, _time: Address);
    }

    "there are no structural parameters" {
        "fmi3EnterConfigurationMode" enter_configuration_mode();
        "fmi3ExitConfigurationMode" exit_configuration_mode();
    }

    "there are no dependencies of elements (providesPerElementDependencies is false)" {
        "fmi3GetNumberOfVariableDependencies" get_number_of_variable_dependencies(_reference: u32, _n: Address);
        "fmi3GetVariableDependencies" get_variable_dependencies(_dependent: u32, _of_dependent: Address, _independents: Address, _of_independents: Address, _kinds: Address, _n: Count);
    }

    "there are no derivatives of variables" {
        "fmi3GetDirectionalDerivative" get_directional_derivative(_unknowns: Address, _n_unknowns: Count, _knowns: Address, _n_knowns: Count, _seed: Address, _n_seed: Count, _sensitivity: Address, _n: Count);
        "fmi3GetAdjointDerivative" get_adjoint_derivative(_unknowns: Address, _n_unknowns: Count, _knowns: Address, _n_knowns: Count, _seed: Address, _n_seed: Count, _sensitivity: Address, _n: Count);
        "fmi3GetOutputDerivatives" get_output_derivatives(_references: Address, _n_references: Count, _orders: Address, _values: Address, _n: Count);
    }

    "this unit is for co-simulation alone" {
        "fmi3EnterContinuousTimeMode" enter_continuous_time_mode();
        "fmi3CompletedIntegratorStep" completed_integrator_step(_no_set_prior: Bool, _event_mode: Address, _terminate: Address);
        "fmi3SetTime" set_time(_time: f64);
        "fmi3SetContinuousStates" set_continuous_states(_states: Address, _n: Count);
        "fmi3GetContinuousStateDerivatives" get_continuous_state_derivatives(_derivatives: Address, _n: Count);
        "fmi3GetEventIndicators" get_event_indicators(_indicators: Address, _n: Count);
        "fmi3GetContinuousStates" get_continuous_states(_states: Address, _n: Count);
        "fmi3GetNominalsOfContinuousStates" get_nominals_of_continuous_states(_nominals: Address, _n: Count);
        "fmi3GetNumberOfEventIndicators" get_number_of_event_indicators(_n: Address);
        "fmi3GetNumberOfContinuousStates" get_number_of_continuous_states(_n: Address);
        "fmi3ActivateModelPartition" activate_model_partition(_clock: u32, _time: f64);
    }
}
