//! The experiments that are made where there are no logs yet.

use axis_sim::Axis;
use axis_sim::effects::{Measure, Scales};

/// The experiments, from what an axis file tells of strokes, speeds and forces. Nothing in it
/// comes from a friction; what depends on one is found while they are made.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentificationPlan {
    /// Fastest of the constant-speed runs, m/s or rad/s of the load.
    pub fastest: f64,
    /// The fastest over the slowest.
    pub range: f64,
    /// Different speeds to begin with, in equal ratios; each is run both ways.
    pub speeds: usize,
    /// Speeds that are added about the speed at which friction falls, in multiples of it.
    pub about_fall: Vec<f64>,
    /// Time at constant speed before the record, s: the drive's controllers settle.
    pub settle_time: f64,
    /// Way before the record, m or rad: bristles bend. Where those that are found ask for more,
    /// the runs are repeated.
    pub settle_distance: f64,
    /// Time recorded at constant speed, s.
    pub record_time: f64,
    /// Acceleration and jerk of the ramps, m/s², m/s³ or rad.
    pub ramps: [f64; 2],
    /// Amplitude of the first small motion, m or rad; it grows until friction shows.
    pub smallest: f64,
    /// Frequencies of the small motions, Hz; well below the axis' own, where the inertia's share
    /// of the torque is known best.
    pub frequencies: Vec<f64>,
    /// Rate of the logs, Hz; that of the control where it is lower.
    pub log_rate: f64,
    /// Seed of the sensors' noise.
    pub seed: u64,
}

/// Ratio of the fastest run's speed to that of the fastest trajectory: friction is wanted there and
/// somewhat beyond.
const BEYOND: f64 = 2.5;

/// Speed, as a share of the stroke a second, above which a run there would take more than a
/// third of the stroke.
const REACH: f64 = 0.2;

impl IdentificationPlan {
    /// In proportion to an axis: from 0.2 to 300 mm/s on a stroke of 1.5 m.
    pub fn of(axis: &Axis) -> Self {
        let scales = Scales::of(axis);
        let stroke = axis.stroke.maximum - axis.stroke.minimum;
        let trajectories = axis.trajectories.iter().map(|t| t.limits.velocity());
        let fastest = trajectories.reduce(f64::max).unwrap_or(REACH * stroke);
        let fastest = (BEYOND * fastest).min(REACH * stroke);
        // On a stroke of 1.5 m ramps of 2 m/s² and 50 m/s³ up to 0.3 m/s: 0.15 s up, 0.27 of that
        // for the jerk; no more than the actuator has the force for.
        let acceleration = (fastest / 0.15).min(2.0 * scales.ratio(Measure::Acceleration));
        let jerk = acceleration / 0.04;
        Self {
            fastest,
            range: 1500.0,
            speeds: 12,
            about_fall: vec![
                0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 1.9, 2.2, 2.6, 3.0, 3.6, 4.5,
            ],
            settle_time: 0.6,
            settle_distance: 1e-3 * stroke,
            record_time: 1.0,
            ramps: [acceleration, jerk],
            smallest: 1e-7 * stroke,
            frequencies: vec![0.5, 1.0, 2.0],
            log_rate: 1000.0,
            seed: 0,
        }
    }

    /// The speeds to begin with, the fastest first.
    pub(super) fn first_speeds(&self) -> Vec<f64> {
        let last = self.speeds.saturating_sub(1).max(1) as f64;
        let share = |k: usize| self.range.powf(-(k as f64) / last);
        (0..self.speeds).map(|k| self.fastest * share(k)).collect()
    }

    /// Motions that are made at least, for progress.
    pub fn motions(&self) -> u64 {
        (self.speeds + self.about_fall.len() + self.frequencies.len()) as u64
    }
}
