//! One test program: geometry, contour error, figures of circles, feed, programs in G-code.

mod circle;
mod contour;
mod feed;
#[cfg(feature = "gcode")]
mod gcode;
mod geometry;
