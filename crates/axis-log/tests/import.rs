//! Files of other programs: recognised by content, mapped as asked, damage refused.

mod moteus;
mod sinumerik_trace;
mod twincat;

use std::path::{Path, PathBuf};

use axis_log::{ColumnMap, ColumnUnit, Mapping, MappingProposal, propose, read_log};
use proptest::prelude::*;

fn data(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    folder.join(name)
}

fn copy(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// The mapping that is proposed, as a user would take it over.
fn accepted(proposal: &MappingProposal) -> Mapping {
    let columns = proposal.columns.iter().map(|column| {
        let unit = ColumnUnit {
            unit: Some(column.unit),
            factor: column.factor,
            ..Default::default()
        };
        ColumnMap::in_unit(&column.source, column.channel, unit).unwrap()
    });
    Mapping {
        columns: columns.collect(),
        sample_rate_hz: None,
    }
}

/// A column without unit to a channel.
fn plain(source: &str, channel: &str) -> Mapping {
    Mapping {
        columns: vec![ColumnMap::in_unit(source, channel, ColumnUnit::default()).unwrap()],
        sample_rate_hz: None,
    }
}

/// Sources and channels that are proposed.
fn pairs(proposal: &MappingProposal) -> Vec<(&str, &str)> {
    let columns = proposal.columns.iter();
    columns.map(|c| (&*c.source, c.channel)).collect()
}

/// What a file with this text is refused with.
fn refusal(text: impl AsRef<[u8]>, mapping: &Mapping) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.txt", text);
    read_log(&path, mapping, &[]).unwrap_err().to_string()
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
    let mapping = accepted(&proposal);
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

fn recording_mapping(extra: &[(&str, &str)]) -> Mapping {
    let of = |source: &str, channel: &str, unit| ColumnMap::in_unit(source, channel, unit).unwrap();
    let mm = ColumnUnit {
        unit: Some("mm"),
        ..Default::default()
    };
    let plain = |(source, channel): &(&str, &str)| of(source, channel, ColumnUnit::default());
    let cycle = ColumnUnit {
        factor: Some(0.002),
        ..Default::default()
    };
    let mut columns = vec![
        of("CYCLE", "t_s", cycle),
        of("DES_POS|1", "position_ref_m", mm),
        of("ENC_POS|1", "position_m", mm),
    ];
    columns.extend(extra.iter().map(plain));
    Mapping {
        columns,
        sample_rate_hz: None,
    }
}

#[test]
fn a_recording_of_data_recorder_is_read_as_it_is_mapped() {
    let path = data("sinumerik.json");
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(proposal.format, "SINUMERIK Data Recorder");
    let sources: Vec<&str> = proposal.columns.iter().map(|c| &*c.source).collect();
    assert_eq!(sources, ["DES_POS|1", "ENC_POS|1"]);
    assert_eq!(proposal.others, ["CYCLE", "CURRENT|1", "HF_EVENT"]);
    assert!(proposal.caution.contains("CYCLE"));
    let required = ["position_ref_m", "position_m"];
    let log = read_log(&path, &recording_mapping(&[]), &required).unwrap();
    let [command, feedback] = required.map(|name| log.channel(name).unwrap());
    assert_eq!(log.len(), 20);
    for k in 0..20 {
        let time = log.time()[k] - log.time()[0];
        assert!((time - 2e-3 * k as f64).abs() < 1e-11, "{time}");
        let there = 0.1 + 0.01 * (0.1 * k as f64).sin();
        assert!((command[k] - there).abs() < 1e-12, "{k}");
        assert!(k == 0 || feedback[k] == command[k - 1]);
    }
}

/// What a recording may lack is told with what would be valid.
#[test]
fn damaged_recordings_are_refused_with_their_place() {
    let whole = std::fs::read_to_string(data("sinumerik.json")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let message = |text: &str, mapping: &Mapping| {
        let path = copy(folder.path(), "x.json", text);
        read_log(&path, mapping, &[]).unwrap_err().to_string()
    };
    let mapping = recording_mapping(&[]);
    let no_errors = "\"ErrorMessages\": []";
    assert!(whole.contains(no_errors));
    for (text, expected) in [
        (whole[..whole.len() / 2].to_owned(), "EOF while parsing"),
        (
            whole.replace("SignalListHFData", "SignalListLFData"),
            "no SignalListHFData",
        ),
        (
            whole.replace("\"Address\": \"CYCLE\"", "\"A\": 1"),
            "missing field `Address`",
        ),
        (
            whole.replace("[4817083, ", "[4817083, 1.0, "),
            "row 3 of HFData has 6 values, the header lists 5",
        ),
        (whole.replace("HFData\": [[", "other\": [["), "no samples"),
        (whole.replace("[4817083, ", "[4817082, "), "row 3"),
        (whole.replace("[4817083, ", "[\"x\", "), "row 3 (\"CYCLE\")"),
        (
            whole.replace(no_errors, "\"ErrorMessages\": [\"lost data\"]"),
            "lost data",
        ),
        ("{\"Header\": 1}".to_owned(), "line 1 column"),
    ] {
        let message = message(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {expected:?}");
    }
    // No cycle, no time; a hole and a text only where they are asked for.
    let bare = message(&whole, &Mapping::default());
    assert!(
        bare.contains("map a column to \"t_s\"") && bare.contains("CYCLE"),
        "{bare}"
    );
    let hole = message(&whole, &recording_mapping(&[("CURRENT|1", "current_q_a")]));
    assert!(hole.contains("row 8 (\"CURRENT|1\"): \"null\""), "{hole}");
    let text = message(&whole, &recording_mapping(&[("HF_EVENT", "current_q_a")]));
    assert!(text.contains("row 1 (\"HF_EVENT\")"), "{text}");
}

/// A column of numbers, as `oscilloscope_dump` of odrivetool writes, needs a name and a rate.
#[test]
fn a_column_without_a_name_reads_once_it_has_one() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = Mapping {
        sample_rate_hz: Some(8000.0),
        ..Default::default()
    };
    let path = copy(folder.path(), "dump.csv", "iq_a\n0.5\n0.75\n-0.25\n");
    let log = read_log(&path, &mapping, &["iq_a"]).unwrap();
    assert_eq!(log.channel("iq_a").unwrap(), [0.5, 0.75, -0.25]);
    assert_eq!(log.time(), [0.0, 1.25e-4, 2.5e-4]);
}

const EXAMPLES: [&str; 5] = [
    "halscope.log",
    "moteus.csv",
    "sinumerik.json",
    "sinumerik_trace.xml",
    "twincat.csv",
];

proptest! {
    /// Bytes that are lost, doubled or others: read or refused, without a panic.
    #[test]
    fn damage_of_any_kind_is_read_or_refused(
        example in 0..EXAMPLES.len(),
        at in any::<prop::sample::Index>(),
        length in 0..40_usize,
        instead in prop::collection::vec(prop_oneof![any::<u8>(), Just(b'\n'), Just(b'\t'), Just(b'<')], 0..6),
        cut in any::<bool>(),
    ) {
        let mut bytes = std::fs::read(data(EXAMPLES[example])).unwrap();
        let at = at.index(bytes.len());
        let end = if cut { bytes.len() } else { bytes.len().min(at + length) };
        bytes.splice(at..end, instead);
        let folder = tempfile::tempdir().unwrap();
        let path = copy(folder.path(), "x.csv", &bytes);
        let mapping = propose(&path).ok().flatten().map(|proposal| accepted(&proposal));
        drop(read_log(&path, &mapping.unwrap_or_default(), &[]));
    }
}
