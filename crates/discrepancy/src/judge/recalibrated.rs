//! Known parameters that were moved.

use std::f64::consts::PI;

use axis_log::never_zero;
use axis_sim::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::answers::State;
use crate::estimate::known::{shown, tolerances};

/// A known parameter that was moved inside its tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Recalibrated {
    /// Name.
    pub name: String,
    /// Share of its value by which it was moved; of an angle that angle, rad.
    pub share: f64,
    /// Tolerance, likewise.
    pub tolerance: f64,
    /// Whether it is an angle.
    #[serde(default)]
    pub is_angle: bool,
}

/// Those of a machine at a state.
pub(super) fn recalibrated(machine: &Axis, state: &State) -> Vec<Recalibrated> {
    let known = machine.known().into_iter().zip(&state.shares);
    let known = known.zip(tolerances(machine));
    let known = known.zip(machine.known_angles());
    let one = |(((name, &share), tolerance), is_angle)| Recalibrated {
        name: shown(name),
        share,
        tolerance,
        is_angle,
    };
    known.map(one).collect()
}

/// Share of the tolerance from which a parameter is at its edge: fits end just inside.
const EDGE: f64 = 0.99;

impl Recalibrated {
    /// Whether the fit moved it to the limit of its tolerance. An angle that may have any value has no limit.
    pub fn is_at_edge(&self) -> bool {
        let is_any = self.is_angle && self.tolerance >= EDGE * PI;
        self.tolerance > 0.0 && !is_any && self.share.abs() >= EDGE * self.tolerance
    }

    /// By how much it was moved, with its unit.
    pub fn moved(&self) -> String {
        match self.is_angle {
            true => format!("{:+.3}°", self.share.to_degrees()),
            false => format!("{:+.2} %", 100.0 * self.share),
        }
    }

    /// Its tolerance, with its unit.
    pub fn within(&self) -> String {
        match self.is_angle {
            true => format!("{}°", never_zero(self.tolerance.to_degrees(), 3)),
            false => format!("{} %", never_zero(100.0 * self.tolerance, 2)),
        }
    }
}
