//! Frequency response of the elastic drive in closed form.

use nalgebra::Complex;

use super::ElasticDrive;
use crate::DriveError;
use crate::error::frequency;

/// Where an elastic drive is driven or observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Side {
    /// Rotation of the motor (rad), driven by a torque (N·m).
    Motor,
    /// Displacement of the load (m, rad where it turns), driven by a force (N, N·m).
    Load,
}

impl ElasticDrive {
    /// Receptance from a load at `input` to the displacement at `output` with the
    /// load at `x`, one value for each angular frequency ω (rad/s). With
    /// κ = k(x) (1 + iωβ) and D = ω² (ω² J m − κ (J + m r²)):
    ///
    /// ```text
    /// motor to motor:  (κ − ω² m) / D        motor to load and back:  r κ / D
    /// load to load:    (r² κ − ω² J) / D
    /// ```
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if `x` or a frequency is not finite or the stiffness
    /// there is not valid; [`DriveError::Singular`] at zero frequency, where the axis is free,
    /// and at a resonance without damping.
    pub fn receptance(
        &self,
        x: f64,
        [input, output]: [Side; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        self.check_position(x)?;
        let stiffness = self.parameters.stiffness.at(x);
        let at = |&w: &f64| self.receptance_at(stiffness, input, output, w);
        angular_frequencies.iter().map(at).collect()
    }

    fn receptance_at(
        &self,
        stiffness: f64,
        input: Side,
        output: Side,
        w: f64,
    ) -> Result<Complex<f64>, DriveError> {
        let p = &self.parameters;
        let (r, square) = (p.travel_per_radian, frequency(w)? * w);
        let spring = Complex::new(stiffness, stiffness * w * p.stiffness_damping);
        let both = square * p.motor_inertia * p.load_inertia;
        let determinant = (Complex::from(both) - spring * self.total_inertia()) * square;
        let response = match (input, output) {
            (Side::Motor, Side::Motor) => spring - square * p.load_inertia,
            (Side::Load, Side::Load) => spring * (r * r) - square * p.motor_inertia,
            _ => spring * r,
        } / determinant;
        if response.re.is_finite() && response.im.is_finite() {
            return Ok(response);
        }
        Err(DriveError::Singular {
            angular_frequency: w,
        })
    }
}
