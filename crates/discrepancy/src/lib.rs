//! Finds where a simulated axis and its logs disagree, and names what is missing.

mod fit;
mod known;
mod model;
mod screen;
mod search;
mod spectrum;

pub use fit::{Fit, Fitter, free_parameters, known_deviation};
pub use known::{Known, known_parameters, tolerance, with_known};
pub use model::{LogSet, Prepared, State};
pub use search::{Found, Named, ONE_CLASS, RunnerUp, Settings, search};
