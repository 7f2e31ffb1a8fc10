//! Captures of LinuxCNC's halscope.
//!
//! Halscope writes them in `write_log_file` of its
//! [source](https://github.com/LinuxCNC/linuxcnc/blob/master/src/hal/utils/scope_files.c), up to
//! 2.8 as [lines of names and values](lines), since 2.9 as a [table](table). A pin that was taken
//! into several channels is there as often.

mod lines;
mod table;

use super::{Format, Found};
use crate::error::CsvProblem;
use crate::read_error::{Place, ReadProblem};
use crate::table::Head;

pub(super) const FORMAT: Format = Format {
    name: "LinuxCNC halscope",
    is_it: |bytes| bytes.starts_with(PERIOD.as_bytes()) || table::is_it(bytes),
    open: |bytes| match table::is_it(bytes) {
        true => Ok(Box::new(table::Capture::read(bytes)?)),
        false => Ok(Box::new(lines::Capture::read(bytes)?)),
    },
    columns: proposed,
    caution: "the pins of motion(9) are in the machine's units: mm (or inch, deg) as LINEAR_UNITS and ANGULAR_UNITS of its INI file say",
};

const PERIOD: &str = "Sampling period is ";

/// What pins of a joint end in, what they are, and their unit on a machine in mm
/// (<https://manpages.ubuntu.com/manpages/noble/man9/motion.9.html>).
const PINS: &[(&str, &str, &str)] = &[
    (".motor-pos-cmd", "position_ref_m", "mm"),
    (".motor-pos-fb", "position_m", "mm"),
    (".vel-cmd", "velocity_ref_m_s", "mm/s"),
    (".acc-cmd", "acceleration_ref_m_s2", "mm/s²"),
];

fn proposed(heads: &[&Head]) -> Vec<Found> {
    let one = |head: &&Head| {
        let joint = head.name.strip_prefix("joint.")?;
        let pins = PINS.iter().rev();
        let mut found = pins.filter_map(|(end, channel, unit)| {
            let joint = joint.strip_suffix(end)?;
            Some(Found::of(joint, head, channel, unit))
        });
        found.next()
    };
    heads.iter().filter_map(one).collect()
}

/// The sampling period in s of what stands behind [`PERIOD`]: a number of nanoseconds, whose unit
/// is `nSec` up to 2.8 and `ns` in some of 2.7 and since 2.9.
fn period(behind: &str) -> Result<f64, ReadProblem> {
    let text = behind.trim();
    let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
    let unit = text[digits.len()..].trim();
    let is_known = ["", "ns", "nsec"].contains(&unit.to_ascii_lowercase().as_str());
    let period = digits.parse::<u32>().ok().filter(|ns| is_known && *ns > 0);
    period
        .map(|ns| f64::from(ns) * 1e-9)
        .ok_or_else(|| ReadProblem::NotANumber {
            place: Place::Line { line: 1, column: 1 },
            name: PERIOD.trim().to_owned(),
            text: text.to_owned(),
        })
}

/// The text.
fn text(bytes: &[u8]) -> Result<&str, CsvProblem> {
    std::str::from_utf8(bytes).map_err(|e| {
        let before = &bytes[..e.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count() as u64;
        CsvProblem::NotText { line }
    })
}
