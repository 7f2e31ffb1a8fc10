//! The experiments on a simulated machine, logged as a user would log them.

use axis_log::{Log, LogError};
use axis_sim::balance::ObservedMotion;
use axis_sim::{Axis, ClosedLoop, Cycle, LoopState, Measured, Recorder, Start};
use compensator::NoCompensation;
use lugre::identify::StaticFit;
use trajectories::{Limits, Program, Sine, Step};

use super::found::{Identified, ParameterSource};
use super::from_logs::{curve_of, identify_from_logs};
use super::plan::IdentificationPlan;
use crate::PipelineError;

/// Logs of an experiment, and what they tell.
#[derive(Clone, Debug)]
pub struct Session {
    /// The constant-speed runs and the small motions, with their names.
    pub logs: Vec<(String, Log)>,
    /// What [`identify_from_logs`] makes of them.
    pub found: Identified,
}

/// Way before the record of a run, in pre-sliding distances T_C/σ0: the bristles' past is
/// forgotten to exp(−10), 0.005 %.
const FORGOTTEN: f64 = 10.0;

/// Rounds of experiments: in each, the way before the record is that which the last asks for.
const ROUNDS: usize = 3;

/// Makes the experiments on `machine` and identifies its friction from their logs, knowing
/// of it what `axis` says.
///
/// `sense` makes of what the axis file's sensors read what the drive gets to see (further noise).
/// `each` is called after every motion.
///
/// # Errors
/// [`PipelineError`] if a run diverges or leaves its stroke, or where the logs do not show a
/// parameter that any law needs.
pub fn identify(
    machine: &Axis,
    axis: &Axis,
    plan: &IdentificationPlan,
    mut sense: impl FnMut(&mut Measured),
    each: impl Fn(),
) -> Result<Session, PipelineError> {
    let mut plan = plan.clone();
    let mut round = 1;
    loop {
        let session = session(machine, axis, &plan, &mut sense, &each)?;
        let lever = axis.friction.lever(axis.travel_per_radian());
        let law = &session.found.law;
        let needed = FORGOTTEN * lever * law.coulomb / law.stiffness;
        let is_known = session.found.parameters[4].source == ParameterSource::Logs;
        if !is_known || needed <= plan.settle_distance || round == ROUNDS {
            return Ok(session);
        }
        plan.settle_distance = needed;
        round += 1;
    }
}

fn session(
    machine: &Axis,
    axis: &Axis,
    plan: &IdentificationPlan,
    sense: &mut impl FnMut(&mut Measured),
    each: &impl Fn(),
) -> Result<Session, PipelineError> {
    let mut bench = Bench::new(machine, axis, plan, sense)?;
    for speed in plan.first_speeds() {
        bench.both_ways(speed)?;
        each();
    }
    let first = curve_of(axis, &bench.log()?)?;
    for speed in refined(axis, plan, &first) {
        bench.both_ways(speed)?;
        each();
    }
    let speeds = bench.log()?;
    let statics = curve_of(axis, &speeds)?;
    bench.forget();
    let amplitude = bench.amplitude(&statics)?;
    for &frequency in &plan.frequencies {
        bench.sine(amplitude, frequency)?;
        each();
    }
    let logs = vec![
        ("constant-speed".to_owned(), speeds),
        ("pre-sliding".to_owned(), bench.log()?),
    ];
    let found = identify_from_logs(axis, &logs)?;
    Ok(Session { logs, found })
}

/// Speeds about that at which friction falls, where the first runs show one; the slowest
/// decade again below them where they do not.
fn refined(axis: &Axis, plan: &IdentificationPlan, first: &StaticFit) -> Vec<f64> {
    let lever = axis.friction.lever(axis.travel_per_radian());
    let fall = lever * first.stribeck_speed.value;
    if first.stiction.value > first.coulomb.value {
        let about = plan.about_fall.iter().map(|share| share * fall);
        return about.filter(|&speed| speed < plan.fastest).collect();
    }
    let slowest = plan.fastest / plan.range;
    vec![0.5 * slowest, 0.2 * slowest, 0.1 * slowest]
}

/// A simulated machine under its drive, and the logger beside it.
struct Bench<'a, S> {
    closed_loop: ClosedLoop,
    state: LoopState,
    axis: &'a Axis,
    plan: &'a IdentificationPlan,
    sense: &'a mut S,
    /// Of no cycle yet, and of those of the log that is being made.
    empty: Recorder,
    recorder: Recorder,
    /// Cycles since the log began, and cycles a sample.
    cycles: u64,
    every: u64,
    home: f64,
}

impl<'a, S: FnMut(&mut Measured)> Bench<'a, S> {
    fn new(
        machine: &Axis,
        axis: &'a Axis,
        plan: &'a IdentificationPlan,
        sense: &'a mut S,
    ) -> Result<Self, PipelineError> {
        let closed_loop = ClosedLoop::new(machine)?.with_seed(plan.seed);
        let stroke = &machine.stroke;
        let room = stroke.maximum - stroke.minimum;
        let travel = travel(plan, plan.fastest).min(MOST * room);
        let home = 0.5 * (stroke.minimum + stroke.maximum - travel);
        let state = closed_loop.start(&Start::at(home))?;
        let every = (1.0 / (plan.log_rate * machine.period)).round().max(1.0);
        let empty = Recorder::as_logged(machine, every * machine.period)?;
        Ok(Self {
            recorder: empty.clone(),
            empty,
            closed_loop,
            state,
            axis,
            plan,
            sense,
            cycles: 0,
            every: every as u64,
            home,
        })
    }

    /// Follows a program from where the axis stands.
    fn follow(&mut self, steps: Vec<Step>, what: &str) -> Result<(), PipelineError> {
        let motion = planned(Program::new(self.home, steps))?;
        let period = self.closed_loop.axis().period;
        let (recorder, cycles, every) = (&mut self.recorder, &mut self.cycles, self.every);
        let observe = |cycle: &Cycle| {
            if cycles.is_multiple_of(every) {
                recorder.push(&Cycle {
                    time: *cycles as f64 * period,
                    ..*cycle
                });
            }
            *cycles += 1;
        };
        self.state = self.state.clone().at_rest();
        let outcome = self.closed_loop.run_from(
            &mut self.state,
            &motion,
            &mut NoCompensation,
            &mut *self.sense,
            observe,
        );
        outcome.completed().map_err(|source| PipelineError::Run {
            what: what.to_owned(),
            source,
        })
    }

    /// A run there and one back, with a rest after each.
    fn both_ways(&mut self, speed: f64) -> Result<(), PipelineError> {
        let [acceleration, jerk] = self.plan.ramps;
        let limits = planned(Limits::new(speed, acceleration, jerk))?;
        let stroke = &self.closed_loop.axis().stroke;
        let room = stroke.maximum - stroke.minimum;
        let way = travel(self.plan, speed).min(MOST * room);
        let rest = Step::Dwell { duration: REST };
        let steps = vec![
            Step::MoveBy { by: way, limits },
            rest,
            Step::MoveBy { by: -way, limits },
            rest,
        ];
        let unit = self.axis.freedom().unit();
        self.follow(steps, &format!("constant-speed run at {speed} {unit}/s"))
    }

    /// A sine about home.
    fn sine(&mut self, amplitude: f64, frequency: f64) -> Result<(), PipelineError> {
        let cycles = (2.0 * frequency).ceil().max(3.0) as u32;
        let step = Step::Sine(Sine {
            amplitude,
            frequency,
            cycles,
        });
        self.follow(vec![step], "small motion about a standstill")
    }

    /// Amplitude of a sine that takes friction to about half of its Coulomb level: from the
    /// smallest up, as what it does to friction tells.
    fn amplitude(&mut self, statics: &StaticFit) -> Result<f64, PipelineError> {
        let coulomb = statics.coulomb.value;
        let fastest = self.plan.frequencies.iter().copied().reduce(f64::max);
        let frequency = fastest.unwrap_or(1.0);
        let mut amplitude = self.plan.smallest;
        for _ in 0..TRIALS {
            let from = self.recorder.cycles().len();
            self.sine(amplitude, frequency)?;
            let share = self.swing(from)? / coulomb;
            if (0.35..0.65).contains(&share) {
                break;
            }
            // Twice and a half at most, so that noise that is taken for friction does no harm.
            amplitude *= (0.5 / share).clamp(0.4, 2.5);
        }
        Ok(amplitude)
    }

    /// Half of the way from the least to the greatest friction in the samples from one on.
    fn swing(&self, from: usize) -> Result<f64, PipelineError> {
        let log = self.log()?.skip(from)?;
        let period = self.every as f64 * self.closed_loop.axis().period;
        let shown = ObservedMotion::of(&log, period, self.axis).map_err(|reason| {
            super::IdentifyLogsError::Channels {
                log: "the small motions".to_owned(),
                reason,
            }
        })?;
        let course = shown.friction(self.axis, SLOW.min(0.05 / period));
        // The filter's ends are left out.
        let edge = course.force.len() / 10;
        let inner = &course.force[edge..course.force.len() - edge];
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let [low, high] = inner
            .iter()
            .fold(ends, |[a, b], f| [f64::min(a, *f), f64::max(b, *f)]);
        let lever = self.axis.friction.lever(self.axis.travel_per_radian());
        Ok(0.5 * lever * (high - low))
    }

    fn log(&self) -> Result<Log, LogError> {
        self.recorder.log()
    }

    /// Begins a new log.
    fn forget(&mut self) {
        self.recorder = self.empty.clone();
        self.cycles = 0;
    }
}

/// Rest after each run, s.
const REST: f64 = 0.3;

/// Most of the stroke that a run takes.
const MOST: f64 = 0.98;

/// Trials of an amplitude: 2.5¹⁶ is six decades.
const TRIALS: usize = 16;

/// Cut-off under which friction is looked at in a trial, Hz: ten times the sine's and more.
const SLOW: f64 = 10.0;

/// Way of a run with its ramps: these take speed²/2a each, plus the jerk's share.
fn travel(plan: &IdentificationPlan, speed: f64) -> f64 {
    let settle = plan.settle_time.max(plan.settle_distance / speed);
    speed * (settle + plan.record_time + 0.1) + speed * speed / plan.ramps[0]
}

fn planned<T>(result: Result<T, trajectories::TrajectoryError>) -> Result<T, PipelineError> {
    result.map_err(|source| PipelineError::Trajectory { index: 0, source })
}
