//! What is stored through serde comes back; what constructors refuse does not get in.

use axis_rating::motor::TorqueCurve;
use axis_rating::screw::{ScrewMounting, ScrewStrength};
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
fn data_sheets_come_back_and_invalid_curves_do_not_get_in() {
    let curve = TorqueCurve::new(vec![[0.0, 5.0], [300.0, 4.5], [400.0, 0.0]]).unwrap();
    let text = comes_back(&curve);
    assert_eq!(text, "[[0.0,5.0],[300.0,4.5],[400.0,0.0]]");
    is_refused::<TorqueCurve>(&text, ["300.0", "500.0"], "speeds that do not rise");
    is_refused::<TorqueCurve>(&text, ["4.5", "-4.5"], "below 0");
    comes_back(&ScrewStrength {
        root_diameter_m: 0.02,
        youngs_modulus_pa: 2.06e11,
        density_kg_per_m3: 7850.0,
        mounting: ScrewMounting::FixedSupported,
    });
}
