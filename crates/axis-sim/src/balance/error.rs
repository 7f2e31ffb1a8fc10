//! Why a log cannot be balanced.

use thiserror::Error;

use super::quality::CutoffBound;

/// Why the torque balance of a log cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BalanceError {
    /// Nothing that says how the axis moved.
    #[error(
        "no channel shows the motion: a torque balance needs one of {needed}; the log has {available}"
    )]
    NoMotion {
        /// Channels of which one would do.
        needed: String,
        /// Channels that there are.
        available: String,
    },
    /// Nothing that says what moved it.
    #[error(
        "no channel shows the motor's torque: a torque balance of an actuator \"{actuator}\" needs one of {needed}; the log has {available}"
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
    /// A motion that is faster than its log.
    #[error(
        "the log has {rate:.4} samples a second, and most of its acceleration lies below {motion:.4} Hz only: a torque balance of it needs {least:.4} samples a second at least; log at a higher rate, or slower motion"
    )]
    Slow {
        /// Samples a second, Hz.
        rate: f64,
        /// Frequency below which nine tenths of the acceleration's power lie, Hz.
        motion: f64,
        /// Lowest rate that would do, Hz.
        least: f64,
    },
    /// Hardly any sample in which the axis moves.
    #[error(
        "only {kept} of {samples} samples are left for a torque balance, which compares what lies below {cutoff:.3} Hz ({bound}): in at least {least} of them the axis must move faster than {speed:.3e} {unit}, which its sensor tells from standstill, and farther than its friction's contact bends before it slides; a longer or faster log has more, and so has a higher [balance] cutoff_hz in the axis file"
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
        /// What bounds it.
        bound: CutoffBound,
    },
}
