//! The closed loop over a motion.

use crate::drive::{Command, Drive, Reading};
use crate::error::IndependentError;
use crate::hidden::Hidden;
use crate::machine::Machine;
use crate::motion::{Motion, Setpoint};
use crate::parameters::Parameters;
use crate::random::Random;

/// Steps of the machine in a control period.
const STEPS: u32 = 10;
/// Time before the log in which a constant load settles, s.
const BEFORE: f64 = 1.5;

/// Standard deviations of what the drive's own sensors add, white, every control period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopNoise {
    /// m.
    pub position: f64,
    /// rad.
    pub angle: f64,
    /// rad/s.
    pub speed: f64,
    /// Of each current, A.
    pub current: f64,
}

impl LoopNoise {
    /// Of a good linear scale, encoder and current sensor.
    pub const GOOD: Self = Self {
        position: 10e-9,
        angle: 2e-6,
        speed: 0.01,
        current: 5e-3,
    };

    fn on(&self, mut seen: Reading, random: &mut Random) -> Reading {
        seen.position += self.position * random.normal();
        seen.angle += self.angle * random.normal();
        seen.speed += self.speed * random.normal();
        for i in &mut seen.current {
            *i += self.current * random.normal();
        }
        seen
    }
}

/// A control period: what was wanted, read and commanded.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// Reference.
    pub wanted: Setpoint,
    /// As the drive read it.
    pub seen: Reading,
    /// What it asked for.
    pub command: Command,
}

/// Runs a motion; every control period is shown to `each`.
///
/// # Errors
/// [`IndependentError::NotConverged`], [`IndependentError::OffScrew`].
pub fn run(
    (p, hidden): (&Parameters, &Hidden),
    motion: &Motion,
    noise: (&LoopNoise, &mut Random),
    each: impl FnMut(&Sample),
) -> Result<(), IndependentError> {
    run_pushed((p, hidden), motion, noise, |_| Push::default(), each)
}

/// What comes into the loop from outside in a control period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push {
    /// Added to what the speed controller asks for: to the q current's reference, A, or to a torque, N·m.
    pub current: f64,
    /// Force on the table in positive direction, N.
    pub force: f64,
    /// Added to the position that the position controller reads, m.
    pub position: f64,
}

/// [`run`] with what comes in from outside at each time, s.
///
/// # Errors
/// As [`run`].
pub fn run_pushed(
    (p, hidden): (&Parameters, &Hidden),
    motion: &Motion,
    (noise, random): (&LoopNoise, &mut Random),
    push: impl Fn(f64) -> Push,
    mut each: impl FnMut(&Sample),
) -> Result<(), IndependentError> {
    let periods = |time: f64| (time / p.period + 1e-6).floor() as i64;
    let before = match hidden.friction.load_held && hidden.friction.load != 0.0 {
        true => periods(BEFORE),
        false => 0,
    };
    let mut drive = Drive::new(p, hidden.delay_cycles);
    let begin = -(before as f64) * p.period;
    let step = p.period / f64::from(STEPS);
    let mut machine = Machine::new(p, hidden.clone(), motion.start(), begin, step);
    for k in -before..=periods(motion.duration()) {
        let time = k as f64 * p.period;
        let wanted = motion.at(time);
        let seen = noise.on(machine.seen(), random);
        let from_outside = push(time);
        let reference = [wanted.position, wanted.velocity];
        let read = Reading {
            position: seen.position + from_outside.position,
            ..seen
        };
        let command = drive.step_pushed(reference, &read, from_outside.current);
        if k >= 0 {
            each(&Sample {
                time,
                wanted,
                seen,
                command,
            });
        }
        for i in 0..STEPS {
            // In the middle of the step, as its forces are.
            machine.push(push(time + (f64::from(i) + 0.5) * step).force);
            machine.step(command.voltage)?;
        }
    }
    Ok(())
}
