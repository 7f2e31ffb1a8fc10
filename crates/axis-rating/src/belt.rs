//! Load of a toothed belt: teeth in mesh, and cords.
//!
//! Belt makers rate teeth by a force per tooth and width, and count at most 12 teeth in mesh (CONTI SYNCHROFLEX, calculation
//! example of a roll table, belt-pilot.com; it states the torque of a tooth and centimetre, M_spez z t/(2π) in force).

use crate::error::{RatingError, not_negative, positive};
use crate::rating::Rating;

/// Most teeth that are counted as in mesh.
pub const MOST_TEETH_IN_MESH: f64 = 12.0;

/// The teeth of a belt.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BeltTeeth {
    /// Permissible force of one tooth for each metre of width, N/m, at the speed of the duty.
    pub force_per_width_n_per_m: f64,
    /// Width, m.
    pub width_m: f64,
    /// Teeth in mesh on the driven pulley: half of its teeth if the belt wraps half of it.
    pub in_mesh: f64,
}

impl BeltTeeth {
    /// The greatest pull of the pulley on the belt against what the teeth in mesh take.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no belt has.
    pub fn tooth_load(&self, greatest_n: f64) -> Result<Rating, RatingError> {
        let value = not_negative("greatest_n", greatest_n)?;
        let force = positive("force_per_width_n_per_m", self.force_per_width_n_per_m)?;
        let width = positive("width_m", self.width_m)?;
        let teeth = positive("in_mesh", self.in_mesh)?.min(MOST_TEETH_IN_MESH);
        Ok(Rating::at_most(value, force * width * teeth, "N"))
    }
}

/// The greatest force in the cords, pretension and pull together, against what they take.
///
/// On a linear axis the tight strand carries the whole pull on top of the pretension (Siegling, *Timing belts: calculation
/// methods*: F_B = F_U + F_V).
///
/// # Errors
/// [`RatingError::Invalid`] of forces below 0 or a limit that is not above 0.
pub fn cord_load(greatest_n: f64, pretension_n: f64, limit_n: f64) -> Result<Rating, RatingError> {
    let pull = not_negative("greatest_n", greatest_n)?;
    let value = pull + not_negative("pretension_n", pretension_n)?;
    Ok(Rating::at_most(value, positive("limit_n", limit_n)?, "N"))
}
