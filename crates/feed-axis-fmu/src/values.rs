//! Values of variables: all are of one type, `Float64` or `Real`.

use axis_fmu::UnitError;

use crate::access::Access;
use crate::arrays::call_with_access;
use crate::component::ComponentAt;
use crate::instance::Instance;

/// Does `work` for each variable with its place, up to the first that is refused. `is_there` says whether there are addresses of values.
fn each(
    component: ComponentAt<'_>,
    name: &str,
    (references, variables): (*const u32, usize),
    (values, is_there): (usize, bool),
    mut work: impl FnMut(&mut Instance, Access, u32, usize) -> Result<(), UnitError>,
) -> i32 {
    call_with_access(component, name, |instance, access| {
        if variables != values {
            return Err(UnitError::Lengths { variables, values });
        }
        if variables > 0 && (references.is_null() || !is_there) {
            return Err(UnitError::Null("array"));
        }
        (0..variables).try_for_each(|i| work(instance, access, access.reference(references, i), i))
    })
}

/// Reads variables into an array.
pub fn get(
    component: ComponentAt<'_>,
    name: &str,
    asked: (*const u32, usize),
    (array, count): (*mut f64, usize),
) -> i32 {
    let room = (count, !array.is_null());
    each(component, name, asked, room, |instance, access, one, i| {
        access.put(array, i, instance.unit.get(one)?);
        Ok(())
    })
}

/// Sets variables to the numbers of an array.
pub fn set(
    component: ComponentAt<'_>,
    name: &str,
    asked: (*const u32, usize),
    (array, count): (*const f64, usize),
) -> i32 {
    let room = (count, !array.is_null());
    each(component, name, asked, room, |instance, access, one, i| {
        instance.unit.set(one, access.number(array, i))
    })
}
