//! Mappings and messages that the tests of `read_log` share.

use std::path::Path;

use axis_log::{ColumnMap, Log, Mapping};

pub const REQUIRED: &[&str] = &["position_ref_m", "position_m"];

pub fn map(source: &str, channel: &str, scale: f64, offset: f64) -> ColumnMap {
    ColumnMap {
        source: source.into(),
        channel: channel.into(),
        scale,
        offset,
        delay: 0.0,
    }
}

pub fn mapping(columns: &[(&str, &str, f64)], sample_rate_hz: Option<f64>) -> Mapping {
    Mapping {
        columns: columns.iter().map(|&(s, c, k)| map(s, c, k, 0.0)).collect(),
        sample_rate_hz,
    }
}

pub fn names(log: &Log) -> Vec<&str> {
    log.channels().iter().map(|c| c.name.as_str()).collect()
}

pub fn without_folder(message: &str, folder: &Path) -> String {
    let prefix = format!("{}/", folder.display());
    message
        .strip_prefix(&prefix)
        .expect("the file first")
        .into()
}

pub fn emps() -> Mapping {
    mapping(
        &[
            ("t", "t_s", 1.0),
            ("qg", "position_ref_m", 1.0),
            ("qm", "position_m", 1.0),
            ("vir", "drive_command_v", 2.0),
        ],
        None,
    )
}
