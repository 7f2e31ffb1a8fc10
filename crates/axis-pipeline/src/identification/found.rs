//! What logs told of an axis' friction.

use std::fmt;

use lugre::Parameters;
use lugre::identify::{ConstantSpeedRun, PreslidingFit, StaticFit};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Friction as logs show it, in the coordinate of the axis file's own.
#[derive(Clone, Debug)]
pub struct Identified {
    /// Every stretch at which friction was read against speed; those that were left out because
    /// nothing slid yet are the last.
    pub runs: Vec<SpeedRun>,
    /// Every small motion about a standstill.
    pub small_motions: Vec<SmallMotion>,
    /// The steady-state curve.
    pub statics: StaticFit,
    /// `T_C`, `T_S`, `Ω_S`, `σ2`, `σ0`, `σ1`.
    pub parameters: [FoundParameter; 6],
    /// All six as a law, those that are open as [`ParameterSource`] says.
    pub law: Parameters,
    /// What the logs leave open, and the run that would tell.
    pub open: Vec<Open>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
}

/// A stretch of a log at constant speed, or of one that changes slowly.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedRun {
    /// Index of the log.
    pub log: usize,
    /// From when to when, s of the log.
    pub time: [f64; 2],
    /// Mean speed and friction, in the law's coordinate.
    pub run: ConstantSpeedRun,
    /// Whether the speed is constant; else friction is the torque less what inertia takes.
    pub steady: bool,
    /// Distance since the load last turned, where the stretch begins, in the law's coordinate; infinite
    /// for one that slid for longer than that by its nature.
    pub distance: f64,
    /// Why it was left out, if it was.
    pub left_out: Option<String>,
}

/// A small motion about a standstill.
#[derive(Clone, Debug, PartialEq)]
pub struct SmallMotion {
    /// Index of the log.
    pub log: usize,
    /// From when to when, s of the log.
    pub time: [f64; 2],
    /// What it shows, or why it does not show it.
    pub fit: Result<PreslidingFit, String>,
}

/// Where a parameter comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterSource {
    /// The logs.
    Logs,
    /// The axis file, because the logs leave it open.
    AxisFile,
    /// The logs show no fall of friction with speed: `T_S` is `T_C`, and `Ω_S` the slowest
    /// speed, without a meaning.
    NoFall,
    /// The logs show none: the best value is the least there can be, 0.
    NotSeen,
}

/// A parameter with how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundParameter {
    /// Its name: `T_C`, `T_S`, `Ω_S`, `σ2`, `σ0`, `σ1`.
    pub name: &'static str,
    /// Its value, in the law's coordinate.
    pub value: f64,
    /// Standard error; none if the logs do not tell the parameter.
    pub standard_error: Option<f64>,
    /// Interval that holds it in 95 % of such logs.
    pub interval: Option<[f64; 2]>,
    /// Where it comes from.
    pub source: ParameterSource,
}

impl FoundParameter {
    /// Of an estimate with that many degrees of freedom.
    pub(super) fn of(name: &'static str, value: f64, error: f64, freedom: usize) -> Self {
        let half = error * student(freedom);
        // No parameter of friction is below zero.
        let interval = [(value - half).max(0.0), value + half];
        Self {
            name,
            value,
            standard_error: Some(error),
            interval: Some(interval),
            source: ParameterSource::Logs,
        }
    }

    /// Of one that the logs leave open.
    pub(super) fn open(name: &'static str, value: f64, source: ParameterSource) -> Self {
        Self {
            name,
            value,
            standard_error: None,
            interval: None,
            source,
        }
    }
}

/// Half of a 95 % interval in standard errors that have so many degrees of freedom, 1 or more.
pub(super) fn student(freedom: usize) -> f64 {
    match StudentsT::new(0.0, 1.0, freedom.max(1) as f64) {
        Ok(distribution) => distribution.inverse_cdf(0.975),
        // Not of a number of degrees above 0.
        Err(_) => f64::INFINITY,
    }
}

/// What the logs leave open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Open {
    /// Names of the parameters.
    pub parameters: Vec<&'static str>,
    /// Why.
    pub why: String,
    /// The run that would tell.
    pub run: String,
}

impl fmt::Display for Open {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.parameters.join(" and ");
        write!(f, "{names} not identified: {}; {}", self.why, self.run)
    }
}

#[cfg(test)]
mod tests {
    use super::student;

    /// As tables of Student's distribution print them.
    #[test]
    fn quantiles_are_those_of_the_table() {
        for (freedom, table) in [
            (2, 4.303),
            (5, 2.571),
            (10, 2.228),
            (30, 2.042),
            (100_000, 1.960),
        ] {
            assert!((student(freedom) - table).abs() < 0.0005, "{freedom}");
        }
    }
}
