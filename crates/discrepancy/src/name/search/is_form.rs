//! Effects that are forms of others.

use axis_sim::effects::{ActiveEffect, FrictionForm};

/// Whether an active effect is a form of another.
pub(crate) fn is_form(active: &ActiveEffect) -> bool {
    FrictionForm::of(active).is_some()
}
