//! The residual on check logs, and the noise that it is judged by.

use axis_sim::{Axis, ReplayError};

use crate::answers::{Rest, State};
use crate::name::gap::{Gap, gap};
use crate::noise::{Floor, LogNoise, Simulated, SlowNoise, coloured_noise, floors_with};

/// Times the noise, as it is known with its colour, beyond which the residual in a channel is
/// something else, and the colour is not to be trusted either.
const EXPLAINS: f64 = 2.0;

/// The gap on check logs.
pub(super) struct Left {
    pub(super) gap: Gap,
    /// Noise alone, by channel.
    pub(super) floors: Vec<Floor>,
    /// Noise of sensors that is not white, where the residual shows it.
    pub(super) loop_noise: Option<LogNoise>,
}

impl Left {
    /// Of a machine at a `state`, its simulations of the logs that were fitted and of `check` logs,
    /// the residuals of these before and after, their `floors` as of white noise, and slow noise of
    /// their
    /// logger, which is in these already.
    pub(super) fn of(
        machine: &Axis,
        state: &State,
        fitted: Simulated,
        check: Simulated,
        [before, after]: [&Rest; 2],
        floors: Vec<Floor>,
        slow: &SlowNoise,
    ) -> Result<Self, ReplayError> {
        let (set, traces) = check;
        let white = Self {
            gap: gap(set, before, after, &floors),
            floors,
            loop_noise: None,
        };
        if white.gap.is_at_floor() {
            return Ok(white);
        }
        let Some(noise) = coloured_noise(machine, state, fitted, check)? else {
            return Ok(white);
        };
        let floors = floors_with(machine, set, state, traces, &noise)?;
        let floors = slow.beside_floors(set, floors);
        let gap = gap(set, before, after, &floors);
        tracing::debug!(?gap, "beside coloured noise in the loop");
        let mut channels = gap.channels.iter();
        if channels.any(|c| c.after > EXPLAINS * c.floor) {
            return Ok(white);
        }
        Ok(Self {
            gap,
            floors,
            loop_noise: Some(noise),
        })
    }
}
