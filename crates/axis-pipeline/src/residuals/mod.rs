//! What no parameter holds, learned in three ways and compared: tables over angle and
//! position, the cascade-forward network of Liu et al. 2025 trained on simulated machines and
//! refined on the machine's logs, and the effects that a search has named.
//!
//! All three learn behind the same gate ([`compensator::ResidualLearner`]) from the same
//! quantity, the torque that the adapted model leaves unexplained.

mod compare;
mod drawn;
mod learner;
mod named;
mod network;

pub use compare::{
    AFTER, Compared, PROGRAMS, ResidualComparison, ResidualMethod, compare, comparisons,
};
pub use drawn::{DrawnMachine, drawn_effects, drawn_machine};
pub use learner::{AnyLearner, AnyResidual};
pub use named::{NamedEffects, NamedResidual};
pub use network::{NetworkSettings, trained_basis};
