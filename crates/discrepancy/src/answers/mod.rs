//! How a model answers a log: by its closed loop, or by its torque balance.

mod defect;
pub mod effort;
mod inexact;
mod prepare;
mod set;
mod share;
mod shown;
mod slack;
mod state;
mod stored;
mod ticks;

use axis_sim::effects::ActiveEffect;
use axis_sim::{Axis, Balance, Probe, Replay, ReplayError, Trace};

pub(crate) use self::inexact::IMMATERIAL;
pub(crate) use self::set::ANGLE;
pub use self::set::{LogSet, Prepared, Rest};
pub use self::state::State;
pub(crate) use self::state::is_form_of;

/// What a model makes of a log.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The logged reference goes through the simulated closed loop: for machines whose
    /// controller is known.
    Replay(Box<Replay>),
    /// The measured motion asks for a motor torque, which is compared with what the log
    /// shows of it: for all others.
    Balance(Box<Balance>),
}

impl Answer {
    /// As the file of results has it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Replay(_) => "closed-loop-replay",
            Self::Balance(_) => "torque-balance",
        }
    }

    /// The answer of a machine with effects and, where asked, a disturbance.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine cannot be set up, or its loop does not hold.
    pub fn run(
        &self,
        machine: &Axis,
        effects: &[ActiveEffect],
        probe: Option<&Probe>,
    ) -> Result<Trace, ReplayError> {
        match self {
            Self::Replay(replay) => replay.run(machine, effects, probe),
            Self::Balance(balance) => balance.run(machine, effects, probe),
        }
    }

    /// The reference's replay; none of a torque balance.
    pub fn replay(&self) -> Option<&Replay> {
        match self {
            Self::Replay(replay) => Some(replay),
            Self::Balance(_) => None,
        }
    }

    /// The torque balance; none of a replay.
    pub fn balance(&self) -> Option<&Balance> {
        match self {
            Self::Balance(balance) => Some(balance),
            Self::Replay(_) => None,
        }
    }
}
