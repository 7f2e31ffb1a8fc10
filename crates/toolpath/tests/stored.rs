//! What is stored through serde comes back; what constructors refuse does not get in.

use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;
use toolpath::named::{CircleTest, Direction};
use toolpath::{Blend, FeedLimits, Nurbs, NurbsData, PathBlending};

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
fn limits_and_curves_come_back_and_invalid_ones_do_not_get_in() {
    let limits = FeedLimits {
        feed: 0.1,
        velocity: [0.5, 0.25],
        acceleration: [5.0; 2],
        jerk: [100.0; 2],
        acceleration_step: [0.0; 2],
    };
    let text = comes_back(&limits);
    is_refused::<FeedLimits<2>>(&text, ["0.25", "-0.25"], "velocity");
    is_refused::<FeedLimits<2>>(&text, ["0.25", "0.25,0.5"], "2, one for each axis");
    is_refused::<FeedLimits<3>>(&text, ["0.25", "0.25"], "3, one for each axis");
    let data = NurbsData {
        degree: 2,
        points: vec![[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        weights: vec![1.0, 0.5_f64.sqrt(), 1.0],
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    };
    let text = comes_back(&data);
    is_refused::<NurbsData<2>>(&text, ["[1.0,1.0]", "[1.0]"], "2, one for each axis");
    let back: NurbsData<2> = serde_json::from_str(&text).unwrap();
    assert!(Nurbs::new(&back).is_ok());
    comes_back(&PathBlending {
        tolerance: 1e-5,
        shape: Blend::Quintic,
    });
    comes_back(&CircleTest {
        centre: [0.0; 2],
        radius: 0.1,
        start: 0.0,
        direction: Direction::Counterclockwise,
        run_in: 0.5,
        turns: 1.0,
        run_out: 0.5,
    });
}
