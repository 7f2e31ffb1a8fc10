//! Keys that say which others a file may have.

use crate::freedom::Freedom;
use crate::part::units::*;
use crate::part::{Key, count, quantity, word};
use crate::work::FREQUENCIES;

/// Kinds of the first schema.
pub(super) const SHORT_KINDS: [&str; 2] = ["ball-screw", "rigid-mass"];

/// What tells which keys a file may have.
pub(super) fn first_keys() -> Vec<Key> {
    vec![word("kind", &SHORT_KINDS), count("schema", 1, 2)]
}

/// Keys of the table [control] that are not the controller's.
pub(super) fn loop_keys(freedom: Freedom) -> Vec<Key> {
    let limit = match freedom {
        Freedom::Linear => quantity("following_error_limit", &LENGTH, 1e-6, 10.0),
        Freedom::Rotary => quantity("following_error_limit", &ANGLE, 1e-9, 100.0),
    };
    vec![
        quantity("frequency", &FREQUENCY, FREQUENCIES[0], FREQUENCIES[1]),
        limit.optional(),
        word("gains", &["given", "estimated"]).optional(),
    ]
}
