//! A program of one's own on these libraries: it adds to each registry without a change
//! in them. One file each:
//!
//! | file | what | registered in |
//! |---|---|---|
//! | `chain_hoist.rs` | a mechanism | [`registry`] |
//! | `quadratic_drag.rs` | an effect | [`registry`] |
//! | `motor_power.rs` | a log channel | [`recorder`] |
//! | `acceleration_feedforward.rs` | a compensation strategy | [`strategies`] |
//!
//! `docs/extending.md` walks through them.
//!
//! ```
//! use axis_sim::{Axis, ClosedLoop};
//! use compensator::NoCompensation;
//!
//! let axis = Axis::parse_with("hoist.toml", outside::HOIST, &outside::registry())?;
//! let mut recorder = outside::recorder(&axis);
//! let motion = axis.plan(&axis.trajectories[0])?;
//! ClosedLoop::new(&axis)?
//!     .run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
//!     .completed()?;
//! assert!(recorder.log()?.has("motor_power_w"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod acceleration_feedforward;
mod chain_hoist;
mod motor_power;
mod quadratic_drag;

use axis_pipeline::strategies::{STRATEGIES, StrategyKind};
use axis_sim::{Axis, Recorder, Registry};

pub use acceleration_feedforward::ACCELERATION_FEEDFORWARD;
pub use chain_hoist::CHAIN_HOIST;
pub use motor_power::MOTOR_POWER;
pub use quadratic_drag::QUADRATIC_DRAG;

/// An axis file that names the mechanism.
pub const HOIST: &str = include_str!("../hoist.toml");

/// What axis files of this program may name.
pub fn registry() -> Registry {
    let mut registry = Registry::default();
    registry.mechanisms.push(&CHAIN_HOIST);
    registry.effects.push(&QUADRATIC_DRAG);
    registry
}

/// A recorder of logs with the channel.
pub fn recorder(axis: &Axis) -> Recorder {
    Recorder::new(axis).with(MOTOR_POWER)
}

/// All strategies of the library, and that of this crate.
pub fn strategies() -> Vec<&'static StrategyKind> {
    let mut strategies = STRATEGIES.to_vec();
    strategies.push(&ACCELERATION_FEEDFORWARD);
    strategies
}
