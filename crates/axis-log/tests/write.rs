//! Logs to CSV, Parquet and MAT: read back to the same bits, laid out as documented.

use std::fs;
use std::path::Path;

use axis_log::{Channel, LAYOUT, Log, LogFile, LogSink, Mapping, read_log, unit_of, write};
use base64::Engine as _;
use parquet::file::reader::{FileReader, SerializedFileReader};
use proptest::prelude::*;

const EXTENSIONS: [&str; 4] = ["csv", "parquet", "mat", "MAT"];

fn log(rows: usize) -> Log {
    let samples = |from: f64| {
        (0..rows)
            .map(|k| from + k as f64 * 1e-3)
            .collect::<Vec<_>>()
    };
    let channels = ["t_s", "position_m", "acceleration_m_s2", "torque_n_m"];
    let one = |(k, name): (usize, &&str)| Channel::new(*name, samples(k as f64)).unwrap();
    Log::new(channels.iter().enumerate().map(one).collect()).unwrap()
}

fn bits(log: &Log) -> Vec<Vec<u64>> {
    let of = |c: &Channel| c.samples.iter().map(|v| v.to_bits()).collect();
    log.channels().iter().map(of).collect()
}

proptest! {
    // Each case writes four files.
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn every_format_gives_back_the_same_bits(
        rows in prop::collection::vec(
            (1e-9..1e3f64, prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO),
            1..60,
        ),
    ) {
        let mut now = 0.0;
        let time: Vec<f64> = rows.iter().map(|(dt, _)| { now += dt; now }).collect();
        let force: Vec<f64> = rows.iter().map(|&(_, v)| v).collect();
        let log = Log::new(vec![
            Channel::new("t_s", time).unwrap(),
            Channel::new("force_n", force).unwrap(),
        ]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        for extension in EXTENSIONS {
            let path = folder.path().join(format!("log.{extension}"));
            write(&path, &log).unwrap();
            let again = read_log(&path, &Mapping::default(), &["force_n"]).unwrap();
            prop_assert_eq!(bits(&again), bits(&log), "{}", extension);
        }
        prop_assert_eq!(fs::read_dir(folder.path()).unwrap().count(), EXTENSIONS.len());
    }
}

/// Blocks that are no whole row groups, and more than one of them.
#[test]
fn a_log_in_blocks_is_the_log() {
    let whole = log(150_000);
    let folder = tempfile::tempdir().unwrap();
    for extension in ["csv", "parquet", "mat"] {
        let path = folder.path().join(format!("blocks.{extension}"));
        let mut file = LogFile::create(&path).unwrap();
        let mut from = 0;
        for length in [1, 70_000, 4096, 75_903] {
            file.write(&whole.skip(from).unwrap().first(length).unwrap())
                .unwrap();
            from += length;
        }
        assert!(!path.exists(), "put in place before it is whole");
        Box::new(file).finish().unwrap();
        let again = read_log(&path, &Mapping::default(), &[]).unwrap();
        assert!(again == whole, "{extension}");
        let at_once = folder.path().join(format!("once.{extension}"));
        write(&at_once, &whole).unwrap();
        let same = fs::read(&at_once).unwrap() == fs::read(&path).unwrap();
        assert!(same, "{extension}: the blocks can be seen in the bytes");
    }
}

#[test]
fn what_cannot_be_written_is_refused_and_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, log: &Log| {
        let path = folder.path().join(name);
        let message = write(&path, log).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
        message
    };
    for name in ["log.txt", "log"] {
        let found = message(name, &log(2));
        assert!(found.contains(".csv or .parquet or .mat"), "{found}");
    }
    let found = message("none/log.mat", &log(2));
    assert!(found.contains("cannot create a file"), "{found}");
    let odd = ["t_s", "Ist 1_m"].map(|name| Channel::new(name, vec![0.0]).unwrap());
    let odd = Log::new(odd.to_vec()).unwrap();
    fs::write(folder.path().join("log.mat"), "mine").unwrap();
    let found = message("log.mat", &odd);
    assert!(
        found.contains("\"Ist 1_m\" cannot be a variable"),
        "{found}"
    );
    assert_eq!(fs::read(folder.path().join("log.mat")).unwrap(), b"mine");
    for extension in ["csv", "parquet", "mat"] {
        let path = folder.path().join(format!("a.{extension}"));
        let empty = LogFile::create(&path).unwrap();
        assert!(Box::new(empty).finish().is_err(), "no block");
        let mut other = LogFile::create(&path).unwrap();
        other.write(&log(1)).unwrap();
        assert!(other.write(&odd).is_err(), "other channels");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// A little-endian number of up to eight bytes.
fn number(bytes: &[u8], at: usize, length: usize) -> usize {
    let one = |k: usize| usize::from(bytes[at + k]) << (8 * k);
    (0..length).map(one).sum()
}

/// Elements of a MAT file: type and data, as pages 1-9 and 1-10 of "MAT-File Format" have them.
fn elements(mut bytes: &[u8]) -> Vec<(usize, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let (kind, small) = (number(bytes, 0, 2), number(bytes, 2, 2));
        let (from, length) = match small {
            0 => (8, number(bytes, 4, 4)),
            _ => (4, small),
        };
        found.push((kind, &bytes[from..from + length]));
        bytes = &bytes[(from + length).next_multiple_of(8)..];
    }
    found
}

#[test]
fn a_mat_file_is_laid_out_as_documented() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mat");
    write(&path, &log(3)).unwrap();
    let bytes = fs::read(&path).unwrap();
    assert!(bytes.starts_with(b"MATLAB 5.0 MAT-file"));
    // No data of subsystems, version 0x0100, little-endian.
    assert_eq!(&bytes[116..128], b"\0\0\0\0\0\0\0\0\0\x01IM");
    let arrays = elements(&bytes[128..]);
    assert!(arrays.iter().all(|(kind, _)| *kind == 14));
    let parts: Vec<_> = arrays.iter().map(|(_, array)| elements(array)).collect();
    let class = |parts: &[(usize, &[u8])]| parts[0].1[0];
    let position = &parts[1];
    assert_eq!(class(position), 6);
    assert_eq!(
        position.iter().map(|p| p.0).collect::<Vec<_>>(),
        [6, 5, 1, 9]
    );
    assert_eq!(position[1].1, [3, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(position[2].1, b"position_m");
    assert_eq!(position[3].1[..8], 1.0_f64.to_le_bytes());
    let units = &parts[4];
    assert_eq!((class(units), units[2].1), (2, &b"units"[..]));
    assert_eq!(
        units[3],
        (5, &[32, 0, 0, 0][..]),
        "length of a field's name"
    );
    let fields = units[4].1.chunks(32).map(|name| {
        let name = name.split(|byte| *byte == 0).next().unwrap();
        String::from_utf8(name.to_vec()).unwrap()
    });
    for (field, (kind, value)) in fields.zip(&units[5..]) {
        let value = elements(value);
        assert_eq!((*kind, class(&value), value[3].0), (14, 4, 17));
        let text: Vec<u16> = value[3]
            .1
            .chunks(2)
            .map(|c| number(c, 0, 2) as u16)
            .collect();
        assert_eq!(String::from_utf16(&text).ok().as_deref(), unit_of(&field));
        assert_eq!(number(value[1].1, 4, 4), text.len());
    }
    assert_eq!(units.len(), 5 + 4);
    let version = &parts[5];
    assert_eq!(version[2].1, b"axis_log_version");
    assert_eq!(version[3].1, f64::from(LAYOUT).to_le_bytes());
}

/// The place of a field of a table of a FlatBuffer, where it has it
/// (<https://flatbuffers.dev/internals/>).
fn place(bytes: &[u8], table: usize, field: usize) -> Option<usize> {
    let signed = i32::from_le_bytes(bytes[table..table + 4].try_into().unwrap());
    let vtable = usize::try_from(i64::try_from(table).unwrap() - i64::from(signed)).unwrap();
    let entry = 4 + 2 * field;
    let offset = (entry < number(bytes, vtable, 2)).then(|| number(bytes, vtable + entry, 2))?;
    (offset != 0).then_some(table + offset)
}

fn follow(bytes: &[u8], at: usize) -> usize {
    at + number(bytes, at, 4)
}

fn text(bytes: &[u8], table: usize, field: usize) -> &str {
    let at = follow(bytes, place(bytes, table, field).unwrap());
    std::str::from_utf8(&bytes[at + 4..at + 4 + number(bytes, at, 4)]).unwrap()
}

/// The tables of a vector of tables.
fn tables(bytes: &[u8], table: usize, field: usize) -> Vec<usize> {
    let at = follow(bytes, place(bytes, table, field).unwrap());
    let one = |k: usize| follow(bytes, at + 4 + 4 * k);
    (0..number(bytes, at, 4)).map(one).collect()
}

#[test]
fn a_parquet_file_says_the_unit_of_each_field() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    write(&path, &log(3)).unwrap();
    let value = |key: &str| metadata(&path, key);
    assert_eq!(value("axis-log"), LAYOUT.to_string());
    let message = base64::engine::general_purpose::STANDARD
        .decode(value("ARROW:schema"))
        .unwrap();
    assert_eq!(number(&message, 0, 4), 0xffff_ffff);
    assert_eq!(number(&message, 4, 4), message.len() - 8);
    let bytes = &message[8..];
    let root = follow(bytes, 0);
    // Message: version V5, header of type Schema.
    assert_eq!(number(bytes, place(bytes, root, 0).unwrap(), 2), 4);
    assert_eq!(bytes[place(bytes, root, 1).unwrap()], 1);
    let schema = follow(bytes, place(bytes, root, 2).unwrap());
    let fields = tables(bytes, schema, 1);
    let log = log(1);
    assert_eq!(fields.len(), log.channels().len());
    for (field, channel) in fields.into_iter().zip(log.channels()) {
        assert_eq!(text(bytes, field, 0), channel.name);
        // Not nullable, floating point of double precision.
        assert_eq!(place(bytes, field, 1), None);
        assert_eq!(bytes[place(bytes, field, 2).unwrap()], 3);
        let kind = follow(bytes, place(bytes, field, 3).unwrap());
        assert_eq!(number(bytes, place(bytes, kind, 0).unwrap(), 2), 2);
        let pairs = tables(bytes, field, 6);
        assert_eq!(pairs.len(), 1);
        assert_eq!(text(bytes, pairs[0], 0), "unit");
        assert_eq!(text(bytes, pairs[0], 1), channel.unit);
    }
}

fn metadata(path: &Path, key: &str) -> String {
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let all = reader.metadata().file_metadata().key_value_metadata();
    let found = all.unwrap().iter().find(|pair| pair.key == key).unwrap();
    found.value.clone().unwrap()
}
