//! Paths of a machine tool, a feed along them within each axis' limits, contour error, and the
//! figures of ISO 230-4.
#![forbid(unsafe_code)]

mod arc;
mod blend;
mod contour;
mod error;
mod feed;
#[cfg(feature = "gcode")]
pub mod gcode;
pub mod iso230_4;
mod line;
pub mod named;
mod nurbs;
mod path;
mod point;
mod quadrature;
mod segment;
mod vector;

pub use arc::Arc;
pub use blend::Blend;
pub use contour::{Follower, Foot, nearest_point, tangent_estimate};
pub use error::ToolpathError;
pub use feed::{AxesPoint, FeedLimits, FeedPoint, FeedProfile};
pub use line::Line;
pub use nurbs::{MAX_DEGREE, Nurbs, NurbsData};
pub use path::{Junction, JunctionKind, Path, PathTolerances};
pub use point::PathPoint;
pub use segment::Segment;
