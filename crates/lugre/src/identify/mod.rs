//! Identification from records: of LuGre's six parameters in two experiments, and of any
//! law of the family by [`identify_law`].
//!
//! 1. Constant speeds, both directions, many speeds on either side of `Ω_S`:
//!    [`ConstantSpeedRun::from_record`] condenses each record,
//!    [`identify_static`] fits `T_C`, `T_S`, `Ω_S`, `σ2` of the steady-state
//!    curve and leaves out runs in which the machine vibrated; where friction does not
//!    fall with speed, [`identify_coulomb`] fits `T_C` and `σ2` alone.
//! 2. Small to-and-fro motion about a standstill: [`identify_presliding`] fits
//!    `σ0` and `σ1` by simulating the bristle along the measured motion.
//!
//! Speeds, displacements and torques are those at the friction's location:
//! whatever sits between it and the sensors is for the caller to take out.
//! The machine's inertia torque, too, where it is accelerating.

mod constant_speeds;
mod coulomb;
mod curve;
mod error;
mod estimate;
mod law_fit;
mod least_squares;
mod numbers;
mod presliding;
mod record;
mod report;
mod series;
mod static_fit;
mod trial;

pub use constant_speeds::{VIBRATION_LIMIT, identify_static, identify_static_within};
pub use coulomb::identify_coulomb;
pub use error::FrictionIdentifyError;
pub use estimate::ParameterEstimate;
pub use law_fit::{BeforeRecord, FrictionRecord, LawEstimate, LawFit, identify_law};
pub use least_squares::FitOutcome;
pub use numbers::{Identifiable, IdentifiableOnset, Number, NumberKind, UnknownNumbers};
pub use presliding::{MeasuredMotion, PreslidingFit, PreslidingRecord, identify_presliding};
pub use record::ConstantSpeedRun;
pub use static_fit::{LeftOut, Reason, StaticFit, StaticKnowledge, StaticParameters};
