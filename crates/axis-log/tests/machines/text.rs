//! Text: what stands before, between and behind the numbers.

use std::fmt::Write as _;

use axis_log::{ColumnMap, ColumnUnit, Mapping, read_log};

use super::{assert_near, given, rate, told};
use crate::reading::mapping;

const PINS: [&str; 2] = ["joint.1.motor-pos-cmd", "joint.1.motor-pos-fb"];

/// Command in mm, and the feedback a tenth behind.
fn command(k: usize) -> f64 {
    20.0 * (0.004 * k as f64).sin()
}

fn lines(unit: &str, comma: bool) -> String {
    let mut text = format!("Sampling period is 500000 {unit}\n");
    for k in 0..401 {
        // One line more than there are samples.
        let at = if k < 400 { command(k) } else { -999.0 };
        let [a, b] = PINS;
        let line = format!("\n{a} {at:+.14} {b} {:+.14} {a} {at:+.14} ", at - 0.1);
        text += &if comma {
            line.replace("+0.", "+0,")
                .replace('.', ",")
                .replace("joint,1,", "joint.1.")
        } else {
            line
        };
    }
    text
}

fn table(screen: &str, comma: bool) -> String {
    let mut text = format!(
        "# Sampling period is 500000 ns\n{}\n{screen}",
        PINS.join(";")
    );
    for k in 0..400 {
        let line = format!("{:.14};{:.14}\n", command(k), command(k) - 0.1);
        text += &if comma { line.replace('.', ",") } else { line };
    }
    text
}

#[test]
fn captures_of_every_release_of_halscope_are_read() {
    let screen = "# Position: 0.500000;0.500000\n# Scale: 3;-2\n";
    let texts = [
        ("2.6", lines("ns", false)),
        ("2.8", lines("nSec ", false)),
        ("2.8, German", lines("nSec ", true)),
        ("2.9", table("", false)),
        ("2.9, German", table("", true)),
        ("2.10", table(screen, false)),
    ];
    for (release, text) in texts {
        let log = given("scope.log", &text).accepted();
        assert_eq!(log.log.len(), 400, "{release}");
        assert!((rate(&log) - 2000.0).abs() < 1e-6, "{release}");
        for (channel, off) in [("position_ref_m", 0.0), ("position_m", 0.1)] {
            let found = log.log.channel(channel).unwrap();
            assert_near(found, |k| 1e-3 * (command(k) - off), 1e-15);
        }
    }
    // A pin that is there twice is two columns.
    let others = given("scope.log", lines("ns", false)).proposal().others;
    assert_eq!(others, ["joint.1.motor-pos-cmd (2)"]);
}

#[test]
fn a_table_is_read_whatever_its_encoding_line_ends_and_first_line() {
    let text = "t_s;position_m\n0;0,5\n0,01;0,25\n0,02;-0,125\n";
    let wide = |unit: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
        let text = format!("{mark}{text}");
        text.encode_utf16().flat_map(unit).collect()
    };
    let files: Vec<(&str, Vec<u8>)> = vec![
        ("plain", text.into()),
        ("byte-order mark", format!("\u{feff}{text}").into()),
        ("returns", text.replace('\n', "\r").into()),
        ("both", text.replace('\n', "\r\n").into()),
        ("no last line end", text.trim_end().into()),
        ("UTF-16, small end", wide(u16::to_le_bytes, "\u{feff}")),
        ("UTF-16, great end", wide(u16::to_be_bytes, "\u{feff}")),
        ("UTF-16 without mark", wide(u16::to_le_bytes, "")),
        ("Excel", format!("sep=;\n{text}").into()),
        ("Excel, quoted", format!("\"SEP=;\"\r\n{text}").into()),
        (
            "Excel, tabs",
            format!("sep=\t\n{}", text.replace(';', "\t")).into(),
        ),
        (
            "Excel, bars",
            format!("sep=|\n{}", text.replace(';', "|")).into(),
        ),
    ];
    for (what, bytes) in files {
        let log = given("log.csv", bytes).plain();
        assert_eq!(log.log.time(), [0.0, 0.01, 0.02], "{what}");
        assert_eq!(log.log.channel("position_m").unwrap(), [0.5, 0.25, -0.125]);
        let open = told(&log).contains("no line end");
        assert_eq!(open, what == "no last line end", "{what}: {}", told(&log));
    }
    // Lines keep their numbers behind the line of Excel.
    let path = given("log.csv", "sep=,\nt_s,position_m\n0,1\n1,x\n");
    let message = read_log(&path.path, &Mapping::default(), &[]).unwrap_err();
    assert!(
        message.to_string().contains("line 4, column 2"),
        "{message}"
    );
}

#[test]
fn a_first_row_of_numbers_is_data_and_it_is_said() {
    let mapped = mapping(
        &[("column 1", "t_s", 1.0), ("column 2", "position_m", 1e-3)],
        None,
    );
    for text in [
        "0.00,5\n0.01,6.5\n0.02,-7\n",
        "0,00;5;\n0,01;6,5;\n0,02;-7;\n",
        "0.00 5\n0.01 6.5\n0.02 -7",
        "0,00  5\n0,01  6,5\n0,02  -7\n",
        "# made today\n0.00\t5\n0.01\t6.5\n0.02\t-7\n",
    ] {
        let log = given("log.txt", text).mapped(&mapped);
        assert_eq!(log.log.time(), [0.0, 0.01, 0.02], "{text:?}");
        assert_near(
            log.log.channel("position_m").unwrap(),
            |k| [5e-3, 6.5e-3, -7e-3][k],
            1e-18,
        );
        assert!(
            told(&log).contains("its first row holds numbers"),
            "{}",
            told(&log)
        );
    }
    // A single column in numbers, as an oscilloscope dumps it.
    let rate_hz = mapping(&[("column 1", "iq_a", 1.0)], Some(8e3));
    let log = given("dump.csv", "0.5\n0.75\n-0.25\n").mapped(&rate_hz);
    assert_eq!(log.log.channel("iq_a").unwrap(), [0.5, 0.75, -0.25]);
}

#[test]
fn a_row_that_is_there_twice_is_taken_once_and_another_at_its_time_refused() {
    let text = |second: &str| format!("time,x,state\n0.1,5,a\n0.2,6,b\n{second}\n0.3,7,b\n");
    let mapped = mapping(&[("time", "t_s", 1.0), ("x", "position_m", 1.0)], None);
    let log = given("log.csv", text("0.2,6,b")).mapped(&mapped);
    assert_eq!(log.log.channel("position_m").unwrap(), [5.0, 6.0, 7.0]);
    assert!(told(&log).contains("1 row(s) occur twice, the first at t = 0.2000 s"));
    // Also where a column that is not read differs: the stamp is wrong then.
    for second in ["0.2,6.5,b", "0.2,6,c"] {
        let path = given("log.csv", text(second));
        let message = read_log(&path.path, &mapped, &[]).unwrap_err().to_string();
        assert!(
            message.contains("line 4, column 1 (\"time\"): the time 0.2 s is repeated"),
            "{message}"
        );
    }
    // Behind it rows keep their lines.
    let path = given("log.csv", text("0.2,6,b").replace("0.3,7", "0.3,x"));
    let message = read_log(&path.path, &mapped, &[]).unwrap_err().to_string();
    assert!(message.contains("line 5, column 2"), "{message}");
}

/// Names with blanks in them, over numbers between blanks.
#[test]
fn names_between_blanks_keep_their_units() {
    for names in ["Time [s] Pos [mm]", " Time (s)   Pos axis  ", "Time Pos"] {
        let given = given("log.txt", format!("{names}\n 0.000  1.5\n 0.001  1.25\n"));
        let log = given.accepted();
        assert_eq!(log.log.time(), [0.0, 0.001], "{names}");
        assert_near(
            log.log.channel("position_m").unwrap(),
            |k| [1.5e-3, 1.25e-3][k],
            1e-18,
        );
    }
}

/// Blanks between fields, in names too.
#[test]
fn twincat_exports_with_blanks_between_fields_are_read() {
    let head = "Name scope 1\nFile a b.csv\nStarttime of export 132959733843760000 Montag, 2. Mai 2022\n\n";
    let mut rows = String::new();
    (0..5).for_each(|k| writeln!(rows, "{k} {}.5 {k} -{k}.25", k + 10).unwrap());
    let names = [
        "Name SetPos Name ActPos\n",
        "Name SetPos  Name ActPos of axis\nSymbolName A.SetPos SymbolName A.ActPos\n",
        "Name Set pos Name Act pos\nData-Type REAL64 Data-Type REAL64\nUnit (None) Unit mm (Length)\n",
    ];
    for names in names {
        let given = given("scope.csv", format!("{head}{names}\n{rows}EOF\n"));
        let columns = axis_log::columns(&given.path).unwrap();
        assert_eq!((columns.rows, columns.all_columns), (5, 3), "{names}");
        let command: Vec<f64> = columns.columns[1..].iter().map(|c| c.greatest).collect();
        assert_eq!(command, [14.5, -0.25], "{names}");
    }
    // Channels of one time: told apart by a line that has a field for each.
    let names = "Name Set pos Act pos\nSymbolName A.SetPos A.ActPos\n";
    let mut rows = String::new();
    (0..5).for_each(|k| writeln!(rows, "{k} {k}.5 {k}.25").unwrap());
    let proposal = given("scope.csv", format!("{head}{names}\n{rows}")).proposal();
    let sources: Vec<&str> = proposal.columns.iter().map(|c| c.source.as_str()).collect();
    assert_eq!(sources, ["A.SetPos", "A.ActPos"]);
}

/// A trace in which a `rec` is left out while nothing changes.
#[test]
fn values_of_a_trace_hold_where_it_counts_more_than_it_has() {
    let place = |k: usize| 40.0 + (k.clamp(100, 300) - 100) as f64 * 0.5;
    let trace = |counted: &str, drops: &str| {
        let mut text = format!(
            "<traceSession><traceData><dataFrame><frameHeader{drops}/>\n<dataSignal interval=\"0.004\" id=\"f1\" name=\"/Nck/!SD/nckServoDataActPos1stEnc64 [u1, 1]\"{counted}/>\n"
        );
        let mut last = f64::NAN;
        for k in 0..400 {
            if place(k) != last {
                last = place(k);
                writeln!(
                    text,
                    "<rec time=\"{:.4}\" f1=\"{last}\"/>",
                    0.004 * k as f64
                )
                .unwrap();
            }
        }
        text + "</dataFrame></traceData></traceSession>"
    };
    // By its count to the end; without one, as far as there is a `rec`.
    for (counted, drops, rows) in [
        (" datapointCount=\"400\"", "", 400),
        ("", " dropOuts=\"0\"", 301),
    ] {
        let log = given("trace.xml", trace(counted, drops)).accepted();
        assert_eq!(log.log.len(), rows);
        let found = log.log.channel("position_m").unwrap();
        assert_near(found, |k| 1e-3 * place(k), 1e-15);
        assert!(log.log.missing("position_m").is_empty());
        assert!(
            told(&log).contains("because nothing changed"),
            "{}",
            told(&log)
        );
        assert!((rate(&log) - 250.0).abs() < 1e-9);
    }
    // What is counted as lost, or not at all, is a hole.
    for (counted, drops) in [(" datapointCount=\"201\"", " dropOuts=\"3\""), ("", "")] {
        let log = given("trace.xml", trace(counted, drops)).accepted();
        let holes = log.log.missing("position_m");
        assert_eq!(
            holes.iter().map(std::ops::Range::len).sum::<usize>(),
            100,
            "{holes:?}"
        );
    }
}

/// The length of a cycle stands in the header; several axes, one of which turns.
#[test]
fn a_recording_has_its_time_and_a_choice_of_axes() {
    let signal = |name: &str, axis: &str| {
        format!("{{\"Name\":\"{name}\",\"Axis\":\"{axis}\",\"Address\":\"{name}\"}}")
    };
    let recording = |cycle: &str| {
        let signals = [
            signal("CYCLE", "Cycle"),
            signal("DES_POS|1", "X1"),
            signal("ENC_POS|1", "X1"),
            signal("ENC_POS|5", "B1"),
        ];
        let row = |k: u32| format!("[{},{k}.5,{k},{}]", 7000 + k, 3 * k);
        let rows: Vec<String> = (0..6).chain(8..12).map(row).collect();
        format!(
            "{{\"Header\":{{\"SignalListHFData\":[{}]{cycle}}},\"Payload\":[{{\"HFData\":[{}]}}]}}",
            signals.join(","),
            rows.join(",")
        )
    };
    for cycle in [",\"CycleTimeMs\":4", ",\"CycleTimeMs\":\"4\""] {
        let given = given("capture.json", recording(cycle));
        let proposal = given.proposal();
        assert_eq!(proposal.axis.as_deref(), Some("1 (X1)"));
        let other = &proposal.other_axes[0];
        assert_eq!((other.axis.as_str(), other.columns.len()), ("5 (B1)", 1));
        assert_eq!(
            (other.columns[0].channel, other.columns[0].unit),
            ("position_rad", "deg")
        );
        let log = given.accepted();
        assert!((rate(&log) - 250.0).abs() < 1e-9, "{}", rate(&log));
        assert!((log.log.time()[0] - 28.0).abs() < 1e-12);
        // Two cycles that are not there are a hole.
        assert_eq!(log.log.missing("position_m"), std::slice::from_ref(&(6..8)));
    }
    // Without it the counter can be mapped, as it must be.
    let given = given("capture.json", recording(""));
    let mapped = mapping(
        &[("CYCLE", "t_s", 0.002), ("ENC_POS|1", "position_m", 1e-3)],
        None,
    );
    assert!((rate(&given.mapped(&mapped)) - 500.0).abs() < 1e-9);
}

/// A unit in a column's name, or in the line below the names, is used if the mapping states none; a unit or
/// factor in the mapping takes precedence, and is reported if it is another. A source that the file lacks is
/// reported.
#[test]
fn a_column_is_read_in_the_unit_that_the_file_states() {
    let in_names =
        "Zeit [ms];Istposition [mm];Istweg (mm);cur [mA]\n0;100;100;1000\n1;101;101;1100\n";
    let below = "Zeit [ms];Istposition [mm];Istweg (mm);cur [mA]\n";
    let below = in_names.replace(below, "Zeit;Istposition;Istweg;cur\nms;mm;mm;mA\n");
    for (text, names) in [
        (
            in_names.to_owned(),
            ["Zeit [ms]", "Istposition [mm]", "cur [mA]", "Istweg (mm)"],
        ),
        (below, ["Zeit", "Istposition", "cur", "Istweg"]),
    ] {
        let file = given("drive.csv", text);
        let plain = |source: &str, channel: &str| {
            ColumnMap::in_unit(source, channel, ColumnUnit::default()).unwrap()
        };
        let metre = ColumnUnit {
            unit: Some("m"),
            ..Default::default()
        };
        let columns = vec![
            plain(names[0], "t_s"),
            plain(names[1], "position_m"),
            plain(names[2], "iq_a"),
            ColumnMap::in_unit(names[3], "position_ref_m", metre).unwrap(),
            plain("elsewhere", "iq_ref_a"),
        ];
        let log = file.mapped(&Mapping {
            columns,
            sample_rate_hz: None,
        });
        assert_eq!(log.log.time(), [0.0, 1e-3]);
        assert_near(
            log.log.channel("position_m").unwrap(),
            |k| 0.1 + 1e-3 * k as f64,
            1e-15,
        );
        assert_near(
            log.log.channel("iq_a").unwrap(),
            |k| 1.0 + 0.1 * k as f64,
            1e-15,
        );
        assert_eq!(log.log.channel("position_ref_m").unwrap(), [100.0, 101.0]);
        let told = told(&log);
        for words in [
            format!("\"{}\" is read in mm", names[1]),
            format!("\"{}\" is read in mA", names[2]),
            "\"elsewhere\" (source), which is not there; the file has: ".to_owned(),
            format!(
                "\"{}\": the file states mm (0.001 m), and its mapping takes 1 of it for 1 m",
                names[3]
            ),
        ] {
            assert!(told.contains(&words), "{words}: {told}");
        }
        assert!(
            !told.contains(&format!("\"{}\" is read", names[3])),
            "{told}"
        );
    }
}

/// German joins words.
#[test]
fn joined_words_are_known() {
    let file = given(
        "drive.csv",
        "Zeit [s];Sollposition [mm];Istposition [mm];Iststrom [A]\n0;0;0;0\n0.001;1;1;1\n",
    );
    let found: Vec<&str> = file.proposal().columns.iter().map(|c| c.channel).collect();
    assert_eq!(found, ["t_s", "position_ref_m", "position_m", "iq_a"]);
}
