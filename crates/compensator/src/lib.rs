//! Corrections for a servo axis, one trait for the simulator and for a controller.
//!
//! # The problem
//! Once a control cycle, at `t_k`, a controller knows the [`Sample`]: the
//! reference now and a cycle ahead, the table position, the motor speed, the
//! currents, and what it commanded last. From these alone a [`Compensator`]
//! makes a [`Correction`], a `position` and a `command`:
//!
//! ```text
//! e(k) = S_ref(k) − S(k) + position          input of the position controller
//! u(k) = output of the speed controller + command
//! ```
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | S, S_ref | position of the load, its reference | m, or rad if it turns |
//! | u | command to the actuator: q current, torque, force or voltage | A, N·m, N or V |
//! | `motor_angle`, `motor_speed` | of the motor | rad, rad/s |
//! | `period` | of the control cycle | s |
//!
//! # Strategies
//! | strategy | correction |
//! |---|---|
//! | [`NoCompensation`] | nothing |
//! | [`NetworkCompensation`] | the error that a network predicts for the end of the cycle (Section 4.4 of Liu et al. 2025, doi:10.3390/machines13050433) |
//! | [`TransferFunction`] | the error that a linear model predicts from the reference alone |
//! | [`FrictionFeedforward`] | the command for LuGre friction along the reference |
//! | [`Plan`] | offsets with which the drive follows a motion that is known ahead |
//! | [`PlanWithFeedback`] | the plan, and an observer and state feedback in place of the drive's loops |
//! | [`DriveTermsFeedforward`] | what an ordinary drive makes of its own constants, pulses and tables |
//! | [`Combined`] | the sum of two |
//!
//! Speed and acceleration, which the network asks for, come from the
//! [`MotionEstimator`]: motor speed, corrected by the scale. The linear model
//! comes from `identify_transfer_function` (feature `identify`, least squares), the gains of a
//! [`Feedback`] from `FeedbackDesign` (feature `design`, Riccati equations).
//!
//! `Adaptation` (feature `identify`) learns a [`DriveModel`] from the logs of moves, for
//! the [`Plan`] of the next; `ResidualLearner` what no parameter of it holds; `LearnedMove`
//! (feature `alloc`) the correction of one move from its repetitions. A [`Guard`] limits,
//! fades and watches any of them.
//!
//! All are generic over their scalar: `f64` where none is named, `f32` for a
//! controller without double precision in hardware; identification and
//! [`cfnn::Network`] are in `f64`, and `cast` takes their results over.
//!
//! Everything but identification, adaptation and design works without `std`, and nothing is
//! allocated in a cycle.
//!
//! # What it knows nothing of
//! The simulator: no inner state of a plant comes in. Files, the planning of motions, the training
//! of networks.
//!
//! # Example
//! ```
//! use compensator::{
//!     Combined, Compensator, FeedforwardDrive, FrictionFeedforward, NoCompensation, Sample,
//! };
//! use lugre::{LuGre, Parameters};
//!
//! let friction = LuGre::new(Parameters {
//!     viscous: 0.0298,
//!     ..Parameters::LIU_2025
//! })?;
//! let drive = FeedforwardDrive {
//!     travel_per_radian: 0.01 / std::f64::consts::TAU, // m/rad
//!     torque_constant: 1.641,                          // N·m/A
//!     period: 1e-4,                                    // s
//! };
//! let mut law = Combined::new(NoCompensation, FrictionFeedforward::new(friction, drive)?);
//! // At 100 mm/s, after the bristles have settled, friction asks for T/K_t.
//! let mut sample = Sample::default();
//! sample.reference.velocity = 0.1;
//! let mut iq = 0.0;
//! for _ in 0..1000 {
//!     iq = law.correct(&sample).command;
//! }
//! assert!((iq - (0.6757 + 0.0298 * 62.83) / 1.641).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "identify")]
mod adapt;
mod combined;
mod drive_terms;
mod error;
mod estimator;
mod feedback;
mod friction;
mod gaussian;
mod guard;
#[cfg(feature = "identify")]
mod identify;
#[cfg(feature = "alloc")]
mod learning;
mod model;
mod network;
mod none;
mod plan;
mod remainder;
mod residual;
mod sample;
mod signal_path;
#[cfg(feature = "serde")]
mod stored;
mod transfer_function;
mod warmed;

#[cfg(feature = "identify")]
pub use adapt::{
    AdaptError, AdaptParameter, AdaptPrior, Adaptation, Estimated, Learned, PriorSpread,
    UnexplainedTorque,
};
pub use combined::Combined;
pub use drive_terms::{
    DriveTerms, DriveTermsFeedforward, DriveTermsRow, ReversalPulse, ReversalStart,
};
pub use error::CompensatorError;
pub use estimator::{MotionEstimate, MotionEstimator, NoiseGains, ObserverGains};
#[cfg(feature = "design")]
pub use feedback::{
    DesignError, DriveSituation, FeedbackDesign, FeedbackSettings, Margins, SampledDrive,
    SampledResponse, Variation,
};
pub use feedback::{
    Deviations, Feedback, Gains as FeedbackGains, MOST_MEASURED, MOST_STATES, Node as FeedbackNode,
    PlanWithFeedback, States,
};
pub use friction::{FeedforwardDrive, FrictionFeedforward};
pub use guard::{Guard, GuardLimits, Guarded, Status, Trip};
#[cfg(feature = "identify")]
pub use identify::{
    Candidates, MotionRecord, TransferFunctionError, TransferFunctionFit, Trial,
    identify_transfer_function,
};
#[cfg(feature = "alloc")]
pub use learning::{Advice, Gauss, LearnedMove, LearningSettings, Round};
pub use model::{
    Cascade, Drive, DriveModel, DriveSection, Kinematics, Mode, SECTIONS, StrokeSections,
};
pub use network::{IncrementModel, NetworkCompensation};
pub use none::NoCompensation;
pub use plan::{
    HomedAt, Plan, PlanSettings, Planned, Planner, PlannerConstants, Standstill, Target,
};
pub use residual::{HARMONICS, KNOTS, Residual, ResidualAt, ResidualModel};
#[cfg(feature = "alloc")]
pub use residual::{NETWORK_INPUTS, ResidualNetwork};
#[cfg(feature = "identify")]
pub use residual::{
    NetworkBasis, ResidualBasis, ResidualLearner, ResidualRow, ResidualTables, Unexplained,
    over_gaussian,
};
pub use sample::{Correction, Reference, Sample};
pub use signal_path::{DriveFilter, SignalPath};
pub use transfer_function::{MAX_ORDER, TransferFunction, TransferFunctionModel};

/// A correction strategy. It keeps its own estimates; a cycle cannot fail.
///
/// `T` is the scalar that it computes in: `f64` where none is named, as in
/// `dyn Compensator`, or `f32`.
pub trait Compensator<T: axis_scalar::Scalar = f64> {
    /// Forgets everything; the next sample is the first of a motion from rest.
    fn reset(&mut self);

    /// The correction for the cycle that begins with `sample`.
    fn correct(&mut self, sample: &Sample<T>) -> Correction<T>;

    /// How far what it observed last is from what it expected, in deviations of its noise;
    /// 0 if it observes nothing. What a [`Guard`] watches.
    fn surprise(&self) -> T {
        T::ZERO
    }
}

impl<T: axis_scalar::Scalar, C: Compensator<T> + ?Sized> Compensator<T> for &mut C {
    fn reset(&mut self) {
        (**self).reset();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        (**self).correct(sample)
    }

    fn surprise(&self) -> T {
        (**self).surprise()
    }
}

#[cfg(feature = "alloc")]
impl<T: axis_scalar::Scalar, C: Compensator<T> + ?Sized> Compensator<T> for alloc::boxed::Box<C> {
    fn reset(&mut self) {
        (**self).reset();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        (**self).correct(sample)
    }

    fn surprise(&self) -> T {
        (**self).surprise()
    }
}

/// The README's example, run as a test.
#[cfg(all(doctest, feature = "std"))]
#[doc = include_str!("../README.md")]
struct Readme;
