//! CSV in and out: what is read back, and what is refused, with the place.

use std::fs;
use std::io::{self, Read, Write};

use axis_log::{Channel, CsvProblem, Log, metrics::ErrorSummary};
use axis_log::{read_csv, read_csv_from, write_csv, write_csv_to};
use proptest::prelude::*;

fn read(text: &str) -> Result<Log, CsvProblem> {
    read_csv_from(text.as_bytes(), "log.csv", &["position_m"]).map_err(|e| {
        assert_eq!(e.file, "log.csv");
        e.problem
    })
}

fn message(text: &str) -> String {
    read_csv_from(text.as_bytes(), "log.csv", &["position_m"])
        .expect_err("must be refused")
        .to_string()
}

fn sample_log() -> Log {
    Log::new(vec![
        Channel::new("t_s", vec![0.0, 1e-3]).unwrap(),
        Channel::new("position_m", vec![0.6, 0.1 + 0.2]).unwrap(),
    ])
    .unwrap()
}

#[test]
fn reads_names_units_and_numbers() {
    let text = "\u{feff}# a drive\r\nposition_m, t_s ,iq_a\r\n0.6,0,1e-3\r\n\r\n0.7,0.5,-2\r\n";
    let log = read(text).unwrap();
    let names: Vec<&str> = log.channels().iter().map(|c| c.name.as_str()).collect();
    let units: Vec<&str> = log.channels().iter().map(|c| c.unit.as_str()).collect();
    assert_eq!(names, ["t_s", "position_m", "iq_a"]);
    assert_eq!(units, ["s", "m", "A"]);
    assert_eq!(log.time(), [0.0, 0.5]);
    assert_eq!(log.channel("iq_a").unwrap(), [1e-3, -2.0]);
}

#[test]
fn refusals_name_file_line_and_column() {
    for (text, expected) in [
        ("", "log.csv: the file is empty"),
        ("t_s,position_m\n", "log.csv: line 1: no data"),
        (
            "t_s,iq_a\n0,1\n",
            "log.csv: line 1: no column \"position_m\"",
        ),
        (
            "position_m,iq_a\n0,1\n",
            "log.csv: line 1: no column \"t_s\"",
        ),
        (
            "t_s,position_m,position_m\n0,1,2\n",
            "log.csv: line 1, column 2 and column 3: \"position_m\" occurs twice",
        ),
        (
            "t_s,position_m,speed\n0,1,2\n",
            "log.csv: line 1, column 3: \"speed\" has no known unit suffix",
        ),
        (
            "t_s,position_m\n0,1\n1,2,3\n",
            "log.csv: line 3: 3 fields: the header has 2",
        ),
        (
            "t_s,position_m\n0,1\n1\n",
            "log.csv: line 3: 1 fields: the header has 2",
        ),
        (
            "\n#\r\nt_s,position_m\r\n0,1\r\n\r\n# note\r\n1,2.0.0",
            "log.csv: line 7, column 2 (\"position_m\"): \"2.0.0\" is not a number",
        ),
        (
            "t_s,position_m\n0,\n",
            "log.csv: line 2, column 2 (\"position_m\"): \"\" is not a number",
        ),
        (
            "t_s,position_m\n0,NaN\n",
            "log.csv: line 2, column 2 (\"position_m\"): \"NaN\" is not a finite number",
        ),
        (
            "t_s,position_m\n0,1e999\n",
            "log.csv: line 2, column 2 (\"position_m\"): \"1e999\" is not a finite number",
        ),
        (
            "position_m,t_s\n0,1\n0,1\n",
            "log.csv: line 3, column 2 (\"t_s\"): 1 s does not come after 1 s",
        ),
        (
            "t_s,position_m\n0,1\n2,1\n1,1\n",
            "log.csv: line 4, column 1 (\"t_s\"): 1 s does not come after 2 s",
        ),
    ] {
        let found = message(text);
        assert!(found.starts_with(expected), "{text:?} gave {found:?}");
    }
}

#[test]
fn carriage_returns_end_lines_too() {
    assert!(read("t_s,position_m\r0,1\r").is_ok());
    // A last row needs none.
    for text in ["t_s,position_m\r0,1", "t_s,position_m\n0,1"] {
        let log = read(text).unwrap();
        assert_eq!(log.channel("position_m").unwrap(), [1.0], "{text:?}");
    }
}

#[test]
fn a_header_of_a_million_columns_is_refused_in_few_words() {
    let text = format!("t_s{}\n", ",x_m".repeat(999_999));
    let found = message(&text);
    assert!(
        found.starts_with("log.csv: line 1: 1000000 columns: at most 4096"),
        "{found}"
    );
    let name = "x".repeat(100_000);
    let found = message(&format!("t_s,{name}\n0,1\n"));
    assert!(found.len() < 500, "{} bytes", found.len());
    let field = "9.".repeat(100_000);
    let found = message(&format!("t_s,position_m\n0,{field}\n"));
    assert!(found.len() < 500, "{} bytes", found.len());
}

#[test]
fn bytes_that_are_not_text_are_refused() {
    let bytes: &[u8] = b"t_s,position_m\n0,1\n1,\xff\n";
    let error = read_csv_from(bytes, "log.csv", &[]).unwrap_err();
    assert!(matches!(error.problem, CsvProblem::NotText { line: 3 }));
}

#[test]
fn a_reader_that_fails_is_an_error() {
    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("cable pulled"))
        }
    }
    let error = read_csv_from(Broken, "drive", &[]).unwrap_err();
    assert!(error.to_string().contains("cable pulled"), "{error}");
}

#[test]
fn a_full_disk_is_an_error() {
    struct Full;
    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::Error::other("no space"))
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    assert!(write_csv_to(Full, &sample_log()).is_err());
}

#[test]
fn writes_whole_files_that_all_may_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    fs::write(&path, "old").unwrap();
    let log = sample_log();
    write_csv(&path, &log).unwrap();
    assert_eq!(read_csv(&path, &["position_m"]).unwrap(), log);
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "t_s,position_m\n0,0.6\n0.001,0.30000000000000004\n"
    );
    // No temporary file is left beside it.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
    }
}

#[test]
fn a_missing_folder_or_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("absent").join("log.csv");
    for error in [
        write_csv(&path, &sample_log()).unwrap_err(),
        read_csv(&path, &[]).unwrap_err(),
    ] {
        let text = error.to_string();
        assert!(text.starts_with(&path.display().to_string()), "{text}");
    }
}

#[test]
fn a_folder_in_the_files_place_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    fs::create_dir(&path).unwrap();
    let error = write_csv(&path, &sample_log()).unwrap_err().to_string();
    assert!(error.starts_with(&path.display().to_string()), "{error}");
    assert!(error.contains("cannot put it in place"), "{error}");
}

/// The published trajectory 1 lies outside the repository; where it is not, the
/// test says so.
#[test]
fn reads_the_published_trajectory() {
    let golden = "golden/trajectory1_published.csv";
    let Some(path) = crate::needs::named_or_shared("AXIS_LOG_GOLDEN", golden) else {
        return;
    };
    let log = read_csv(&path, &["position_ref_m", "position_m", "iq_a"]).unwrap();
    let error = ErrorSummary::between(
        log.channel("position_ref_m").unwrap(),
        log.channel("position_m").unwrap(),
    )
    .unwrap();
    println!("{} samples, error {error:?}", log.len());
    // Published: 54.453 and 5.3491 µm over every 0.1 ms. The file holds every
    // tenth of those instants, hence the tolerances of that comparison.
    assert!((error.max * 1e6 - 54.453).abs() < 0.02);
    assert!((error.mean * 1e6 - 5.3491).abs() < 0.005);
}

proptest! {
    #[test]
    fn write_then_read_gives_the_same_bits(
        rows in prop::collection::vec(
            (1e-9..1e3f64, prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO),
            1..60,
        ),
    ) {
        let mut now = 0.0;
        let time: Vec<f64> = rows.iter().map(|(dt, _)| { now += dt; now }).collect();
        let values: Vec<f64> = rows.iter().map(|&(_, v)| v).collect();
        let log = Log::new(vec![
            Channel::new("t_s", time).unwrap(),
            Channel::new("force_n", values).unwrap(),
        ]).unwrap();
        let mut text = Vec::new();
        write_csv_to(&mut text, &log).unwrap();
        let again = read_csv_from(text.as_slice(), "memory", &[]).unwrap();
        for (a, b) in log.channels().iter().zip(again.channels()) {
            let bits = |c: &Channel| c.samples.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(&a.name, &b.name);
            prop_assert_eq!(bits(a), bits(b));
        }
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "[-t_sm,.0-9eE#\"\n\r naif]{0,80}") {
        if let Ok(log) = read_csv_from(text.as_bytes(), "memory", &[]) {
            prop_assert!(log.time().windows(2).all(|w| w[0] < w[1]));
        }
    }
}
