//! Belts, shafts and springs in series against values by hand.

use feed_dynamics::{BeltStrands, InSeries, Mounting, ScrewShaft, Stiffness};
use std::sync::Arc;

use crate::relative;

#[test]
fn belt_strands_by_hand() {
    // 1 MN for each unit of strain, 0.5 m at x = 0, 2.5 m in all.
    let belt = BeltStrands::new(1e6, 0.5, 2.5).unwrap();
    // 1/0.5 + 1/2; 1/1 + 1/1.5; 1/1.25 + 1/1.25 where they are equal; 1/2 + 1/0.5.
    for (x, by_hand) in [(0.0, 2.5e6), (0.5, 5e6 / 3.0), (0.75, 1.6e6), (1.5, 2.5e6)] {
        assert!(relative(belt.at(x), by_hand) < 1e-15, "{x}: {}", belt.at(x));
    }
    // Least there, and the same as far on either side.
    for away in [1e-3, 0.1, 0.7] {
        assert!(belt.at(0.75 + away) > belt.at(0.75));
        assert!(relative(belt.at(0.75 + away), belt.at(0.75 - away)) < 1e-14);
    }
    // Bounded beyond both ends: a strand of 2.5 mm.
    let bound = 1e6 * (1.0 / 0.0025 + 1.0 / 2.4975);
    for x in [-0.4975, -0.5, -7.0, 2.0, 9.0] {
        assert!(relative(belt.at(x), bound) < 1e-12, "{x}: {}", belt.at(x));
    }
}

#[test]
fn screw_shafts_by_hand() {
    // 40 mm of steel, E A = 259 MN, 1.5 m.
    let rigidity = 206e9 * std::f64::consts::PI * 0.02_f64.powi(2);
    let shaft = |mounting| ScrewShaft::new(rigidity, 1.5, mounting).unwrap();
    let (free, fixed) = (shaft(Mounting::FixedFree), shaft(Mounting::FixedFixed));
    for x in [0.3, 0.75, 1.2] {
        let soft = x / rigidity;
        assert!(relative(free.at(x), 1.0 / soft) < 1e-15);
        assert!(relative(free.compliance(x), soft) < 1e-15);
        let stiff = rigidity * 1.5 / (x * (1.5 - x));
        assert!(relative(fixed.at(x), stiff) < 1e-14);
        // Two springs of its two parts side by side.
        let parts = rigidity / x + rigidity / (1.5 - x);
        assert!(relative(fixed.at(x), parts) < 1e-14);
    }
    assert!(relative(fixed.at(0.75), 4.0 * rigidity / 1.5) < 1e-15);
    // At a rigid bearing nothing gives way, and the stiffness is bounded.
    assert_eq!([free.compliance(0.0), fixed.compliance(1.5)], [0.0, 0.0]);
    for at in [free.at(0.0), free.at(-1.0), fixed.at(0.0), fixed.at(1.5)] {
        assert!(relative(at, 1000.0 * rigidity / 1.5) < 1e-15, "{at}");
    }
    assert!(relative(free.at(0.0016), rigidity / 0.0016) < 1e-15);
    // Beyond the free end it is that of the end.
    assert_eq!(free.at(2.0), free.at(1.5));
}

#[test]
fn bearings_are_in_series_with_their_part_of_the_shaft() {
    let (rigidity, bearing) = (2.5e8, 4e8);
    let on = |mounting| {
        let shaft = ScrewShaft::new(rigidity, 2.0, mounting).unwrap();
        shaft.on_bearings(bearing).unwrap()
    };
    for x in [0.0, 0.5, 1.4, 2.0] {
        let driven = 1.0 / bearing + x / rigidity;
        let far = 1.0 / bearing + (2.0 - x) / rigidity;
        assert!(relative(on(Mounting::FixedFree).at(x), 1.0 / driven) < 1e-15);
        let both = 1.0 / driven + 1.0 / far;
        assert!(relative(on(Mounting::FixedFixed).at(x), both) < 1e-15);
    }
}

#[test]
fn springs_in_series_add_their_compliances() {
    let belt: Arc<dyn Stiffness> = Arc::new(BeltStrands::new(1e6, 0.5, 2.5).unwrap());
    let series = InSeries(vec![belt, Arc::new(4e6), Arc::new(1e6)]);
    // 1/1.6 + 1/4 + 1/1 = 1.875 per MN/m.
    assert!(relative(series.at(0.75), 1e6 / 1.875) < 1e-15);
    assert!(relative(series.at(0.0), 1e6 / (0.4 + 0.25 + 1.0)) < 1e-15);
    assert_eq!(7.5.at(123.0), 7.5);
    // None at all would be rigid, which no elastic drive takes.
    assert_eq!(InSeries(Vec::new()).at(0.0), f64::INFINITY);
}

#[test]
fn bad_numbers_are_refused_by_name() {
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let shaft = |rigidity, length| ScrewShaft::new(rigidity, length, Mounting::FixedFree);
        let on = |bearing| shaft(1e8, 1.0).unwrap().on_bearings(bearing);
        for (error, field) in [
            (
                BeltStrands::new(bad, 0.5, 2.0).unwrap_err(),
                "specific_stiffness",
            ),
            (BeltStrands::new(1e6, bad, 2.0).unwrap_err(), "shortest"),
            (BeltStrands::new(1e6, 0.5, bad).unwrap_err(), "total"),
            (shaft(bad, 1.0).unwrap_err(), "rigidity"),
            (shaft(1e8, bad).unwrap_err(), "length"),
            (on(bad).unwrap_err(), "bearing_stiffness"),
        ] {
            let text = error.to_string();
            assert!(text.starts_with(&format!("{field} = {bad}")), "{text}");
        }
    }
    assert!(BeltStrands::new(1e6, 1.9985, 2.0).is_err());
    assert!(BeltStrands::new(1e6, 0.0015, 2.0).is_err());
}
