//! Parquet and MAT as other programs write them.

use axis_log::{ColumnMap, ColumnUnit, Mapping, read_log};

use super::{assert_near, given, told};
use crate::parquet_file::by_hand::{Codec, Stored, file};
use crate::reading::mapping;

fn values(rows: usize) -> Vec<Option<f64>> {
    let value = |k: usize| (k % 7 != 3).then_some(0.25 * k as f64 - 3.0);
    (0..rows).map(value).collect()
}

/// Every way to compress, either kind of page, nulls as holes.
#[test]
fn every_codec_is_read_and_null_is_a_hole() {
    let (rows, missing) = (300, values(300));
    let time: Vec<Option<f64>> = (0..rows).map(|k| Some(1e-3 * k as f64)).collect();
    for codec in Codec::ALL {
        for second in [false, true] {
            let columns = [
                ("t_s", Stored::Doubles(time.clone())),
                ("position_m", Stored::Doubles(missing.clone())),
            ];
            let given = given("log.parquet", file(&columns, codec, second));
            let log = given.plain();
            assert_eq!(log.log.len(), rows, "{codec:?}");
            let holes: Vec<_> = (0..rows).filter(|k| k % 7 == 3).map(|k| k..k + 1).collect();
            assert_eq!(log.log.missing("position_m"), holes, "{codec:?}");
            let found = log.log.channel("position_m").unwrap();
            // A straight line stands in the holes, and the values are one.
            assert_near(found, |k| 0.25 * k as f64 - 3.0, 1e-12);
            assert!(told(&log).contains("without a value"), "{}", told(&log));
            // A reader that takes no holes names the first.
            let message = read_log(&given.path, &Mapping::default(), &[]).unwrap_err();
            assert!(
                message
                    .to_string()
                    .contains("row 4 (\"position_m\"): the value is missing")
            );
        }
    }
}

/// A page that is cut, or holds other bytes, is damaged whatever it is compressed by; nothing panics.
#[test]
fn damaged_pages_of_every_codec_are_refused_or_read() {
    let columns = [("position_m", Stored::Doubles(values(60)))];
    let rate = mapping(&[], Some(1e3));
    for codec in Codec::ALL {
        let whole = file(&columns, codec, false);
        for at in 4..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x5a;
            let given = given("log.parquet", &damaged);
            if let Err(e) = read_log(&given.path, &rate, &[]) {
                assert!(e.to_string().len() < 600, "{e}");
            }
        }
    }
}

/// Time stamps have the unit of their type, under a mapping without scale too.
#[test]
fn typed_time_stamps_are_read_with_their_unit() {
    for (unit, of_second) in [("ms", 1_000_i64), ("us", 1_000_000), ("ns", 1_000_000_000)] {
        let start = 1_700_000_000 * of_second;
        let stamps: Vec<i64> = (0..200).map(|k| start + k * of_second / 250).collect();
        for (name, mapped) in [("t_s", false), ("timestamp", false), ("stamp", true)] {
            let columns = [
                (name, Stored::Stamps(stamps.clone(), unit)),
                ("position_m", Stored::Doubles(values(200))),
            ];
            let given = given("log.parquet", file(&columns, Codec::Plain, false));
            let log = match (mapped, name) {
                (true, _) => {
                    let unit = ColumnUnit::default();
                    given.mapped(&Mapping {
                        columns: vec![ColumnMap::in_unit(name, "t_s", unit).unwrap()],
                        sample_rate_hz: None,
                    })
                }
                (_, "t_s") => given.plain(),
                _ => given.accepted(),
            };
            // Seconds since 1970 are rounded to 2.4e-7 s, of 4 ms.
            assert!((super::rate(&log) - 250.0).abs() < 0.01, "{unit} {name}");
            assert!((log.log.time()[0] - 1.7e9).abs() < 1e-6, "{unit} {name}");
        }
    }
}

/// One element of a MAT file, little-endian.
fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
    bytes.extend(content);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

/// An array: its class, its size, its name, and what follows.
fn array(class: u32, size: [u32; 2], name: &str, rest: &[Vec<u8>]) -> Vec<u8> {
    let head = [
        element(6, &words(&[class, 0])),
        element(5, &words(&size)),
        element(1, name.as_bytes()),
    ];
    element(14, &[head.concat(), rest.concat()].concat())
}

fn doubles(size: [u32; 2], name: &str, values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    array(6, size, name, &[element(9, &bytes)])
}

fn structure(size: [u32; 2], name: &str, fields: &[&str], arrays: &[Vec<u8>]) -> Vec<u8> {
    let mut names = Vec::new();
    for field in fields {
        let mut own = field.as_bytes().to_vec();
        own.resize(16, 0);
        names.extend(own);
    }
    let head = vec![element(5, &words(&[16])), element(1, &names)];
    array(2, size, name, &[head, arrays.to_vec()].concat())
}

/// Structs, a matrix, cells and a text, of 50 instants and three signals one behind the other.
fn nested(time: &[f64], q: &[f64]) -> Vec<u8> {
    let text = array(4, [1, 2], "", &[element(4, &[b'o', 0, b'k', 0])]);
    let inner = structure([1, 1], "", &["iq"], &[doubles([50, 1], "", &q[..50])]);
    let data = structure(
        [1, 1],
        "data",
        &["t", "q", "note", "sub", "none"],
        &[
            doubles([50, 1], "", time),
            doubles([50, 3], "", q),
            text,
            inner,
            element(14, &[]),
        ],
    );
    let runs = structure(
        [1, 2],
        "run",
        &["x"],
        &[
            doubles([1, 50], "", time),
            doubles([1, 50], "", &q[50..100]),
        ],
    );
    let cells = array(
        1,
        [2, 1],
        "c",
        &[doubles([50, 1], "", time), doubles([50, 1], "", &q[100..])],
    );
    // Rows are longer: each is a signal.
    let flat = doubles([2, 50], "flat", &q[..100]);
    [data, runs, cells, flat].concat()
}

/// A file of arrays, each deflated by itself or not.
fn file_of(arrays: &[u8], compressed: bool) -> Vec<u8> {
    let mut bytes = [&[b' '; 124][..], &[0, 1, b'I', b'M']].concat();
    let mut rest = arrays;
    while !rest.is_empty() {
        let length = u32::from_le_bytes(rest[4..8].try_into().unwrap()) as usize;
        let (one, after) = rest.split_at(8 + length.next_multiple_of(8));
        match compressed {
            false => bytes.extend(one),
            true => {
                let small = miniz_oxide::deflate::compress_to_vec_zlib(one, 6);
                bytes.extend([15_u32.to_le_bytes(), (small.len() as u32).to_le_bytes()].concat());
                bytes.extend(small);
            }
        }
        rest = after;
    }
    bytes
}

#[test]
fn signals_of_structs_matrices_and_cells_are_offered_by_their_path() {
    let time: Vec<f64> = (0..50).map(|k| 0.002 * f64::from(k)).collect();
    // Three axes side by side; column by column in the file.
    let q: Vec<f64> = (0..150).map(f64::from).collect();
    let whole = nested(&time, &q);
    for compressed in [false, true] {
        let given = given("log.mat", file_of(&whole, compressed));
        let mapped = mapping(
            &[
                ("data.t", "t_s", 1.0),
                ("data.q(2)", "a_m", 1.0),
                ("data.sub.iq", "iq_a", 1.0),
                ("run(2).x", "b_m", 1.0),
                ("c{2}", "c_m", 1.0),
                ("flat(2)", "d_m", 1.0),
            ],
            None,
        );
        let required = ["a_m", "iq_a", "b_m", "c_m", "d_m"];
        let log = read_log(&given.path, &mapped, &required).unwrap();
        assert_eq!(log.time(), time);
        for (channel, from, step) in [
            ("a_m", 50, 1),
            ("iq_a", 0, 1),
            ("b_m", 50, 1),
            ("c_m", 100, 1),
            ("d_m", 1, 2),
        ] {
            let found = log.channel(channel).unwrap();
            assert_near(found, |k| (from + step * k) as f64, 0.0);
            assert_eq!(found.len(), 50);
        }
        // What has no numbers is told as what it is, and nothing is called damaged.
        let wrong = mapping(&[("data.t", "t_s", 1.0), ("data.note", "x_m", 1.0)], None);
        let message = read_log(&given.path, &wrong, &["x_m"])
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("column \"data.note\" is text"),
            "{message}"
        );
        let absent = mapping(&[("data.t", "t_s", 1.0)], None);
        let message = read_log(&given.path, &absent, &["x_m"])
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("\"data.q(3)\"") && !message.contains("damaged"),
            "{message}"
        );
    }
}
