//! Logs by a mapping: what is renamed, skipped and refused, in CSV.

use std::fs;

use crate::reading::{REQUIRED, emps, map, mapping, names, without_folder};
use axis_log::{Log, Mapping, read_log};
use proptest::prelude::*;

fn csv(text: &str, mapping: &Mapping, required: &[&str]) -> Result<Log, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    fs::write(&path, text).unwrap();
    read_log(&path, mapping, required).map_err(|e| without_folder(&e.to_string(), folder.path()))
}

#[test]
fn a_mapping_renames_scales_and_shifts() {
    let text = "state,Pos PV,Time,Pos SP,iq_a\nRUN,600.5,0,600,1\nRUN,601,1,601.5,2\n";
    let mut columns = mapping(
        &[("Time", "t_s", 1e-3), ("Pos SP", "position_ref_m", 1e-3)],
        None,
    );
    columns
        .columns
        .push(map("Pos PV", "position_m", 1e-3, -0.5));
    // One source may feed two channels.
    columns
        .columns
        .push(map("Pos PV", "motor_angle_rad", -2.0, 0.0));
    let log = csv(text, &columns, REQUIRED).unwrap();
    assert_eq!(
        names(&log),
        [
            "t_s",
            "position_ref_m",
            "position_m",
            "motor_angle_rad",
            "iq_a"
        ]
    );
    assert_eq!(log.time(), [0.0, 1e-3]);
    assert_eq!(
        log.channel("position_m").unwrap(),
        [1e-3 * 600.5 - 0.5, 1e-3 * 601.0 - 0.5]
    );
    assert_eq!(log.channel("motor_angle_rad").unwrap(), [-1201.0, -1202.0]);
}

#[test]
fn without_a_mapping_columns_with_units_are_taken() {
    let text = "position_m,state,t_s,\n1,RUN,0,\n2,STOP,1,\n";
    let log = csv(text, &Mapping::default(), &["t_s", "position_m"]).unwrap();
    assert_eq!(names(&log), ["t_s", "position_m"]);
}

#[test]
fn a_mapped_source_that_is_absent_leaves_the_channels_own_column() {
    // A simulated log already has the names that the mapping aims at.
    let text = "t_s,position_ref_m,position_m\n0,1,2\n1,2,3\n";
    let log = csv(text, &emps(), REQUIRED).unwrap();
    assert_eq!(names(&log), ["t_s", "position_ref_m", "position_m"]);
    // Where both are there, the mapping counts.
    let text = "t,qm,position_m\n0,1,7\n1,2,8\n";
    let log = csv(text, &emps(), &["position_m"]).unwrap();
    assert_eq!(log.channel("position_m").unwrap(), [1.0, 2.0]);
}

#[test]
fn the_sample_rate_stands_in_for_a_time_column_only() {
    let rate = mapping(&[], Some(4000.0));
    let log = csv("position_m\n5\n6\n7\n", &rate, &["t_s", "position_m"]).unwrap();
    assert_eq!(log.time(), [0.0, 1.0 / 4000.0, 2.0 / 4000.0]);
    let log = csv("position_m,t_s\n5,1\n6,2\n", &rate, &[]).unwrap();
    assert_eq!(log.time(), [1.0, 2.0]);
}

#[test]
fn csv_refusals_name_line_and_column() {
    for (text, expected) in [
        ("", "log.csv: the file is empty"),
        ("t,qg,qm\n", "log.csv: no samples"),
        (
            "t,qg\n0,1\n",
            "log.csv: no column for \"position_m\" (mapped from \"qm\"): the file has \"t\", \"qg\"",
        ),
        (
            "qm,qg\n0,1\n",
            "log.csv: no time: map a column to \"t_s\" or give sample_rate_hz; the file has \"qm\", \"qg\"",
        ),
        (
            "t,qg,qm,qm\n0,1,2,3\n",
            "log.csv: column 3 and column 4 are both named \"qm\"",
        ),
        (
            "t,qg,qm\n0,1\n",
            "log.csv: line 2: 2 fields: the header has 3",
        ),
        (
            "#\nt,qg,qm\n\n0,1,2\n# x\n1,,2\n",
            "log.csv: line 6, column 2 (\"qg\"): the value is missing",
        ),
        (
            "t,qg,qm\n0,1,2\n1,x,2\n",
            "log.csv: line 3, column 2 (\"qg\"): \"x\" is not a number",
        ),
        (
            "t,qg,qm\n0,1,2\n1,2,NaN\n",
            "log.csv: line 3, column 3 (\"qm\"): NaN is not a finite number",
        ),
        (
            "t,qg,qm,vir\n0,1,2,1e308\n",
            "log.csv: line 2, column 4 (\"vir\"): inf is not a finite number",
        ),
        (
            "t,qg,qm\n0,1,2\n0,2,3\n",
            "log.csv: line 3, column 1 (\"t\"): the time 0 s is repeated",
        ),
        (
            "t,qg,qm\n0,1,2\n2,2,3\n\n1,2,3\n",
            "log.csv: line 5, column 1 (\"t\"): the time falls from 2 s to 1 s",
        ),
    ] {
        let found = csv(text, &emps(), REQUIRED).unwrap_err();
        assert!(found.starts_with(expected), "{text:?} gave {found:?}");
    }
}

#[test]
fn mappings_that_make_no_sense_are_refused_before_the_file_is_opened() {
    for (wrong, expected) in [
        (
            mapping(&[("q", "position", 1.0)], None),
            "channel \"position\" (from \"q\") has no known unit",
        ),
        (
            mapping(&[("q", "x_m", 1.0), ("p", "x_m", 1.0)], None),
            "channel \"x_m\" has two sources",
        ),
        (
            mapping(&[("q", "x_m", 0.0)], None),
            "channel \"x_m\": scale is 0",
        ),
        (mapping(&[], Some(-1.0)), "sample_rate_hz is -1"),
    ] {
        let found = read_log("absent.csv", &wrong, &[]).unwrap_err().to_string();
        let expected = format!("absent.csv: mapping: {expected}");
        assert!(found.starts_with(&expected), "{found:?}");
    }
    let mut wrong = emps();
    wrong.columns[0].offset = f64::NAN;
    let found = read_log("absent.csv", &wrong, &[]).unwrap_err().to_string();
    assert!(found.contains("\"t_s\": offset is NaN"), "{found}");
}

#[test]
fn unknown_extensions_and_absent_files_are_named() {
    for (path, expected) in [
        ("absent.xlsx", "absent.xlsx: the extension is \"xlsx\""),
        ("absent", "absent: the name has no extension"),
        ("absent.csv", "absent.csv: cannot read it"),
        #[cfg(feature = "parquet")]
        ("absent.PARQUET", "absent.PARQUET: cannot read it"),
        #[cfg(feature = "mat")]
        ("absent.mat", "absent.mat: cannot read it"),
        #[cfg(not(feature = "parquet"))]
        (
            "absent.parquet",
            "absent.parquet: this program was built without Parquet: save the log as CSV",
        ),
        #[cfg(not(feature = "mat"))]
        (
            "absent.mat",
            "absent.mat: this program was built without MAT: save the log as CSV",
        ),
    ] {
        let found = read_log(path, &Mapping::default(), &[])
            .unwrap_err()
            .to_string();
        assert!(found.starts_with(expected), "{found:?}");
    }
}

proptest! {
    // Each case writes a file.
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_mapping_undoes_its_inverse(
        values in prop::collection::vec(-1e3..1e3f64, 1..40), scale in 1e-6..1e6f64, offset in -1e3..1e3f64,
    ) {
        let mut text = "q\n".to_owned();
        for v in &values {
            text += &format!("{:e}\n", (v - offset) / scale);
        }
        let mapping = Mapping { columns: vec![map("q", "x_m", scale, offset)], sample_rate_hz: Some(1e3) };
        let log = csv(&text, &mapping, &["x_m"]).unwrap();
        for (v, x) in values.iter().zip(log.channel("x_m").unwrap()) {
            // Four roundings of numbers up to 2e3: 4 · 2e3 · 1.1e-16.
            prop_assert!((v - x).abs() < 1e-12, "{v} {x}");
        }
    }

}
