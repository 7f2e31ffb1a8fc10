//! Voltage of a permanent-magnet synchronous motor, and the speeds that it allows.
//!
//! In the rotor's frame, at constant speed and currents (the equations of docs/theory/foc-pmsm.md without derivatives):
//!
//! ```text
//! u_d = R i_d − ω_e L_q i_q          u_q = R i_q + ω_e (L_d i_d + ψ)
//! ```
//!
//! An inverter with space vector modulation gives phase voltages of up to U_dc/√3 without overmodulation.

use crate::error::{RatingError, not_negative, positive};
use crate::rating::Rating;

/// Electrical values of a motor. Currents and flux are amplitudes of the phase.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct MotorVoltage {
    /// Resistance of a phase, Ω.
    pub resistance_ohm: f64,
    /// Inductance in the axis of the magnets, H.
    pub inductance_d_h: f64,
    /// Inductance across it, H.
    pub inductance_q_h: f64,
    /// Flux of the magnets, V s: torque constant over 1.5 and over the pole pairs.
    pub flux_v_s: f64,
    /// Electrical radians per radian (m) of the motor: pole pairs; π over the pole pitch.
    pub electrical_per_motor: f64,
    /// Voltage of the DC link, V.
    pub dc_link_v: f64,
}

impl MotorVoltage {
    fn checked(&self) -> Result<(), RatingError> {
        not_negative("resistance_ohm", self.resistance_ohm)?;
        positive("inductance_d_h", self.inductance_d_h)?;
        positive("inductance_q_h", self.inductance_q_h)?;
        positive("flux_v_s", self.flux_v_s)?;
        positive("electrical_per_motor", self.electrical_per_motor)?;
        positive("dc_link_v", self.dc_link_v)?;
        Ok(())
    }

    /// Amplitude of the phase voltage that the inverter gives, U_dc/√3, V.
    pub fn available_v(&self) -> f64 {
        self.dc_link_v / 3.0_f64.sqrt()
    }

    /// Amplitude of the phase voltage for currents (d, q; A) at a constant motor speed, V.
    pub fn needed_v(&self, current_a: [f64; 2], speed_rad_per_s: f64) -> f64 {
        let [d, q] = current_a;
        let electrical = self.electrical_per_motor * speed_rad_per_s;
        let u_d = self.resistance_ohm * d - electrical * self.inductance_q_h * q;
        let u_q = self.resistance_ohm * q + electrical * (self.inductance_d_h * d + self.flux_v_s);
        u_d.hypot(u_q)
    }

    /// One instant against what the inverter gives.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no motor has.
    pub fn rating(&self, current_a: [f64; 2], speed_rad_per_s: f64) -> Result<Rating, RatingError> {
        self.checked()?;
        let needed = self.needed_v(current_a, speed_rad_per_s);
        Ok(Rating::at_most(needed, self.available_v(), "V"))
    }

    /// Motor speed up to which the voltage suffices for a torque-making current (A) without field weakening,
    /// rad/s: the positive root of
    ///
    /// ```text
    /// (ψ² + L_q² i²) ω_e² + 2 R i ψ ω_e + R² i² − u² = 0
    /// ```
    ///
    /// 0 if the resistance takes all of the voltage.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no motor has.
    pub fn base_speed_rad_per_s(&self, current_q_a: f64) -> Result<f64, RatingError> {
        self.checked()?;
        let (i, flux) = (not_negative("current_q_a", current_q_a)?, self.flux_v_s);
        let drop = self.resistance_ohm * i;
        let left = self.available_v() - drop;
        if left <= 0.0 {
            return Ok(0.0);
        }
        let a = flux.hypot(self.inductance_q_h * i).powi(2);
        let b = drop * flux;
        let c = left * (self.available_v() + drop);
        // c/(b + √(b² + a c)): no difference of near numbers.
        Ok(c / (b + (b * b + a * c).sqrt()) / self.electrical_per_motor)
    }

    /// Motor speed up to which a demagnetising current (A) holds the voltage without load, its resistance left out,
    /// rad/s: u/(ψ − L_d i). Infinite if the current can take away the whole flux.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no motor has.
    pub fn weakened_speed_rad_per_s(&self, current_d_a: f64) -> Result<f64, RatingError> {
        self.checked()?;
        let i = not_negative("current_d_a", current_d_a)?;
        let left = self.flux_v_s - self.inductance_d_h * i;
        Ok(match left > 0.0 {
            true => self.available_v() / left / self.electrical_per_motor,
            false => f64::INFINITY,
        })
    }

    /// Voltage between phases that the turning magnets make if the inverter switches off, √3 ω_e ψ, against what
    /// the drive withstands: it charges the DC link through the diodes.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no motor has, or a limit that is not above 0.
    pub fn back_emf(&self, fastest_rad_per_s: f64, limit_v: f64) -> Result<Rating, RatingError> {
        self.checked()?;
        let electrical = self.electrical_per_motor * fastest_rad_per_s.abs();
        let voltage = 3.0_f64.sqrt() * electrical * self.flux_v_s;
        Ok(Rating::at_most(voltage, positive("limit_v", limit_v)?, "V"))
    }
}
