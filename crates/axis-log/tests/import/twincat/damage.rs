//! Exports that are damaged, or made with options that lose what is needed.

use axis_log::{Mapping, propose};

use super::super::{copy, plain, refusal};
use super::{export, whole};

#[test]
fn damage_is_refused_with_its_line() {
    let whole = whole();
    let mapping = plain("ActPos", "x_1");
    let row = "7\t6,442176872376911\t7\t5,646424733950354\t7\t1\r\n";
    assert!(whole.contains(row));
    for (to, expected) in [
        (
            "7\t6,442176872376911\t7\r\n",
            "line 30: 3 fields: the header has 8",
        ),
        ("7\r\n", "line 30: 1 fields"),
        ("7\t6\t7\t5\t7\t1\t7\t1\t7\r\n", "line 30: 9 fields"),
        (
            "7\t6\t7\tx\t7\t1\r\n",
            "line 30, column 4 (\"ActPos\"): \"x\"",
        ),
        (
            "7\t6\t7\t5.646,4\t7\t1\r\n",
            "line 30, column 4 (\"ActPos\"): \"5.646,4\"",
        ),
        (
            "7\t6\t\t5\t7\t1\r\n",
            "line 30, column 3 (\"time\"): the value is missing",
        ),
        (
            "x\t6\t7\t5\t7\t1\r\n",
            "line 30, column 1 (\"time\"): \"x\"",
        ),
        (
            "5\t6\t7\t5\t7\t1\r\n",
            "column \"ActPos\" is sampled at other times from line 30 on",
        ),
    ] {
        let text = whole.replacen(row, to, 1);
        assert_ne!(text, whole);
        let message = refusal(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {to:?}");
    }
}

/// The time is checked as that of every file.
#[test]
fn a_time_that_does_not_rise_is_refused_with_its_line() {
    let mapping = plain("A", "x_1");
    for (rows, expected) in [
        (
            "0\t1\n1\t2\n1\t3\n",
            "line 9, column 1 (\"t_s\"): the time 0.001 s is repeated",
        ),
        (
            "0\t1\n1\t2\n0,5\t3\n",
            "line 9, column 1 (\"t_s\"): the time falls",
        ),
        ("0\t1\ninf\t2\n", "line 8, column 1 (\"t_s\"): inf"),
        ("0\t1\n1\tNaN\n", "line 8, column 2 (\"A\"): NaN"),
        // The first row too, though rows begin where numbers do.
        ("x\t1\n1\t2\n", "line 7, column 1 (\"time\"): \"x\""),
        ("", "no samples"),
        ("EOF\n", "no samples"),
    ] {
        let message = refusal(export("Name\tA", rows), &mapping);
        assert!(message.contains(expected), "{message:?} for {rows:?}");
    }
}

#[test]
fn what_is_missing_from_an_export_is_told() {
    let mapping = Mapping::default();
    for (text, expected) in [
        (
            export("Name\tA\tName\tB", "1\t2\n3\t4\n"),
            "line 7: 2 values for 2 channels, so without time",
        ),
        (
            export("Name\tA\tB", "1\t2\n3\t4\n"),
            "line 7: 2 values for 2 channels, so without time",
        ),
        (
            export("Name\tA", "1\n3\n"),
            "line 7: 1 values for 1 channels, so without time",
        ),
        (export("", "0\t1\n"), "line 1: no second line \"Name\""),
        (
            export("Name\t", "0\t1\n"),
            "line 5: no channel behind \"Name\"",
        ),
        (
            export("Name\tA", "0,1,5\n1,2,5\n").replace('\t', ","),
            "line 7: 3 fields, the header has 2: if the decimal mark is a comma",
        ),
        (
            export("Name\tA b\tc", "0\t1\t2\n").replace('\t', " "),
            "line 5: spaces separate the fields and also stand in names",
        ),
        (
            export(&format!("Name{}", "\tA".repeat(5000)), "0\t1\n"),
            "line 5: 5001 columns",
        ),
    ] {
        let message = refusal(&text, &mapping);
        assert!(message.contains(expected), "{message:?} for {expected:?}");
    }
}

#[test]
fn other_files_that_begin_with_names_are_no_exports() {
    let folder = tempfile::tempdir().unwrap();
    for text in [
        "Name,t_s\nFile,0\n",
        "Name\ta\nFile\tb\n",
        "Name\ta\nFile;b\nStart\n",
        "Name\ta\nFiles\tb\nStart\n",
        "Names\ta\nFile\tb\nStart\n",
        "Name",
        "Name\n",
    ] {
        let path = copy(folder.path(), "x.csv", text);
        let format = propose(&path).unwrap().map(|proposal| proposal.format);
        assert_ne!(format, Some("TwinCAT Scope"), "{text:?}");
    }
}

/// Rows of few bytes under a wide header.
#[test]
fn memory_is_bounded_by_the_file() {
    let names: Vec<String> = (0..2000).map(|k| format!("Name\ta{k}_m")).collect();
    let rows = format!(
        "{}\n{}",
        vec!["0\t1"; 2000].join("\t"),
        "1\t2\n".repeat(40_000)
    );
    let message = refusal(export(&names.join("\t"), &rows), &Mapping::default());
    assert!(message.contains("bytes of memory"), "{message}");
}
