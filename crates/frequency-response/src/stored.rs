//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use serde::Deserialize;

use crate::fit::{Parameters, Plane};
use crate::{FittedMode, FittedPole, ModalFit, ResponseError, Uncertain};

/// A complex number as a pair of its parts.
pub(crate) mod complex {
    use nalgebra::Complex;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(z: &Complex<f64>, to: S) -> Result<S::Ok, S::Error> {
        (z.re, z.im).serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Complex<f64>, D::Error> {
        let (re, im) = Deserialize::deserialize(from)?;
        Ok(Complex::new(re, im))
    }
}

/// A band, of whose ends infinity is written as the greatest number: JSON has no infinity.
pub(crate) mod band {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(band: &[f64; 2], to: S) -> Result<S::Ok, S::Error> {
        let end = |hz: f64| if hz == f64::INFINITY { f64::MAX } else { hz };
        band.map(end).serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
        let band = <[f64; 2]>::deserialize(from)?;
        Ok(band.map(|hz| if hz == f64::MAX { f64::INFINITY } else { hz }))
    }
}

#[derive(Deserialize)]
#[serde(rename = "ModalFit", deny_unknown_fields)]
pub(crate) struct StoredFit {
    modes: Vec<FittedMode>,
    poles: Vec<FittedPole>,
    delay_s: Uncertain,
    misfit: f64,
    relative_error: f64,
    lines: usize,
    band_hz: [f64; 2],
    plane: Plane,
    parameters: Parameters,
}

impl TryFrom<StoredFit> for ModalFit {
    type Error = ResponseError;

    /// What its response is computed from must be that of so many poles.
    fn try_from(stored: StoredFit) -> Result<Self, ResponseError> {
        let refuse = |name, value, valid| Err(ResponseError::Setting { name, value, valid });
        let Parameters {
            real,
            pairs,
            ref values,
        } = stored.parameters;
        if real != stored.poles.len() || pairs != stored.modes.len() {
            let found = real.saturating_add(pairs) as f64;
            return refuse("parameters: poles", found, "as many as modes and poles");
        }
        if values.len() != 2 * real + 4 * pairs + 1 {
            let valid = "two for each real pole, four for each mode, and the delay";
            return refuse("parameters: values", values.len() as f64, valid);
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return refuse("parameters: a value", *value, "a finite number");
        }
        let Plane { scale, held } = stored.plane;
        if !(scale.is_finite() && scale > 0.0) {
            return refuse("plane: scale", scale, "above 0 rad/s");
        }
        if !(held.is_finite() && held >= 0.0) {
            return refuse("plane: held", held, "0 or above");
        }
        let fit = Self {
            modes: stored.modes,
            poles: stored.poles,
            delay_s: stored.delay_s,
            misfit: stored.misfit,
            relative_error: stored.relative_error,
            lines: stored.lines,
            band_hz: stored.band_hz,
            plane: stored.plane,
            parameters: stored.parameters,
        };
        match fit.contradiction() {
            None => Ok(fit),
            Some(value) => refuse(
                "a number of modes, poles or delay",
                value,
                "that of the parameters",
            ),
        }
    }
}
