//! One test program: geometry, contour error, figures of circles, feed, programs in G-code.

// The promised bits are of the library; here the standard functions are exact enough.
#![allow(clippy::disallowed_methods)]

mod blending;
mod circle;
mod contour;
mod feed;
#[cfg(feature = "gcode")]
mod gcode;
mod geometry;
#[cfg(feature = "serde")]
mod stored;
