//! What a circle of two axes showed.

use std::fmt::{self, Write};
use std::path::Path;

use serde::Serialize;

use super::contour_found::{Both, Reversal};

/// What was found, in µm.
#[derive(Serialize)]
pub struct Contoured<'a> {
    /// Names of the axes.
    pub x: &'a str,
    pub y: &'a str,
    pub compensation: &'a str,
    pub radius_mm: f64,
    pub feed_m_per_min: f64,
    /// Greatest speed along the path.
    pub fastest_m_per_min: f64,
    /// Of one direction, run-in and run-out included.
    pub duration_s: f64,
    pub clockwise: Turned,
    pub counterclockwise: Turned,
    pub both: Both,
    pub report: Option<&'a Path>,
}

/// One direction.
#[derive(Serialize)]
pub struct Turned {
    /// Greatest distance from the circle.
    pub contour_error_um: f64,
    /// Circular deviation G.
    pub g_um: f64,
    /// Radial deviations F.
    pub f_max_um: f64,
    pub f_min_um: f64,
    /// Peaks of the radial deviation after an axis has reversed.
    pub reversals: Vec<Reversal>,
}

impl Contoured<'_> {
    /// What was run, in one line.
    pub fn title(&self) -> String {
        let reached = match self.fastest_m_per_min < REACHED * self.feed_m_per_min {
            true => format!(
                " (not reached: {:.1} m/min at most within acceleration and jerk)",
                self.fastest_m_per_min
            ),
            false => String::new(),
        };
        format!(
            "X {}, Y {}: circle of {} mm at {} m/min{reached}, compensation {} (simulated)",
            self.x,
            self.y,
            self.radius_mm,
            self.feed_m_per_min,
            self.compensation.replace('_', "-")
        )
    }

    /// The figures of both directions: name, clockwise, counterclockwise, µm.
    pub fn rows(&self) -> [(&'static str, f64, f64); 4] {
        let (a, b) = (&self.clockwise, &self.counterclockwise);
        [
            (
                "contour error, greatest",
                a.contour_error_um,
                b.contour_error_um,
            ),
            ("circular deviation G", a.g_um, b.g_um),
            ("radial deviation F max", a.f_max_um, b.f_max_um),
            ("radial deviation F min", a.f_min_um, b.f_min_um),
        ]
    }

    /// Those of both together.
    pub fn together(&self) -> [(&'static str, f64); 3] {
        let both = &self.both;
        [
            ("bidirectional circular deviation G(b)", both.g_um),
            ("circular hysteresis H", both.h_um),
            ("mean bidirectional radial deviation D", both.d_um),
        ]
    }
}

/// Share of the feed from which on it counts as reached.
const REACHED: f64 = 0.99;

impl fmt::Display for Contoured<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        writeln!(
            f,
            "{:<40}{:>12}{:>20}",
            "µm", "clockwise", "counterclockwise"
        )?;
        for (name, there, back) in self.rows() {
            writeln!(f, "{name:<40}{there:>12.3}{back:>20.3}")?;
        }
        for (name, value) in self.together() {
            writeln!(f, "{name:<40}{value:>12.3}")?;
        }
        let turns = [
            ("clockwise", &self.clockwise),
            ("counterclockwise", &self.counterclockwise),
        ];
        for (name, turn) in turns {
            let mut peaks = String::new();
            for r in &turn.reversals {
                let _ = write!(
                    peaks,
                    "; {} at {:.0}°: {:.3} µm",
                    r.axis, r.angle_deg, r.peak_um
                );
            }
            writeln!(f, "after a reversal, {name}{}", peaks.replacen(';', ":", 1))?;
        }
        match self.report {
            Some(path) => write!(f, "{}", path.display()),
            None => Ok(()),
        }
    }
}
