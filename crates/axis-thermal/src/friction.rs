//! Friction at another temperature than the one it is known at.

use crate::error::{ThermalError, check};

/// How a friction changes with the temperature of the part that it acts in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum TemperatureLaw {
    /// Not at all.
    #[default]
    Constant,
    /// By the factor exp(−c ΔT): oil and grease over some tens of kelvins, near Vogel's law.
    Exponential {
        /// c, 1/K.
        per_kelvin: f64,
    },
    /// By the factor 1 − c ΔT, never below 0.
    Linear {
        /// c, 1/K.
        per_kelvin: f64,
    },
}

impl TemperatureLaw {
    /// The factor at ΔT kelvins above the temperature at which the friction is known.
    pub fn factor(&self, above: f64) -> f64 {
        match *self {
            Self::Constant => 1.0,
            Self::Exponential { per_kelvin } => (-per_kelvin * above).exp(),
            Self::Linear { per_kelvin } => (1.0 - per_kelvin * above).max(0.0),
        }
    }

    fn validate(&self, name: &'static str) -> Result<(), ThermalError> {
        let (Self::Exponential { per_kelvin } | Self::Linear { per_kelvin }) = *self else {
            return Ok(());
        };
        let inside = (-0.2..=0.2).contains(&per_kelvin);
        check(inside, name, per_kelvin, "1/K", "from -0.2 to 0.2")
    }
}

/// The laws by which friction changes as the axis warms up. Each may be switched off
/// ([`FrictionLaws::CONSTANT`]).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FrictionLaws {
    /// Of the viscous part.
    pub viscous: TemperatureLaw,
    /// Of the dry part.
    pub dry: TemperatureLaw,
    /// Share by which the nut's dry friction grows for each kelvin that the screw under the nut
    /// is warmer than the nut, 1/K: the screw's growth raises the preload of the balls.
    pub preload_per_kelvin: f64,
}

impl FrictionLaws {
    /// Friction that does not change.
    pub const CONSTANT: Self = Self {
        viscous: TemperatureLaw::Constant,
        dry: TemperatureLaw::Constant,
        preload_per_kelvin: 0.0,
    };

    pub(crate) fn validate(&self) -> Result<(), ThermalError> {
        self.viscous.validate("friction's viscous law")?;
        self.dry.validate("friction's dry law")?;
        let preload = self.preload_per_kelvin;
        let inside = (-0.5..=0.5).contains(&preload);
        let valid = "from -0.5 to 0.5";
        check(inside, "preload_per_kelvin", preload, "1/K", valid)
    }
}

impl Default for FrictionLaws {
    /// Viscous −2.5 %/K, dry −0.2 %/K, preload +1.5 %/K of the difference. Assumed: greases lose half
    /// of their viscosity in some 25 to 30 K; no measured law of this axis is known.
    fn default() -> Self {
        Self {
            viscous: TemperatureLaw::Exponential { per_kelvin: 0.025 },
            dry: TemperatureLaw::Linear { per_kelvin: 0.002 },
            preload_per_kelvin: 0.015,
        }
    }
}
