//! Calls that reach arrays of the environment.

use axis_fmu::UnitError;

use crate::access::Access;
use crate::call::call;
use crate::component::ComponentAt;
use crate::instance::Instance;

/// As [`call`], with what reads and writes single numbers.
pub fn call_with_access(
    component: ComponentAt<'_>,
    name: &str,
    work: impl FnOnce(&mut Instance, Access) -> Result<(), UnitError>,
) -> i32 {
    let Some(component) = component else {
        return call(None, name, |_| Ok(()));
    };
    let access = component.access;
    call(Some(&mut component.instance), name, |instance| {
        work(instance, access)
    })
}
