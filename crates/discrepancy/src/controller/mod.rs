//! An unknown controller, estimated: structure, gains, filters and delay from logs of
//! reference, position and command.
//!
//! # Equation error
//! What a controller commands follows from what it was given and shown alone; the machine
//! does not come into it. So each control kind of [`axis_sim::control::CONTROLS`] is run on
//! the logged reference and the logged sensors, and its command û is compared with the logged
//! one, both through the same low pass F without phase:
//!
//! ```text
//! r(t) = F u(t) − F û(t − d; θ) − c
//! ```
//!
//! θ are gains and filters, d is the delay of the logged command, c a constant where the
//! controller has an integrator. The start is linear in products of the gains
//! (`u = K_p (Kv e / r + f v_ref / r − ω) + K_i ∫(…) + c`) over a grid of Kv and f; from there
//! Levenberg–Marquardt with the control kind itself.
//!
//! # Kv and 1/T_i
//! With f = 1, position and speed from one place and nothing at its limit, the cascade is
//! `K_p (s + Kv)(s + 1/T_i)/s` on the position error: Kv and 1/T_i may be exchanged, and the
//! command stays as it is. So there are two minima; both are tried, and told with what they
//! leave.
//!
//! # Instruments
//! Noise of a log that the controller did not see makes least squares biased. The estimate is
//! made again with the derivatives on the signals of a closed-loop simulation, which carry no
//! noise, as instruments (A. Janot, P.-O. Vandanjon, M. Gautier, IEEE Trans. Control Syst.
//! Technol. 22 (2014) 132–145, doi:10.1109/TCST.2013.2246163). It is taken where it differs
//! from least squares by more than its own interval (J. A. Hausman, Econometrica 46 (1978)
//! 1251–1271, doi:10.2307/1913827).
//!
//! # Intervals
//! From the scatter of the score over blocks of the logs, so that a residual that is not white
//! widens them: cluster-robust covariance (K.-Y. Liang, S. L. Zeger, Biometrika 73 (1986)
//! 13–22, doi:10.1093/biomet/73.1.13).

mod closed;
mod equation;
mod error;
mod fitted;
mod law;
mod low_pass;
mod own;
mod seen;
mod solve;
mod start;
mod structure;

use axis_log::Log;
use axis_sim::Axis;
use axis_sim::control::Control;
use axis_sim::part::Part;

pub use closed::{ClosedLoopGains, closed_loop};
use equation::Equation;
pub use error::ControllerError;
use fitted::Fitted;
use law::{DELAY, Free};
pub use own::{OwnController, better_than_own};
use seen::Seen;

/// A gain as estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// Its key in the axis file, without unit.
    pub key: &'static str,
    /// In SI units.
    pub value: f64,
    /// 95 % interval, in SI units.
    pub ci95: [f64; 2],
}

impl Gain {
    /// Whether it may be nothing at all.
    fn holds_zero(&self) -> bool {
        let [low, high] = self.ci95;
        self.value != 0.0 && low <= 0.0 && high >= 0.0
    }
}

/// A structure that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Its name, such as "p-pi, feedback load".
    pub name: String,
    /// Share of the check logs' command, in mean square, that it leaves; none if it could
    /// not be fitted.
    pub left: Option<f64>,
    /// Whether the check logs tell it from the chosen one.
    pub is_told_apart: bool,
}

/// Why logs do not determine a gain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Undetermined {
    /// It is at the edge of what an axis file takes, or of what is searched: these limits, in SI units.
    AtEdge([f64; 2]),
    /// Its 95 % interval holds 0.
    HoldsZero,
}

/// A controller as estimated.
#[derive(Clone, Debug)]
pub struct ControllerEstimate {
    /// The control, with the estimated gains.
    pub control: Part<dyn Control>,
    /// The words that go with its structure: key and word.
    pub words: Vec<(&'static str, &'static str)>,
    /// Its gains and filters.
    pub gains: Vec<Gain>,
    /// Delay of the logged command behind the logged sensors, s.
    pub delay: Gain,
    /// Share of the command that is explained, in mean square: on the fitted logs, on the
    /// check logs.
    pub explained: [f64; 2],
    /// Whether the gains were found with instruments; by least squares else.
    pub instrumented: bool,
    /// The gains that the logs do not determine, by their keys, and why.
    pub undetermined: Vec<(&'static str, Undetermined)>,
    /// All structures, the chosen one first, then by what they leave.
    pub tried: Vec<Tried>,
}

/// Logs with their names and sampling periods (s).
pub type Logs = [(String, Log, f64)];

/// Estimates the controller of `machine`, whose file may have one or none; its control
/// period must be set. The structure is chosen by what it leaves of the check logs; each
/// gain more must leave a hundredth less.
///
/// # Errors
/// [`ControllerError`]: a channel is missing, or no structure can be fitted.
pub fn estimate(
    machine: &Axis,
    fit: &Logs,
    check: &Logs,
) -> Result<ControllerEstimate, ControllerError> {
    let see = |logs: &Logs| -> Result<Vec<Seen>, ControllerError> {
        logs.iter().map(|log| Seen::of(machine, log)).collect()
    };
    let fitting = Equation::new(machine, see(fit)?);
    let checking = Equation::new(machine, see(check)?);
    let (fitted, failed) = fitted::all(&fitting, &checking, fit);
    let tried = |found: &Fitted| Tried {
        name: found.name(machine.travel_per_radian()),
        left: Some(found.left),
        is_told_apart: (fitted.first()).is_none_or(|best| best.is_told_from(found, &checking)),
    };
    let failed = failed.into_iter().map(|name| Tried {
        name,
        left: None,
        is_told_apart: true,
    });
    let tried = fitted.iter().map(tried).chain(failed).collect();
    let Some(best) = fitted.into_iter().next() else {
        return Err(ControllerError::NoneFits);
    };
    let (solved, instrumented) = best.solved();
    let explained = |logs: &Equation<'_>| 1.0 - logs.left(&best.law, &solved.at).unwrap_or(1.0);
    let mut gains: Vec<Gain> = (best.law.free.iter().enumerate())
        .map(|(i, free)| solved.gain(free.key, i))
        .collect();
    let doubted = |(gain, free): (&Gain, &Free)| {
        let why = match free.is_at_edge(gain.value) {
            true => Undetermined::AtEdge(free.room),
            // A delay may be none.
            false if free.key != DELAY && gain.holds_zero() => Undetermined::HoldsZero,
            false => return None,
        };
        Some((gain.key, why))
    };
    let undetermined = gains.iter().zip(&best.law.free).filter_map(doubted);
    let undetermined = undetermined.collect();
    let Some(delay) = gains.pop() else {
        return Err(ControllerError::NoneFits);
    };
    Ok(ControllerEstimate {
        control: best.law.control(&solved.at)?,
        words: best.structure.words.clone(),
        undetermined,
        gains,
        delay,
        explained: [explained(&fitting), explained(&checking)],
        instrumented,
        tried,
    })
}
