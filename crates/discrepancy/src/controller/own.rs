//! Whether the controller that a file has gives the commands of the logs.

use axis_sim::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::equation::Equation;
use super::law::{Free, Law};
use super::seen::Seen;
use super::{Logs, estimate};

/// The controller of a file, and another that gives the logged commands better.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnController {
    /// Share of the check logs' command, in mean square, that the file's controller leaves, with
    /// the delay of the logged command free.
    pub left: f64,
    /// The structure that leaves least, such as "p-pi, `speed_lowpass`".
    pub better: String,
    /// The share that this leaves.
    pub better_left: f64,
}

/// Share of what the file's controller leaves that another may leave at most: less is no other
/// controller, but gains inside their tolerance and noise of the log.
pub(super) const BETTER: f64 = 0.1;

/// Share of the command, in mean square, that is nothing to ask about.
const GIVES_IT: f64 = 1e-6;

/// Whether another controller than the machine's gives the commands of logs ten times as well;
/// `None` if it does not, or where they do not show a command.
pub fn better_than_own(machine: &Axis, fit: &Logs, check: &Logs) -> Option<OwnController> {
    let law = own(machine)?;
    let see = |logs: &Logs| -> Option<Vec<Seen>> {
        logs.iter().map(|log| Seen::of(machine, log).ok()).collect()
    };
    let (fitting, checking) = (see(fit)?, see(check)?);
    let solved = Equation::new(machine, fitting).solve(&law, &law.start(), None)?;
    let left = Equation::new(machine, checking).left(&law, &solved.at)?;
    if left < GIVES_IT {
        return None;
    }
    let found = estimate(machine, fit, check).ok()?;
    let better_left = 1.0 - found.explained[1];
    (better_left < BETTER * left).then(|| OwnController {
        left,
        better: found
            .tried
            .first()
            .map(|t| t.name.clone())
            .unwrap_or_default(),
        better_left,
    })
}

/// The control of the file, all of its values told.
fn own(machine: &Axis) -> Option<Law> {
    machine.has_control().then(|| Law {
        kind: machine.control.kind(),
        values: machine.control.values().clone(),
        free: vec![Free::delay(machine.period)],
        has_constant: machine.control.kind().name != "p-p",
        washout: 0.0,
    })
}
