//! Energy that a stop gives back to the DC link, and the brake resistor that takes it.
//!
//! Electrical power of the motor is torque times speed plus the winding's losses; where that is negative the drive
//! regenerates. Of the energy of one uninterrupted stretch of regeneration the link's capacitors take
//!
//! ```text
//! E_C = ½ C (U_on² − U²)
//! ```
//!
//! up to the voltage U_on at which the brake switches on; the brake takes the residual (the balance of drive makers'
//! guides: energy of motion, less losses of load and winding, less the capacitors', such as Yaskawa's Σ-7 manual,
//! section Regenerative Resistor).

use crate::error::{RatingError, not_negative, positive};
use crate::rating::Rating;

/// A DC link with a brake.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DcLink {
    /// Capacitance, F.
    pub capacitance_f: f64,
    /// Voltage in normal operation, V.
    pub voltage_v: f64,
    /// Voltage at which the brake switches on, V.
    pub brake_on_v: f64,
}

impl DcLink {
    /// Energy that the capacitors take before the brake switches on, J.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of a brake that switches on below the voltage of normal operation, and of values
    /// that no link has.
    pub fn capacitor_energy_j(&self) -> Result<f64, RatingError> {
        let capacitance = not_negative("capacitance_f", self.capacitance_f)?;
        let voltage = positive("voltage_v", self.voltage_v)?;
        let on = positive("brake_on_v", self.brake_on_v)?;
        let over = not_negative("brake_on_v, less voltage_v,", on - voltage)?;
        Ok(0.5 * capacitance * over * (on + voltage))
    }
}

/// Regeneration over a duty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Regeneration {
    capacitor_j: f64,
    duration_s: f64,
    /// Of the stretch that is under way, J.
    stretch_j: f64,
    greatest_j: f64,
    braked_j: f64,
    peak_w: f64,
}

impl Regeneration {
    /// On a link whose capacitors take so much of each stretch, J ([`DcLink::capacitor_energy_j`]).
    pub fn with_capacitor(capacitor_j: f64) -> Self {
        Self {
            capacitor_j,
            ..Self::default()
        }
    }

    /// Adds a stretch: torque times speed, and the losses of the winding, W.
    pub fn push(&mut self, duration_s: f64, mechanical_w: f64, loss_w: f64) {
        let back = -(mechanical_w + loss_w);
        self.duration_s += duration_s;
        if back > 0.0 {
            self.stretch_j += duration_s * back;
            self.greatest_j = self.greatest_j.max(self.stretch_j);
            self.peak_w = self.peak_w.max(back);
        } else {
            self.braked_j += (self.stretch_j - self.capacitor_j).max(0.0);
            self.stretch_j = 0.0;
        }
    }

    /// Greatest energy of one stretch, J.
    pub fn greatest_energy_j(&self) -> f64 {
        self.greatest_j
    }

    /// Greatest power given back, W.
    pub fn peak_power_w(&self) -> f64 {
        self.peak_w
    }

    /// Mean power of the brake, W.
    pub fn mean_brake_power_w(&self) -> f64 {
        let under_way = (self.stretch_j - self.capacitor_j).max(0.0);
        match self.duration_s > 0.0 {
            true => (self.braked_j + under_way) / self.duration_s,
            false => 0.0,
        }
    }

    /// The greatest energy of one stretch against what the capacitors, and a brake of `brake_j` per stop, take.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of an energy below 0.
    pub fn energy(&self, brake_j: f64) -> Result<Rating, RatingError> {
        let limit = self.capacitor_j + not_negative("brake_j", brake_j)?;
        Ok(Rating::at_most(self.greatest_j, limit, "J"))
    }

    /// Mean power of the brake against its continuous power.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of a power that is not above 0.
    pub fn mean_power(&self, continuous_w: f64) -> Result<Rating, RatingError> {
        let limit = positive("continuous_w", continuous_w)?;
        Ok(Rating::at_most(self.mean_brake_power_w(), limit, "W"))
    }

    /// The greatest power against what a resistor takes at the voltage at which it switches on, U²/R.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of a voltage or a resistance that is not above 0.
    pub fn peak_power(&self, brake_on_v: f64, resistance_ohm: f64) -> Result<Rating, RatingError> {
        let voltage = positive("brake_on_v", brake_on_v)?;
        let limit = voltage * voltage / positive("resistance_ohm", resistance_ohm)?;
        Ok(Rating::at_most(self.peak_w, limit, "W"))
    }
}
