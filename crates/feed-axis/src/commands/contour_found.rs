//! What `contour` finds on a machine, and its words.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_log::PlusMinus;
use serde::Serialize;

use super::contour::{Both, Reversal};
use super::contour_places::Place;

/// One lap of a path, in the path's coordinates of the plane that is shown.
pub struct Shown {
    /// Arc length of the feet, m.
    pub s: Vec<f64>,
    /// Contour error, m.
    pub error: Vec<f64>,
    /// Position and foot, m.
    pub at: Vec<[[f64; 2]; 2]>,
}

/// What was found, in µm.
#[derive(Serialize)]
pub struct MachineContoured {
    pub machine: String,
    pub path: String,
    /// The path and its feed, in words.
    #[serde(skip)]
    pub path_at_feed: String,
    pub compensation: &'static str,
    pub feed_m_per_min: f64,
    /// What was found from circles at two feeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identified: Option<IdentifiedCoupling>,
    /// Whether the references were corrected.
    pub corrected: bool,
    /// One for each sense of a circle, else one.
    pub directions: Vec<Contoured>,
    /// Both senses of a circle, last lap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub both: Option<Both>,
    pub feeds: Vec<FeedRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<PathBuf>,
}

/// Squareness and cross-talk of X by Y, with standard errors.
#[derive(Serialize)]
pub struct IdentifiedCoupling {
    pub squareness_um_per_m: [f64; 2],
    pub crosstalk_um_per_m_per_s2: [f64; 2],
    pub residual_um: f64,
}

/// One sense of a path.
#[derive(Serialize)]
pub struct Contoured {
    pub direction: String,
    pub duration_s: f64,
    pub laps: Vec<LapFigures>,
    /// Of the last lap.
    pub reversals: Vec<Reversal>,
    pub corners: Vec<Place>,
    pub curves: Vec<Place>,
    #[serde(skip)]
    pub shown: Shown,
}

/// One lap.
#[derive(Clone, Serialize)]
pub struct LapFigures {
    pub lap: usize,
    /// Greatest contour error, that of which 99 % are below, and root mean square.
    pub contour_error_um: f64,
    pub p99_um: f64,
    pub rms_um: f64,
}

/// One feed.
#[derive(Serialize)]
pub struct FeedRow {
    pub feed_m_per_min: f64,
    /// Greatest speed along the path, if it is not reached.
    pub fastest_m_per_min: f64,
    pub duration_s: f64,
    /// Greatest contour error of all senses, in the first and the last lap.
    pub first_um: f64,
    pub last_um: f64,
}

impl LapFigures {
    /// Of contour errors in m, in any order.
    pub fn of(lap: usize, mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let count = errors.len();
        let at = |share: f64| match count {
            0 => 0.0,
            _ => errors[((share * count as f64) as usize).min(count - 1)],
        };
        let square: f64 = errors.iter().map(|e| e * e).sum();
        Self {
            lap,
            contour_error_um: 1e6 * at(1.0),
            p99_um: 1e6 * at(0.99),
            rms_um: 1e6 * (square / count.max(1) as f64).sqrt(),
        }
    }
}

impl MachineContoured {
    /// What was run, in one line.
    pub fn title(&self) -> String {
        let corrected = if self.corrected {
            ", references corrected"
        } else {
            ""
        };
        format!(
            "{}: {}, compensation {}{corrected} (simulated)",
            self.machine,
            self.path_at_feed,
            self.compensation.replace('_', "-")
        )
    }

    /// Where the page is written.
    pub fn reported(self, path: Option<&Path>) -> Self {
        Self {
            report: path.map(Path::to_owned),
            ..self
        }
    }
}

impl fmt::Display for MachineContoured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        if let Some(found) = &self.identified {
            let ([phi, d_phi], [k, d_k]) =
                (found.squareness_um_per_m, found.crosstalk_um_per_m_per_s2);
            writeln!(
                f,
                "squareness of X and Y {} µm/m, cross-talk {} µm/(m/s²), from circles",
                PlusMinus::new(phi, d_phi, 2),
                PlusMinus::new(k, d_k, 2)
            )?;
        }
        writeln!(
            f,
            "{:<24}{:>12}{:>12}{:>12}",
            "contour error, µm", "greatest", "99 %", "rms"
        )?;
        for one in &self.directions {
            for lap in &one.laps {
                let name = format!("{}, lap {}", one.direction, lap.lap);
                writeln!(
                    f,
                    "{name:<24}{:>12.3}{:>12.3}{:>12.3}",
                    lap.contour_error_um, lap.p99_um, lap.rms_um
                )?;
            }
        }
        if let Some(both) = &self.both {
            writeln!(
                f,
                "last lap, both directions: G(b) {:.3}, H {:.3}, D {:.3} µm",
                both.g_um, both.h_um, both.d_um
            )?;
        }
        for one in &self.directions {
            for (name, all) in [("corner", &one.corners), ("curve", &one.curves)] {
                for place in all {
                    writeln!(
                        f,
                        "{name} at {:.3} mm, {}: {:.3} µm",
                        place.s_mm,
                        place.shape(),
                        place.error_um
                    )?;
                }
            }
            let peaks = one
                .reversals
                .iter()
                .map(|r| format!("{} at {:.0}°: {:.3} µm", r.axis, r.angle_deg, r.peak_um));
            let peaks: Vec<String> = peaks.collect();
            if !peaks.is_empty() {
                writeln!(
                    f,
                    "after a reversal, {}: {}",
                    one.direction,
                    peaks.join("; ")
                )?;
            }
        }
        for row in &self.feeds {
            writeln!(
                f,
                "at {} m/min ({:.2} reached, {:.2} s): {:.3} µm, last lap {:.3} µm",
                row.feed_m_per_min,
                row.fastest_m_per_min,
                row.duration_s,
                row.first_um,
                row.last_um
            )?;
        }
        match &self.report {
            Some(path) => write!(f, "{}", path.display()),
            None => Ok(()),
        }
    }
}
