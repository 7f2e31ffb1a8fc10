//! What is stored through serde comes back; what constructors refuse does not get in.

use compensator::{
    AdaptParameter, Candidates, FeedbackSettings, FeedforwardDrive, LearningSettings,
    ObserverGains, TransferFunctionModel,
};
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
fn models_and_settings_come_back_and_invalid_models_do_not_get_in() {
    let model = TransferFunctionModel::new(1e-4, 1e-6, &[0.99, 0.5], &[1e-5, -2e-5]).unwrap();
    let text = comes_back(&model);
    is_refused::<TransferFunctionModel>(&text, ["0.99", "1.0"], "below 1");
    is_refused::<TransferFunctionModel>(&text, ["0.99,", ""], "as many coefficients");
    is_refused::<TransferFunctionModel>(&text, ["0.0001", "0.0"], "period");
    comes_back(&FeedforwardDrive {
        travel_per_radian: 1.6e-3,
        torque_constant: 1.641,
        period: 1e-4,
    });
    comes_back(&ObserverGains::<f64>::default());
    comes_back(&FeedbackSettings::default());
    comes_back(&Candidates::for_period(1e-4));
    comes_back(&LearningSettings::default());
    assert_eq!(
        comes_back(&AdaptParameter::BristleStiffness),
        "\"bristle-stiffness\""
    );
}
