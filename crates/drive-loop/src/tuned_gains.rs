//! Gains, and what they do.

use schemars::JsonSchema;
use serde::Serialize;

/// Gains in SI, of the motor's and the load's coordinates as the axis file has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TunedGains {
    /// k_v, 1/s.
    pub kv_per_s: f64,
    /// k_p: command (A, N·m, N or V) per speed of the motor (rad/s, m/s).
    pub speed_proportional: f64,
    /// T_n = k_p/k_i, s; none without an integral.
    pub integral_time_s: Option<f64>,
    /// Command per acceleration of the load; 0 where it is not fed forward.
    pub acceleration_feedforward: f64,
    /// Frequency of the notch that was set, Hz; none where it is as the file has it.
    pub notch_hz: Option<f64>,
}

/// How good a loop holds the load, and its margins over the set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LoopFigures {
    /// Maximum sensitivity over the set at either cut; none where a corner is unstable.
    pub sensitivity: Option<f64>,
    /// The same with one more cycle of delay.
    pub sensitivity_late: Option<f64>,
    /// Compliance of the sliding load per frequency, at low ones: 2π r²/(K k_i k_v), m/N per Hz or
    /// rad/(N·m) per Hz; none without an integral.
    pub compliance_slope: Option<f64>,
    /// Geometric mean over the file's mass at all positions, sliding and stuck, of the root mean
    /// square compliance from 1 to 300 Hz, m/N or rad/(N·m).
    pub compliance_rms: f64,
    /// Greatest compliance of the sliding load at the first position.
    pub compliance_peak: f64,
    /// Ripple of the command by the sensor's step, a share of the greatest command (RMS).
    pub ripple: f64,
    /// Objective: the lower, the better the load is held.
    pub objective: f64,
}
