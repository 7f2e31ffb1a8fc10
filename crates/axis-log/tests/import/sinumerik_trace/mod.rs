//! Traces of SINUMERIK Operate.

use axis_log::intake::{Options, prepare};
use axis_log::{Mapping, propose, read_log};

use super::{accepted, copy, data, pairs, plain, refusal};

const COMMAND: &str = "Setpoint, axis 1";
const FEEDBACK: &str = "Position & encoder 1, axis 1";

fn whole() -> String {
    std::fs::read_to_string(data("sinumerik_trace.xml")).unwrap()
}

#[test]
fn a_trace_is_read_as_it_is_mapped() {
    let path = data("sinumerik_trace.xml");
    // The time needs no mapping; nothing else is applied by itself.
    let bare = read_log(&path, &Mapping::default(), &[]).unwrap();
    assert_eq!((bare.channels().len(), bare.len()), (1, 20));
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(proposal.format, "SINUMERIK trace");
    let expected = [(COMMAND, "position_ref_m"), (FEEDBACK, "position_m")];
    assert_eq!(pairs(&proposal), expected);
    // Of two signals with one description, and of one without, the names.
    let currents = [1, 2].map(|k| format!("/Nck/!SD/nckServoDataActCurr64 [u1, {k}]"));
    assert_eq!(proposal.others[..2], currents);
    assert_eq!(proposal.others[2], "/Channel/!RP/rpa [u1, 15]");
    assert!(proposal.caution.contains("screen"));
    // Before its first value a signal has none.
    let hole = read_log(&path, &accepted(&proposal), &[]).unwrap_err();
    let hole = hole.to_string();
    assert!(
        hole.contains("row 1 (\"Position & encoder 1, axis 1\")"),
        "{hole}"
    );
    let required = ["position_ref_m", "position_m"];
    let prepared = prepare(
        &[&path],
        &accepted(&proposal),
        &required,
        Options::default(),
    );
    let log = prepared.unwrap().log;
    let [command, feedback] = required.map(|name| log.channel(name).unwrap());
    for k in 0..20 {
        assert!((log.time()[k] - 2e-3 * k as f64).abs() < 1e-15);
        let there = 0.1 + 0.01 * (0.1 * k as f64).sin();
        assert!((command[k] - there).abs() < 1e-12, "{k}");
        assert!(k == 0 || feedback[k] == command[k - 1]);
    }
    assert_eq!(log.missing("position_m").first(), Some(&(0..1)));
}

/// A signal that no list has is known by what the control calls it; a current's unit is not.
#[test]
fn signals_are_known_by_their_words_too() {
    let folder = tempfile::tempdir().unwrap();
    let text = whole();
    let named = |name: &str| {
        text.replace("\"Setpoint, axis 1\"", &format!("\"{name}\""))
            .replace("cmdContrPos", "other")
    };
    for (name, channel) in [
        ("Lagesollwert", Some("position_ref_m")),
        ("Drehzahlistwert", Some("velocity_rad_s")),
        ("Stromistwert", None),
    ] {
        let path = copy(folder.path(), "trace.xml", named(name));
        let proposal = propose(&path).unwrap().unwrap();
        let found = pairs(&proposal)
            .into_iter()
            .find(|(source, _)| *source == name);
        assert_eq!(found.map(|(_, channel)| channel), channel, "{name}");
    }
}

/// A value holds until the next one.
#[test]
fn an_attribute_that_is_missing_keeps_its_value() {
    let path = data("sinumerik_trace.xml");
    let mapping = plain("/Nck/!SD/nckServoDataActCurr64 [u1, 1]", "iq_a");
    let log = read_log(&path, &mapping, &["iq_a"]).unwrap();
    let current = log.channel("iq_a").unwrap();
    assert_eq!(current[..6], [1.5, 1.5, 1.5, 1.5, 1.9, 1.9]);
    assert_eq!(current[16..], [3.1; 4]);
}

/// An infinity's or NaN's bits as an integer are no value, and hold as none.
#[test]
fn what_was_not_measured_is_a_hole() {
    let text = whole().replace("f3=\"1.9\"", "f3=\"9218868437227405312\"");
    let mapping = plain("/Nck/!SD/nckServoDataActCurr64 [u1, 1]", "iq_a");
    let message = refusal(&text, &mapping);
    assert!(
        message.contains("row 5") && message.contains("missing"),
        "{message}"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.xml", &text);
    let log = prepare(&[&path], &mapping, &["iq_a"], Options::default()).unwrap();
    assert_eq!(log.log.missing("iq_a").first(), Some(&(4..8)));
}

/// Bytes that are not UTF-8 are ISO-8859-1, whatever is declared.
#[test]
fn either_encoding_is_read_with_a_mark_and_other_line_ends() {
    let folder = tempfile::tempdir().unwrap();
    let name = "Position S\u{fc}d";
    let mapping = plain(name, "position_ref_m");
    let text = whole().replace(COMMAND, name).replace('\n', "\r\n");
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [
        text.clone().into_bytes(),
        format!("\u{feff}\r\n{text}").into_bytes(),
        latin,
    ] {
        let path = copy(folder.path(), "x", &bytes);
        let log = read_log(&path, &mapping, &["position_ref_m"]).unwrap();
        assert_eq!(log.channel("position_ref_m").unwrap()[0], 100.0);
    }
    // A place is the key where no signal has another.
    let mut text = whole();
    for k in 1..=5 {
        text = text.replace(&format!("id=\"f{k}\" "), "");
    }
    let path = copy(folder.path(), "y", &text);
    let log = read_log(&path, &plain(COMMAND, "position_ref_m"), &[]).unwrap();
    assert_eq!(log.channel("position_ref_m").unwrap()[0], 100.0);
}

#[test]
fn other_xml_is_not_a_trace() {
    let folder = tempfile::tempdir().unwrap();
    for text in [
        "<a><b><traceData/></b></a>",
        "<traceData><dataFrame/></traceData>",
        "<a><!-- <traceData/> --></a>",
        "<a>&lt;traceData/&gt;</a>",
        "<a></b><traceData/></a>",
        "<traceSession/>",
        "<",
        "",
    ] {
        let path = copy(folder.path(), "x.xml", text);
        assert_eq!(propose(&path).unwrap(), None, "{text}");
    }
}

#[test]
fn damage_is_refused_with_its_place() {
    let whole = whole();
    let mapping = plain(COMMAND, "position_ref_m");
    let first = "<rec time=\"0.002\" f1=\"100.99833416646828\"";
    assert!(whole.contains(first));
    for (from, to, expected) in [
        ("</dataFrame>", "</dataframe>", "line 37: "),
        (first, "<rec f1=\"100\"", "line 18: a rec without time"),
        (
            first,
            "<rec time=\"\"",
            "line 18: the time of a rec is \"\"",
        ),
        (
            first,
            "<rec time=\"inf\"",
            "line 18: the time of a rec is \"inf\"",
        ),
        (
            first,
            "<rec time=\"0.002\" f9=\"1\"",
            "line 18: a rec has \"f9\"",
        ),
        (
            first,
            "<rec time=\"0.002\" f1=\"1\" f1=\"1\"",
            "line 18: a rec has an attribute twice",
        ),
        (
            first,
            "<rec time=\"0.002\" time=\"0.002\"",
            "line 18: a rec has an attribute twice",
        ),
        (first, "<rec time=\"0.002\" f1=1", "line 18: "),
        (first, "<rec time=\"0.002\" f1=\"&x;\"", "line 18: "),
        (
            first,
            "<rec time=\"0\"",
            "row 2 (\"t_s\"): the time 0 s is repeated",
        ),
        (first, "<rec time=\"-1\"", "row 2 (\"t_s\"): the time falls"),
        (
            "f1=\"100.99833416646828\"",
            "f1=\"a\"",
            "not numbers only (\"a\" in rec 2)",
        ),
        ("id=\"f2\"", "id=\"f1\"", "line 13: two dataSignals \"f1\""),
        (
            "<traceSession>",
            "<!DOCTYPE a [<!ENTITY x \"1\">]><traceSession>",
            "line 3: a document type",
        ),
        (
            "</dataFrame>",
            "<dataSignal/></dataFrame>",
            "line 37: a dataSignal behind the first rec",
        ),
        (
            "</dataFrame>",
            "</dataFrame><dataFrame/>",
            "line 37: a second dataFrame",
        ),
        ("<dataFrame>", "<x><dataFrame>", "line 38: "),
    ] {
        let text = whole.replacen(from, to, 1);
        assert_ne!(text, whole);
        let message = refusal(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {to:?}");
    }
}

#[test]
fn what_is_not_a_whole_trace_is_told() {
    let whole = whole();
    let mapping = plain(COMMAND, "position_ref_m");
    let lines = |keep: &dyn Fn(&str) -> bool| {
        let kept = whole.lines().filter(|line| keep(line));
        kept.collect::<Vec<_>>().join("\n")
    };
    let deep = format!("<a><traceData/>{}", "<b>".repeat(40));
    let many = format!("<a><traceData><dataFrame>{}", "<dataSignal/>".repeat(5000));
    for (text, expected) in [
        (whole[..whole.len() / 2].to_owned(), "line 21: "),
        (
            whole[..whole.find("</dataFrame>").unwrap()].to_owned(),
            "it ends inside of <dataFrame>",
        ),
        (
            lines(&|line| !line.contains("<rec time=\"0.")),
            "no samples",
        ),
        (
            lines(&|line| !line.contains("dataSignal") && !line.contains("<rec")),
            "no dataSignal",
        ),
        (
            "<a><traceCaptureSetup/></a>".to_owned(),
            "line 1: no dataFrame",
        ),
        (deep, "more than 32 elements"),
        (many, "more than 4096 signals"),
    ] {
        let message = refusal(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {expected:?}");
    }
}

/// Few bytes may stand for many values.
#[test]
fn memory_is_bounded_by_the_file() {
    let signals: String = (0..4000)
        .map(|k| format!("<dataSignal name=\"a{k}_m\"/>"))
        .collect();
    let all: String = (1..=4000).map(|k| format!(" f{k}=\"1\"")).collect();
    let recs: String = (1..40_000)
        .map(|k| format!("<rec time=\"{k}\"/>"))
        .collect();
    let text = format!(
        "<a><traceData><dataFrame>{signals}<rec time=\"0\"{all}/>{recs}</dataFrame></traceData></a>"
    );
    let message = refusal(&text, &Mapping::default());
    assert!(message.contains("bytes of memory"), "{message}");
}
