//! What is stored through serde comes back; what constructors refuse does not get in.

use crate::paper;
use feed_dynamics::{BeltStrands, FeedDrive, NutCoupling, Observation, RigidDrive};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// That a value comes back as it was, by its debug text: all its fields to the bit.
fn comes_back<T: Serialize + DeserializeOwned + Debug>(value: &T) -> String {
    let text = serde_json::to_string(value).unwrap();
    let back: T = serde_json::from_str(&text).unwrap();
    assert_eq!(format!("{back:?}"), format!("{value:?}"));
    text
}

/// That a text with `from` replaced by `to` is refused with a message that has `part`.
fn is_refused<T: DeserializeOwned + Debug>(text: &str, [from, to]: [&str; 2], part: &str) {
    assert!(text.contains(from), "{text}");
    let message = serde_json::from_str::<T>(&text.replacen(from, to, 1))
        .unwrap_err()
        .to_string();
    assert!(message.contains(part), "{message}");
}

#[test]
fn drives_come_back_and_invalid_ones_do_not_get_in() {
    let drive = FeedDrive::new(paper()).unwrap().left_handed();
    let text = comes_back(&drive);
    let lead = format!("\"lead\":{:?}", drive.parameters().lead);
    is_refused::<FeedDrive>(&text, [&lead, "\"lead\":-0.01"], "lead");
    is_refused::<FeedDrive>(&text, ["\"area\":", "\"area\":-"], "area");
    let back: FeedDrive = serde_json::from_str(&text).unwrap();
    let modes = |drive: &FeedDrive| {
        drive
            .modes(0.4, NutCoupling::MovingNode)
            .unwrap()
            .frequencies_rad_s
    };
    assert_eq!(modes(&back), modes(&drive));
    let text = comes_back(&RigidDrive::new(20.0, 1e-3).unwrap());
    is_refused::<RigidDrive>(&text, ["20.0", "0.0"], "inertia");
    let text = comes_back(&BeltStrands::new(1e6, 0.5, 2.0).unwrap());
    is_refused::<BeltStrands>(&text, ["0.5", "3.5"], "shortest");
    comes_back(&NutCoupling::MovingNode);
    comes_back(&Observation::default());
}
