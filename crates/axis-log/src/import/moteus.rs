//! CSV files of moteus controllers, as the maker's own example writes them.
//!
//! `CsvController` of
//! [csv_output.py](https://github.com/mjbots/moteus/blob/main/lib/python/examples/csv_output.py)
//! writes a line of names and a line for each answer of a controller:
//!
//! ```text
//! time,MODE,POSITION,VELOCITY,TORQUE,VOLTAGE,TEMPERATURE,FAULT
//! 0.0013,10,0.0123,0.5,0.02,24.5,31.0,0
//! ```
//!
//! Names are those of `moteus.Register`, or a number as `0x01a`; `time` is in seconds of the
//! clock of the computer that asks, since the file was begun or since 1970. A register that an
//! answer does not have is written as 0.

use super::{Format, Found};
use crate::csv_table::CsvTable;
use crate::log::TIME_CHANNEL;
use crate::table::Head;

pub(super) const FORMAT: Format = Format {
    name: "moteus (csv_output.py)",
    is_it,
    open: |bytes| {
        Ok(Box::new(
            CsvTable::open(bytes)?.with_names([TIME_CHANNEL.to_owned()]),
        ))
    },
    columns: proposed,
    caution: "times are those at which the computer received the answers, so they are uneven; position, velocity and torque are of the output, which is the motor's only without a gear in the controller's configuration; what an answer lacked is written as 0",
};

const TIME: &str = "time";
/// Registers that the example always asks for.
const ALWAYS: [&str; 2] = ["MODE", "POSITION"];

/// Registers, what they are, and their unit
/// (<https://github.com/mjbots/moteus/blob/main/docs/protocol/registers.md>).
const REGISTERS: &[(&str, &str, &str)] = &[
    ("POSITION", "motor_angle_rad", "rev"),
    ("VELOCITY", "motor_speed_rad_s", "rev/s"),
    ("TORQUE", "torque_n_m", "N·m"),
    ("Q_CURRENT", "iq_a", "A"),
    ("D_CURRENT", "id_a", "A"),
];

fn proposed(heads: &[&Head]) -> Vec<Found> {
    let one = |(register, channel, unit): &(&str, &'static str, &'static str)| {
        let head = heads.iter().find(|head| head.name == *register)?;
        Some(Found::of("", head, channel, unit))
    };
    REGISTERS.iter().filter_map(one).collect()
}

/// `time`, and registers behind it.
fn is_it(bytes: &[u8]) -> bool {
    let line = bytes.split(|byte| *byte == b'\n').next();
    let Some(Ok(line)) = line.map(std::str::from_utf8) else {
        return false;
    };
    let mut names = line.trim_ascii_end().split(',');
    let is_first = names.next() == Some(TIME);
    is_first
        && names.clone().all(is_register)
        && ALWAYS.iter().all(|a| names.clone().any(|n| n == *a))
}

/// `Q_CURRENT`, `0x01a`.
fn is_register(name: &str) -> bool {
    if let Some(number) = name.strip_prefix("0x") {
        return !number.is_empty() && number.bytes().all(|b| b.is_ascii_hexdigit());
    }
    let fits = |b: u8| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_';
    name.starts_with(|c: char| c.is_ascii_uppercase()) && name.bytes().all(fits)
}
