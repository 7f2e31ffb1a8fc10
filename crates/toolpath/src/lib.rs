//! Paths of a machine tool, a feed along them within the limits of each axis, the contour error
//! of what the machine did, and the figures of a circular test.
//!
//! # The problem
//! Two or three axes are to move along a curve in space x(s), s its arc length in m. Each axis has
//! limits of velocity (m/s), acceleration (m/s²) and jerk (m/s³), which a feed s(t) must keep:
//!
//! ```text
//! v = x′ ṡ        a = x″ ṡ² + x′ s̈        j = x‴ ṡ³ + 3 x″ ṡ s̈ + x′ s⃛        ′ by s, ˙ by t
//! ```
//!
//! and what the machine did, p(t), is judged by its distance from the curve, not by its distance
//! from where it should have been at that instant.
//!
//! | part | |
//! |---|---|
//! | [`Path`] | [`Line`], [`Arc`] (helix), [`Nurbs`], [`Blend`] in 2 or 3 dimensions by arc length, with x′, x″, x‴; junctions checked |
//! | [`PathBlending`] | blends in place of the corners of lines, within a tolerance |
//! | [`named`] | circular test, tilted circle, rounded rectangle, butterfly |
//! | [`FeedProfile`] | s(t) from standstill to standstill within [`FeedLimits`] |
//! | [`Follower`] | contour error to the foot on the branch that was reached |
//! | [`iso230_4`] | G, H, D, F of a circle; quadrant glitches |
//! | `gcode` (feature) | programs of G0 to G3 to paths with feeds; G61 and G64 P |
//!
//! ```
//! use toolpath::named::CircleTest;
//! use toolpath::{FeedLimits, FeedProfile, Follower};
//!
//! // A circle of 50 mm at 3 m/min; 1 m/s² and 20 m/s³ for each axis.
//! let circle = CircleTest::new(0.05).path()?;
//! let limits = FeedLimits::equal(0.05, 1.0, 1.0, 20.0);
//! let profile = FeedProfile::plan(&circle.path, &limits)?;
//!
//! // A machine of which Y lags by 1 ms.
//! let mut follower = Follower::new(&circle.path, 0.0);
//! let mut worst = 0.0f64;
//! for i in 0..=20_000 {
//!     let t = profile.duration() * f64::from(i) / 2e4;
//!     let [x, y] = [profile.axes(t).position[0], profile.axes(t - 1e-3).position[1]];
//!     worst = worst.max(follower.follow([x, y]).signed().abs());
//! }
//! // y sin θ of a lag v τ = 50 µm along the path: ½ v τ |sin 2θ| at most.
//! assert!((worst - 25e-6).abs() < 0.1e-6);
//! # Ok::<(), toolpath::ToolpathError>(())
//! ```
//!
//! # What it deliberately knows nothing of
//! Axes' models, controllers, files, tools and workpieces. All lengths are in m, angles in rad, times in s.
//!
//! # Cost
//! All values are found in `f64` and are the same bits on each run. A plan allocates; neither a
//! point of a path, nor a foot, nor a point of a profile does.
//!
//! # Features
//! `gcode` reads programs; off by default.
// The promised bits are of the library.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod arc;
mod blend;
mod blending;
mod contour;
mod corner;
mod error;
mod feed;
mod flattened;
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
#[cfg(feature = "serde")]
mod stored;
mod vector;

pub use arc::Arc;
pub use blend::Blend;
pub use blending::PathBlending;
pub use contour::{Follower, Foot, nearest_point, tangent_estimate};
pub use error::ToolpathError;
pub use feed::{AxesPoint, FeedLimits, FeedPoint, FeedProfile};
pub use line::Line;
pub use nurbs::{MAX_DEGREE, Nurbs, NurbsData};
pub use path::{Junction, JunctionKind, Path, PathTolerances};
pub use point::PathPoint;
pub use segment::PathSegment;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
