//! The functions of `fmi2Functions.h` for co-simulation.

mod absent;
mod access;
mod component;
mod lifecycle;
mod states;
mod status;
mod values;

use self::component::Component;
use crate::instance::Instance;

/// `fmi2Boolean`.
type Bool = i32;

/// What an exported function is given as `fmi2Component`.
type ComponentAt<'a> = Option<&'a mut Component>;

/// The instance of a component.
fn of(component: ComponentAt<'_>) -> Option<&mut Instance> {
    component.map(|component| &mut component.instance)
}
