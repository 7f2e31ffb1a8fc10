//! Time: steps as long as the losses allow.

use nalgebra::DVector;

use crate::error::{ThermalError, check};
use crate::state::ThermalState;
use crate::work::AxisAtWork;

/// Greatest temperature that is still followed, °C: beyond it, losses grow faster than they are
/// carried off.
const HOTTEST: f64 = 1000.0;

/// Shortest step, s.
const SHORTEST: f64 = 1e-3;

/// How exactly a run is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ThermalAccuracy {
    /// By which a step of first order may differ from one of second order, K. What is kept is
    /// that of second order.
    pub tolerance: f64,
    /// Longest step, s.
    pub longest_step: f64,
}

impl Default for ThermalAccuracy {
    /// 5 mK, 300 s. Over an hour of the paper's axis the growth then differs by less than
    /// 0.002 µm of 134 from that with a thousandth of the tolerance (`cargo xtask heat-proof`).
    fn default() -> Self {
        Self {
            tolerance: 5e-3,
            longest_step: 300.0,
        }
    }
}

/// What a run took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermalWork {
    /// Steps that were kept.
    pub steps: u64,
    /// Steps that were made again, shorter.
    pub repeated: u64,
}

impl AxisAtWork {
    /// Runs on for `duration` seconds in air of a constant temperature, °C.
    ///
    /// # Errors
    /// As [`AxisAtWork::run_in`].
    pub fn run(
        &self,
        state: &mut ThermalState,
        air: f64,
        duration: f64,
    ) -> Result<ThermalWork, ThermalError> {
        self.run_in(state, |_| air, duration, &ThermalAccuracy::default())
    }

    /// Runs on for `duration` seconds in air whose temperature (°C) follows the state's time (s);
    /// between the ends of a step it counts as a straight line.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] for a duration or an accuracy without sense,
    /// [`ThermalError::RunsAway`] if a temperature passes 1000 °C.
    pub fn run_in(
        &self,
        state: &mut ThermalState,
        air: impl Fn(f64) -> f64,
        duration: f64,
        accuracy: &ThermalAccuracy,
    ) -> Result<ThermalWork, ThermalError> {
        let inside = (0.0..=1e9).contains(&duration);
        check(inside, "duration", duration, "s", "from 0 to 1e9")?;
        let tolerance = accuracy.tolerance;
        let inside = tolerance >= 1e-12;
        check(inside, "tolerance", tolerance, "K", "1e-12 or above")?;
        let longest = accuracy.longest_step;
        let inside = longest >= SHORTEST;
        check(inside, "longest_step", longest, "s", "0.001 or above")?;
        let begun = state.time;
        let mut work = ThermalWork::default();
        let mut wanted = 10.0_f64.min(longest);
        loop {
            let left = begun + duration - state.time;
            if left <= 0.0 {
                state.time = begun + duration;
                return Ok(work);
            }
            // Two equal steps instead of a long and a very short one.
            let h = match left {
                left if left <= wanted => left,
                left if left <= 2.0 * wanted => 0.5 * left,
                _ => wanted,
            };
            let now = state.time;
            let mut power = |t: &DVector<f64>, since: f64| {
                let mut powers = self.powers(t);
                powers.axpy(air(now + since), &self.network.to_air, 1.0);
                powers
            };
            let stepped = self.network.step(&state.temperatures, h, &mut power);
            let hottest = stepped.temperatures.amax();
            if hottest.is_nan() || hottest > HOTTEST {
                return Err(ThermalError::RunsAway {
                    time: now,
                    temperature: hottest,
                });
            }
            // The difference goes with h² and more; never by more than a factor of 4.
            let factor = (0.9 * (tolerance / stepped.error.max(1e-300)).sqrt()).clamp(0.25, 4.0);
            wanted = (h * factor).clamp(SHORTEST, longest);
            if stepped.error > tolerance && h > SHORTEST {
                work.repeated += 1;
                continue;
            }
            work.steps += 1;
            state.temperatures = stepped.temperatures;
            state.time = match h == left {
                true => begun + duration,
                false => now + h,
            };
        }
    }
}
