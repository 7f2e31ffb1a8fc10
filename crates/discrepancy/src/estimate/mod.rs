//! Parameters: known ones inside their tolerance, sizes of effects, and how sure they are.

pub mod bounded;
pub mod calibration;
pub mod columns;
pub mod fit;
pub mod gauss_newton;
pub mod interval;
pub mod known;
pub mod linear;
pub mod projector;
mod refine;
pub(crate) mod smooth;
pub mod spread;
pub mod starts;
pub mod step;
pub mod thin;
