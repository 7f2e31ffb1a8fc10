//! Each pair of kinds of axis on a small circle: it runs, or one sentence says why not.

use axis_machine::{CoupledMachine, Lap};
use axis_sim::Axis;

use crate::coupled::{bare, circle};

/// An axis file of each kind of mechanism that moves along a line; of the linear motor one with currents and one that takes a force.
const KINDS: [&str; 7] = [
    "liu2025-y",
    "screw-datasheet",
    "rack",
    "belt",
    "linear-motor",
    "linear-stage",
    "emps",
];

const RADIUS: f64 = 2e-3;

fn axis(name: &str) -> Axis {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes");
    Axis::read(format!("{folder}/{name}.toml").as_ref()).unwrap()
}

/// The truth of a circle is its closed form: the distance from the centre less the radius.
#[test]
fn every_pair_of_kinds_runs_a_circle() {
    let axes = KINDS.map(axis);
    let (profile, counted) = circle(RADIUS, 0.02);
    for (i, x) in axes.iter().enumerate() {
        for y in &axes[i..] {
            let name = format!("{} and {}", x.name, y.name);
            let machine = CoupledMachine::new([x, y]).unwrap_or_else(|e| panic!("{name}: {e}"));
            let lap: Lap<2> = bare(&machine, &profile, None);
            let feet = lap.traced.contour_error_between(counted);
            let positions = lap.traced.between(counted);
            let mut worst = 0.0_f64;
            for (foot, [u, v]) in feet.zip(positions) {
                let radial = (u.hypot(*v) - RADIUS).abs();
                assert!((foot.length() - radial).abs() < 1e-12, "{name}: {radial}");
                worst = worst.max(radial);
            }
            // Measured: 6 to 580 µm.
            assert!((1e-6..1e-3).contains(&worst), "{name}: {worst}");
        }
    }
}

#[test]
fn a_pair_that_cannot_run_is_refused_in_one_sentence() {
    let pair = |x: &str, y: &str| {
        let (x, y) = (axis(x), axis(y));
        CoupledMachine::new([&x, &y]).unwrap_err().to_string()
    };
    let message = pair("liu2025-y", "rotary-table");
    assert_eq!(
        message,
        "the load of axis 2 (from 1) turns; valid: an axis that moves along a line"
    );
    let message = pair("rack-push", "linear-stage");
    assert!(
        message.starts_with("axis 1 (from 1): this axis has no [control]"),
        "{message}"
    );
}
