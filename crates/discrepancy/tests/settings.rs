//! What a search may be asked.

use axis_sim::Axis;
use discrepancy::Settings;

fn machine(name: &str) -> Axis {
    let file = format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}

#[test]
fn settings_that_cannot_be_meant_are_refused() {
    let (rigid, screw) = (machine("emps"), machine("liu2025"));
    let all = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<Vec<_>>();
    let said = |accepted: &[&str], rejected: &[&str], machine: &Axis| {
        let settings = Settings {
            accepted: all(accepted),
            rejected: all(rejected),
            ..Settings::default()
        };
        settings.check(machine).err().map(|e| e.to_string())
    };
    assert_eq!(said(&["backlash"], &[], &screw), None);
    assert_eq!(said(&[], &["backlash"], &rigid), None);
    let no_gap = said(&["backlash"], &[], &rigid).unwrap();
    assert!(no_gap.contains("rigid-mass") && no_gap.contains("coulomb-friction"));
    assert!(!no_gap.contains("lead-error"), "{no_gap}");
    assert!(said(&["warp"], &[], &screw).unwrap().contains("lead-error"));
    assert!(
        said(&["backlash"], &["backlash"], &screw)
            .unwrap()
            .contains("both")
    );
    let five = [
        "backlash",
        "lead-error",
        "torque-ripple",
        "constant-load",
        "payload-mass",
    ];
    assert!(said(&five, &[], &screw).unwrap().contains("at most 4"));
}
