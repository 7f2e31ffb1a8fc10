//! Values of variables: all are of one type, `Float64` or `Real`.

use axis_fmu::UnitError;

use crate::access::Access;
use crate::call::call;
use crate::component::ComponentAt;
use crate::instance::Instance;

/// Addresses of so many value references and values, and whether they are addresses of any.
#[derive(Clone, Copy)]
struct Asked {
    references: *const u32,
    variables: usize,
    values: usize,
    /// Whether the address of the values is one.
    is_there: bool,
}

impl Asked {
    fn of((references, variables): (*const u32, usize), values: usize, is_there: bool) -> Self {
        Self {
            references,
            variables,
            values,
            is_there,
        }
    }
}

/// Does `work` for each variable with its place, up to the first that is refused.
fn each(
    component: ComponentAt<'_>,
    name: &str,
    asked: Asked,
    mut work: impl FnMut(&mut Instance, Access, u32, usize) -> Result<(), UnitError>,
) -> i32 {
    let Some(component) = component else {
        return call(None, name, |_| Ok(()));
    };
    let access = component.access;
    call(Some(&mut component.instance), name, |instance| {
        let Asked {
            references,
            variables,
            values,
            is_there,
        } = asked;
        if variables != values {
            return Err(UnitError::Lengths { variables, values });
        }
        if variables > 0 && (references.is_null() || !is_there) {
            return Err(UnitError::Null("array"));
        }
        (0..variables).try_for_each(|i| {
            let reference = access.reference(references, i);
            work(instance, access, reference, i)
        })
    })
}

/// Reads variables into an array.
pub fn get(
    component: ComponentAt<'_>,
    name: &str,
    asked: (*const u32, usize),
    (array, values): (*mut f64, usize),
) -> i32 {
    let asked = Asked::of(asked, values, !array.is_null());
    each(component, name, asked, |instance, access, reference, i| {
        access.put(array, i, instance.unit.get(reference)?);
        Ok(())
    })
}

/// Sets variables to the numbers of an array.
pub fn set(
    component: ComponentAt<'_>,
    name: &str,
    asked: (*const u32, usize),
    (array, values): (*const f64, usize),
) -> i32 {
    let asked = Asked::of(asked, values, !array.is_null());
    each(component, name, asked, |instance, access, reference, i| {
        instance.unit.set(reference, access.number(array, i))
    })
}
