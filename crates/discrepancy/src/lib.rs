//! Finds where a simulated axis and its measured logs disagree, and names the
//! effect that the model lacks.
//!
//! # The problem
//! Logs y of a closed loop, N samples of C channels each (m, rad, A, V), and a
//! simulation ŷ(θ, e) of the same loop on the same reference, with known
//! parameters θ inside their tolerance and effects e of a library
//! ([`axis_sim::effects`]). With the residual r = y − ŷ in frequency,
//!
//! ```text
//! D(θ, e) = 2 Σ_b n_b log det S_b + Σ_i (θ_i / s_i)²,     S_b = Σ_{f in b} r(f) r(f)ᴴ / n_b
//! ```
//!
//! is minus twice the log-likelihood of a stationary residual with any spectrum
//! (Whittle 1953). An effect is named when it lowers D by more than chance
//! could in any candidate, on logs that were not fitted as well, and by more
//! than a hundredth of what was found before. Where the effects named in the end make any
//! channel of these logs worse than it was without them, none is given.
//!
//! # Modules, in the order in which data passes
//! - [`logs`]: whether logs can be compared at all: sampling, units, signs, holes.
//! - `answers`: how a model answers a log, by closed-loop replay or torque balance; a
//!   [`LogSet`] is logs that are compared together. `spectrum`: their residual in frequency, and D.
//! - `noise`: how much of a residual is noise of sensors or of the logger.
//! - `estimate`: known parameters and sizes of effects, with intervals ([`Fitter`]).
//! - `name`: [`search()`] screens all effects by what they would do to these logs, refines
//!   the best few by simulation, adds the best, and begins again.
//! - `judge`: [`discovery`] puts what was found into a [`Verdict`], with what it costs, what
//!   it may be confused with, what no effect explains, and the motion to run next.
//!
//! [`Evidence`] goes all this way for logs that were looked at, as the command `discover` does.
//!
//! [`controller`] estimates an unknown controller, before any of this.
//! [`Prediction`] says before any search what it could see and tell apart on a motion;
//! [`summary`] is for where only a table of errors was measured.
//!
//! # What this crate knows nothing of
//! Files, terminals and pictures. It simulates nothing itself.

mod answers;
pub mod controller;
mod estimate;
mod evidence;
mod judge;
pub mod logs;
mod name;
mod noise;
mod prediction;
mod spectrum;
pub mod summary;

pub use answers::{Answer, LogSet, Prepared, State};
pub use estimate::columns::free_parameters;
pub use estimate::fit::{Fit, Fitter};
pub use estimate::interval::Spread;
pub use estimate::known::{known_deviations, tolerances};
pub use evidence::{Evidence, EvidenceError};
pub use judge::{
    Against, Answered, Assessment, AtScrew, Confidence, Cost, Curve, Discovered, Discovery,
    DriveFunction, EffectFound, EffortCost, FigureLogs, FormFound, FrictionCurve, Gaps, Level,
    Likeness, NextExperiment, Overlay, ParameterFound, Proposal, REMEDIES, ReadUnit, Recalibrated,
    RefusedEffects, Remedy, RemedyFound, ReplacedEffect, Shown, Size, TrackingCost, Unknown,
    Verdict, discovery, judged, said_evidence,
};
pub use name::gap::{ChannelGap, Gap, MATERIAL_OF_NOISE};
pub use name::library::{Library, applicable};
pub use name::search::{
    Alike, Found, Named, ONE_CLASS, RefusalReason, Refused, Replaced, RunnerUp, SearchError,
    Settings, SettingsError, Test, search, search_with,
};
pub use noise::SensorNoise;
pub use prediction::{Hypothesis, Imitation, PredictedEffect, Prediction};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
