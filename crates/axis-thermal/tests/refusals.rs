//! What cannot be is refused, in words.

use axis_thermal::{DutySample, ThermalError, ThermalModel, ThermalParameters};

fn refused(change: impl Fn(&mut ThermalParameters)) -> String {
    let mut parameters = ThermalParameters::default();
    change(&mut parameters);
    ThermalModel::new(parameters).unwrap_err().to_string()
}

#[test]
fn numbers_out_of_range_are_named() {
    let screw = |change: fn(&mut axis_thermal::ThermalScrew)| {
        refused(|p| change(p.screw.as_mut().unwrap()))
    };
    for (message, name) in [
        (refused(|p| p.bodies.nut.capacity = 0.0), "nut is 0 J/K"),
        (
            refused(|p| p.links.nut_to_screw = -1.0),
            "nut_to_screw is -1",
        ),
        (refused(|p| p.shares.nut.dry = 0.8), "guides' share of dry"),
        (
            refused(|p| p.shares.front_of_bearings = f64::NAN),
            "front_of_bearings is NaN",
        ),
        (
            refused(|p| p.friction.preload_per_kelvin = 3.0),
            "preload_per_kelvin",
        ),
        (
            refused(|p| p.expansion.scale = 1.0),
            "expansion of the scale",
        ),
        (
            refused(|p| p.reference_temperature = f64::INFINITY),
            "reference_temperature",
        ),
        (screw(|s| s.length = 0.0), "length of the screw"),
        (screw(|s| s.segments = 1), "segments is 1"),
        (screw(|s| s.nut_length = 2.0), "nut_length is 2"),
    ] {
        assert!(
            message.contains(name) && message.contains("valid"),
            "{message}"
        );
    }
}

#[test]
fn a_duty_without_time_or_of_another_screw_is_refused() {
    let model = ThermalModel::new(ThermalParameters::default()).unwrap();
    assert_eq!(
        model.under(&model.duty()).unwrap_err(),
        ThermalError::NoDuration
    );
    let other = ThermalModel::new(ThermalParameters::without_screw()).unwrap();
    let mut duty = other.duty();
    duty.push(&DutySample {
        duration: 1.0,
        ..DutySample::default()
    });
    let error = model.under(&duty).unwrap_err();
    let expected = ThermalError::OtherPlaces {
        found: 1,
        expected: 60,
    };
    assert_eq!(error, expected);
    let at_work = other.under(&duty).unwrap();
    for duration in [-1.0, f64::NAN, 1e12] {
        assert!(
            at_work
                .run(&mut other.at_rest(20.0), 20.0, duration)
                .is_err()
        );
    }
}

/// Wherever the nut is, and however long: shares of the time add up to 1.
#[test]
fn the_nut_is_somewhere() {
    let model = ThermalModel::new(ThermalParameters::default()).unwrap();
    for position in [-10.0, 0.0, 0.0125, 0.7, 1.4999, 99.0] {
        let mut duty = model.duty();
        duty.push(&DutySample {
            duration: 3.0,
            position,
            dry_power: 7.0,
            ..DutySample::default()
        });
        let all: f64 = duty.time_shares().iter().sum();
        assert!((all - 1.0).abs() < 1e-12, "{position}: {all}");
        assert!((duty.friction_power()[0] - 7.0).abs() < 1e-12);
    }
}
