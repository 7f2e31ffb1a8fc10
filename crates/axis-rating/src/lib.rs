//! Ratings of a feed axis: what a duty asks of its parts, beside what their data sheets allow.
//!
//! # The problem
//!
//! A duty is torque, speed and force over time. Each part of an axis has limits: torque curves, a temperature, a critical
//! speed, a life. A [`Rating`] is one value beside its limit, and [`Rating::margin`] by how much the limit is kept: 1 just,
//! below 1 not.
//!
//! | module | ratings |
//! |---|---|
//! | [`motor`] | RMS and peak torque against curves over speed, speed, inertia ratio |
//! | [`voltage`] | voltage, speed without and with field weakening, back-EMF |
//! | [`winding`] | temperature of a winding |
//! | [`brake`] | regeneration: capacitors, brake's energy and power |
//! | [`screw`] | critical speed, buckling, DN value |
//! | [`life`], [`preload`] | life of nuts, bearings and guides; static safety |
//! | [`belt`] | teeth and cords |
//!
//! Units are SI and stand at the end of names. A linear motor takes force for torque and m/s for rad/s.
//!
//! # What this crate knows nothing of
//! Axes, files, motions: it takes numbers.
//!
//! # Example
//! Life of a ball screw under its mean load (MISUMI, *Selection of Ball Screws*, page 1678, prints 24824 h):
//!
//! ```
//! use axis_rating::{BASE_REVOLUTIONS, RollingElement, life};
//!
//! let revolutions = life::nominal_life(BASE_REVOLUTIONS, 4400.0, 1.2 * 250.0, RollingElement::Ball)?;
//! let hours = life::life_h(revolutions, 2118.0 / 60.0)?;
//! assert!((hours - 24824.0).abs() < 3.0);
//! let rating = life::life(hours, 20_000.0)?;
//! assert!(rating.holds() && (rating.margin() - 1.24).abs() < 0.01);
//! # Ok::<(), axis_rating::RatingError>(())
//! ```

pub mod belt;
pub mod brake;
mod error;
pub mod life;
mod means;
pub mod motor;
mod power_course;
pub mod preload;
mod rating;
pub mod screw;
#[cfg(feature = "serde")]
mod stored;
pub mod voltage;
pub mod winding;

pub use belt::BeltTeeth;
pub use brake::{DcLink, Regeneration};
pub use error::RatingError;
pub use life::{BASE_REVOLUTIONS, GuideBase, RollingElement};
pub use means::{MeanLoad, RootMeanSquare};
pub use motor::{MotorDuty, TorqueCurve};
pub use power_course::PowerCourse;
pub use rating::{Bound, Rating};
pub use screw::{ScrewMounting, ScrewStrength};
pub use voltage::MotorVoltage;
pub use winding::WindingModel;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
