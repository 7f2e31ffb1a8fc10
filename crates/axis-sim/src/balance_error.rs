//! Why a log cannot be balanced.

use thiserror::Error;

/// Why the torque balance of a log cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BalanceError {
    /// Nothing that says how the axis moved.
    #[error("no channel shows the motion; valid: one of {needed}; the log has {available}")]
    NoMotion {
        /// Channels of which one would do.
        needed: String,
        /// Channels that there are.
        available: String,
    },
    /// Nothing that says what moved it.
    #[error(
        "no channel shows the motor's torque; valid, of an actuator \"{actuator}\": one of {needed}; the log has {available}"
    )]
    NoTorque {
        /// Kind of the actuator.
        actuator: String,
        /// Channels of which one would do.
        needed: String,
        /// Channels that there are.
        available: String,
    },
    /// A sampling period that is none.
    #[error(
        "the sampling period of {period} s is not valid: it must be a finite number above zero"
    )]
    Period {
        /// As given, s.
        period: f64,
    },
    /// Hardly any sample in which the axis moves.
    #[error(
        "only {kept} of {samples} samples are left for a torque balance: in at least {least} of them the axis must move faster than {speed:.3e} {unit}, the least that its sensor distinguishes from standstill, and farther than its friction's pre-sliding displacement; both sides are low-passed at {cutoff:.3} Hz, set by {reason}: valid is a longer log, a faster or longer motion, or another [balance] cutoff_hz in the axis file: lower against noise, higher against short motions"
    )]
    Standstill {
        /// Samples left.
        kept: usize,
        /// Samples at the reduced rate.
        samples: usize,
        /// Fewest that do.
        least: usize,
        /// Speed that is told from rest, m/s or rad/s.
        speed: f64,
        /// Its unit.
        unit: &'static str,
        /// Cut-off of the comparison, Hz.
        cutoff: f64,
        /// What sets it.
        reason: CutoffReason,
    },
}

/// What sets the cut-off of a torque balance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CutoffReason {
    /// The rate of the samples.
    Sampling,
    /// A resonance, below which the axis moves as one body.
    Resonance,
    /// Noise of the acceleration.
    Noise,
    /// The axis file.
    Asked,
}

impl std::fmt::Display for CutoffReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Sampling => "the rate of the samples",
            Self::Resonance => "the axis' lowest resonance",
            Self::Noise => "noise of the acceleration",
            Self::Asked => "[balance] cutoff_hz of the axis file",
        })
    }
}
