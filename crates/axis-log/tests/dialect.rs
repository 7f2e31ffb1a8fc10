//! Tables of text as drives and laboratories write them, and what their mapping could be.

use std::fs;

use axis_log::{Mapping, columns, propose, read_log};

use crate::reading::{map, without_folder};

const POSITION: &[f64] = &[600.0, 600.5, 601.25];

fn write(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> std::path::PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// Time in ms, position in mm.
fn mapping(time: &str, position: &str) -> Mapping {
    let columns = vec![
        map(time, "t_s", 1e-3, 0.0),
        map(position, "position_m", 1.0, 0.0),
    ];
    Mapping {
        columns,
        sample_rate_hz: None,
    }
}

#[test]
fn what_stands_between_fields_and_before_decimals_is_told_from_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let utf16: Vec<u8> = "\u{feff}t;x\r\n0;600\r\n1;600,5\r\n2;601,25\r\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let texts: &[(&str, &[u8])] = &[
        ("comma.csv", b"t,x\n0,600\n1,600.5\n2,601.25\n"),
        ("semicolon.csv", b"t;x\n0;600\n1;600.5\n2;601.25\n"),
        (
            "decimal-comma.csv",
            b"t;x\r\n0;600\r\n1;600,5\r\n2;601,25\r\n",
        ),
        ("tab.tsv", b"t\tx\n0\t600\n1\t600.5\n2\t601.25\n"),
        ("tab.txt", b"t\tx\n0\t6,000e2\n1\t600,5\n2\t601,25\n"),
        (
            "blanks.dat",
            b"  t      x\n  0  600.0\n  1  600.5\n  2  601.25\n",
        ),
        ("numpy.txt", b"# t x\n0 600\n1 600.5\n2 601.25\n"),
        (
            "numpy-comma.csv",
            b"# made today\n# t,x\n0,600\n1,600.5\n2,601.25\n",
        ),
        (
            "stray.csv",
            b"t,x,\"a; b\"\n0,600,1\n1,600.5,1\n2,601.25,1\n",
        ),
        ("end.csv", b"t;x\n0;600;\n1;600,5;\n2;601,25;\n"),
        (
            "units.csv",
            b"t;x;state\n[ms];[mm];-\n0;600;a\n1;600,5;b\n2;601,25;b\n",
        ),
        ("latin.csv", b"t;x;\xb0C\n0;600;1\n1;600,5;1\n2;601,25;1\n"),
        ("wide.csv", &utf16),
    ];
    for (name, bytes) in texts {
        let log = read_log(
            write(&folder, name, bytes),
            &mapping("t", "x"),
            &["position_m"],
        );
        let log = log.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(log.time(), [0.0, 1e-3, 2e-3], "{name}");
        assert_eq!(log.channel("position_m").unwrap(), POSITION, "{name}");
    }
}

#[test]
fn numbers_that_could_mean_two_things_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    for (text, expected) in [
        // Thousands are grouped.
        (
            "t;x\n0;999.5\n1;1,000.5\n",
            "line 3, column 2 (\"x\"): \"1,000.5\" is not a number",
        ),
        (
            "t;x\n0;999.5\n1;1,000\n",
            "line 3, column 2 (\"x\"): \"1,000\" is not a number",
        ),
        (
            "t;x\n0;1,5\n1;1.5\n",
            "line 3, column 2 (\"x\"): \"1.5\" is not a number",
        ),
        (
            "t;x\n0;1,000,000\n",
            "line 2, column 2 (\"x\"): \"1,000,000\" is not a number",
        ),
        (
            "t;x\n[ms];[mm]\n0;1\n1;a\n",
            "line 4, column 2 (\"x\"): \"a\" is not a number",
        ),
        (
            "t x\n0 1\n\n1 a\n",
            "line 4, column 2 (\"x\"): \"a\" is not a number",
        ),
        // A second line without a known unit is a row.
        (
            "t;x\nab;cd\n0;1\n",
            "line 2, column 1 (\"t\"): \"ab\" is not a number",
        ),
    ] {
        let path = write(&folder, "log.txt", text.as_bytes());
        let found = read_log(&path, &mapping("t", "x"), &[])
            .unwrap_err()
            .to_string();
        let found = without_folder(&found, folder.path());
        assert_eq!(
            found.strip_prefix("log.txt: ").unwrap_or(&found)[..expected.len()],
            *expected
        );
    }
}

#[test]
fn a_mapping_is_proposed_by_names_and_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let proposed = |header: &str| {
        let path = write(&folder, "log.csv", format!("{header}\n").as_bytes());
        let found = propose(path).unwrap().unwrap();
        let columns = found.columns.into_iter();
        columns
            .map(|c| (c.source, c.channel, c.unit))
            .collect::<Vec<_>>()
    };
    for (name, expected) in [
        ("t", Some(("t_s", "s"))),
        ("Time [ms]", Some(("t_s", "ms"))),
        ("t_ms", Some(("t_s", "ms"))),
        ("Zeit / s", Some(("t_s", "s"))),
        ("DES_POS|1", Some(("position_ref_m", "mm"))),
        ("ENC_POS|1", Some(("position_m", "mm"))),
        ("CURRENT|1", Some(("iq_a", "A"))),
        ("X1_CommandPosition", Some(("position_ref_m", "mm"))),
        ("X1_ActualVelocity", Some(("velocity_m_s", "mm/s"))),
        ("ActPos (deg)", Some(("position_rad", "deg"))),
        ("Lagesollwert [mm]", None), // a compound that no word list has
        ("Lage Sollwert [mm]", Some(("position_ref_m", "mm"))),
        ("motor speed [rpm]", Some(("motor_speed_rad_s", "rpm"))),
        ("motorPosition [rev]", Some(("motor_angle_rad", "rev"))),
        ("tau_mot", Some(("torque_n_m", "N·m"))),
        ("Kraft in kN", Some(("force_n", "kN"))),
        ("q_deg", Some(("position_rad", "deg"))),
        // None of these, or of another dimension than the quantity.
        ("following error [mm]", None),
        ("position_m", None),
        ("torque [mm]", None),
        ("position [parsec]", None),
        ("temperature", None),
    ] {
        let expected = expected.map(|(channel, unit)| (name.to_owned(), channel, unit));
        // Beside a column that nothing is known of, so that there is a proposal.
        let found = proposed(&format!("{name};zzz"));
        assert_eq!(found, Vec::from_iter(expected), "{name}");
    }
    // The first of two axes; the unit of the line below counts.
    let found = proposed("t;Pos 1;Pos 2\ns;µm;µm");
    let expected = [("t", "t_s", "s"), ("Pos 1", "position_m", "µm")];
    let found: Vec<_> = found.iter().map(|(s, c, u)| (s.as_str(), *c, *u)).collect();
    assert_eq!(found.len(), 2);
    assert_eq!(found[0], expected[0]);
    assert_eq!((found[1].0, found[1].1), ("Pos 1", "position_m"));
}

/// What is proposed reads.
#[test]
fn a_proposal_is_a_mapping() {
    use axis_log::{ColumnMap, ColumnUnit};
    let folder = tempfile::tempdir().unwrap();
    let path = write(
        &folder,
        "log.csv",
        b"Time [ms];x [mm]\n0;600\n1;600,5\n2;601,25\n",
    );
    let found = propose(&path).unwrap().unwrap();
    let column = |c: &axis_log::ProposedColumn| {
        let unit = ColumnUnit {
            unit: Some(c.unit),
            ..Default::default()
        };
        ColumnMap::in_unit(&c.source, c.channel, unit).unwrap()
    };
    let mapping = Mapping {
        columns: found.columns.iter().map(column).collect(),
        sample_rate_hz: None,
    };
    let log = read_log(&path, &mapping, &["position_m"]).unwrap();
    assert_eq!(log.time(), [0.0, 1e-3, 2e-3]);
    assert!((log.channel("position_m").unwrap()[2] - 0.601_25).abs() < 1e-15);
}

#[test]
fn columns_are_shown_before_anything_is_known_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let text = "a;b;state;c\n;mm;;\n1;0,5;RUN;\n2;1,5;RUN;\n6;;STOP;\n";
    let found = columns(write(&folder, "log.txt", text.as_bytes())).unwrap();
    assert_eq!((found.rows, found.all_columns), (3, 4));
    let found = found.columns;
    let told: Vec<_> = found
        .iter()
        .map(|c| (c.name.as_str(), c.unit.as_deref(), c.numbers))
        .collect();
    assert_eq!(told, [("a", None, 3), ("b", Some("mm"), 2)]);
    assert_eq!(
        (found[0].least, found[0].greatest, found[0].mean),
        (1.0, 6.0, 3.0)
    );
    assert_eq!(
        (found[1].least, found[1].greatest, found[1].mean),
        (0.5, 1.5, 1.0)
    );
}
