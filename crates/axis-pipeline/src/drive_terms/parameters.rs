//! Where a term is entered in drives and controls of makers: numbers of parameters, as their manuals name them.
//!
//! Sources, as docs/drive-terms-sinumerik.md and docs/drive-terms-twincat.md list them:
//!
//! - SINAMICS S210: "SINAMICS Parameter SINAMICS S210", Siemens TIA Portal Information System (offline help, en-US,
//!   package sdrpa400), which states the units;
//! - SINAMICS S120: "Servo drives (highly dynamic)", the same help (package Stdr011000UI), which states no units;
//! - SINUMERIK 840D: Installation and Start-Up Guide, 04.00, 6.9.10;
//! - AX5000: IDN description, AX8000: Object description, TwinCAT CNC: TF5200 Axis parameters, Beckhoff Information System.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::Serialize;

/// A parameter of a maker's drive or control for a term.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DriveParameter {
    /// Drive or control.
    pub drive: &'static str,
    /// Number, as its manual names it.
    pub parameter: &'static str,
    /// What to enter; none where it takes more than this term.
    pub value: Option<f64>,
    /// In which unit; none where the manual that was read states no unit: compare it in the drive.
    pub unit: Option<&'static str>,
    /// What else is to be known.
    pub note: Option<&'static str>,
}

/// What is entered of a term.
#[derive(Clone, Copy)]
enum Enter {
    /// The value in the drive's unit, times this.
    Times(f64),
    /// The time constant, s, of a low pass whose corner the value is, Hz; times this.
    TimeConstant(f64),
    /// More than this term.
    More,
}

struct Row {
    term: &'static str,
    drive: &'static str,
    parameter: &'static str,
    enter: Enter,
    unit: Option<&'static str>,
    note: Option<&'static str>,
    /// Whether it is one of a motor that turns alone.
    is_rotary: bool,
}

const S120: &str = "SINAMICS S120";
const S210: &str = "SINAMICS S210";
const SINUMERIK: &str = "SINUMERIK 840D";
const AX5000: &str = "AX5000";
const AX8000: &str = "AX8000";
const CNC: &str = "TwinCAT CNC";

const fn row(
    term: &'static str,
    drive: &'static str,
    parameter: &'static str,
    enter: Enter,
    unit: Option<&'static str>,
) -> Row {
    Row {
        term,
        drive,
        parameter,
        enter,
        unit,
        note: None,
        is_rotary: false,
    }
}

impl Row {
    const fn rotary(self) -> Self {
        Self {
            is_rotary: true,
            ..self
        }
    }

    const fn noted(self, note: &'static str) -> Self {
        Self {
            note: Some(note),
            ..self
        }
    }
}

const ONE: Enter = Enter::Times(1.0);
const LOAD: &str = "the load's inertia: this total less the motor's own (p0341)";
const FILTER: &str = "type of the first current set-point filter; frequency and damping beside it";
const POINTS: &str = "friction torques at the speeds p3820 to p3829; p3842 = 1 switches it on, r3841 is connected to p1569";

const ROWS: &[Row] = &[
    row("position_gain", SINUMERIK, "MD32200", ONE, Some("1000/min")),
    row("position_gain", AX5000, "S-0-0104", ONE, Some("1000/min")),
    // From 1000/min to 0.01/s.
    row(
        "position_gain",
        CNC,
        "P-AXIS-00099",
        Enter::Times(1e5 / 60.0),
        Some("0.01/s"),
    ),
    row("speed_gain", S120, "p1460", ONE, None).rotary(),
    row("speed_gain", S210, "p1460", ONE, Some("N·m·s/rad")).rotary(),
    row("speed_gain", AX5000, "S-0-0100", ONE, Some("N·m/(rad/s)"))
        .rotary()
        .noted("with bit 15 of P-0-0010 set"),
    row("speed_gain", AX8000, "3140:01", ONE, Some("N·m/(rad/s)")).rotary(),
    row("speed_integral_time", S120, "p1462", ONE, None),
    row("speed_integral_time", S210, "p1462", ONE, Some("ms")),
    row("speed_integral_time", AX5000, "S-0-0101", ONE, Some("ms")),
    row(
        "speed_integral_time",
        AX8000,
        "3140:02",
        Enter::Times(1e-3),
        Some("s"),
    ),
    row(
        "speed_lowpass",
        S210,
        "p1441",
        Enter::TimeConstant(1e3),
        Some("ms"),
    ),
    row("command_lowpass", S120, "p1657", Enter::More, None).noted(FILTER),
    row("notch_frequency", S120, "p1657", Enter::More, None).noted(FILTER),
    row("current_q_gain", S120, "p1715", ONE, None),
    row("current_q_gain", AX5000, "S-0-0106", ONE, Some("V/A")),
    row("current_q_integral_time", S120, "p1717", ONE, None),
    row(
        "current_q_integral_time",
        AX5000,
        "S-0-0107",
        ONE,
        Some("ms"),
    ),
    row(
        "current_d_integral_time",
        AX5000,
        "S-0-0120",
        ONE,
        Some("ms"),
    ),
    row("inertia_total", S120, "p1498", Enter::More, None)
        .rotary()
        .noted(LOAD),
    row("inertia_total", S210, "p1498", Enter::More, Some("kg·m²"))
        .rotary()
        .noted(LOAD),
    row(
        "coulomb_friction",
        S120,
        "p3830 to p3839",
        Enter::More,
        None,
    )
    .rotary()
    .noted(POINTS),
    row(
        "viscous_friction",
        S120,
        "p3830 to p3839",
        Enter::More,
        None,
    )
    .rotary()
    .noted(POINTS),
    row("coulomb_friction", AX8000, "3144:02", ONE, Some("N·m")).rotary(),
    row("standing_load", S120, "p1532", ONE, None).rotary(),
    row("standing_load", S210, "p1532", ONE, Some("N·m")).rotary(),
    row("standing_load", AX8000, "3140:05", ONE, Some("N·m")).rotary(),
];

/// The parameters of a term by its name and its value in a drive's unit, of an axis whose motor turns, or is linear.
pub(super) fn parameters(term: &str, drive_value: f64, is_rotary: bool) -> Vec<DriveParameter> {
    let of = ROWS.iter().filter(|row| row.term == term);
    of.filter(|row| is_rotary || !row.is_rotary)
        .map(|row| DriveParameter {
            drive: row.drive,
            parameter: row.parameter,
            value: match row.enter {
                Enter::Times(by) => Some(by * drive_value),
                Enter::TimeConstant(by) => Some(by / (TAU * drive_value)),
                Enter::More => None,
            },
            unit: row.unit,
            note: row.note,
        })
        .collect()
}
