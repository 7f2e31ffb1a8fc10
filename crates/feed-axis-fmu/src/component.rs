//! What `fmi3Instance`, `fmi2Component` and `fmi2CallbackFunctions` are.

use safer_ffi::prelude::*;

use crate::access::{Access, Lent};
use crate::instance::Instance;
use crate::log::Logger;
use crate::status::{Address, Status};

/// An instance as it is made.
#[derive_ReprC]
#[repr(opaque)]
#[repr(C)]
pub struct Made {
    access: Lent,
    last_step: Status,
    instance: Instance,
}

/// An instance as it comes back from C; of the same layout.
#[derive_ReprC]
#[repr(opaque)]
#[repr(C)]
pub struct Component {
    pub(crate) access: Access,
    /// How the last step ended.
    pub(crate) last_step: Status,
    pub(crate) instance: Instance,
}

const _: () = assert!(size_of::<Made>() == size_of::<Component>());

/// What an exported function is given as `fmi3Instance` or `fmi2Component`.
pub type ComponentAt<'a> = Option<&'a mut Component>;

/// The instance of a component.
pub fn of(component: ComponentAt<'_>) -> Option<&mut Instance> {
    component.map(|component| &mut component.instance)
}

impl Made {
    pub fn of(instance: Instance) -> repr_c::Box<Self> {
        let made = Self {
            access: Lent::ALL,
            last_step: Status::Ok,
            instance,
        };
        Box::new(made).into()
    }
}

/// `fmi2CallbackFunctions`: of all but the logger nothing is used, and the instance keeps a copy.
#[derive_ReprC]
#[repr(opaque)]
#[repr(C)]
pub struct Callbacks {
    pub(crate) logger: Option<Logger>,
    _allocate_memory: Address,
    _free_memory: Address,
    _step_finished: Address,
    pub(crate) environment: Address,
}
