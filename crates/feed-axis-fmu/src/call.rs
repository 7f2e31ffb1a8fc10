//! What all functions have in common: status, messages, no panic across the border.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use axis_fmu::UnitError;
use safer_ffi::prelude::*;

use crate::instance::Instance;
use crate::status::Status;

/// Does `work` on the instance. What goes wrong is told to its logger, a panic too, after which
/// the instance is of no more use.
pub fn call(
    instance: Option<&mut Instance>,
    name: &str,
    work: impl FnOnce(&mut Instance) -> Result<(), UnitError>,
) -> i32 {
    let Some(instance) = instance else {
        return Status::Error as i32;
    };
    let refused = match caught(|| work(instance)) {
        Ok(Ok(())) => return Status::Ok as i32,
        Ok(Err(error)) => error.to_string(),
        Err(panic) => {
            instance.unit.fail();
            panic
        }
    };
    instance
        .log
        .tell(Status::Error, &format!("{name}: {refused}"));
    Status::Error as i32
}

/// What `work` gives, or the words of its panic.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let words = words(&*panic);
        format!("an error of the library ({words}); please report it")
    })
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_default()
}

/// A string of C as UTF-8; nothing if there is none.
pub fn text(string: Option<char_p::Ref<'_>>) -> String {
    let bytes = string.map(|string| string.to_bytes()).unwrap_or_default();
    String::from_utf8_lossy(bytes).into_owned()
}
