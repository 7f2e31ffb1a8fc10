//! Tables of text as drives and laboratories write them, and what their mapping could be.

use std::fs;

use axis_log::intake::{Options, prepare};
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
        ("Lagesollwert [mm]", Some(("position_ref_m", "mm"))),
        ("Lage Sollwert [mm]", Some(("position_ref_m", "mm"))),
        ("motor speed [rpm]", Some(("motor_speed_rad_s", "rpm"))),
        ("motorPosition [rev]", Some(("motor_angle_rad", "rev"))),
        ("tau_mot", Some(("torque_n_m", "N·m"))),
        ("Kraft in kN", Some(("force_n", "kN"))),
        ("q_deg", Some(("position_rad", "deg"))),
        // Words that are joined, in every order.
        ("Lageistwert", Some(("position_m", "mm"))),
        ("Drehzahlistwert [U/min]", Some(("velocity_rad_s", "rpm"))),
        ("Drehzahlsollwert", Some(("velocity_ref_rad_s", "rpm"))),
        ("Momentensollwert", Some(("torque_ref_n_m", "N·m"))),
        ("Wegist [mm]", Some(("position_m", "mm"))),
        ("xsoll_mm", Some(("position_ref_m", "mm"))),
        ("actpos", Some(("position_m", "mm"))),
        ("Lageabweichung [mm]", None),
        // At the motor.
        ("Motorwinkel [°]", Some(("motor_angle_rad", "deg"))),
        ("Motordrehzahl", Some(("motor_speed_rad_s", "rpm"))),
        ("rotor angle", Some(("motor_angle_rad", "deg"))),
        (
            "motor speed setpoint [rpm]",
            Some(("speed_ref_rad_s", "rpm")),
        ),
        ("Motorwinkelsollwert [°]", None),
        // What should be.
        ("Zielposition", Some(("position_ref_m", "mm"))),
        ("target velocity", Some(("velocity_ref_m_s", "mm/s"))),
        ("Stromvorgabe", Some(("iq_ref_a", "A"))),
        ("consigne de vitesse", Some(("velocity_ref_m_s", "mm/s"))),
        // The current that makes torque, and others.
        ("current q [A]", Some(("iq_a", "A"))),
        ("I_q", Some(("iq_a", "A"))),
        ("torque current", Some(("iq_a", "A"))),
        ("Drehmomentstrom", Some(("iq_a", "A"))),
        ("current d [A]", Some(("id_a", "A"))),
        ("I_d [mA]", Some(("id_a", "mA"))),
        ("Id_ist", Some(("id_a", "A"))),
        ("Stromistwert feldbildend", Some(("id_a", "A"))),
        ("current d ref", None),
        ("id", None),
        ("DC bus current [A]", None),
        ("Strom U [A]", None),
        ("Current position", Some(("position_m", "mm"))),
        // None of these, or of another dimension than the quantity.
        ("following error [mm]", None),
        ("position_m", None),
        ("id_a", None),
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

/// Channel, unit and factor.
type Proposed = (&'static str, &'static str, Option<f64>);

/// The proposal for a column of that name, and what is said of it.
fn proposal_of(name: &str) -> (Vec<Proposed>, String) {
    let folder = tempfile::tempdir().unwrap();
    let row = "1;".repeat(name.matches(';').count() + 1) + "1";
    let text = format!("{name};zzz\n{row}\n");
    let path = write(&folder, "log.csv", text.as_bytes());
    let found = propose(path).unwrap().unwrap();
    let columns = found.columns.iter();
    let columns = columns.map(|c| (c.channel, c.unit, c.factor)).collect();
    (columns, found.remarks.join("\n"))
}

#[test]
fn a_share_of_a_rated_value_is_proposed_in_no_unit() {
    for (name, channel, factor) in [
        ("Moment_%", "torque_n_m", "factor the value in N·m"),
        ("Moment [%]", "torque_n_m", "factor the value in N·m"),
        ("torque_percent", "torque_n_m", "factor the value in N·m"),
        (
            "Sollmoment Prozent",
            "torque_ref_n_m",
            "factor the value in N·m",
        ),
        (
            "Torque 0.1 %",
            "torque_n_m",
            "factor 0.1 times the value in N·m",
        ),
        (
            "Moment [0,1 %]",
            "torque_n_m",
            "factor 0.1 times the value in N·m",
        ),
        ("Kraft [‰]", "force_n", "factor 0.1 times the value in N"),
        (
            "Strom [% In]",
            "iq_a",
            "factor the value in A at 100 % (peak",
        ),
        ("Velocity % 2", "velocity_m_s", "factor the value in m/s"),
    ] {
        let (columns, remarks) = proposal_of(name);
        assert_eq!(columns, [], "{name}");
        for words in [name, channel, factor] {
            assert!(remarks.contains(words), "{words}: {remarks}");
        }
    }
    assert_eq!(proposal_of("override_%"), (vec![], String::new()));
}

#[test]
fn rms_amperes_are_proposed_with_their_factor() {
    let root = std::f64::consts::SQRT_2;
    for (name, channel, unit) in [
        ("iq_rms", "iq_a", "A"),
        ("Strom [Arms]", "iq_a", "A"),
        ("Iq (A_eff)", "iq_a", "A"),
        ("Strom A eff", "iq_a", "A"),
        ("Effektivstrom [mA]", "iq_a", "mA"),
        ("Current [mA RMS]", "iq_a", "mA"),
        ("iq_ref_rms", "iq_ref_a", "A"),
        ("current d (rms)", "id_a", "A"),
    ] {
        let (columns, remarks) = proposal_of(name);
        assert_eq!(columns, [(channel, unit, Some(root))], "{name}");
        assert!(remarks.contains("√2"), "{remarks}");
    }
    // A mean over time is no torque; a column that is no RMS value goes first.
    let (columns, remarks) = proposal_of("torque_rms [Nm]");
    assert!(columns.is_empty() && remarks.contains("RMS"), "{remarks}");
    assert_eq!(proposal_of("iq_rms;iq").0, [("iq_a", "A", None)]);
    // As proposed it reads, and nothing is to be said of it; without the factor there is.
    let folder = tempfile::tempdir().unwrap();
    let path = write(&folder, "log.csv", b"t_s;iq_rms [A]\n0;1\n1;2\n");
    for (scale, is_told) in [(root, false), (1.0, true)] {
        let mapping = Mapping {
            columns: vec![map("iq_rms [A]", "iq_a", scale, 0.0)],
            sample_rate_hz: None,
        };
        let log = prepare(&[&path], &mapping, &[], Options::default()).unwrap();
        assert_eq!(log.log.channel("iq_a").unwrap(), [scale, 2.0 * scale]);
        let told = log
            .done
            .iter()
            .any(|done| done.to_string().contains("states A RMS"));
        assert_eq!(told, is_told);
    }
    let proposal = propose(&path).unwrap().unwrap();
    assert!(
        proposal
            .lines()
            .ends_with("unit = \"A\"\nfactor = 1.4142135623730951\n")
    );
}

/// Lines above the names are none of them; what stands below them has its line number.
#[test]
fn titles_above_the_names_are_passed_over_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let titles = ["Drive trace recorder v3.2", "X-Achse"];
    for (name, text) in [
        ("a.csv", "{0}\n{1}\nt;x;i\n0;600;1\n1;600,5;1\n2;601,25;1\n"),
        (
            "b.csv",
            "{0},,\n\n{1},1 ms,\nt,x,i\n0,600,1\n1,600.5,1\n2,601.25,1\n",
        ),
        (
            "c.txt",
            "{0}\r\n{1}\r\nt\tx\ti\r\nms\tmm\tA\r\n0\t600\t1\r\n1\t600.5\t1\r\n2\t601.25\t1\r\n",
        ),
        ("d.dat", "{0}\n{1}\nt x i\n0 600 1\n1 600.5 1\n2 601.25 1\n"),
        (
            "e.csv",
            "sep=;\n{0}\n\"{1}\nt;x;i\n0;600;1\n1;600,5;\n2;601,25;1\n",
        ),
    ] {
        let text = text.replace("{0}", titles[0]).replace("{1}", titles[1]);
        let path = write(&folder, name, text.as_bytes());
        let log = prepare(&[&path], &mapping("t", "x"), &[], Options::default()).unwrap();
        assert_eq!(log.log.channel("position_m").unwrap(), POSITION, "{name}");
        let told: Vec<String> = log.done.iter().map(ToString::to_string).collect();
        let is_told = |title: &&str| told[0].contains(*title);
        assert!(titles.iter().all(is_told), "{name}: {told:?}");
        assert!(
            columns(&path)
                .unwrap()
                .looks_like
                .contains("2 lines above the names")
        );
        let proposal = propose(&path).unwrap().unwrap();
        let found: Vec<&str> = proposal.columns.iter().map(|c| c.channel).collect();
        assert_eq!(found[..2], ["t_s", "position_m"], "{name}");
    }
    let refused = |text: &str| {
        let path = write(&folder, "log.txt", text.as_bytes());
        let error = read_log(&path, &mapping("t", "x"), &[]).unwrap_err();
        without_folder(&error.to_string(), folder.path()).to_owned()
    };
    assert!(refused("X-Achse\n\nt;x\n0;1\n1;2\n2;3\n3;a\n").contains("line 7, column 2"));
    // Names for some of the fields, with no names below, are no title; nor is anything above
    // a second table.
    for text in ["t;x\n0;1;2\n1;2;3\n", "t;x\n0;1;2\n1;2;3\na;b;c\n0;1;2\n"] {
        assert!(
            refused(text).contains("line 2: 3 fields"),
            "{}",
            refused(text)
        );
    }
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
            factor: c.factor,
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
