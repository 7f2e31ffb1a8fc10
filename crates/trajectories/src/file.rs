//! How programs stand in files: millimetres, with the unit in each key.

use alloc::vec::Vec;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Chirp, Limits, Program, Sine, Step, Sweep, TrajectoryError};

/// A [`Program`] as written.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ProgramFile {
    start_mm: f64,
    // Read in raw form, so that what is wrong with a step is told with the step's number.
    steps: Vec<StepFile>,
}

/// A [`Step`] as written.
#[derive(Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum StepFile {
    Move {
        to_mm: f64,
        velocity_mm_s: f64,
        acceleration_mm_s2: f64,
        jerk_mm_s3: f64,
    },
    MoveBy {
        by_mm: f64,
        velocity_mm_s: f64,
        acceleration_mm_s2: f64,
        jerk_mm_s3: f64,
    },
    Dwell {
        duration_s: f64,
    },
    Sine {
        amplitude_mm: f64,
        frequency_hz: f64,
        cycles: u32,
    },
    Chirp {
        amplitude_mm: f64,
        from_frequency_hz: f64,
        to_frequency_hz: f64,
        duration_s: f64,
        ramp_s: Option<f64>,
        #[serde(default)]
        sweep: Sweep,
    },
}

/// Division, because 1000 is exact and 0.001 is not: 900 mm becomes the f64 nearest to 0.9 m.
fn metres(mm: f64) -> f64 {
    mm / 1000.0
}

/// The millimetres that read back as `m`, where such a number exists.
fn millimetres(m: f64) -> f64 {
    let near = m * 1000.0;
    [near, near.next_down(), near.next_up()]
        .into_iter()
        .find(|&mm| metres(mm) == m)
        .unwrap_or(near)
}

fn limits(velocity: f64, acceleration: f64, jerk: f64) -> Result<Limits, TrajectoryError> {
    Limits::new(metres(velocity), metres(acceleration), metres(jerk))
}

impl TryFrom<StepFile> for Step {
    type Error = TrajectoryError;

    fn try_from(file: StepFile) -> Result<Self, TrajectoryError> {
        Ok(match file {
            StepFile::Move {
                to_mm,
                velocity_mm_s,
                acceleration_mm_s2,
                jerk_mm_s3,
            } => Self::Move {
                to: metres(to_mm),
                limits: limits(velocity_mm_s, acceleration_mm_s2, jerk_mm_s3)?,
            },
            StepFile::MoveBy {
                by_mm,
                velocity_mm_s,
                acceleration_mm_s2,
                jerk_mm_s3,
            } => Self::MoveBy {
                by: metres(by_mm),
                limits: limits(velocity_mm_s, acceleration_mm_s2, jerk_mm_s3)?,
            },
            StepFile::Dwell { duration_s } => Self::Dwell {
                duration: duration_s,
            },
            StepFile::Sine {
                amplitude_mm,
                frequency_hz,
                cycles,
            } => Self::Sine(Sine {
                amplitude: metres(amplitude_mm),
                frequency: frequency_hz,
                cycles,
            }),
            StepFile::Chirp {
                amplitude_mm,
                from_frequency_hz,
                to_frequency_hz,
                duration_s,
                ramp_s,
                sweep,
            } => Self::Chirp(Chirp {
                amplitude: metres(amplitude_mm),
                from_frequency: from_frequency_hz,
                to_frequency: to_frequency_hz,
                duration: duration_s,
                ramp: ramp_s.unwrap_or(duration_s / 10.0),
                sweep,
            }),
        })
    }
}

impl From<Step> for StepFile {
    fn from(step: Step) -> Self {
        match step {
            Step::Move { to, limits } => Self::Move {
                to_mm: millimetres(to),
                velocity_mm_s: millimetres(limits.velocity()),
                acceleration_mm_s2: millimetres(limits.acceleration()),
                jerk_mm_s3: millimetres(limits.jerk()),
            },
            Step::MoveBy { by, limits } => Self::MoveBy {
                by_mm: millimetres(by),
                velocity_mm_s: millimetres(limits.velocity()),
                acceleration_mm_s2: millimetres(limits.acceleration()),
                jerk_mm_s3: millimetres(limits.jerk()),
            },
            Step::Dwell { duration } => Self::Dwell {
                duration_s: duration,
            },
            Step::Sine(sine) => Self::Sine {
                amplitude_mm: millimetres(sine.amplitude),
                frequency_hz: sine.frequency,
                cycles: sine.cycles,
            },
            Step::Chirp(chirp) => Self::Chirp {
                amplitude_mm: millimetres(chirp.amplitude),
                from_frequency_hz: chirp.from_frequency,
                to_frequency_hz: chirp.to_frequency,
                duration_s: chirp.duration,
                ramp_s: Some(chirp.ramp),
                sweep: chirp.sweep,
            },
        }
    }
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
}

impl TryFrom<ProgramFile> for Program {
    type Error = TrajectoryError;

    fn try_from(file: ProgramFile) -> Result<Self, TrajectoryError> {
        let mut steps = Vec::with_capacity(file.steps.len());
        for (i, raw) in file.steps.into_iter().enumerate() {
            let kind = raw.kind();
            let step = Step::try_from(raw).map_err(|source| TrajectoryError::Step {
                number: i + 1,
                kind,
                source: source.into(),
            })?;
            steps.push(step);
        }
        Self::new(metres(file.start_mm), steps)
    }
}

impl From<Program> for ProgramFile {
    fn from(program: Program) -> Self {
        Self {
            start_mm: millimetres(program.start()),
            steps: program.steps().iter().copied().map(Into::into).collect(),
        }
    }
}

impl Serialize for Step {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StepFile::from(*self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Step {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::try_from(StepFile::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

impl Serialize for Program {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ProgramFile::from(self.clone()).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Program {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::try_from(ProgramFile::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}
