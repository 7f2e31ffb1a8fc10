//! Motions to tell explanations apart by.

use axis_sim::Axis;
use axis_sim::effects::{Measure, Scales};
use trajectories::{Chirp, Limits, Program, Sine, Step, Sweep, TrajectoryError};

/// Motions to choose from, inside the stroke and the speeds of the axis.
pub(super) fn motions(axis: &Axis) -> Result<Vec<(&'static str, Program)>, TrajectoryError> {
    let start = axis.stroke.start;
    let room = axis.stroke.maximum - start;
    let scales = Scales::of(axis);
    let [of_speed, of_acceleration] =
        [Measure::Speed, Measure::Acceleration].map(|m| scales.ratio(m));
    // The paper's axis goes at 0.333 m/s at most.
    let most = axis
        .samples
        .map_or(0.333 * of_speed, |ranges| ranges.speed.most);
    let fastest = most.min(0.3 * of_speed);
    let length = scales.motion / 0.2;
    // The same course in time, faster or slower.
    let pace = of_speed / length;
    // As far as the actuator has the force.
    let of_force = (of_acceleration / (of_speed * pace)).min(1.0);
    let to = |share: f64, speed: f64| -> Result<Step, TrajectoryError> {
        Ok(Step::Move {
            to: start + share * room,
            limits: Limits::new(
                speed,
                2.25 * speed * pace * of_force,
                12.0 * speed * pace * pace * of_force,
            )?,
        })
    };
    let rest = |duration| Step::Dwell { duration };
    let chirp = |amplitude| {
        Step::Chirp(Chirp {
            amplitude,
            from_frequency: 2.0,
            to_frequency: 90.0,
            duration: 3.0,
            ramp: 0.1,
            sweep: Sweep::default(),
        })
    };
    let wave = Step::Sine(Sine {
        amplitude: 1e-3 * of_acceleration,
        frequency: 4.0,
        cycles: 10,
    });
    let there_and_back = |share: f64, speed: f64| -> Result<Vec<Step>, TrajectoryError> {
        Ok(vec![
            rest(0.2),
            to(share, speed)?,
            rest(0.2),
            to(0.0, speed)?,
            rest(0.2),
        ])
    };
    let medium = (0.1 * of_speed).min(fastest);
    let small = 3e-5 * of_acceleration;
    let mut all = vec![
        (
            "a small chirp from 2 to 90 Hz",
            vec![rest(0.2), chirp(small), rest(0.2)],
        ),
        ("small waves at 4 Hz", vec![rest(0.2), wave, rest(0.2)]),
        (
            "there and back, slowly",
            there_and_back(0.06, 0.02 * of_speed)?,
        ),
        ("there and back, fast", there_and_back(0.4, fastest)?),
        (
            "over the whole stroke and back",
            there_and_back(0.9, medium)?,
        ),
    ];
    let mut halting = Vec::new();
    for share in [0.15, 0.3, 0.15, 0.0] {
        halting.extend([rest(0.5), to(share, medium)?]);
    }
    all.push(("in steps with pauses of half a second", halting));
    let mut mixed = there_and_back(0.06, 0.03 * of_speed)?;
    mixed.extend(there_and_back(0.3, fastest)?);
    mixed.extend([chirp(small), rest(0.2)]);
    all.push(("slow, fast, and a small chirp", mixed));
    all.into_iter()
        .map(|(what, steps)| {
            let program = Program::new(start, steps)?;
            Ok((what, program.with_unit(axis.unit_of_programs())))
        })
        .collect()
}
