//! Why no feedback was designed.

use thiserror::Error;

use crate::CompensatorError;

/// Why no feedback could be designed for an axis.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DesignError {
    /// The model or a setting is not valid.
    #[error(transparent)]
    Setting(#[from] CompensatorError),
    /// The drive's own loops cannot be replaced through offsets.
    #[error("the drive's control cannot be replaced through offsets: {0}")]
    Control(&'static str),
    /// The modes are not those of an axis.
    #[error("the modes are not valid: {0}")]
    Modes(&'static str),
    /// More states than a feedback has room for.
    #[error(
        "the model has {states} states and a feedback has room for {most}: take fewer modes, or a shorter delay"
    )]
    Size {
        /// Of the model.
        states: usize,
        /// What there is room for.
        most: usize,
    },
    /// A Riccati equation has no solution that could be found.
    #[error(
        "the Riccati equation of the {what} at χ = {sticking} was not solved: relative residual {residual:.1e}"
    )]
    Riccati {
        /// "state feedback" or "observer".
        what: &'static str,
        /// Share of bristles that follow the motion.
        sticking: f64,
        /// ‖residual‖/‖solution‖; not a number where there is no solution.
        residual: f64,
    },
    /// No constant command keeps the load in place against a constant force.
    #[error("no command holds the load against a constant force (χ = {sticking})")]
    SteadyState {
        /// Share of bristles that follow the motion.
        sticking: f64,
    },
    /// A margin that was asked for is not there.
    #[error(
        "{what} is {value:.3}, and {most} at most was asked for: load inertia × {mass}, friction × {friction}, χ = {sticking}, slow sliding {stribeck}, first resonance {frequency:.0} rad/s"
    )]
    Margin {
        /// What is too great.
        what: &'static str,
        /// How great it is.
        value: f64,
        /// What was asked for.
        most: f64,
        /// Of the load's inertia.
        mass: f64,
        /// Of bristles and viscous friction.
        friction: f64,
        /// Share of bristles that follow the motion.
        sticking: f64,
        /// Share of the negative damping of slow sliding.
        stribeck: f64,
        /// Where the load was: the first elastic mode there, rad/s; 0 for none.
        frequency: f64,
    },
}

impl DesignError {
    /// How far a margin is from what was asked for: its share above it; infinite for any other
    /// reason.
    pub(super) fn excess(&self) -> f64 {
        match self {
            Self::Margin { value, most, .. } => value / most,
            _ => f64::INFINITY,
        }
    }
}
