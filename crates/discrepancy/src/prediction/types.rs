//! What is asked beforehand, and what is answered.

use axis_sim::effects::ActiveEffect;
use serde::{Deserialize, Serialize};

/// What is supposed of a machine.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// Effects that are there, of the library or not.
    pub effects: Vec<ActiveEffect>,
    /// Shares by which its known parameters are off, in the order of
    /// [`axis_sim::Axis::known`]; what is missing is 0.
    pub shares: Vec<f64>,
    /// Noise of its sensors, as a multiple above 0 of that of the [`super::Prediction`].
    pub noise: f64,
    /// Noise of each channel that is fitted, RMS, likewise: what is too small beside it is
    /// not named. Empty if that is as `noise` says.
    pub of_channels: Vec<f64>,
    /// Names of effects that the search may not name.
    pub rejected: Vec<String>,
}

/// What can be known of an effect beforehand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PredictedEffect {
    /// Expected fall of D on the fit log, known parameters and the other effects
    /// fitted out.
    pub gain: f64,
    /// Its size in deviations, of what a fit makes of noise.
    pub above_noise: f64,
    /// Whether the gain is at least twice what the search asks for, and the size and what
    /// it does to a channel beside its noise by as much more.
    pub detectable: bool,
    /// Effects of the library that do nearly the same on this log: the sine of
    /// their angle is below [`crate::ONE_CLASS`], or too little is left beside them.
    pub class: Vec<String>,
    /// Of an effect that the search does not have: what those it has make of it.
    pub imitation: Option<Imitation>,
}

/// How far the library's effects together do what another effect does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Imitation {
    /// The effects, as many as a search may name at most.
    pub by: Vec<String>,
    /// Fall of D that is left beside them.
    pub left: f64,
    /// Whether that is less than twice what the search asks for: no search can
    /// then say that something else is there.
    pub complete: bool,
}
