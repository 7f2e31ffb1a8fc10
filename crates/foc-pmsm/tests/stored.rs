//! What is stored through serde comes back; what constructors refuse does not get in.

use foc_pmsm::svpwm::Overmodulation;
use foc_pmsm::{AntiWindup, CurrentGains, Dq, MotorParameters, PiParameters, Pmsm};
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
fn motors_and_settings_come_back_and_invalid_motors_do_not_get_in() {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: 0.36,
        inductance_d: 1.4e-3,
        inductance_q: 1.9e-3,
        flux_linkage: 0.18,
    };
    let motor = Pmsm::new(parameters).unwrap();
    let text = comes_back(&motor);
    assert_eq!(text, comes_back(&parameters));
    is_refused::<Pmsm>(&text, ["0.36", "-0.36"], "resistance");
    is_refused::<Pmsm>(&text, ["0.18", "-0.18"], "flux_linkage");
    is_refused::<Pmsm>(&text, ["pole_pairs\":4", "pole_pairs\":0"], "pole_pairs");
    let reluctance = Pmsm::reluctance(MotorParameters {
        flux_linkage: 0.0,
        ..parameters
    })
    .unwrap();
    comes_back(&reluctance);
    comes_back(
        &Pmsm::<f32>::new(MotorParameters {
            pole_pairs: 1,
            resistance: 0.1,
            inductance_d: 1e-3,
            inductance_q: 1e-3,
            flux_linkage: 0.1,
        })
        .unwrap(),
    );
    comes_back(&CurrentGains {
        kp: Dq { d: 1.0, q: 2.0 },
        ..CurrentGains::default()
    });
    comes_back(&PiParameters {
        kp: 1.0,
        ki: 20.0,
        limit: 5.0,
        period: 1e-4,
    });
    comes_back(&AntiWindup::BackCalculation {
        tracking_time: 0.01,
    });
    assert_eq!(comes_back(&Overmodulation::SixStep), "\"six-step\"");
}
