//! What is stored through serde comes back; what constructors refuse does not get in.

use frequency_response::{Averaging, Excitation, FitSettings, ModalFit, Multisine};
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
fn fits_come_back_and_damaged_ones_do_not_get_in() {
    let fit = crate::fits::fit_without_noise(crate::machine::Machine::default());
    let text = comes_back(&fit);
    let back: ModalFit = serde_json::from_str(&text).unwrap();
    for frequency in [3.0, 40.0, 120.0] {
        assert_eq!(back.at(frequency), fit.at(frequency));
    }
    is_refused::<ModalFit>(&text, ["\"pairs\":1", "\"pairs\":7"], "as many as modes");
    is_refused::<ModalFit>(
        &text,
        ["\"values\":[", "\"values\":[1.0,"],
        "two for each real pole",
    );
    is_refused::<ModalFit>(&text, ["\"scale\":", "\"scale\":-"], "above 0 rad/s");
    // Modes that are not those of the parameters.
    for key in ["frequency_hz", "damping", "rate", "delay_s"] {
        let from = format!("\"{key}\":{{\"value\":");
        let to = format!("{from}1");
        let message = "valid: that of the parameters";
        is_refused::<ModalFit>(&text, [&from, &to], message);
    }
    is_refused::<ModalFit>(
        &text,
        ["\"residue\":[", "\"residue\":[1"],
        "valid: that of the parameters",
    );
    comes_back(&Excitation::Multisine(Multisine {
        amplitude: 1.0,
        period: 1000,
        from_hz: 5.0,
        to_hz: 500.0,
        ratio: 1.1,
        seed: 3,
    }));
    comes_back(&Averaging::Periods {
        period: 100,
        skip: 1,
    });
    comes_back(&FitSettings::default());
}
