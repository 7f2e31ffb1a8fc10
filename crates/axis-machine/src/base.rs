//! A base that moves under an axis.

use crate::error::MachineError;

/// One mode of a base along an axis: a mass on a spring, pushed by the reaction of the axis' drive.
///
/// With load m, base M, spring k, damper c, the base's displacement u, and q the load's position on it:
///
/// ```text
/// m (q̈ + ü) = F                    load, F the drive's force less friction
/// (M + m) ü + c u̇ + k u = −m q̈     momentum of both
/// ü + 2 ζ ω u̇ + ω² u = −μ q̈        ω² = k/(M + m), μ = m/(M + m)
/// ```
///
/// Along a circle at Ω = v/R ≪ ω the base is at u = −μ q̈/ω² (1 + O(Ω²/ω²)): the circle grows by μ v²/(R ω²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseMode {
    /// Natural frequency ω/2π of base and load together, Hz.
    pub frequency: f64,
    /// Damping ratio ζ.
    pub damping: f64,
    /// Mass ratio μ: of the load to base and load.
    pub mass_ratio: f64,
    /// Share of the base's displacement by which the tool moves against the workpiece: 1 if the other of the two stands on the
    /// ground, 0 if both are on the base.
    pub at_tool: f64,
}

impl Default for BaseMode {
    /// 15 Hz, 2 %, 0.15, all of it at the tool.
    fn default() -> Self {
        Self {
            frequency: 15.0,
            damping: 0.02,
            mass_ratio: 0.15,
            at_tool: 1.0,
        }
    }
}

/// Displacement and speed of a base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BaseState {
    /// m.
    pub displacement: f64,
    /// m/s.
    pub speed: f64,
    /// Mean acceleration of the load over the last period, m/s².
    pub load_acceleration: f64,
}

impl BaseMode {
    /// Least and greatest frequency, Hz.
    pub(crate) const FREQUENCY: [f64; 2] = [0.1, 500.0];
    /// Of the damping ratio.
    pub(crate) const DAMPING: [f64; 2] = [0.0, 0.9];
    /// Of the mass ratio.
    pub(crate) const MASS_RATIO: [f64; 2] = [0.0, 0.5];
    /// Of the share at the tool.
    pub(crate) const AT_TOOL: [f64; 2] = [-10.0, 10.0];

    pub(crate) fn check(&self, axis: usize) -> Result<(), MachineError> {
        let within = |what, value: f64, [least, most]: [f64; 2], unit| {
            // False for a NaN too.
            match value >= least && value <= most {
                true => Ok(()),
                false => Err(MachineError::Invalid {
                    what,
                    axis: axis + 1,
                    value,
                    unit,
                    valid: format!("from {least} to {most} {unit}")
                        .trim_end()
                        .to_owned(),
                }),
            }
        };
        within(
            "the frequency of the base",
            self.frequency,
            Self::FREQUENCY,
            "Hz",
        )?;
        within(
            "the damping ratio of the base",
            self.damping,
            Self::DAMPING,
            "",
        )?;
        within(
            "the mass ratio of the base",
            self.mass_ratio,
            Self::MASS_RATIO,
            "",
        )?;
        within(
            "the share of the base at the tool",
            self.at_tool,
            Self::AT_TOOL,
            "",
        )
    }

    fn omega(&self) -> f64 {
        std::f64::consts::TAU * self.frequency
    }

    /// Acceleration of the base in the middle of the coming period, m/s², that of the load as in the last.
    pub(crate) fn acceleration_ahead(&self, state: &BaseState, period: f64) -> f64 {
        let ahead = self.advanced(state, state.load_acceleration, 0.5 * period);
        let omega = self.omega();
        -self.mass_ratio * state.load_acceleration
            - 2.0 * self.damping * omega * ahead.speed
            - omega * omega * ahead.displacement
    }

    /// After `period` (s) under a constant acceleration of the load (m/s²): the closed form of a damped oscillator about
    /// −μ q̈/ω².
    pub(crate) fn advanced(
        &self,
        state: &BaseState,
        load_acceleration: f64,
        period: f64,
    ) -> BaseState {
        let omega = self.omega();
        let settled = -self.mass_ratio * load_acceleration / (omega * omega);
        let decay = self.damping * omega;
        let damped = omega * (1.0 - self.damping * self.damping).sqrt();
        let (away, speed) = (state.displacement - settled, state.speed);
        let shrink = libm::exp(-decay * period);
        let (sin, cos) = libm::sincos(damped * period);
        BaseState {
            displacement: settled + shrink * (away * cos + (speed + decay * away) / damped * sin),
            speed: shrink * (speed * cos - (decay * speed + omega * omega * away) / damped * sin),
            load_acceleration,
        }
    }
}
