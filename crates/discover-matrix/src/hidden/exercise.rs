//! Motions that logs are taken on.

use axis_sim::effects::{Measure, Scales};
use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use serde::{Deserialize, Serialize};
use trajectories::{Limits, Program, Step, TrajectoryError};

/// Motions that a log may be taken on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Exercise {
    /// A move and the way back.
    ThereAndBack,
    /// That, slow and fast.
    SlowAndFast,
    /// That, and a small chirp.
    WithChirp,
    /// A move, and no way back: too poor to tell many effects from one another.
    OneWay,
}

impl Exercise {
    /// Those that are rich enough for most questions.
    pub const RICH: [Self; 3] = [Self::ThereAndBack, Self::SlowAndFast, Self::WithChirp];

    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::ThereAndBack => "there-and-back",
            Self::SlowAndFast => "slow-and-fast",
            Self::WithChirp => "with-chirp",
            Self::OneWay => "one-way",
        }
    }
}

/// The exercise on this axis; `check` gives one of the same kind that differs
/// in length and speed.
///
/// # Errors
/// [`TrajectoryError`] where it does not fit the axis.
pub fn exercise(axis: &Axis, kind: Exercise, check: bool) -> Result<Program, TrajectoryError> {
    let (mut chirp, mut program) = (1.0, program(axis, kind, check, 1.0)?);
    // A loop that follows the chirp needs a multiple of the force that a slow one does.
    while kind == Exercise::WithChirp && chirp > LEAST_CHIRP && effort(axis, &program) > OF_LIMIT {
        chirp *= 0.5;
        program = self::program(axis, kind, check, chirp)?;
    }
    Ok(program)
}

/// Greatest effort that an exercise asks for, as a share of the actuator's limit: at the limit
/// the least change of a parameter changes when it is left again, and the rest of the log.
const OF_LIMIT: f64 = 0.8;

/// Share of the chirp below which it is left as it is.
const LEAST_CHIRP: f64 = 0.02;

/// Greatest effort on a motion, as a share of the actuator's limit; 0 where the axis does not
/// run, which whoever simulates it is told.
fn effort(axis: &Axis, program: &Program) -> f64 {
    let mut most = 0.0_f64;
    let run = ClosedLoop::new(axis).map(|looped| {
        let mut seen = |cycle: &Cycle| most = most.max(cycle.command.effort.abs());
        looped
            .without_noise()
            .run(program, &mut NoCompensation, &mut seen)
    });
    match run {
        Ok(_) => most / axis.actuator.limit(),
        Err(_) => 0.0,
    }
}

fn program(
    axis: &Axis,
    kind: Exercise,
    check: bool,
    chirp: f64,
) -> Result<Program, TrajectoryError> {
    let start = axis.stroke.start;
    let (length, share) = if check { (0.85, 0.8) } else { (1.0, 1.0) };
    let scales = Scales::of(axis);
    let length = length * scales.motion;
    let of_speed = scales.ratio(Measure::Speed);
    // The same course in time as on the paper's axis, faster or slower.
    let pace = of_speed / (scales.motion / 0.2);
    // As far as the actuator has the force.
    let of_acceleration = (of_speed * pace).min(scales.ratio(Measure::Acceleration));
    let to = |position: f64, speed: f64| -> Result<Step, TrajectoryError> {
        let acceleration = share * 0.225 * (speed / 0.1) * of_acceleration;
        let jerk = 1.2 * of_acceleration * pace;
        Ok(Step::Move {
            to: position,
            limits: Limits::new(share * speed * of_speed, acceleration, jerk)?,
        })
    };
    let rest = Step::Dwell { duration: 0.2 };
    let mut steps = vec![rest, to(start + length, 0.1)?, rest];
    if kind != Exercise::OneWay {
        steps.extend([to(start, 0.1)?, rest]);
    }
    if matches!(kind, Exercise::SlowAndFast | Exercise::WithChirp) {
        steps.extend([
            to(start + 0.2 * length, 0.03)?,
            rest,
            to(start, 0.03)?,
            rest,
        ]);
        steps.extend([to(start + length, 0.25)?, rest, to(start, 0.25)?, rest]);
    }
    if kind == Exercise::WithChirp {
        let amplitude = chirp * if check { 2.5e-5 } else { 3e-5 };
        let sweep = trajectories::Chirp {
            amplitude: amplitude * scales.ratio(Measure::Acceleration),
            from_frequency: 2.0,
            to_frequency: 90.0,
            duration: 2.5,
            ramp: 0.1,
            sweep: trajectories::Sweep::default(),
        };
        steps.extend([Step::Chirp(sweep), rest]);
    }
    Program::new(start, steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At an actuator's limit a log says little of anything else; the paper's axis follows a
    /// chirp so little that it has the whole.
    #[test]
    fn no_exercise_drives_an_actuator_into_its_limit() {
        for (name, whole) in [("liu2025", true), ("joint", true), ("linear-motor", false)] {
            let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/");
            let axis = Axis::read(format!("{root}{name}.toml").as_ref()).unwrap();
            for kind in [
                Exercise::ThereAndBack,
                Exercise::SlowAndFast,
                Exercise::WithChirp,
            ] {
                for check in [false, true] {
                    let made = exercise(&axis, kind, check).unwrap();
                    let share = effort(&axis, &made);
                    assert!(share > 0.0 && share <= OF_LIMIT, "{name} {kind:?}: {share}");
                }
            }
            let all = program(&axis, Exercise::WithChirp, false, 1.0).unwrap();
            let is_whole = exercise(&axis, Exercise::WithChirp, false).unwrap() == all;
            assert_eq!(is_whole, whole, "{name}");
        }
    }
}
