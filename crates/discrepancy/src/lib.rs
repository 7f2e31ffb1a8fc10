//! Finds where a simulated axis and its measured logs disagree, and names the
//! effect that the model lacks.
//!
//! # The problem
//! Logs y of a closed loop, N samples of C channels each (m, rad, A, V), and a
//! simulation ŷ(θ, e) of the same loop on the same reference, with known
//! parameters θ inside their tolerance and effects e of a library
//! ([`axis_sim::effects`]). With the rest r = y − ŷ in frequency,
//!
//! ```text
//! D(θ, e) = 2 Σ_b n_b log det S_b + Σ_i (θ_i / s_i)²,     S_b = Σ_{f in b} r(f) r(f)ᴴ / n_b
//! ```
//!
//! is minus twice the log-likelihood of a stationary rest with any spectrum
//! (Whittle 1953). An effect is named when it lowers D by more than chance
//! could in any candidate, on logs that were not fitted as well, and by more
//! than a hundredth of what was found before. Where the effects named in the end make any
//! channel of these logs worse than it was without them, none is given.
//!
//! # Steps
//! [`intake`] looks at the logs; [`LogSet`] prepares them; [`search()`] moves the
//! known parameters, screens all effects by what they would do to these logs,
//! refines the best few by simulation, adds the best, and begins again;
//! [`discovery`] puts what was found into a [`Verdict`], intervals and gaps.
//! [`summary`] is for where only a table of errors was measured. [`Foresight`] says
//! before any search what it could see and tell apart on a motion.
//!
//! # What this crate knows nothing of
//! Files, terminals and pictures. It simulates nothing itself.

mod answer;
mod bounded;
mod curves;
mod experiment;
mod fit;
mod foresight;
mod gap;
mod gauss_newton;
pub mod intake;
mod interval;
mod known;
mod lack;
mod library;
mod linear;
mod model;
mod noise;
mod outcome;
mod projector;
mod screen;
mod search;
mod sensor_noise;
mod spectrum;
pub mod summary;

pub use answer::Answer;
pub use experiment::Proposal;
pub use fit::{Fit, Fitter, free_parameters};
pub use foresight::{Foreseen, Foresight, Hypothesis, Imitation};
pub use gap::{ChannelGap, Gap};
pub use interval::Spread;
pub use known::{known_deviations, tolerances};
pub use lack::{Curve, Unknown};
pub use library::{Library, applicable};
pub use model::{LogSet, Prepared, State};
pub use outcome::{
    Against, Answered, AtScrew, Confidence, Cost, Discovered, Discovery, DriveFunction,
    EffectFound, EffortCost, FormFound, FrictionLaw, Gaps, Level, Likeness, NextExperiment,
    Overlay, ParameterFound, REMEDIES, ReadUnit, Recalibrated, RefusedEffects, Remedy, RemedyTold,
    ReplacedEffect, Shown, Size, Told, TrackingCost, Verdict, discovery, judged,
};
pub use search::{
    Alike, Found, Named, ONE_CLASS, Reason, Refused, Replaced, RunnerUp, SearchError, Settings,
    SettingsError, search, search_with,
};
pub use sensor_noise::SensorNoise;
