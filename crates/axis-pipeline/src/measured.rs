//! The unit of an axis' errors, and values under names that say it.
//!
//! An axis that moves along a line has errors in µm, one that turns in µrad. [`ErrorUnit`] is decided
//! once, by how the axis moves; what is written to files says it in the name of a value (`errors_um`,
//! `errors_urad`) or beside it (`unit`).

use std::fmt;
use std::ops::Deref;

use axis_sim::Axis;
use axis_sim::mechanism::Freedom;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A millionth of the unit of an axis' position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum ErrorUnit {
    /// µm, of an axis that moves along a line.
    #[default]
    #[serde(rename = "µm")]
    Micrometre,
    /// µrad, of one that turns.
    #[serde(rename = "µrad")]
    Microradian,
}

impl ErrorUnit {
    /// That of an axis.
    pub fn of(axis: &Axis) -> Self {
        axis.freedom().into()
    }

    /// As people read it: `µm`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Micrometre => "µm",
            Self::Microradian => "µrad",
        }
    }

    /// As names end in it: `um`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Micrometre => "um",
            Self::Microradian => "urad",
        }
    }

    /// A thousand of it, in which positions and speeds are shown: `mm`.
    pub fn thousand(self) -> &'static str {
        match self {
            Self::Micrometre => "mm",
            Self::Microradian => "mrad",
        }
    }

    /// A million of it, the SI unit of the position: `m`.
    pub fn million(self) -> &'static str {
        self.freedom().unit()
    }

    fn freedom(self) -> Freedom {
        match self {
            Self::Micrometre => Freedom::Linear,
            Self::Microradian => Freedom::Rotary,
        }
    }
}

impl From<Freedom> for ErrorUnit {
    fn from(freedom: Freedom) -> Self {
        match freedom {
            Freedom::Linear => Self::Micrometre,
            Freedom::Rotary => Self::Microradian,
        }
    }
}

impl fmt::Display for ErrorUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// Values that files hold under one name on an axis that moves along a line, and under another on one that
/// turns.
macro_rules! measured {
    ($($(#[$doc:meta])* $name:ident $linear:literal $rotary:literal;)+) => {
        $(
            $(#[$doc])*
            ///
            /// A field of a file flattens it, so that its name is that of the unit.
            #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
            pub enum $name<T> {
                /// Of an axis that moves along a line.
                #[serde(rename = $linear)]
                Linear(T),
                /// Of an axis that turns.
                #[serde(rename = $rotary)]
                Rotary(T),
            }

            impl<T> $name<T> {
                /// A value in the unit of an axis.
                pub fn new(unit: ErrorUnit, value: T) -> Self {
                    match unit {
                        ErrorUnit::Micrometre => Self::Linear(value),
                        ErrorUnit::Microradian => Self::Rotary(value),
                    }
                }

                /// Of which axis it is.
                pub fn unit(&self) -> ErrorUnit {
                    match self {
                        Self::Linear(_) => ErrorUnit::Micrometre,
                        Self::Rotary(_) => ErrorUnit::Microradian,
                    }
                }
            }

            impl<T> Deref for $name<T> {
                type Target = T;

                fn deref(&self) -> &T {
                    match self {
                        Self::Linear(value) | Self::Rotary(value) => value,
                    }
                }
            }

            impl<T: Default> Default for $name<T> {
                fn default() -> Self {
                    Self::Linear(T::default())
                }
            }
        )+

        /// Every name with the unit that it ends in and what that is made of.
        #[cfg(test)]
        const NAMES: &[[&str; 2]] = &[$([$linear, $rotary]),+];
    };
}

measured! {
    /// Errors, µm or µrad.
    Errors "errors_um" "errors_urad";
    /// A series of errors, µm or µrad.
    ErrorSeries "error_um" "error_urad";
    /// Root mean squares of errors, µm or µrad.
    Rms "rms_um" "rms_urad";
    /// What a model misses on the motions that it was fitted to, RMS, µm or µrad.
    TrainingRms "training_rms_um" "training_rms_urad";
    /// What a model misses on other motions, RMS, µm or µrad.
    ValidationRms "validation_rms_um" "validation_rms_urad";
    /// From the least to the greatest error, µm or µrad.
    PeakToPeak "peak_to_peak_um" "peak_to_peak_urad";
    /// Greatest errors without compensation, µm or µrad.
    WithoutCompensation "none_um" "none_urad";
    /// Greatest errors that are left, µm or µrad.
    Left "left_um" "left_urad";
    /// Greatest absolute error of a network, µm or µrad.
    MaxAbsError "max_abs_error_um" "max_abs_error_urad";
    /// Mean absolute error of a network, µm or µrad.
    MeanAbsError "mean_abs_error_um" "mean_abs_error_urad";
    /// Greatest absolute error of a linear map, µm or µrad.
    LinearMaxAbsError "linear_max_abs_error_um" "linear_max_abs_error_urad";
    /// Mean absolute error of a linear map, µm or µrad.
    LinearMeanAbsError "linear_mean_abs_error_um" "linear_mean_abs_error_urad";
    /// A speed of the load, mm/s or mrad/s.
    Speed "speed_mm_s" "speed_mrad_s";
    /// Velocities of the reference, mm/s or mrad/s.
    Velocity "velocity_mm_s" "velocity_mrad_s";
    /// Accelerations of the reference, mm/s² or mrad/s².
    Acceleration "acceleration_mm_s2" "acceleration_mrad_s2";
    /// Jerks of the reference, mm/s³ or mrad/s³.
    Jerk "jerk_mm_s3" "jerk_mrad_s3";
    /// A position of the load, m or rad.
    Position "position_m" "position_rad";
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every name of a turning axis is that of the other with its unit in the place of the length.
    #[test]
    fn names_differ_by_their_unit_alone() {
        let rad = |part: &str| match part {
            "um" => "urad".to_owned(),
            "mm" => "mrad".to_owned(),
            "m" => "rad".to_owned(),
            other => other.to_owned(),
        };
        for [linear, rotary] in NAMES {
            let expected: Vec<String> = linear.split('_').map(rad).collect();
            assert_eq!(expected.join("_"), *rotary);
            assert_ne!(linear, rotary);
        }
    }

    #[test]
    fn a_unit_has_one_spelling_for_people_names_and_files() {
        for freedom in [Freedom::Linear, Freedom::Rotary] {
            let unit = ErrorUnit::from(freedom);
            assert_eq!(unit.symbol(), format!("µ{}", freedom.unit()));
            assert_eq!(unit.key(), format!("u{}", freedom.unit()));
            assert_eq!(unit.thousand(), format!("m{}", freedom.unit()));
            assert_eq!(unit.million(), freedom.unit());
            let json = serde_json::to_string(&unit).unwrap();
            assert_eq!(json, format!("\"{unit}\""));
        }
    }

    #[test]
    fn a_flattened_value_is_read_under_the_name_that_it_was_written_under() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct File {
            #[serde(flatten)]
            errors: Errors<Vec<f64>>,
            #[serde(flatten)]
            speed: Speed<f64>,
            more: u32,
        }
        for (unit, text) in [
            (
                ErrorUnit::Micrometre,
                r#"{"errors_um":[0.1,-2.0],"speed_mm_s":3.5,"more":1}"#,
            ),
            (
                ErrorUnit::Microradian,
                r#"{"errors_urad":[0.1,-2.0],"speed_mrad_s":3.5,"more":1}"#,
            ),
        ] {
            let file = File {
                errors: Errors::new(unit, vec![0.1, -2.0]),
                speed: Speed::new(unit, 3.5),
                more: 1,
            };
            assert_eq!(serde_json::to_string(&file).unwrap(), text);
            assert_eq!(serde_json::from_str::<File>(text).unwrap(), file);
        }
    }
}
