//! Files of other programs: recognised by content, mapped as asked, damage refused.

use std::path::{Path, PathBuf};

use axis_log::{ColumnMap, ColumnUnit, Mapping, propose, read_log};

fn data(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    folder.join(name)
}

fn copy(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_halscope_capture_is_read_as_it_is_mapped() {
    let path = data("halscope.log");
    // Nothing is applied by itself.
    let bare = read_log(&path, &Mapping::default(), &[]).unwrap();
    assert_eq!((bare.channels().len(), bare.len()), (1, 20));
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(proposal.format, "LinuxCNC halscope");
    assert_eq!(proposal.others, ["pid.x.output"]);
    let columns = proposal.columns.iter().map(|column| {
        let unit = ColumnUnit {
            unit: Some(column.unit),
            ..Default::default()
        };
        ColumnMap::in_unit(&column.source, column.channel, unit).unwrap()
    });
    let mapping = Mapping {
        columns: columns.collect(),
        sample_rate_hz: None,
    };
    let log = read_log(&path, &mapping, &["position_ref_m", "position_m"]).unwrap();
    let (command, feedback) = (
        log.channel("position_ref_m").unwrap(),
        log.channel("position_m").unwrap(),
    );
    for k in 0..20 {
        assert!((log.time()[k] - 1e-3 * k as f64).abs() < 1e-15);
        assert!((command[k] - 0.01 * (0.1 * k as f64).sin()).abs() < 1e-15);
        assert!(k == 0 || feedback[k] == command[k - 1]);
    }
    let lines = proposal.lines();
    assert!(
        lines
            .contains("source = \"joint.0.motor-pos-fb\"\nchannel = \"position_m\"\nunit = \"mm\"")
    );
}

#[test]
fn content_counts_and_not_the_extension() {
    let text = std::fs::read_to_string(data("halscope.log")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.csv", "a.txt", "a"] {
        let path = copy(folder.path(), name, &text);
        assert_eq!(read_log(&path, &Mapping::default(), &[]).unwrap().len(), 20);
    }
    let csv = copy(folder.path(), "b.csv", "t_s,position_m\n0,1\n1,2\n");
    assert_eq!(propose(&csv).unwrap(), None);
}

#[test]
fn damaged_captures_are_refused_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let head = "Sampling period is 1000 ns \n";
    for (text, expected) in [
        (
            "Sampling period is 0 ns \n\na +1 \na +2 ".to_owned(),
            "line 1",
        ),
        (
            "Sampling period is a while\n\na +1 \na +2 ".to_owned(),
            "line 1",
        ),
        (format!("{head}\n"), "no samples"),
        (format!("{head}\na +1 "), "no samples"),
        (format!("{head}\na +1 \nb +2 \na +3 "), "line 4"),
        (format!("{head}\na +1 \na +2 b +1 \na +3 "), "line 4"),
        (
            format!("{head}\na +1 \na x \na +3 "),
            "line 4, column 2 (\"a\"): \"x\"",
        ),
        (
            format!("{head}\na +1 \na\na +3 "),
            "line 4, column 2 (\"a\"): \"\"",
        ),
    ] {
        let path = copy(folder.path(), "x.log", &text);
        let message = read_log(&path, &Mapping::default(), &[])
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message:?} for {text:?}");
    }
}
