//! Keys of the loop, whatever its controller.

use crate::freedom::Freedom;
use crate::part::units::*;
use crate::part::{Key, quantity, word};
use crate::work::FREQUENCIES;

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
