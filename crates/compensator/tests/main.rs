//! One test program: every strategy against closed forms, and against the drives that it may meet.

#[cfg(feature = "identify")]
mod adapt;
mod bits;
mod drive_terms;
mod estimator;
#[cfg(feature = "design")]
mod feedback;
#[cfg(feature = "design")]
mod feedback_drive;
mod friction;
mod guard;
#[cfg(feature = "identify")]
mod identify;
mod kinematics;
#[cfg(feature = "alloc")]
mod learning;
mod limits;
#[cfg(feature = "alloc")]
mod network;
mod residual;
mod single_precision;
#[cfg(feature = "serde")]
mod stored;
#[cfg(feature = "alloc")]
mod transfer_function;
mod warm;
