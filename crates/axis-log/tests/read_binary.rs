//! Logs from Parquet and MAT: what is read, skipped and refused.

use std::fs;
use std::path::{Path, PathBuf};

use crate::parquet_file::{self, Column, Values};
use crate::reading::{REQUIRED, emps, mapping, names, without_folder};
use axis_log::{Channel, Log, Mapping, read_log, write_csv};
use proptest::prelude::*;

fn parquet(
    columns: &[Column],
    groups: usize,
    mapping: &Mapping,
    required: &[&str],
) -> Result<Log, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    parquet_file::write(&path, columns, groups);
    read_log(&path, mapping, required).map_err(|e| without_folder(&e.to_string(), folder.path()))
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

#[test]
fn parquet_columns_of_all_four_types_are_read() {
    let columns = [
        Column::new("time_ns", Values::Int64(vec![0, 1_000_000, 2_000_000])),
        Column::new("qg", Values::Float(vec![0.5, 1.5, 2.5])),
        Column::new("position_m", Values::Double(vec![0.1, 0.2, 0.3])),
        Column::new("count_1", Values::Int32(vec![-1, 0, 1])),
        Column::new("running_1", Values::Boolean(vec![true, true, false])),
    ];
    let mapping = mapping(
        &[("time_ns", "t_s", 1e-9), ("qg", "position_ref_m", 1.0)],
        None,
    );
    for groups in [1, 3] {
        let log = parquet(&columns, groups, &mapping, REQUIRED).unwrap();
        assert_eq!(
            names(&log),
            ["t_s", "position_ref_m", "position_m", "count_1"]
        );
        assert_eq!(log.time(), [0.0, 1e-9 * 1e6, 1e-9 * 2e6]);
        assert_eq!(log.channel("position_ref_m").unwrap(), [0.5, 1.5, 2.5]);
        assert_eq!(log.channel("position_m").unwrap(), [0.1, 0.2, 0.3]);
        assert_eq!(log.channel("count_1").unwrap(), [-1.0, 0.0, 1.0]);
    }
}

#[test]
fn parquet_refusals_name_the_row() {
    let time = || Column::new("t_s", Values::Double(vec![0.0, 1.0, 2.0]));
    let nulls = Values::OptionalDouble(vec![Some(1.0), Some(2.0), None]);
    let nan = Values::Double(vec![1.0, f64::NAN, 2.0]);
    for (column, expected) in [
        (
            Column::new("position_m", nulls),
            "row 3 (\"position_m\"): the value is missing",
        ),
        (
            Column::new("position_m", nan),
            "row 2 (\"position_m\"): NaN is not a finite number",
        ),
        (
            Column::new("position_m", Values::Boolean(vec![true; 3])),
            "column \"position_m\" is of type BOOLEAN: a flat column",
        ),
        (
            Column::new("x_m", Values::Double(vec![0.0; 3])),
            "no column for \"position_m\": the file has \"t_s\", \"x_m\"",
        ),
    ] {
        // Over several row groups the row still counts from the file's start.
        for groups in [1, 3] {
            let columns = [time(), column.clone()];
            let found =
                parquet(&columns, groups, &Mapping::default(), &["position_m"]).unwrap_err();
            assert!(
                found.starts_with(&format!("log.parquet: {expected}")),
                "{found}"
            );
        }
    }
    let times = [
        Column::new("t_s", Values::Double(vec![0.0, 1.0, 1.0])),
        Column::new("x_m", Values::Double(vec![0.0, 1.0, 2.0])),
    ];
    let found = parquet(&times, 1, &Mapping::default(), &[]).unwrap_err();
    assert!(
        found.starts_with("log.parquet: row 3 (\"t_s\"): the time 1 s is repeated"),
        "{found}"
    );
}

#[test]
fn mat_files_plain_and_compressed_read_alike() {
    for name in ["plain.mat", "compressed.mat"] {
        let log = read_log(fixture(name), &emps(), REQUIRED).unwrap();
        // Not the scalar, the short, the complex, the matrix, the text and the struct.
        assert_eq!(
            names(&log),
            [
                "t_s",
                "position_ref_m",
                "position_m",
                "drive_command_v",
                "duty_1",
                "counts_1"
            ]
        );
        // As numpy computes k * 1e-3 and 0.1 + 0.25 k: the same operations.
        let k = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(log.time(), k.map(|k| k * 1e-3));
        assert_eq!(
            log.channel("position_m").unwrap(),
            k.map(|k| 0.1 + 0.25 * k)
        );
        assert_eq!(log.channel("position_ref_m").unwrap(), k.map(|k| 0.5 + k));
        assert_eq!(
            log.channel("drive_command_v").unwrap(),
            k.map(|k| 2.0 * (k - 2.0))
        );
        assert_eq!(log.channel("counts_1").unwrap(), k);
    }
}

#[test]
fn mat_refusals_say_what_the_file_has() {
    for (source, expected) in [
        ("note", "column \"note\" is text: a real vector"),
        (
            "phase_rad",
            "column \"phase_rad\" is complex: a real vector",
        ),
        (
            "short_m",
            "\"short_m\" has 4 samples: \"t\" has 6, and they must agree",
        ),
        (
            "notes",
            "no column for \"x_m\" (mapped from \"notes\"): the file has \"t\", \"qm\", \"qg\", \
             \"vir\", \"duty_1\", \"Fs_hz\", \"short_m\", \"counts_1\", \"phase_rad\", \
             \"jacobian_m(1)\", \"jacobian_m(2)\", \"note\", \"drive.gain_1\"",
        ),
    ] {
        let mapping = mapping(&[("t", "t_s", 1.0), (source, "x_m", 1.0)], None);
        for name in ["plain.mat", "compressed.mat"] {
            let found = read_log(fixture(name), &mapping, &["x_m"]).unwrap_err();
            let expected = format!("{name}: {expected}");
            assert!(found.to_string().contains(&expected), "{found}");
        }
    }
}

#[test]
fn files_that_are_not_what_their_name_says_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let plain = fs::read(fixture("plain.mat")).unwrap();
    let mut newer = plain.clone();
    newer[..10].copy_from_slice(b"MATLAB 7.3");
    for (name, bytes, expected) in [
        ("x.parquet", &b"t_s\n0\n"[..], "not readable as Parquet"),
        ("x.mat", b"t_s\n0\n", "MAT version 5: it is shorter"),
        (
            "x.mat",
            &[b' '; 200],
            "MAT version 5: the header has no version 5 mark",
        ),
        ("x.mat", &newer, "MAT version 5: it is version 7.3 (HDF5)"),
        (
            "x.mat",
            &plain[..150],
            "it is cut off: the element at byte 128",
        ),
        ("x.mat", &plain[..132], "it is cut off inside the tag"),
        ("x.csv", b"t_s\n0\0\n", "line 2: not UTF-8"),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let found = read_log(&path, &emps(), &[]).unwrap_err().to_string();
        assert!(found.contains(expected), "{found:?} for {expected:?}");
    }
}

proptest! {
    // Each case writes one or two files.
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn csv_and_parquet_give_back_the_same_bits(
        rows in prop::collection::vec(
            (1e-9..1e3f64, prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO),
            1..60,
        ),
        groups in 1..4usize,
    ) {
        let mut now = 0.0;
        let time: Vec<f64> = rows.iter().map(|(dt, _)| { now += dt; now }).collect();
        let force: Vec<f64> = rows.iter().map(|&(_, v)| v).collect();
        let log = Log::new(vec![
            Channel::new("t_s", time.clone()).unwrap(),
            Channel::new("force_n", force.clone()).unwrap(),
        ]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        write_csv(&path, &log).unwrap();
        let from_csv = read_log(&path, &Mapping::default(), &["force_n"]).unwrap();
        let columns = [
            Column::new("force_n", Values::OptionalDouble(force.into_iter().map(Some).collect())),
            Column::new("t_s", Values::Double(time)),
        ];
        let from_parquet = parquet(&columns, groups, &Mapping::default(), &["force_n"]).unwrap();
        let bits = |log: &Log| -> Vec<Vec<u64>> {
            let of = |c: &Channel| c.samples.iter().map(|v| v.to_bits()).collect();
            log.channels().iter().map(of).collect()
        };
        prop_assert_eq!(bits(&from_csv), bits(&log));
        prop_assert_eq!(bits(&from_parquet), bits(&log));
    }

    #[test]
    fn no_damage_to_a_mat_file_makes_the_reader_panic(
        flips in prop::collection::vec((0..10_000usize, any::<u8>()), 1..8), compressed in any::<bool>(),
    ) {
        let bytes = fs::read(fixture(if compressed { "compressed.mat" } else { "plain.mat" })).unwrap();
        damaged(bytes, &flips, "x.mat");
    }

    #[test]
    fn no_damage_to_a_parquet_file_makes_the_reader_panic(
        flips in prop::collection::vec((0..10_000usize, any::<u8>()), 1..8),
    ) {
        damaged(small_parquet(), &flips, "x.parquet");
    }
}

/// A MAT file whose one array claims more numbers than memory has, deflated or not.
#[test]
fn a_mat_file_that_claims_more_than_it_may_is_refused_before_it_is_read() {
    let array = |rows: u32, stored: u32| {
        let mut bytes = Vec::new();
        let mut word = |n: u32| bytes.extend_from_slice(&n.to_le_bytes());
        // Flags (class double), dimensions, the name "x_m", the tag of the numbers.
        for n in [6, 8, 6, 0, 5, 8, rows, 1, 1, 3] {
            word(n);
        }
        bytes.extend_from_slice(b"x_m\0\0\0\0\0");
        bytes.extend([9_u32.to_le_bytes(), stored.to_le_bytes()].concat());
        bytes
    };
    let element = |kind: u32, content: &[u8]| {
        let tag = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
        [&tag, content].concat()
    };
    let header = [&[b' '; 124][..], &[0, 1, b'I', b'M']].concat();
    let rate = mapping(&[], Some(1e3));
    let message = |element: Vec<u8>| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.mat");
        fs::write(&path, [&header[..], &element].concat()).unwrap();
        read_log(&path, &rate, &["x_m"]).unwrap_err().to_string()
    };
    // 100 MB of zeros take 450 kB.
    let zeros = [
        element(14, &array(12_500_000, 100_000_000)),
        vec![0; 100_000_000],
    ]
    .concat();
    let bomb = miniz_oxide::deflate::compress_to_vec_zlib(&zeros, 1);
    drop(zeros);
    let found = message(element(15, &bomb));
    assert!(found.contains("claim 200000056 bytes"), "{found}");
    // The numbers that the tag announces are not there.
    let found = message(element(14, &array(1000, 8000)));
    assert!(found.contains("\"x_m\" are damaged or cut off"), "{found}");
    // The product of the dimensions is not the number of values.
    let found = message(element(14, &array(u32::MAX, 8)));
    assert!(found.contains("one part that is damaged"), "{found}");
}

/// The numbers of a damaged page header are all small integers in the bytes of the
/// file, so every one of them is tried at every place.
#[test]
fn no_byte_of_a_parquet_file_makes_it_ask_for_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.parquet");
    let whole = small_parquet();
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        // A varint that goes on: the length or count takes in the bytes that follow.
        damaged[at] |= 0x80;
        fs::write(&path, &damaged).unwrap();
        if let Err(e) = read_log(&path, &Mapping::default(), &[]) {
            assert!(e.to_string().len() < 500, "{e}");
        }
    }
}

#[test]
fn a_page_that_asks_for_a_dictionary_it_has_not_is_refused() {
    // Found by the property above: the decoder panics on it.
    damaged(small_parquet(), &[(9980, 163)], "x.parquet");
}

fn small_parquet() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.parquet");
    let force = vec![Some(1.0), Some(2.0), Some(3.0)];
    let columns = [
        Column::new("t_s", Values::Double(vec![0.0, 1.0, 2.0])),
        Column::new("x_m", Values::OptionalDouble(force)),
    ];
    parquet_file::write(&path, &columns, 2);
    fs::read(&path).unwrap()
}

/// Whatever is read from a damaged file is either refused or a proper log.
fn damaged(mut bytes: Vec<u8>, flips: &[(usize, u8)], name: &str) {
    for &(at, value) in flips {
        let at = at % bytes.len();
        bytes[at] = value;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    if let Ok(log) = read_log(&path, &emps(), &[]) {
        assert!(log.time().windows(2).all(|w| w[0] < w[1]));
    }
}

/// Two row groups, plain and by dictionary, with and without nulls allowed.
#[test]
#[ignore = "writes tests/fixtures/log.parquet, on which `cargo xtask torture` works"]
fn make_the_parquet_fixture() {
    let rows = 0..120;
    // At rest, there and back in steps of 1 mm.
    let place = |k: i32| f64::from((k - 20).max(0).min(120 - k)) * 1e-3 + 0.6;
    let columns = [
        Column::new(
            "t_s",
            Values::Double(rows.clone().map(|k| f64::from(k) * 1e-3).collect()),
        ),
        Column::new(
            "position_ref_m",
            Values::Double(rows.clone().map(place).collect()),
        ),
        Column::new(
            "position_m",
            Values::OptionalDouble(rows.clone().map(|k| Some(place(k) + 1e-6)).collect()),
        ),
        Column::new(
            "iq_a",
            Values::Float(rows.clone().map(|k| (k % 3) as f32).collect()),
        ),
        Column::new(
            "ticks_1",
            Values::Int64(rows.clone().map(i64::from).collect()),
        ),
        Column::new("state_1", Values::Int32(rows.map(|k| k / 60).collect())),
    ];
    parquet_file::write(&fixture("log.parquet"), &columns, 2);
}
