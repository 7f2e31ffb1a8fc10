//! Files of machines.

use std::path::PathBuf;

use axis_machine::MachineFile;

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data"))
}

/// Reads a file with this text in a folder beside the axis files.
fn read(text: &str) -> Result<MachineFile, String> {
    let axes = folder().join("axes").canonicalize().unwrap();
    let text = text.replace("AXES", axes.to_str().unwrap());
    let path = std::env::temp_dir().join(format!(
        "machine-{}-{:x}.toml",
        std::process::id(),
        hash(&text)
    ));
    std::fs::write(&path, text).unwrap();
    let read = MachineFile::read(&path).map_err(|e| e.to_string());
    std::fs::remove_file(&path).unwrap();
    read
}

fn hash(text: &str) -> u64 {
    text.bytes()
        .fold(5381, |h: u64, b| h.wrapping_mul(33) ^ u64::from(b))
}

const TWO: &str = "schema = 1\nname = \"m\"\n[axes]\nx = \"AXES/linear-stage.toml\"\ny = \"AXES/linear-stage.toml\"\n";

#[test]
fn a_file_makes_a_machine() {
    let more = "[[coupling]]\nof = \"x\"\nby = \"y\"\nsquareness_um_per_m = 20\ncrosstalk_um_per_m_per_s2 = 10\nstraightness_mm_um = [[0, 0], [100, 2], [200, 0]]\n[[base]]\naxis = \"y\"\nfrequency_hz = 15\nmass_ratio = 0.1\n[[gantry]]\naxis = \"y\"\nsecond = \"AXES/linear-stage.toml\"\nstiffness_n_per_m = 1e6\n";
    let file = read(&format!("{TWO}{more}")).unwrap();
    assert_eq!(file.dimensions(), 2);
    let machine = file.machine::<2>().unwrap().unwrap();
    assert_eq!(machine.drives().len(), 3);
    let pair = &machine.coupling().pairs()[0];
    assert!((pair.squareness - 20e-6).abs() < 1e-18 && (pair.crosstalk - 10e-6).abs() < 1e-18);
    assert!((pair.straightness.as_ref().unwrap().at(0.1)[0] - 2e-6).abs() < 1e-18);
    assert!(file.machine::<3>().unwrap().is_none());
    // Nothing lies between axes unless the file says so.
    let plain = read(TWO).unwrap();
    assert!(plain.coupling().unwrap().pairs().is_empty());
}

#[test]
fn every_machine_file_of_this_repository_is_read() {
    let mut count = 0;
    for entry in std::fs::read_dir(folder().join("machines")).unwrap() {
        let path = entry.unwrap().path();
        let file = MachineFile::read(&path).unwrap_or_else(|e| panic!("{e}"));
        match file.dimensions() {
            3 => assert!(file.machine::<3>().unwrap().is_some()),
            _ => assert!(file.machine::<2>().unwrap().is_some()),
        }
        count += 1;
    }
    assert!(count >= 2, "{count}");
}

#[test]
fn what_is_wrong_is_said() {
    let cases = [
        ("schema = 1\n".to_owned(), "missing field `name`"),
        (
            format!("{TWO}[[coupling]]\nof = \"x\"\nby = \"y\"\nsquarenes_um_per_m = 1\n"),
            "squareness_um_per_m",
        ),
        (
            format!("{TWO}[[coupling]]\nof = \"x\"\nby = \"w\"\n"),
            "expected one of `x`, `y`, `z`",
        ),
        (
            format!("{TWO}[[coupling]]\nof = \"x\"\nby = \"z\"\n"),
            "names of [axes]",
        ),
        (TWO.replace("schema = 1", "schema = 2"), "valid: 1"),
        (TWO.replace("linear-stage", "no-such"), "no-such"),
    ];
    for (text, said) in cases {
        let error = read(&text).unwrap_err();
        assert!(error.contains(said), "{error}");
    }
    let later = [
        (
            "[[coupling]]\nof = \"x\"\nby = \"y\"\nsquareness_um_per_m = 20000\n",
            "10 000 µm/m",
        ),
        ("[[coupling]]\nof = \"x\"\nby = \"x\"\n", "another one"),
        (
            "[[base]]\naxis = \"x\"\nfrequency_hz = -1\nmass_ratio = 0.1\n",
            "from 0.1 to 500 Hz",
        ),
        (
            "[[base]]\naxis = \"x\"\nfrequency_hz = nan\nmass_ratio = 0.1\n",
            "from 0.1 to 500 Hz",
        ),
        (
            "[[gantry]]\naxis = \"x\"\nsecond = \"AXES/linear-stage.toml\"\nstiffness_n_per_m = 1e12\n",
            "N/m at this mass",
        ),
    ];
    for (more, said) in later {
        let file = read(&format!("{TWO}{more}")).unwrap();
        let error = file.machine::<2>().unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    let turning = read(&TWO.replacen("linear-stage", "rotary-table", 1)).unwrap();
    assert!(
        turning
            .machine::<2>()
            .unwrap_err()
            .to_string()
            .contains("turns")
    );
}
