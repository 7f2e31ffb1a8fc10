//! What the proof of heat found.

use serde::Serialize;

use super::heat_both::Compensated;
use super::heat_identified::Identified;

/// Errors of the growth at 950 mm, µm.
#[derive(Serialize)]
pub struct Row {
    pub what: &'static str,
    pub hours: u32,
    pub greatest_um: f64,
    pub in_the_end_um: f64,
    /// Growth in the end, by brute force.
    pub growth_um: f64,
    pub steps: u64,
}

/// All that was found.
#[derive(Serialize)]
pub struct Found {
    pub against_brute_force: Vec<Row>,
    /// By which the usual tolerance changes the growth over the hour, against a thousandth of it.
    pub tolerance_um: f64,
    /// Mean losses at 20 °C from the reference and from the simulated loop, W.
    pub losses_w: [f64; 2],
    pub identified: Vec<Identified>,
    /// Both corrections, the position from the motor.
    pub motor: Vec<Compensated>,
    /// The dynamic part, the position from the scale.
    pub scale: Vec<Compensated>,
}
