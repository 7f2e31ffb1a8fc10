//! CSV files of moteus controllers.

use axis_log::intake::{Done, Options, prepare};
use axis_log::{Mapping, propose, read_log};

use super::{accepted, copy, data, pairs, plain, refusal};

#[test]
fn answers_of_a_controller_are_read_as_they_are_mapped() {
    let path = data("moteus.csv");
    // The time needs no mapping; nothing else is applied by itself.
    let bare = read_log(&path, &Mapping::default(), &[]).unwrap();
    assert_eq!((bare.channels().len(), bare.len()), (1, 20));
    assert_eq!((bare.time()[0], bare.time()[2]), (0.0013, 0.0199));
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(proposal.format, "moteus (csv_output.py)");
    assert_eq!(
        pairs(&proposal),
        [
            ("POSITION", "motor_angle_rad"),
            ("VELOCITY", "motor_speed_rad_s"),
            ("TORQUE", "torque_n_m"),
            ("Q_CURRENT", "iq_a"),
            ("D_CURRENT", "id_a"),
        ]
    );
    let others = ["MODE", "VOLTAGE", "TEMPERATURE", "FAULT", "0x01a"];
    assert_eq!(proposal.others, others);
    assert!(proposal.caution.contains("uneven"));
    let log = read_log(&path, &accepted(&proposal), &["motor_angle_rad", "iq_a"]).unwrap();
    let tau = std::f64::consts::TAU;
    assert!((log.channel("motor_angle_rad").unwrap()[10] - 0.25 * tau).abs() < 1e-15);
    assert!((log.channel("motor_speed_rad_s").unwrap()[5] - 0.3 * tau).abs() < 1e-15);
    assert_eq!(log.channel("torque_n_m").unwrap()[5], 0.1);
}

/// Mappings from before the file was recognised name the time by its column.
#[test]
fn a_mapping_that_names_the_time_column_stays_valid() {
    let log = read_log(data("moteus.csv"), &plain("time", "t_s"), &[]).unwrap();
    assert_eq!((log.len(), log.time()[0]), (20, 0.0013));
}

#[test]
fn only_names_of_registers_make_it_such_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let is_it = |text: &str| {
        let path = copy(folder.path(), "x.csv", text);
        let format = propose(&path).unwrap().map(|proposal| proposal.format);
        format.is_some_and(|format| format.starts_with("moteus"))
    };
    let row = "0,10,0.5\n";
    assert!(is_it(&format!("time,MODE,POSITION\n{row}")));
    assert!(is_it(&format!("\u{feff}time,MODE,POSITION\r\n{row}")));
    assert!(is_it(&format!("time,POSITION,MODE\n{row}")));
    assert!(is_it("time,MODE,POSITION,SERIAL_NUMBER1,0x1a\n0,1,2,3,4\n"));
    for head in [
        "time,MODE,VELOCITY",
        "time,POSITION,VELOCITY",
        "t,MODE,POSITION",
        "time,MODE,POSITION,",
        "time,MODE,POSITION,iq",
        "time,MODE,POSITION,0xg",
        "time;MODE;POSITION",
        "time, MODE, POSITION",
    ] {
        assert!(!is_it(&format!("{head}\n{row}")), "{head}");
    }
}

#[test]
fn damage_is_refused_with_its_line() {
    let whole = std::fs::read_to_string(data("moteus.csv")).unwrap();
    let mapping = plain("POSITION", "motor_angle_rad");
    for (from, to, expected) in [
        ("0.0199,10,", "0.0199,", "line 4: 10 fields"),
        ("0.0199,10,", "0.0199,10,10,", "line 4: 12 fields"),
        (
            "0.0199,10,0.05",
            "0.0199,10,x",
            "line 4, column 3 (\"POSITION\"): \"x\"",
        ),
        (
            "0.0199,10,0.05",
            "0.0199,10,",
            "line 4, column 3 (\"POSITION\"): the value is missing",
        ),
        (
            "0.0199,10,0.05",
            "0.0199,10,nan",
            "line 4, column 3 (\"POSITION\"): NaN",
        ),
        (
            "0.0199",
            "0.0099",
            "line 4, column 1 (\"t_s\"): the time 0.0099 s is repeated",
        ),
        (
            "0.0199",
            "0.0001",
            "line 4, column 1 (\"t_s\"): the time falls",
        ),
    ] {
        let text = whole.replacen(from, to, 1);
        assert_ne!(text, whole);
        let message = refusal(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {to:?}");
    }
    let empty = refusal("time,MODE,POSITION\n", &mapping);
    assert!(empty.contains("no samples"), "{empty}");
}

/// Stamps of a computer are uneven; the values of this file, which is made by hand, are not. No row
/// is taken for missing.
#[test]
fn uneven_times_are_made_even() {
    let path = data("moteus.csv");
    let mapping = plain("POSITION", "motor_angle_rad");
    let prepared = prepare(&[&path], &mapping, &["motor_angle_rad"], Options::default()).unwrap();
    let log = read_log(&path, &mapping, &[]).unwrap();
    let done = &prepared.done[..];
    assert!(matches!(done, [Done::Evened { .. }]), "{done:?}");
    let values = |log: &axis_log::Log| log.channel("motor_angle_rad").unwrap().to_vec();
    assert_eq!(values(&prepared.log), values(&log));
    let steps = prepared.log.time().windows(2).map(|w| w[1] - w[0]);
    assert!(steps.clone().all(|step| (step - 0.01).abs() < 1e-4));
}
