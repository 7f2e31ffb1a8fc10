//! What `identify-control` refuses.

use crate::common::refuse;

/// Nothing is read or estimated first: no file with such a controller could be written.
#[test]
fn a_controller_that_is_too_slow_for_the_current_is_not_looked_for() {
    let axis = "data/axes/linear-motor.toml";
    let logs = [
        "--fit",
        "fit.csv",
        "--check",
        "check.csv",
        "--out",
        "axis.toml",
    ];
    let slow = ["identify-control", "--axis", axis, "--frequency-hz", "2000"];
    let message = refuse(&[&slow[..], &logs].concat());
    for part in [
        axis,
        "2000 Hz",
        "current_d_proportional = 90 V/A",
        "less than",
    ] {
        assert!(message.contains(part), "{message}");
    }
}
