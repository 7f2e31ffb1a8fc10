//! How programs stand in files: millimetres or degrees, with the unit in each key.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Chirp, Limits, Program, ProgramUnit, Sine, Step, Sweep, TrajectoryError};

/// A [`Program`] as written.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct ProgramFile {
    #[serde(skip_serializing_if = "Option::is_none")]
    start_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    start_deg: Option<f64>,
    // Read in raw form, so that what is wrong with a step is told with the step's number.
    steps: Vec<StepFile>,
}

/// A [`Step`] as written. Of a number in either unit a file has the one or the other.
#[derive(Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum StepFile {
    Move {
        #[serde(skip_serializing_if = "Option::is_none")]
        to_mm: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        to_deg: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity_mm_s: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity_deg_s: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        acceleration_mm_s2: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        acceleration_deg_s2: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        jerk_mm_s3: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        jerk_deg_s3: Option<f64>,
    },
    MoveBy {
        #[serde(skip_serializing_if = "Option::is_none")]
        by_mm: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        by_deg: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity_mm_s: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity_deg_s: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        acceleration_mm_s2: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        acceleration_deg_s2: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        jerk_mm_s3: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        jerk_deg_s3: Option<f64>,
    },
    Dwell {
        duration_s: f64,
    },
    Sine {
        #[serde(skip_serializing_if = "Option::is_none")]
        amplitude_mm: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        amplitude_deg: Option<f64>,
        frequency_hz: f64,
        cycles: u32,
    },
    Chirp {
        #[serde(skip_serializing_if = "Option::is_none")]
        amplitude_mm: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        amplitude_deg: Option<f64>,
        from_frequency_hz: f64,
        to_frequency_hz: f64,
        duration_s: f64,
        ramp_s: Option<f64>,
        #[serde(default)]
        sweep: Sweep,
    },
}

impl ProgramUnit {
    /// In metres or radians.
    fn read(self, value: f64) -> f64 {
        match self {
            // Division, because 1000 is exact and 0.001 is not: 900 mm becomes the f64 nearest to
            // 0.9 m.
            Self::Millimetres => value / 1000.0,
            Self::Degrees => value.to_radians(),
        }
    }

    /// What reads back as `value`, where such a number exists.
    fn write(self, value: f64) -> f64 {
        let near = match self {
            Self::Millimetres => value * 1000.0,
            Self::Degrees => value.to_degrees(),
        };
        [near, near.next_down(), near.next_up()]
            .into_iter()
            .find(|&written| self.read(written) == value)
            .unwrap_or(near)
    }

    /// An error of a number that was read, whose unit is told as of a motion along a line.
    fn said(self, error: &TrajectoryError) -> String {
        match self {
            Self::Millimetres => error.to_string(),
            Self::Degrees => format!("{error} (m stands for rad)"),
        }
    }

    /// A number to write, as millimetres and as degrees, of which one is left out.
    fn both(self, value: f64) -> [Option<f64>; 2] {
        match self {
            Self::Millimetres => [Some(self.write(value)), None],
            Self::Degrees => [None, Some(self.write(value))],
        }
    }

    /// A number that was written in one of two units, each with its key.
    fn pick(self, of: [(&str, Option<f64>); 2]) -> Result<f64, String> {
        let [millimetres, degrees] = of;
        let (own, other) = match self {
            Self::Millimetres => (millimetres, degrees),
            Self::Degrees => (degrees, millimetres),
        };
        match (own.1, other.1) {
            (Some(value), None) => Ok(self.read(value)),
            (_, Some(_)) => Err(format!(
                "`{}` in a program that is in {}: `{}` would be right",
                other.0,
                self.name(),
                own.0
            )),
            (None, None) => Err(format!("missing field `{}`", own.0)),
        }
    }
}

/// The number in one of two fields, whose names are their keys.
macro_rules! either {
    ($unit:expr, $millimetres:ident, $degrees:ident) => {
        $unit.pick([
            (stringify!($millimetres), $millimetres),
            (stringify!($degrees), $degrees),
        ])?
    };
}

impl StepFile {
    /// Name of the step's kind, for errors met before there is a [`Step`].
    fn kind(&self) -> &'static str {
        match self {
            Self::Move { .. } => "move",
            Self::MoveBy { .. } => "move_by",
            Self::Dwell { .. } => "dwell",
            Self::Sine { .. } => "sine",
            Self::Chirp { .. } => "chirp",
        }
    }

    /// The unit of a step that stands alone.
    fn unit(&self) -> ProgramUnit {
        let degrees = match *self {
            Self::Move { to_deg, .. } => to_deg,
            Self::MoveBy { by_deg, .. } => by_deg,
            Self::Dwell { .. } => None,
            Self::Sine { amplitude_deg, .. } | Self::Chirp { amplitude_deg, .. } => amplitude_deg,
        };
        match degrees {
            Some(_) => ProgramUnit::Degrees,
            None => ProgramUnit::Millimetres,
        }
    }

    /// The step, written in this unit.
    fn read(self, unit: ProgramUnit) -> Result<Step, String> {
        let limits = |velocity, acceleration, jerk| {
            Limits::new(velocity, acceleration, jerk).map_err(|e| unit.said(&e))
        };
        Ok(match self {
            Self::Move {
                to_mm,
                to_deg,
                velocity_mm_s,
                velocity_deg_s,
                acceleration_mm_s2,
                acceleration_deg_s2,
                jerk_mm_s3,
                jerk_deg_s3,
            } => Step::Move {
                to: either!(unit, to_mm, to_deg),
                limits: limits(
                    either!(unit, velocity_mm_s, velocity_deg_s),
                    either!(unit, acceleration_mm_s2, acceleration_deg_s2),
                    either!(unit, jerk_mm_s3, jerk_deg_s3),
                )?,
            },
            Self::MoveBy {
                by_mm,
                by_deg,
                velocity_mm_s,
                velocity_deg_s,
                acceleration_mm_s2,
                acceleration_deg_s2,
                jerk_mm_s3,
                jerk_deg_s3,
            } => Step::MoveBy {
                by: either!(unit, by_mm, by_deg),
                limits: limits(
                    either!(unit, velocity_mm_s, velocity_deg_s),
                    either!(unit, acceleration_mm_s2, acceleration_deg_s2),
                    either!(unit, jerk_mm_s3, jerk_deg_s3),
                )?,
            },
            Self::Dwell { duration_s } => Step::Dwell {
                duration: duration_s,
            },
            Self::Sine {
                amplitude_mm,
                amplitude_deg,
                frequency_hz,
                cycles,
            } => Step::Sine(Sine {
                amplitude: either!(unit, amplitude_mm, amplitude_deg),
                frequency: frequency_hz,
                cycles,
            }),
            Self::Chirp {
                amplitude_mm,
                amplitude_deg,
                from_frequency_hz,
                to_frequency_hz,
                duration_s,
                ramp_s,
                sweep,
            } => Step::Chirp(Chirp {
                amplitude: either!(unit, amplitude_mm, amplitude_deg),
                from_frequency: from_frequency_hz,
                to_frequency: to_frequency_hz,
                duration: duration_s,
                ramp: ramp_s.unwrap_or(duration_s / 10.0),
                sweep,
            }),
        })
    }

    /// A step to write in this unit.
    fn write(step: Step, unit: ProgramUnit) -> Self {
        let limits = |limits: Limits| {
            let all = [limits.velocity(), limits.acceleration(), limits.jerk()];
            all.map(|limit| unit.both(limit))
        };
        match step {
            Step::Move { to, limits: of } => {
                let [to_mm, to_deg] = unit.both(to);
                let [velocity, acceleration, jerk] = limits(of);
                Self::Move {
                    to_mm,
                    to_deg,
                    velocity_mm_s: velocity[0],
                    velocity_deg_s: velocity[1],
                    acceleration_mm_s2: acceleration[0],
                    acceleration_deg_s2: acceleration[1],
                    jerk_mm_s3: jerk[0],
                    jerk_deg_s3: jerk[1],
                }
            }
            Step::MoveBy { by, limits: of } => {
                let [by_mm, by_deg] = unit.both(by);
                let [velocity, acceleration, jerk] = limits(of);
                Self::MoveBy {
                    by_mm,
                    by_deg,
                    velocity_mm_s: velocity[0],
                    velocity_deg_s: velocity[1],
                    acceleration_mm_s2: acceleration[0],
                    acceleration_deg_s2: acceleration[1],
                    jerk_mm_s3: jerk[0],
                    jerk_deg_s3: jerk[1],
                }
            }
            Step::Dwell { duration } => Self::Dwell {
                duration_s: duration,
            },
            Step::Sine(sine) => {
                let [amplitude_mm, amplitude_deg] = unit.both(sine.amplitude);
                Self::Sine {
                    amplitude_mm,
                    amplitude_deg,
                    frequency_hz: sine.frequency,
                    cycles: sine.cycles,
                }
            }
            Step::Chirp(chirp) => {
                let [amplitude_mm, amplitude_deg] = unit.both(chirp.amplitude);
                Self::Chirp {
                    amplitude_mm,
                    amplitude_deg,
                    from_frequency_hz: chirp.from_frequency,
                    to_frequency_hz: chirp.to_frequency,
                    duration_s: chirp.duration,
                    ramp_s: Some(chirp.ramp),
                    sweep: chirp.sweep,
                }
            }
        }
    }
}

impl ProgramFile {
    fn read(self) -> Result<Program, String> {
        let unit = match (self.start_mm, self.start_deg) {
            (None, None) => return Err("missing field `start_mm` or `start_deg`".to_string()),
            (None, Some(_)) => ProgramUnit::Degrees,
            (Some(_), _) => ProgramUnit::Millimetres,
        };
        let (start_mm, start_deg) = (self.start_mm, self.start_deg);
        let start = either!(unit, start_mm, start_deg);
        let mut steps = Vec::with_capacity(self.steps.len());
        for (i, raw) in self.steps.into_iter().enumerate() {
            let kind = raw.kind();
            let step = raw.read(unit);
            steps.push(step.map_err(|e| format!("step {} ({kind}): {e}", i + 1))?);
        }
        let program = Program::new(start, steps).map_err(|e| unit.said(&e))?;
        Ok(program.with_unit(unit))
    }

    fn write(program: &Program) -> Self {
        let unit = program.unit();
        let [start_mm, start_deg] = unit.both(program.start());
        let steps = program.steps().iter();
        Self {
            start_mm,
            start_deg,
            steps: steps.map(|&step| StepFile::write(step, unit)).collect(),
        }
    }
}

/// In millimetres: a step alone does not say what its axis is like.
impl Serialize for Step {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StepFile::write(*self, ProgramUnit::Millimetres).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Step {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let file = StepFile::deserialize(deserializer)?;
        let unit = file.unit();
        file.read(unit).map_err(D::Error::custom)
    }
}

impl Serialize for Program {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ProgramFile::write(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Program {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let file = ProgramFile::deserialize(deserializer)?;
        file.read().map_err(D::Error::custom)
    }
}
