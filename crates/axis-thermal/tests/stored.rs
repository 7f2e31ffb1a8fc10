//! What is stored through serde comes back; what constructors refuse does not get in.

use axis_thermal::{FittedGrowth, GrowthFit, ThermalModel, ThermalParameters, ThermalUnknown};
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
fn parameters_come_back_and_a_model_checks_them() {
    let parameters = ThermalParameters::default();
    let text = comes_back(&parameters);
    is_refused::<ThermalParameters>(&text, ["\"bodies\"", "\"body\""], "unknown field");
    // Values are checked by what takes them, as those of a program are.
    let damaged = text.replacen("\"capacity\":", "\"capacity\":-", 1);
    let damaged: ThermalParameters = serde_json::from_str(&damaged).unwrap();
    assert!(ThermalModel::new(damaged).is_err());
    comes_back(&GrowthFit::default());
    comes_back(&FittedGrowth {
        parameters,
        factors: vec![(ThermalUnknown::NutShare, 1.1)],
        rms: 0.4,
    });
}
