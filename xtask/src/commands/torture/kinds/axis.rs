//! Axis files: of a ball screw and of a rigid mass, damaged and made anew.

use std::cell::Cell;
use std::path::Path;

use axis_log::{Channel, Log};
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity};
use axis_sim::{Axis, ClosedLoop, Cycle, Replay};
use compensator::NoCompensation;
use trajectories::{Motion, Setpoint};

use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::random::Source;
use crate::commands::torture::{grammar, message, mutate};

/// Control cycles that an accepted axis is run for.
const CYCLES: f64 = 10.0;
/// Internal steps beyond which a motion is no work but a hang: some hours.
const ENDLESS: f64 = 1e10;
/// Setpoints that an endless motion gives before it ends.
const ASKED: u32 = 20;
/// Elements of a screw beyond which its loop is not set up for every input.
const MANY_ELEMENTS: u32 = 40;

const RIGID: &str = include_str!("../../../../../data/axes/emps.toml");
const BALL_SCREW: &str = include_str!("../../../../../data/axes/liu2025.toml");

struct AxisFile {
    name: &'static str,
    base: String,
    generated: bool,
}

/// Both kinds of machine, damaged and made anew.
pub fn kinds() -> Vec<Box<dyn Kind>> {
    let kind = |name, base: &str, generated| -> Box<dyn Kind> {
        let base = base.to_owned();
        Box::new(AxisFile {
            name,
            base,
            generated,
        })
    };
    let screw = small_screw();
    vec![
        kind("axis file, damaged", &screw, false),
        kind("axis file, made anew", &screw, true),
        kind("rigid axis file, damaged", RIGID, false),
        kind("rigid axis file, made anew", RIGID, true),
    ]
}

/// The ball screw of the paper with few elements and no other files.
pub fn small_screw() -> String {
    let comment = |line: &str| {
        line.split('#')
            .next()
            .unwrap_or_default()
            .trim_end()
            .to_owned()
    };
    let lines: Vec<String> = BALL_SCREW.lines().map(comment).collect();
    let text = lines.join("\n").replace("elements = 10", "elements = 3");
    text.replace(
        "[experiment]\nmachine = \"liu2025-machine.toml\"\npaper_tables = \"../reference/liu2025\"\n",
        "",
    )
}

impl Kind for AxisFile {
    fn name(&self) -> &'static str {
        self.name
    }

    fn share(&self) -> usize {
        if self.base == RIGID { 1 } else { 2 }
    }

    fn input(&self, random: &mut Source) -> Input {
        let bytes = if self.generated {
            grammar::axis(&self.base, random).into_bytes()
        } else {
            mutate::text(&self.base, random)
        };
        Input {
            file: "axis.toml".to_owned(),
            bytes,
            damaged: false,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        match Axis::read(&desk.join(&input.file)) {
            // A file that is not even text has no lines to name.
            Err(e) => refused(e, input, std::str::from_utf8(&input.bytes).is_ok()),
            Ok(axis) if axis.trajectories.is_empty() => followed(&axis),
            Ok(axis) => run(&axis),
        }
    }
}

/// Plans every trajectory, runs the first for a few cycles, draws a few samples.
fn run(axis: &Axis) -> Verdict {
    let mut motions = Vec::new();
    for spec in &axis.trajectories {
        match axis.plan(spec) {
            Ok(motion) => motions.push(motion),
            Err(e) => return told(e),
        }
    }
    let elements = axis.mechanism.values().optional_count("elements");
    if elements.is_some_and(|n| n > MANY_ELEMENTS) {
        return Verdict::Accepted;
    }
    let closed_loop = match ClosedLoop::new(axis) {
        Ok(closed_loop) => closed_loop,
        Err(e) => return told(e),
    };
    let substeps = (axis.period / axis.simulation.step).clamp(1.0, 1e4);
    let cycles = (2e3 / substeps).clamp(1.0, CYCLES);
    for motion in &motions {
        let steps = motion.duration() / axis.period * substeps;
        let endless = steps.is_nan() || steps > ENDLESS;
        if !(endless || std::ptr::eq(motion, &motions[0])) {
            continue;
        }
        let short = Short::new(motion, cycles * axis.period, endless);
        let mut numbers = true;
        closed_loop.run(&short, &mut NoCompensation, |cycle| {
            numbers &= finite(cycle)
        });
        if endless && short.asked.get() > ASKED {
            return fault(format!(
                "accepted, and {steps:.0e} internal steps are begun"
            ));
        }
        if !numbers {
            return fault("a cycle that is not a number is shown");
        }
    }
    samples(axis)
}

/// The first few samples, as `sample` draws them.
fn samples(axis: &Axis) -> Verdict {
    let plan = SamplePlan {
        count: 3,
        seed: 1,
        density: SpeedDensity::NearZero { scale: 3e-3 },
    };
    match Sampler::new(axis, &plan).and_then(|sampler| sampler.all()) {
        Err(e) => told(e),
        Ok(set) if set.increments.iter().all(|x| x.is_finite()) => Verdict::Accepted,
        Ok(_) => fault("a sample is not a number"),
    }
}

/// Lets the machine follow a log of six samples.
fn followed(axis: &Axis) -> Verdict {
    let time: Vec<f64> = (0..6).map(|k| f64::from(k) * 1e-3).collect();
    let place: Vec<f64> = time.iter().map(|t| t * t).collect();
    let channel = |name: &str, samples: &[f64]| Channel::new(name, samples.to_vec());
    let log = [
        ("t_s", &time),
        ("position_ref_m", &place),
        ("position_m", &place),
    ];
    let channels: Result<Vec<Channel>, _> = log.iter().map(|(n, s)| channel(n, s)).collect();
    let Ok(log) = channels.and_then(Log::new) else {
        return fault("six samples make no log");
    };
    let replay = match Replay::new(&log, 1e-3) {
        Ok(replay) => replay,
        Err(e) => return told(e),
    };
    match replay.run(axis, &[], None) {
        Err(e) => told(e),
        Ok(trace) => {
            let mut numbers = trace.channels.iter().flat_map(|(_, samples)| samples);
            match numbers.all(|x| x.is_finite()) {
                true => Verdict::Accepted,
                false => fault("a replay that is not a number is shown"),
            }
        }
    }
}

/// What an axis that was read cannot do is refused when it is asked for, in words too.
fn told(error: impl std::error::Error + Send + Sync + 'static) -> Verdict {
    match message::judge(&miette::Report::from_err(error), "", false) {
        Ok(()) => Verdict::Refused,
        Err(wrong) => fault(wrong),
    }
}

/// The start of a motion; of an endless one, all of it, with an end where it is not
/// refused at once.
struct Short<'a, M> {
    motion: &'a M,
    duration: f64,
    endless: bool,
    /// How many setpoints were asked for.
    asked: Cell<u32>,
}

impl<'a, M: Motion> Short<'a, M> {
    fn new(motion: &'a M, least: f64, endless: bool) -> Self {
        let whole = motion.duration();
        Self {
            motion,
            duration: if endless { whole } else { whole.min(least) },
            endless,
            asked: Cell::new(0),
        }
    }
}

impl<M: Motion> Motion for Short<'_, M> {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn at(&self, t: f64) -> Setpoint {
        self.asked.set(self.asked.get().saturating_add(1));
        if self.endless && self.asked.get() > ASKED {
            // No loop goes on with this.
            return Setpoint::at_rest(f64::NAN);
        }
        self.motion.at(t)
    }
}

fn finite(cycle: &Cycle) -> bool {
    let measured = cycle.measured.position + cycle.measured.motor_angle + cycle.current.q;
    (cycle.position + cycle.motor_speed + cycle.command.voltage.q + measured).is_finite()
}
