//! An unknown controller, estimated: structure, gains and delay from logs of reference,
//! position and command.
//!
//! # Equation error
//! What a controller commands follows from what it was given and shown alone; the machine
//! does not come into it. So each control kind of [`axis_sim::control::CONTROLS`] is run on
//! the logged reference and the logged sensors, and its command û compared with the logged
//! one, both through the same low pass F (parallel filtering):
//!
//! ```text
//! r(t) = F u(t) − F û(t − d; θ) − c
//! ```
//!
//! θ are the gains, d the delay of the logged command, c a constant where the controller has
//! an integrator. The start is linear in products of the gains
//! (`u = K_p (P e + f v_ref / r − ω) + K_i ∫(…) + c`), over a grid of P, f and d; from there
//! Gauss–Newton with the control kind itself.
//!
//! # Instruments
//! Noise of the logged sensors makes least squares biased. The normal equations are made
//! again with the derivatives on a simulation's signals, which carry no noise, as instruments:
//! `(Zᵀ J) δ = Zᵀ r` (A. Janot, P.-O. Vandanjon, M. Gautier, Control Engineering Practice 25
//! (2014) 85–101; IEEE Trans. Control Syst. Technol. 22 (2014) 132–145,
//! doi:10.1109/TCST.2013.2246163). A model that lacks something makes them weaker, not wrong.
//!
//! # Intervals
//! From the scatter of the score `Zᵀ r` over blocks of the logs, so that a rest that is not
//! white widens them: cluster-robust covariance (K.-Y. Liang, S. L. Zeger, Biometrika 73
//! (1986) 13–22, doi:10.1093/biomet/73.1.13).

mod closed;
mod equation;
mod error;
mod law;
mod low_pass;
mod seen;
mod start;
mod structure;

use axis_log::Log;
use axis_sim::Axis;
use axis_sim::control::Control;
use axis_sim::part::Part;

pub use closed::{ClosedLoopGains, closed_loop};
use equation::{Equation, Solved};
pub use error::ControllerError;
use law::Law;
use seen::Seen;
use structure::{Structure, structures};

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

/// A structure that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Its name, such as "p-pi, position from the load".
    pub name: String,
    /// Share of the check logs' command, in mean square, that it leaves; none where it could
    /// not be fitted.
    pub left: Option<f64>,
}

/// A controller as estimated.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The control, with the estimated gains.
    pub control: Part<dyn Control>,
    /// The words that go with its structure: key and word.
    pub words: Vec<(&'static str, &'static str)>,
    /// Its gains.
    pub gains: Vec<Gain>,
    /// Delay of the logged command behind the logged sensors, s; with its 95 % interval.
    pub delay: (f64, [f64; 2]),
    /// Share of the command that is explained, in mean square: on the fitted logs, on the
    /// check logs.
    pub explained: [f64; 2],
    /// Whether the gains were found with instruments; by least squares else.
    pub instrumented: bool,
    /// Corner of the low pass of both commands, Hz.
    pub cutoff: f64,
    /// All structures, the chosen one first, then by what they leave.
    pub tried: Vec<Tried>,
}

/// Logs with their names and sampling periods (s).
pub type Logs = [(String, Log, f64)];

/// Estimates the controller of `machine`, whose file may have one or none; its control
/// period must be set. The structure is chosen by what it leaves of the check logs; one with
/// fewer gains is kept where another leaves less by under a hundredth.
///
/// # Errors
/// [`ControllerError`]: a channel is missing, nothing moves, or no structure can be fitted.
pub fn estimate(machine: &Axis, fit: &Logs, check: &Logs) -> Result<Estimate, ControllerError> {
    let see = |logs: &Logs| -> Result<Vec<Seen>, ControllerError> {
        logs.iter().map(|log| Seen::of(machine, log)).collect()
    };
    let (seen, held_out) = (see(fit)?, see(check)?);
    let (fitting, checking) = (
        Equation::new(machine, seen),
        Equation::new(machine, held_out),
    );
    let mut tried = Vec::new();
    let mut best: Option<(f64, Structure, Law, Solved)> = None;
    for structure in structures(machine, fit) {
        let fitted = structure::fit(machine, &structure, &fitting, fit);
        let left = fitted
            .as_ref()
            .and_then(|(law, solved)| checking.left(law, &solved.at));
        tried.push(Tried {
            name: structure.name(),
            left,
        });
        if let (Some((law, solved)), Some(left)) = (fitted, left)
            && best.as_ref().is_none_or(|(least, ..)| left < 0.99 * least)
        {
            best = Some((left, structure, law, solved));
        }
    }
    let Some((left, structure, law, solved)) = best else {
        return Err(ControllerError::NoneFits);
    };
    let name = structure.name();
    let place = |t: &Tried| (t.name != name, t.left.unwrap_or(f64::INFINITY));
    tried.sort_by(|a, b| {
        let (a, b) = (place(a), place(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let fitted = fitting.left(&law, &solved.at).unwrap_or(1.0);
    let gains = law.free.iter().enumerate().map(|(i, key)| Gain {
        key,
        value: solved.at[i],
        ci95: solved.interval(i),
    });
    let (last, period) = (law.free.len(), machine.period);
    Ok(Estimate {
        control: law.control(&solved.at)?,
        words: structure.words.clone(),
        gains: gains.collect(),
        delay: (
            solved.at[last] * period,
            solved.interval(last).map(|d| d * period),
        ),
        explained: [1.0 - fitted, 1.0 - left],
        instrumented: solved.instrumented,
        cutoff: fitting.cutoff(),
        tried,
    })
}
