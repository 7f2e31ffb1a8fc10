//! Axis files: of a ball screw and of a rigid mass, damaged and made anew.

use std::path::Path;

use axis_log::{Channel, Log};
use axis_sim::effects::Machine;
use axis_sim::{Axis, ClosedLoop, Cycle, Replay, RigidAxis};
use compensator::NoCompensation;
use pipeline::sampling::{SamplePlan, Sampler, SpeedDensity};
use trajectories::{Motion, Setpoint};

use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::random::Source;
use crate::commands::torture::{grammar, mutate};

/// Control cycles that an accepted axis is run for.
const CYCLES: f64 = 10.0;
/// Cycles beyond which a motion is no work but a hang: three hours at 10 kHz.
const ENDLESS: f64 = 1e8;
/// Elements of a screw beyond which its loop is not set up for every input.
const MANY_ELEMENTS: usize = 40;

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
        match Machine::read(&desk.join(&input.file)) {
            // A file that is not even text has no lines to name.
            Err(e) => refused(e, input, std::str::from_utf8(&input.bytes).is_ok()),
            Ok(Machine::BallScrew(axis)) => ball_screw(&axis),
            Ok(Machine::Rigid(axis)) => rigid(&axis),
        }
    }
}

/// Plans every trajectory, runs the first for a few cycles, draws a few samples.
fn ball_screw(axis: &Axis) -> Verdict {
    let mut first = None;
    for (i, spec) in axis.trajectories.iter().enumerate() {
        let motion = match axis.plan(spec) {
            Ok(motion) => motion,
            Err(e) => {
                return fault(format!(
                    "accepted, then trajectory {} has no plan: {e}",
                    i + 1
                ));
            }
        };
        let cycles = motion.duration() / axis.period;
        if cycles.is_nan() || cycles > ENDLESS {
            return fault(format!(
                "accepted, with a trajectory of more than {ENDLESS:.0e} cycles"
            ));
        }
        first.get_or_insert(motion);
    }
    if axis.drive.parameters().elements > MANY_ELEMENTS {
        return Verdict::Accepted;
    }
    let closed_loop = match ClosedLoop::new(axis) {
        Ok(closed_loop) => closed_loop,
        Err(e) => return fault(format!("accepted, then the loop cannot be set up: {e}")),
    };
    let mut numbers = true;
    if let Some(motion) = first {
        let substeps = (axis.period / axis.simulation.step).clamp(1.0, 1e4);
        let cycles = (2e3 / substeps).clamp(1.0, CYCLES);
        let short = Short(&motion, cycles * axis.period);
        closed_loop.run(&short, &mut NoCompensation, |cycle| {
            numbers &= finite(cycle)
        });
    }
    if !numbers {
        return fault("a cycle that is not a number is shown");
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
    match Sampler::new(axis, &plan) {
        Err(e) => fault(format!("accepted, then samples cannot be drawn: {e}")),
        Ok(sampler) if sampler.all().increments.iter().all(|x| x.is_finite()) => Verdict::Accepted,
        Ok(_) => fault("a sample is not a number"),
    }
}

/// Lets the machine follow a log of six samples.
fn rigid(axis: &RigidAxis) -> Verdict {
    let time: Vec<f64> = (0..6).map(|k| f64::from(k) * 1e-3).collect();
    let place: Vec<f64> = time.iter().map(|t| t * t).collect();
    let channel = |name: &str, samples: &[f64]| Channel::new(name, samples.to_vec());
    let log = [
        ("t_s", &time),
        ("position_ref_m", &place),
        ("position_m", &place),
    ];
    let channels: Result<Vec<Channel>, _> = log.iter().map(|(n, s)| channel(n, s)).collect();
    let replay = channels
        .and_then(Log::new)
        .and_then(|log| Replay::new(&log, 1e-3));
    let Ok(replay) = replay else {
        return fault("six samples make no log");
    };
    let cycles = 5e-3 / axis.period;
    if cycles > 1e6 {
        return fault(format!("accepted, with {cycles:.0e} cycles in 5 ms"));
    }
    // That a loop does not hold is told when it is run.
    let _ = replay.run(&Machine::Rigid(Box::new(axis.clone())), &[], None);
    Verdict::Accepted
}

/// The start of a motion.
struct Short<M>(M, f64);

impl<M: Motion> Motion for Short<M> {
    fn duration(&self) -> f64 {
        self.1.min(self.0.duration())
    }

    fn at(&self, t: f64) -> Setpoint {
        self.0.at(t)
    }
}

fn finite(cycle: &Cycle) -> bool {
    let measured = cycle.measured.position + cycle.measured.motor_angle + cycle.current.q;
    (cycle.position + cycle.motor_speed + cycle.command.voltage.q + measured).is_finite()
}
