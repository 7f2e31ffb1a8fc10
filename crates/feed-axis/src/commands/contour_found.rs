//! What `contour` finds on a machine, and its words.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_log::PlusMinus;
use axis_machine::{CircleEstimate, CirclesFound};
use serde::{Deserialize, Serialize};
use toolpath::Foot;
use toolpath::iso230_4::CircleFigures;

use super::contour_places::Place;

/// One lap of a path.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// Arc length of the feet, m.
    pub s: Vec<f64>,
    /// Contour error, m.
    pub error: Vec<f64>,
    /// Position and foot in the plane that is shown, m.
    pub at: Vec<[[f64; 2]; 2]>,
    /// Position and foot of a path in space, m; empty for one in the plane.
    pub space: Vec<[[f64; 3]; 2]>,
}

impl Shown {
    /// Adds a position (m) and its foot; `begun` (m) is the arc length at which the foot's path begins.
    pub fn push<const D: usize>(
        &mut self,
        begun: f64,
        foot: &Foot<D>,
        position: &[f64; D],
        plane: impl Fn([f64; D]) -> [f64; 2],
    ) {
        self.s.push(begun + foot.s);
        self.error.push(foot.length());
        let both = [*position, foot.point.position];
        self.at.push(both.map(plane));
        if D == 3 {
            self.space.push(both.map(|p| std::array::from_fn(|i| p[i])));
        }
    }
}

/// What was found, in µm.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct MachineContoured {
    /// Name of the machine.
    pub machine: String,
    /// What the path is called.
    pub path: String,
    /// The path and its feed, in words.
    #[serde(skip)]
    pub path_at_feed: String,
    /// Name of the strategy.
    pub compensation: String,
    /// Feed along the path.
    pub feed_m_per_min: f64,
    /// What was found from circles at two feeds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identified: Option<IdentifiedCoupling>,
    /// The one-cycle network of each drive, if the compensation has one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub networks: Vec<NetworkRow>,
    /// Whether the references were corrected.
    pub corrected: bool,
    /// One for each sense of a circle, else one.
    pub directions: Vec<Contoured>,
    /// Both senses of a circle, last lap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub both: Option<Both>,
    /// All figures of both senses, SI units.
    #[serde(skip)]
    pub figures: Option<CircleFigures>,
    /// Feed against error.
    pub feeds: Vec<FeedRow>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    /// The page that was written.
    pub report: Option<PathBuf>,
}

/// Squareness and cross-talk of X by Y, with standard errors.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct IdentifiedCoupling {
    /// Squareness.
    pub squareness_um_per_m: [f64; 2],
    /// Cross-talk.
    pub crosstalk_um_per_m_per_s2: [f64; 2],
    /// Root mean square of the radial residuals.
    pub residual_um: f64,
}

impl IdentifiedCoupling {
    /// Of values in SI units.
    pub fn of(found: &CirclesFound) -> Self {
        let both = |one: &CircleEstimate| [one.value, one.standard_error].map(|v| 1e6 * v);
        Self {
            squareness_um_per_m: both(&found.squareness),
            crosstalk_um_per_m_per_s2: both(&found.crosstalk),
            residual_um: 1e6 * found.residual,
        }
    }
}

/// The one-cycle network of a drive: errors of the predicted position on samples that it was not trained on, greatest and mean.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct NetworkRow {
    /// X, Y or Z.
    pub axis: String,
    /// Name of the axis.
    pub name: String,
    /// Samples it was trained on.
    pub samples: usize,
    /// Of the network.
    pub unseen_um: [f64; 2],
    /// Of the best linear map of as many samples.
    pub linear_um: [f64; 2],
}

/// One sense of a path.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Contoured {
    /// The sense of a circle; of another path what it is called.
    pub direction: String,
    /// Of one lap.
    pub duration_s: f64,
    /// Greatest speed along it, m/s.
    #[serde(skip)]
    pub fastest: f64,
    /// All laps.
    pub laps: Vec<LapFigures>,
    /// Peaks after reversals, of the last lap.
    pub reversals: Vec<Reversal>,
    /// Corners, of the last lap.
    pub corners: Vec<Place>,
    /// Tightest curves, of the last lap.
    pub curves: Vec<Place>,
    /// The last lap.
    #[serde(skip)]
    pub shown: Shown,
}

/// One lap.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct LapFigures {
    /// Its number, from 1.
    pub lap: usize,
    /// Greatest contour error.
    pub contour_error_um: f64,
    /// That of which 99 % are below.
    pub p99_um: f64,
    /// Root mean square.
    pub rms_um: f64,
}

/// One feed.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct FeedRow {
    /// Feed that was asked for.
    pub feed_m_per_min: f64,
    /// Greatest speed along the path.
    pub fastest_m_per_min: f64,
    /// Of one lap.
    pub duration_s: f64,
    /// Greatest contour error of all senses in the first lap.
    pub first_um: f64,
    /// In the last lap.
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

impl MachineContoured {
    /// Corners, curves and reversals of the last lap.
    fn write_places(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
        Ok(())
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
        for row in &self.networks {
            let ([most, mean], [by_map, mean_by_map]) = (row.unseen_um, row.linear_um);
            writeln!(
                f,
                "network of {} ({}), {} samples: unseen ones within {most:.1e} µm, mean {mean:.1e} µm (linear map {by_map:.1e}, {mean_by_map:.1e})",
                row.axis, row.name, row.samples
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
        if let Some(one) = self.directions.first() {
            writeln!(f, "time of a lap {:.3} s", one.duration_s)?;
        }
        if let Some(both) = &self.both {
            writeln!(
                f,
                "last lap, both directions: G(b) {:.3}, H {:.3}, D {:.3} µm",
                both.g_um, both.h_um, both.d_um
            )?;
        }
        self.write_places(f)?;
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

/// The peak after a reversal.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Reversal {
    /// X or Y.
    pub axis: String,
    /// Where the axis reverses, from +X towards +Y.
    pub angle_deg: f64,
    /// Radial deviation there, µm.
    pub peak_um: f64,
}

impl Reversal {
    /// Of a peak that was found.
    pub fn of(glitch: &toolpath::iso230_4::QuadrantGlitch) -> Self {
        Self {
            axis: ["X", "Y"][glitch.axis.min(1)].to_owned(),
            angle_deg: glitch.angle.to_degrees(),
            peak_um: 1e6 * glitch.peak,
        }
    }
}

/// Both directions together.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Both {
    /// Bidirectional circular deviation G(b).
    pub g_um: f64,
    /// Circular hysteresis H.
    pub h_um: f64,
    /// Mean bidirectional radial deviation D.
    pub d_um: f64,
}

impl Both {
    /// Of figures in m.
    pub fn of(found: &CircleFigures) -> Self {
        Self {
            g_um: 1e6 * found.g_bidirectional,
            h_um: 1e6 * found.h,
            d_um: 1e6 * found.d,
        }
    }
}

/// Window after a reversal in which its glitch is sought, rad.
pub const AFTER_REVERSAL: f64 = 0.35;
