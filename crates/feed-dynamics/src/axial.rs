//! Axial stiffness of a screw's shaft on its bearings.

use crate::DriveError;
use crate::elastic::Stiffness;
use crate::error::positive;

/// Which ends of a screw are held along its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Mounting {
    /// The driven end, x = 0, alone.
    FixedFree,
    /// Both ends, x = 0 and x = length.
    FixedFixed,
}

/// What holds the screw of a [`FeedDrive`](crate::FeedDrive) along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct AxialSupport {
    /// Axial stiffness of each bearing that holds the screw, N/m.
    pub bearing_stiffness: f64,
    /// Which ends are held.
    pub mounting: Mounting,
}

/// A screw's shaft as a spring along its axis, between its bearings and a nut at
/// x, massless.
///
/// With `EA` the axial rigidity, `L` the length (between the bearings where there
/// are two) and `c` the compliance of a bearing, zero where it is rigid:
///
/// ```text
/// fixed and free:   1/k = c + x/EA
/// fixed and fixed:  k = 1/(c + x/EA) + 1/(c + (L − x)/EA),   EA L / (x (L − x)) for c = 0
/// ```
///
/// Two fixed bearings hold as long as their preload is not used up. Source: a
/// uniform bar in tension, as in makers' catalogues and in Altintas, Verl,
/// Brecher, Uriarte, Pritschow, CIRP Annals 60 (2011) 779,
/// doi:10.1016/j.cirp.2011.05.010.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScrewShaft {
    rigidity: f64,
    length: f64,
    mounting: Mounting,
    /// Compliance of each bearing, m/N.
    bearing: f64,
}

impl ScrewShaft {
    /// Most that [`Stiffness::at`] gives, as a multiple of `EA/L`: on a rigid
    /// bearing the stiffness has no bound.
    pub const MOST: f64 = 1000.0;

    /// A shaft of the axial rigidity `rigidity` = EA (N) and `length` (m) on rigid
    /// bearings.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] unless both are finite and above zero.
    pub fn new(rigidity: f64, length: f64, mounting: Mounting) -> Result<Self, DriveError> {
        positive([("rigidity", rigidity), ("length", length)])?;
        Ok(Self {
            rigidity,
            length,
            mounting,
            bearing: 0.0,
        })
    }

    /// The same shaft with each bearing that holds it of the axial stiffness
    /// `bearing_stiffness`, N/m.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] unless it is finite and above zero.
    pub fn on_bearings(self, bearing_stiffness: f64) -> Result<Self, DriveError> {
        positive([("bearing_stiffness", bearing_stiffness)])?;
        Ok(Self {
            bearing: 1.0 / bearing_stiffness,
            ..self
        })
    }

    /// Compliance 1/k of shaft and bearings for a nut at `x`, m/N; beyond an end
    /// it is that of the end. Zero at a rigid bearing.
    pub fn compliance(&self, x: f64) -> f64 {
        let x = x.clamp(0.0, self.length);
        let driven = self.bearing + x / self.rigidity;
        match self.mounting {
            Mounting::FixedFree => driven,
            Mounting::FixedFixed => {
                let far = self.bearing + (self.length - x) / self.rigidity;
                driven * far / (driven + far)
            }
        }
    }
}

/// Bounded: at most [`ScrewShaft::MOST`] times `EA/L`, which is exceeded within
/// L/1000 of a rigid bearing only. [`ScrewShaft::compliance`] has no bound.
impl Stiffness for ScrewShaft {
    fn at(&self, x: f64) -> f64 {
        let least = self.length / (Self::MOST * self.rigidity);
        let compliance = self.compliance(x);
        // Not `max`, which would make a stiffness of an x that is no number.
        1.0 / if compliance < least {
            least
        } else {
            compliance
        }
    }
}
