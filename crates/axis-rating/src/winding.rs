//! Temperature of a winding by a first-order model.
//!
//! With θ the rise above the surroundings, P_r the loss at the reference temperature of the resistance, α the
//! resistance's rise per kelvin, R the thermal resistance and τ the time constant,
//!
//! ```text
//! dθ/dt = (R P_r (1 + α (T_a + θ − T_r)) − θ)/τ
//! ```
//!
//! (a balance of heat in one body; data sheets state its two numbers). In a stretch of constant P_r it is linear, and
//! solved exactly; over a duty that repeats itself θ comes back to where it began, which is solved for.

use crate::error::{RatingError, finite, not_negative, positive};
use crate::power_course::PowerCourse;
use crate::rating::Rating;

/// A winding.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct WindingModel {
    /// Thermal resistance from the winding to the surroundings, K/W.
    pub thermal_resistance_k_per_w: f64,
    /// Thermal time constant, s.
    pub time_constant_s: f64,
    /// Temperature of the surroundings, °C.
    pub ambient_deg_c: f64,
    /// Temperature at which the losses are known, °C.
    pub reference_deg_c: f64,
    /// Rise of the resistance per kelvin of the reference; 0.00393 of copper from 20 °C (IEC 60028).
    pub resistance_rise_per_k: f64,
}

impl WindingModel {
    /// Greatest temperature in a duty that repeats itself for ever, °C; infinite if the losses grow faster with the
    /// temperature than the heat that is carried away. `losses` are those at the reference temperature.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no winding has.
    pub fn greatest_deg_c(&self, losses: &PowerCourse) -> Result<f64, RatingError> {
        let resistance = positive(
            "thermal_resistance_k_per_w",
            self.thermal_resistance_k_per_w,
        )?;
        let time = positive("time_constant_s", self.time_constant_s)?;
        let rise = not_negative("resistance_rise_per_k", self.resistance_rise_per_k)?;
        let ambient = finite("ambient_deg_c", self.ambient_deg_c)?;
        let above = ambient - finite("reference_deg_c", self.reference_deg_c)?;
        // θ at the end of a stretch of rate k and drive d: θ e^(k h) + d (e^(k h) − 1)/k.
        let step = |[duration, power]: [f64; 2]| {
            let heat = resistance * power;
            let (rate, drive) = (
                (rise * heat - 1.0) / time,
                heat * (1.0 + rise * above) / time,
            );
            let whole = rate * duration;
            let gained = match whole == 0.0 {
                true => duration,
                false => whole.exp_m1() / rate,
            };
            [whole, drive * gained]
        };
        let (mut exponent, mut constant) = (0.0, 0.0);
        for stretch in losses.stretches() {
            let [whole, added] = step(stretch);
            constant = constant * whole.exp() + added;
            exponent += whole;
        }
        if exponent == 0.0 {
            return Ok(ambient);
        }
        if exponent > 0.0 || !constant.is_finite() {
            return Ok(f64::INFINITY);
        }
        let mut temperature = constant / -exponent.exp_m1();
        let mut most = temperature;
        for stretch in losses.stretches() {
            let [whole, added] = step(stretch);
            temperature = temperature * whole.exp() + added;
            most = most.max(temperature);
        }
        Ok(ambient + most)
    }

    /// The rise above the surroundings against what the insulation allows, K.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no winding has, or a limit that is not above the surroundings.
    pub fn rise(&self, losses: &PowerCourse, limit_deg_c: f64) -> Result<Rating, RatingError> {
        let name = "limit_deg_c, less the temperature of the surroundings,";
        let limit = positive(name, limit_deg_c - self.ambient_deg_c)?;
        let value = self.greatest_deg_c(losses)? - self.ambient_deg_c;
        Ok(Rating::at_most(value, limit, "K"))
    }
}
