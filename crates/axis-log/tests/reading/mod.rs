//! Mappings, messages and noise that tests share.

use std::path::Path;

use axis_log::{ColumnMap, Log, Mapping};

pub const REQUIRED: &[&str] = &["position_ref_m", "position_m"];

pub fn map(source: &str, channel: &str, scale: f64, offset: f64) -> ColumnMap {
    ColumnMap {
        source: source.into(),
        channel: channel.into(),
        scale,
        is_scale_stated: true,
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

/// Numbers between −1 and 1 of variance 1/3, the same on every machine.
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
