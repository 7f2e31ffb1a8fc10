//! Friction identification on the simulated machine, as the paper does it on
//! its machine: constant-speed runs, then a pre-sliding test (Section 3.2).

use axis_sim::effects::{Measure, Scales};
use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use lugre::identify::{
    ConstantSpeedRun, FrictionIdentifyError, MeasuredMotion as Measured, PreslidingFit,
    PreslidingRecord, StaticFit, identify_coulomb, identify_presliding, identify_static,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use trajectories::{Limits, Motion, Program, SCurve, Sine, Step};

use crate::PipelineError;

/// The experiments.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentificationPlan {
    /// Table speeds of the constant-speed runs, m/s; each is run both ways.
    pub speeds: Vec<f64>,
    /// Time recorded at constant speed, s.
    pub record_time: f64,
    /// Noise on the measured torque, as a share of its value (one standard
    /// deviation, white, a sample each control cycle).
    pub torque_noise: f64,
    /// Amplitude of the pre-sliding test, m of table travel.
    pub presliding_amplitude: f64,
    /// Frequencies of the pre-sliding test, Hz; well below the axis' own, where
    /// the inertia's share of the torque is known best.
    pub presliding_frequencies: Vec<f64>,
    /// Way after which the bristles have forgotten their past, m or rad.
    pub settle_distance: f64,
    /// Acceleration and jerk of the constant-speed runs' ramps, m/s², m/s³ or rad.
    pub ramps: [f64; 2],
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for IdentificationPlan {
    /// 21 speeds from 0.2 to 300 mm/s, one second each, 1 % torque noise.
    fn default() -> Self {
        let speeds = [
            0.2, 0.4, 0.7, 1.0, 1.4, 1.8, 2.2, 2.6, 4.0, 5.0, 6.0, 8.0, 9.0, 10.0, 12.0, 15.0,
            20.0, 40.0, 80.0, 150.0, 300.0,
        ];
        Self {
            speeds: speeds.map(|mm| 1e-3 * mm).to_vec(),
            record_time: 1.0,
            torque_noise: 0.01,
            presliding_amplitude: 20e-6,
            presliding_frequencies: vec![0.5, 1.0, 2.0],
            settle_distance: SETTLE_DISTANCE,
            ramps: [2.0, 50.0],
            seed: 0,
        }
    }
}

/// Speed from which the default's are above the Stribeck effect, m/s.
const FAST: f64 = 0.02;

/// Stribeck speed of the paper's axis at its table, m/s.
const PAPER_STRIBECK: f64 = 4.3191e-3;

/// Pre-sliding distance T_C/σ0 of the paper's axis at its table, m.
const PAPER_PRESLIDING: f64 = 7.094e-5;

impl IdentificationPlan {
    /// The default experiments, in proportion to an axis: speeds to its own and to its
    /// stroke, ways to the pre-sliding distance of its friction. On the paper's axis,
    /// those of the default.
    pub fn of(axis: &Axis) -> Self {
        let scales = Scales::of(axis);
        let near_one = |ratio: f64| {
            if (ratio - 1.0).abs() < 0.01 {
                1.0
            } else {
                ratio
            }
        };
        let lever = axis.friction.lever(axis.travel_per_radian());
        let (own, unit) = (
            axis.friction.law.parameters(),
            axis.friction.unit.parameters(),
        );
        // A run there takes a third of the stroke at most.
        let reach = 2.5 * scales.motion / 0.2;
        let of_speed = scales.ratio(Measure::Speed).min(reach);
        // Slow speeds lie about the Stribeck speed, where there is one.
        let of_slow = match own.stiction > own.coulomb {
            true => near_one(lever * own.stribeck_speed / PAPER_STRIBECK).min(of_speed),
            false => of_speed,
        };
        let scaled = |&speed: &f64| speed * if speed < FAST { of_slow } else { of_speed };
        let of_way = near_one(lever / unit.stiffness / PAPER_PRESLIDING);
        let pace = of_speed / (scales.motion / 0.2);
        // Ramps that the actuator has the force for.
        let of_ramp = (of_speed * pace).min(scales.ratio(Measure::Acceleration));
        let plan = Self::default();
        Self {
            speeds: plan.speeds.iter().map(scaled).collect(),
            presliding_amplitude: of_way * plan.presliding_amplitude,
            settle_distance: of_way * plan.settle_distance,
            ramps: [plan.ramps[0] * of_ramp, plan.ramps[1] * of_ramp * pace],
            ..plan
        }
    }
}

/// What the experiments found.
#[derive(Clone, Debug)]
pub struct Identified {
    /// Every constant-speed run.
    pub runs: Vec<ConstantSpeedRun>,
    /// Static parameters.
    pub statics: StaticFit,
    /// Bristle parameters.
    pub presliding: PreslidingFit,
    /// All six parameters.
    pub parameters: lugre::Parameters,
}

/// Runs the experiments on the axis and identifies its friction.
///
/// Nothing but what a drive logs is used: motor current and speed, and table
/// position. The torque noise is drawn from the plan's seed.
///
/// # Errors
/// [`PipelineError`] where a run diverges or leaves its stroke, or where the
/// records do not show a parameter.
pub fn identify(
    axis: &Axis,
    plan: &IdentificationPlan,
    each: impl Fn() + Sync,
) -> Result<Identified, PipelineError> {
    let closed_loop = ClosedLoop::new(axis)?;
    let both_ways: Vec<f64> = plan.speeds.iter().flat_map(|&v| [v, -v]).collect();
    let runs: Result<Vec<ConstantSpeedRun>, PipelineError> = both_ways
        .par_iter()
        .enumerate()
        .map(|(index, &speed)| {
            let run = constant_speed_run(&closed_loop, plan, speed, index as u64);
            each();
            run
        })
        .collect();
    let runs = runs?;
    let statics = statics(axis, &runs)?;
    let presliding = presliding_test(&closed_loop, plan, &statics)?;
    each();
    let parameters = statics
        .parameters()
        .with_bristles(presliding.stiffness.value, presliding.damping.value);
    Ok(Identified {
        runs,
        statics,
        presliding,
        parameters,
    })
}

/// The steady-state curve; without a fall with speed where the axis file's own friction has
/// none, or the runs show none.
fn statics(axis: &Axis, runs: &[ConstantSpeedRun]) -> Result<StaticFit, PipelineError> {
    let own = axis.friction.law.parameters();
    if own.stiction == own.coulomb {
        return Ok(identify_coulomb(runs)?);
    }
    match identify_static(runs) {
        Err(FrictionIdentifyError::NoStribeckEffect { .. }) => Ok(identify_coulomb(runs)?),
        fit => Ok(fit?),
    }
}

/// Bristles forget their past within some pre-sliding distances of sliding, the
/// drive's controllers within some tenths of a second: wait for both. The distance is
/// 1.5 mm on the paper's axis.
const SETTLE_DISTANCE: f64 = 1.5e-3;
const SETTLE_TIME: f64 = 0.6;

fn constant_speed_run(
    closed_loop: &ClosedLoop,
    plan: &IdentificationPlan,
    speed: f64,
    stream: u64,
) -> Result<ConstantSpeedRun, PipelineError> {
    let axis = closed_loop.axis();
    let stroke = &axis.stroke;
    let settle = SETTLE_TIME.max(plan.settle_distance / speed.abs());
    let [acceleration, jerk] = plan.ramps;
    let limits = limits(speed.abs(), acceleration, jerk)?;
    // Ramps take speed²/2a each, plus the jerk's share; a tenth of a second more is enough.
    let wanted = speed.abs() * (settle + plan.record_time + 0.1) + speed * speed / acceleration;
    // Start where the run has the room that it needs.
    let room = stroke.maximum - stroke.minimum;
    let travel = wanted.min(0.98 * room);
    let middle = 0.5 * (stroke.minimum + stroke.maximum);
    let from = middle - 0.5 * travel.copysign(speed);
    let motion = planned(SCurve::plan(from, from + travel.copysign(speed), &limits))?;
    let (begin, end) = motion.cruise().unwrap_or((0.0, motion.duration()));
    let from_time = (begin + settle).max(end - plan.record_time);

    let to_friction = ToFriction::of(axis);
    let mut positions = Vec::new();
    let mut torques = Vec::new();
    follow(
        closed_loop,
        &motion,
        &format!("constant-speed run at {speed} m/s"),
        |cycle| {
            if (from_time..end).contains(&cycle.time) {
                positions.push(cycle.position);
                let load = axis.load_at(cycle.position);
                torques.push(axis.torque_shown(cycle) - axis.travel_per_radian() * load);
            }
        },
    )?;
    add_noise(&mut torques, plan, stream);
    let speeds: Vec<f64> = positions
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / axis.period / to_friction.lever)
        .collect();
    torques.pop();
    torques
        .iter_mut()
        .for_each(|t| *t *= to_friction.per_torque);
    Ok(ConstantSpeedRun::from_record(
        &speeds,
        &torques,
        1.0 / axis.period,
    )?)
}

/// Small sines about a standstill. The friction torque is the motor's less
/// what the axis' inertia takes; motor, sensor and screw are not taken for
/// rigid, since at 10 Hz their wind-up would be worth 0.7 % of σ1.
fn presliding_test(
    closed_loop: &ClosedLoop,
    plan: &IdentificationPlan,
    statics: &StaticFit,
) -> Result<PreslidingFit, PipelineError> {
    let axis = closed_loop.axis();
    let mut steps = Vec::new();
    for &frequency in &plan.presliding_frequencies {
        let cycles = (2.0 * frequency).ceil().max(3.0);
        steps.push(Step::Sine(Sine {
            amplitude: plan.presliding_amplitude,
            frequency,
            cycles: cycles as u32,
        }));
    }
    let middle = 0.5 * (axis.stroke.minimum + axis.stroke.maximum);
    let motion = planned(Program::new(middle, steps))?;

    let (mut positions, mut speeds, mut torques) = (Vec::new(), Vec::new(), Vec::new());
    follow(closed_loop, &motion, "pre-sliding test", |cycle| {
        positions.push(cycle.position);
        speeds.push(cycle.motor_speed);
        let load = axis.load_at(cycle.position);
        torques.push(axis.torque_shown(cycle) - axis.travel_per_radian() * load);
    })?;
    add_noise(&mut torques, plan, u64::MAX);

    let to_friction = ToFriction::of(axis);
    let inertia = Inertia::of(axis, middle);
    let (mut speed, mut friction) = (Vec::new(), Vec::new());
    // A log of 1 kHz is what a drive gives; derivatives see every cycle.
    const EVERY: usize = 10;
    for k in (2..positions.len() - 2).step_by(EVERY) {
        let motor = slope(&speeds[k - 2..=k + 2], axis.period);
        let table = curvature(&positions[k - 2..=k + 2], axis.period);
        speed.push(slope(&positions[k - 2..=k + 2], axis.period) / to_friction.lever);
        friction.push(to_friction.per_torque * (torques[k] - inertia.torque(motor, table)));
    }
    let record = PreslidingRecord {
        time_step: EVERY as f64 * axis.period,
        motion: Measured::Speed(&speed),
        torque: &friction,
    };
    Ok(identify_presliding(statics, &record)?)
}

/// What acceleration takes of the motor torque, seen through the wind-up of
/// the drive: every rotating part is turned back from the motor by its share
/// of the static wind-up between motor and load.
struct Inertia {
    /// Inertias (kg·m²) and shares of the wind-up.
    parts: Vec<[f64; 2]>,
    /// Inertia of the load, kg or kg·m².
    load: f64,
    /// m/rad or rad/rad.
    travel_per_radian: f64,
}

impl Inertia {
    /// For the load near `x`.
    fn of(axis: &Axis, x: f64) -> Self {
        Self {
            parts: axis.mechanism.rotating(x),
            load: axis.mechanism.load_inertia(),
            travel_per_radian: axis.travel_per_radian(),
        }
    }

    /// Torque at the motor for the motor's (rad/s²) and the load's acceleration.
    fn torque(&self, motor: f64, load: f64) -> f64 {
        let lag = motor - load / self.travel_per_radian;
        let parts = self
            .parts
            .iter()
            .map(|[j, share]| j * (motor - share * lag));
        parts.sum::<f64>() + self.travel_per_radian * self.load * load
    }
}

/// From motor torques to friction in its law's coordinate.
struct ToFriction {
    /// Load travel per unit of the law's coordinate.
    lever: f64,
    /// Friction of the law per motor torque.
    per_torque: f64,
}

impl ToFriction {
    fn of(axis: &Axis) -> Self {
        let r = axis.travel_per_radian();
        let lever = axis.friction.lever(r);
        Self {
            lever,
            per_torque: lever / r,
        }
    }
}

/// First derivative at the middle of five equally spaced values, fourth order.
fn slope(v: &[f64], step: f64) -> f64 {
    (8.0 * (v[3] - v[1]) - (v[4] - v[0])) / (12.0 * step)
}

/// Second derivative at the middle of five equally spaced values, fourth order.
fn curvature(v: &[f64], step: f64) -> f64 {
    let (near, far) = (v[1] + v[3] - 2.0 * v[2], v[0] + v[4] - 2.0 * v[2]);
    (16.0 * near - far) / (12.0 * step * step)
}

fn follow(
    closed_loop: &ClosedLoop,
    motion: &impl Motion,
    what: &str,
    observe: impl FnMut(&Cycle),
) -> Result<(), PipelineError> {
    let outcome = closed_loop.run(motion, &mut NoCompensation, observe);
    outcome.completed().map_err(|source| PipelineError::Run {
        what: what.to_owned(),
        source,
    })
}

fn add_noise(torques: &mut [f64], plan: &IdentificationPlan, stream: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(plan.seed);
    rng.set_stream(stream);
    for torque in torques {
        let normal: f64 = StandardNormal.sample(&mut rng);
        *torque *= 1.0 + plan.torque_noise * normal;
    }
}

fn limits(speed: f64, acceleration: f64, jerk: f64) -> Result<Limits, PipelineError> {
    planned(Limits::new(speed, acceleration, jerk))
}

fn planned<T>(result: Result<T, trajectories::TrajectoryError>) -> Result<T, PipelineError> {
    result.map_err(|source| PipelineError::Trajectory { index: 0, source })
}
