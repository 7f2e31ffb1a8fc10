//! Exports of TwinCAT Scope.

mod damage;

use axis_log::intake::{Options, prepare};
use axis_log::{Log, Mapping, propose, read_log};

use super::{accepted, copy, data, pairs, plain, refusal};

fn whole() -> String {
    std::fs::read_to_string(data("twincat.csv")).unwrap()
}

fn read(text: impl AsRef<[u8]>, mapping: &Mapping) -> Log {
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.txt", text);
    read_log(&path, mapping, &[]).unwrap()
}

/// Three lines that every export has, the names, and these rows.
fn export(names: &str, rows: &str) -> String {
    format!("Name\ta\nFile\tb\nStarttime of export\t1\n\n{names}\n\n{rows}")
}

fn check(log: &Log) {
    let [command, feedback] =
        ["position_ref_m", "position_m"].map(|name| log.channel(name).unwrap());
    assert_eq!(log.len(), 20);
    for k in 0..20 {
        assert!((log.time()[k] - 1e-3 * k as f64).abs() < 1e-15);
        assert!((command[k] - 0.01 * (0.1 * k as f64).sin()).abs() < 1e-15);
        assert!(k == 0 || feedback[k] == command[k - 1]);
    }
}

#[test]
fn an_export_is_read_as_it_is_mapped() {
    let path = data("twincat.csv");
    // The time needs no mapping; nothing else is applied by itself.
    let bare = read_log(&path, &Mapping::default(), &[]).unwrap();
    assert_eq!((bare.channels().len(), bare.len()), (1, 20));
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(proposal.format, "TwinCAT Scope");
    let expected = [("SetPos", "position_ref_m"), ("ActPos", "position_m")];
    assert_eq!(pairs(&proposal), expected);
    assert_eq!(proposal.others, ["bEnable", "ActTemp"]);
    assert!(proposal.caution.contains("0.1 %"));
    check(
        &read_log(
            &path,
            &accepted(&proposal),
            &["position_ref_m", "position_m"],
        )
        .unwrap(),
    );
    let enabled = read_log(&path, &plain("bEnable", "enabled_1"), &[]).unwrap();
    assert_eq!(enabled.channel("enabled_1").unwrap()[2..4], [0.0, 1.0]);
}

/// A log that does not map them reads; one that does is told why it cannot.
#[test]
fn channels_on_another_timeline_are_not_read() {
    let message = refusal(whole(), &plain("ActTemp", "x_1"));
    let expected = "column \"ActTemp\" is sampled at other times from line 24 on (every 5 ms from 0 ms on; the time every 1 ms from 0 ms on): an export of channels with one sample time is needed";
    assert!(message.contains(expected), "{message}");
    // Slower samples that are repeated, or stand in the rows of their time.
    for (slow, pace) in [
        ("0\t7\n0\t7\n2\t8\n2\t8", "2"),
        ("0\t7\n \t \n2\t8\n \t ", "2"),
    ] {
        let rows = slow.lines().enumerate();
        let rows: String = rows
            .map(|(k, slow)| format!("{slow}\t{k}\t{k}\n"))
            .collect();
        let text = export("Name\tslow\tName\tfast", &rows);
        let fast = read(&text, &plain("fast", "x_1"));
        assert_eq!(fast.channel("x_1").unwrap(), [0.0, 1.0, 2.0, 3.0]);
        let message = refusal(&text, &plain("slow", "x_1"));
        assert!(message.contains(&format!("every {pace} ms")), "{message}");
    }
}

#[test]
fn separators_marks_and_line_ends_are_found() {
    let whole = whole();
    let mapping = accepted(&propose(data("twincat.csv")).unwrap().unwrap());
    let with = |separator: &str| whole.replace(',', ".").replace('\t', separator);
    for text in [
        whole.clone(),
        whole.replace("\r\n", "\n"),
        format!("\u{feff}{whole}"),
        whole.replace('\t', ";"),
        with("\t"),
        with(";"),
        with(","),
        with(":").replacen("C:", "C", 1),
        // As version 2 begins, with a separator behind each line.
        whole.replace("time of export", "Record"),
        whole.replace("\r\n", "\t\r\n"),
        whole.replace("EOF\r\n", "EOF"),
        whole.replace("EOF\r\n", ""),
        whole.replace("EOF\r\n", "\r\nEOF\r\nMarker\tx\r\n"),
    ] {
        check(&read(&text, &mapping));
    }
}

/// The header as far as names, and a comment that goes on over several lines.
#[test]
fn a_header_may_be_short_or_broken_over_lines() {
    let whole = whole();
    let mapping = accepted(&propose(data("twincat.csv")).unwrap().unwrap());
    let is_left_out = |line: &&str| {
        let rest = [
            "Symbol", "Data-", "Sample", "Variable", "Index", "Net", "Port", "Offset",
        ];
        let rest = rest.iter().chain(&["Scale", "BitMask", "Unit"]);
        !rest.clone().any(|key| line.starts_with(key))
    };
    let short: Vec<&str> = whole.lines().filter(is_left_out).collect();
    assert_eq!(short.len(), 29);
    check(&read(short.join("\n"), &mapping));
    let without_blank: Vec<&str> = short
        .iter()
        .filter(|line| !line.is_empty())
        .copied()
        .collect();
    check(&read(without_blank.join("\n"), &mapping));
    check(&read(
        whole.replace("released", "(* when\r\n\r\n released:\r\n1 is *)"),
        &mapping,
    ));
}

#[test]
fn channels_of_a_sample_time_may_share_a_time_column() {
    let text = export(
        "Name\tA\tB\tName\tC\nSymbolName\tX.ActPos\tX.SetPos\tSymbolName\tX.ActVelo",
        "0\t1\t2\t0\t3\n0.2\t4\t5\t5\t6\n0.4\t7\tTrue\n",
    );
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.csv", &text);
    let proposal = propose(&path).unwrap().unwrap();
    // By symbol where the name does not tell; what cannot be read is not proposed.
    assert_eq!(
        pairs(&proposal),
        [("B", "position_ref_m"), ("A", "position_m")]
    );
    assert_eq!(proposal.others, ["C"]);
    let log = read(&text, &plain("B", "x_1"));
    assert_eq!(log.time(), [0.0, 2e-4, 4e-4]);
    assert_eq!(log.channel("x_1").unwrap(), [2.0, 5.0, 1.0]);
}

/// Ticks of 100 ns are beyond what a double can count.
#[test]
fn full_timestamps_become_seconds_since_the_first() {
    let text = export(
        "Name\tA",
        "132959733843760000\t1\n132959733843760001\t2\n132959733843762000\t3\n",
    );
    let log = read(&text, &plain("A", "x_1"));
    assert_eq!(log.time(), [0.0, 1e-7, 2e-4]);
    let message = refusal(text.replace("760001", "76000x"), &plain("A", "x_1"));
    assert!(message.contains("line 8, column 1 (\"time\")"), "{message}");
}

#[test]
fn names_that_occur_twice_are_told_apart() {
    let text = export(
        "Name\tActPos\tName\tActPos\tName\tName\tName\tt_s\tName\tn\tName\tn\nSymbolName\tX.ActPos\tSymbolName\tY.ActPos\tSymbolName\tM.Name\tSymbolName\tM.t_s\tSymbolName\ts\tSymbolName\ts",
        "0\t1\t0\t2\t0\t3\t0\t4\t0\t5\t0\t6\n",
    );
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.csv", &text);
    let proposal = propose(&path).unwrap().unwrap();
    assert_eq!(pairs(&proposal), [("X.ActPos", "position_m")]);
    assert_eq!(proposal.others, ["Name", "n", "n (2)"]);
    let other = &proposal.other_axes[0].columns[0];
    assert_eq!(
        (other.source.as_str(), other.channel),
        ("Y.ActPos", "position_m")
    );
    assert_eq!(
        read(&text, &Mapping::default()).channel("M.t_s").unwrap(),
        [4.0]
    );
    let second = read(&text, &plain("n (2)", "x_1"));
    assert_eq!(second.channel("x_1").unwrap(), [6.0]);
}

/// Setpoint and actual value are of one axis, and what is beside them is neither.
#[test]
fn a_proposal_is_of_one_axis() {
    let folder = tempfile::tempdir().unwrap();
    let proposed = |names: &[&str]| {
        let row = "0\t1\t".repeat(names.len());
        let names = names.iter().map(|name| format!("Name\t{name}\t"));
        let text = export(names.collect::<String>().trim_end(), &format!("{row}\n"));
        let path = copy(folder.path(), "x.csv", &text);
        let proposal = propose(&path).unwrap().unwrap();
        let pairs = pairs(&proposal)
            .into_iter()
            .map(|(source, _)| source.to_owned());
        pairs.collect::<Vec<_>>()
    };
    let axes = ["X.ActPos", "Y.SetPos", "Y.ActPos", "X.SetVelo", "X.setpos"];
    assert_eq!(proposed(&axes), ["X.setpos", "X.ActPos", "X.SetVelo"]);
    let behind = ["fActPos_2", "fSetPos_1", "fSetPos_2", "fActVelo_2"];
    assert_eq!(proposed(&behind), ["fSetPos_2", "fActPos_2", "fActVelo_2"]);
    let beside = ["X.ModuloActPos", "X.ActPosWithoutPosCorrection", "X.SetPos"];
    assert_eq!(proposed(&beside), ["X.SetPos"]);
}

/// A channel that ended before the others, and a value that is not there.
#[test]
fn blank_fields_are_holes() {
    let text = export("Name\tA\tName\tB", "0\t1\t0\t1\n1\t \t1\t2\n2\t3\n");
    for (name, line) in [("A", 8), ("B", 9)] {
        let message = refusal(&text, &plain(name, "x_1"));
        let expected = format!("line {line}, column {}", if name == "A" { 2 } else { 4 });
        assert!(
            message.contains(&expected) && message.contains("missing"),
            "{message}"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = copy(folder.path(), "x.csv", &text);
        let log = prepare(&[&path], &plain(name, "x_1"), &["x_1"], Options::default());
        assert_eq!(log.unwrap().log.missing("x_1").len(), 1);
    }
}

/// Channels that a user named are known by their words; efforts are in a unit of the drive's own.
#[test]
fn names_of_a_user_are_known_by_their_words() {
    let text = export(
        "Name\tLagesollwert\tName\tLageistwert\tName\tModuloActPos\tName\tMoment",
        "0\t1\t0\t2\t0\t3\t0\t4\n1\t1\t1\t2\t1\t3\t1\t4\n",
    );
    let folder = tempfile::tempdir().unwrap();
    let path = copy(folder.path(), "x.csv", &text);
    let proposal = propose(&path).unwrap().unwrap();
    let expected = [
        ("Lagesollwert", "position_ref_m"),
        ("Lageistwert", "position_m"),
    ];
    assert_eq!(pairs(&proposal), expected);
    assert_eq!(proposal.others, ["ModuloActPos", "Moment"]);
}
