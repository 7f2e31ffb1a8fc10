//! Functions of what FMI 2.0 offers and this does not: each is there, as the standard asks, returns
//! `fmi2Error` and tells the logger why.

use axis_fmu::UnitError;
use safer_ffi::prelude::*;

use crate::call::call;
use crate::component::{ComponentAt, of};
use crate::status::Address;

/// Never looked at.
type Count = usize;

fn refused(component: ComponentAt<'_>, name: &str, why: &str) -> i32 {
    call(of(component), name, |_| {
        Err(UnitError::Absent(why.to_owned()))
    })
}

/// Functions that are refused whatever they are given.
macro_rules! absent {
    ($($why:literal { $($name:tt $function:ident($($argument:ident: $type:ty),*);)+ })+) => {$($(
        #[doc = concat!("`", $name, "`: ", $why, ".")]
        #[ffi_export(rename = $name)]
        pub fn $function(component: ComponentAt<'_>, $($argument: $type),*) -> i32 {
            let _ = ($($argument,)*);
            refused(component, $name, $why)
        }
    )+)+};
}

/// Values of types that no variable has: fine where none is asked for.
macro_rules! other_types {
    ($($name:tt $function:ident;)+) => {$(
        #[doc = concat!("`", $name, "`: all variables are of type Real.")]
        #[ffi_export(rename = $name)]
        pub fn $function(
            component: ComponentAt<'_>,
            _references: Address,
            count: Count,
            _values: Address,
        ) -> i32 {
            match count {
                0 => call(of(component), $name, |_| Ok(())),
                _ => refused(component, $name, "all variables are of type Real"),
            }
        }
    )+};
}

other_types! {
    "fmi2GetInteger" get_integer;
    "fmi2GetBoolean" get_boolean;
    "fmi2GetString" get_string;
    "fmi2SetInteger" set_integer;
    "fmi2SetBoolean" set_boolean;
    "fmi2SetString" set_string;
}

absent! {
    "there are no derivatives of variables" {
        "fmi2GetDirectionalDerivative" get_directional_derivative(_unknowns: Address, _n_unknowns: Count, _knowns: Address, _n_knowns: Count, _seed: Address, _sensitivity: Address);
        "fmi2GetRealOutputDerivatives" get_real_output_derivatives(_references: Address, _n: Count, _orders: Address, _values: Address);
    }

    "inputs are held over a control cycle (canInterpolateInputs is false)" {
        "fmi2SetRealInputDerivatives" set_real_input_derivatives(_references: Address, _n: Count, _orders: Address, _values: Address);
    }
}
