//! The motor torque that a model needs for a motion.

use lugre::LuGre;

use super::filter::derivative;
use super::motion::Course;
use super::wind_up::{WindUp, behind_a_spring, lag_of_load, lead_of_motor};
use crate::axis::Axis;
use crate::effects::{Hooks, ScrewState, TableState, TableStep};
use crate::plant::Start;

/// The motions of load and motor.
#[derive(Clone, Debug)]
pub(super) struct Motions {
    pub load: Course,
    pub motor: Course,
    /// Whether the load's is the motor's times the travel per radian, and nothing else.
    pub load_is_derived: bool,
    /// Whether the motor's is what its own encoder shows.
    pub motor_is_measured: bool,
    /// Whether that encoder was set to the load's position where the log begins; an angle of its own holds the wind-up.
    pub motor_was_homed: bool,
    /// Where one of the two was measured: what sets the other apart.
    pub wind_up: Option<WindUp>,
}

impl Motions {
    /// Those of motor and load without the reading error of the motor's encoder; `None` if nothing shows
    /// one.
    fn without_encoder_error(&self, hooks: &Hooks, r: f64, h: f64) -> Option<Self> {
        if !self.motor_is_measured || hooks.sensors.eccentricities.is_empty() {
            return None;
        }
        let shown = self.motor.position.iter();
        let error: Vec<f64> = shown.map(|a| hooks.sensors.eccentricity(*a)).collect();
        let speed = derivative(&error, h);
        let error = Course {
            acceleration: derivative(&speed, h),
            speed,
            position: error,
        };
        Some(Self {
            load: match self.load_is_derived {
                true => self.load.plus(-r, &error),
                false => self.load.clone(),
            },
            motor: self.motor.plus(-1.0, &error),
            ..self.clone()
        })
    }

    /// Stiffness between the motion that was measured and a load that was not, N/m or N·m/rad.
    pub fn spring(&self, axis: &Axis) -> Option<f64> {
        let wind_up = self.wind_up.filter(|_| self.load_is_derived)?;
        Some(wind_up.of(axis)[0])
    }
}

/// Share of the greatest speed of a log below which its load stands where the log begins.
const STANDS: f64 = 1e-3;

/// Rounds in which a torque is found of which the ripple depends on itself.
const ROUNDS: usize = 30;

/// Motor torque, N·m, that `axis` (its effects made) needs at each sample.
///
/// ```text
/// T + T_hooks(θ, T) = Σ J_i ((1 − s_i) α + s_i (a − ö) / r) + r (m a + F) + do/dθ (m r α + F),   F = F_friction(v, z) + F_loads(x, v, t)
/// ```
///
/// with an error o of the transmission's kinematics, which the load has beside the screw, and its acceleration
/// ö. What reacts on the motor by do/dθ counts with the motor's acceleration for the load's: what the error
/// itself adds to that is of second order, and lies where the low-pass has taken it out of the motion.
pub(super) fn torque(axis: &Axis, hooks: &Hooks, ends: &Ends, h: f64) -> Vec<f64> {
    let Ends {
        load,
        motor,
        forces,
    } = ends;
    let r = axis.travel_per_radian();
    let mass = axis.mechanism.load_inertia();
    let lagging = lagging(axis, load);
    let inertia = axis.mechanism.total_inertia() - mass * r * r - lagging;
    let offset = offset_acceleration(hooks, ends, h);
    let growth = |k: usize| match &offset {
        Some(_) => hooks.offset_at(&screw_state(load, motor, k, h))[2],
        None => 0.0,
    };
    let one = |(k, force): (usize, f64)| {
        let [of_load, of_motor] = [load.acceleration[k], motor.acceleration[k]];
        let of_screw = of_load - offset.as_ref().map_or(0.0, |o| o[k]);
        let rotation = inertia * of_motor + lagging * of_screw / r;
        let reaction = growth(k) * (mass * r * of_motor + force);
        let all = rotation + r * (mass * of_load + force) + reaction;
        own(hooks, motor.position[k], all)
    };
    forces.iter().copied().enumerate().map(one).collect()
}

/// Acceleration of the error of the transmission's kinematics; `None` if there is none.
fn offset_acceleration(hooks: &Hooks, ends: &Ends, h: f64) -> Option<Vec<f64>> {
    if !hooks.has_offsets() {
        return None;
    }
    let rate = |k: usize| hooks.offset_at(&screw_state(&ends.load, &ends.motor, k, h))[1];
    let rates: Vec<f64> = (0..ends.load.position.len()).map(rate).collect();
    Some(derivative(&rates, h))
}

/// What turns along a screw lags the motor by a share of the wind-up: its inertia by that share, kg·m².
pub(super) fn lagging(axis: &Axis, load: &Course) -> f64 {
    let rotating = axis.mechanism.rotating(middle(&load.position));
    let shares = rotating.iter().map(|[inertia, share]| inertia * share);
    shares.sum()
}

/// Where load and motor are, the end that was not measured by the other and the wind-up, and the
/// forces on the load.
pub(super) struct Ends {
    pub load: Course,
    pub motor: Course,
    pub forces: Vec<f64>,
}

impl Ends {
    pub fn of(axis: &Axis, hooks: &Hooks, motions: &Motions, h: f64) -> Self {
        let corrected = motions.without_encoder_error(hooks, axis.travel_per_radian(), h);
        let motions = corrected.as_ref().unwrap_or(motions);
        let mut motor = motions.motor.clone();
        let ahead = ahead_at_start(axis, hooks, motions, h);
        if motions.motor_was_homed {
            motor.position.iter_mut().for_each(|angle| *angle += ahead);
        }
        let mut load = shifted(hooks, motions, &motor, h).unwrap_or_else(|| motions.load.clone());
        if !motions.motor_was_homed {
            let behind = ahead * axis.travel_per_radian();
            load.position.iter_mut().for_each(|x| *x -= behind);
        }
        let spring = motions.spring(axis);
        let forces = forces(axis, hooks, &load, spring, h);
        let Some(wind_up) = motions.wind_up else {
            return Self {
                load,
                motor,
                forces,
            };
        };
        let wind_up = wind_up.of(axis);
        let mass = axis.mechanism.load_inertia();
        if motions.load_is_derived {
            let behind = |forces: &[f64]| {
                let lag = lag_of_load(forces, &load.acceleration, mass, wind_up, h);
                load.plus(-1.0, &lag)
            };
            // Loads act where the load is. Friction is left at the motor's speed, with the spring in its
            // bristles: it sets the load swinging, and along that speed would reverse with every swing.
            let at_the_load = Course {
                speed: load.speed.clone(),
                ..behind(&forces)
            };
            let forces = self::forces(axis, hooks, &at_the_load, spring, h);
            return Self {
                load: behind(&forces),
                motor,
                forces,
            };
        }
        let pairs = forces.iter().zip(&load.acceleration);
        let transmitted = pairs.map(|(force, a)| force + mass * a).collect();
        let ahead = lead_of_motor(transmitted, wind_up, h);
        Self {
            motor: motor.plus(axis.travel_per_radian().recip(), &ahead),
            load,
            forces,
        }
    }
}

/// Middle of a course.
fn middle(positions: &[f64]) -> f64 {
    let ends = positions.iter();
    let [low, high] = ends.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
    0.5 * (low + high)
}

/// The load's course with errors of the transmission's kinematics, where only the motor's
/// is measured and there are some.
fn shifted(hooks: &Hooks, motions: &Motions, motor: &Course, h: f64) -> Option<Course> {
    if !(motions.load_is_derived && hooks.has_offsets()) {
        return None;
    }
    let load = &motions.load;
    let at = |k: usize| hooks.offset_at(&screw_state(load, motor, k, h));
    let offsets: Vec<[f64; 3]> = (0..load.position.len()).map(at).collect();
    let origin = offsets.first().map_or(0.0, |o| o[0]);
    let rates: Vec<f64> = offsets.iter().map(|o| o[1]).collect();
    let add = |to: &[f64], by: &[f64]| to.iter().zip(by).map(|(a, b)| a + b).collect();
    let moved: Vec<f64> = offsets.iter().map(|o| o[0] - origin).collect();
    Some(Course {
        position: add(&load.position, &moved),
        speed: add(&load.speed, &rates),
        acceleration: add(&load.acceleration, &derivative(&rates, h)),
    })
}

pub(super) fn screw_state(load: &Course, motor: &Course, k: usize, h: f64) -> ScrewState {
    ScrewState {
        time: k as f64 * h,
        angle: motor.position[k],
        rate: motor.speed[k],
        position: load.position[k],
        speed: load.speed[k],
        // Of a transmission that gives way with its load no motion of the motor tells.
        transmitted: 0.0,
    }
}

/// By how much the motor is ahead of the load where the log begins: the wind-up there, rad of the motor. An error
/// of the transmission's kinematics counts from there on, as in a simulation. In an angle that was homed on the load as
/// it stands there, what repeats with the motor's turn has that much more of a phase; by an angle of the motor's own,
/// the load is that much behind.
fn ahead_at_start(axis: &Axis, hooks: &Hooks, motions: &Motions, h: f64) -> f64 {
    let Some(wind_up) = motions.wind_up.filter(|_| motions.load_is_derived) else {
        return 0.0;
    };
    let Some(mut load) = motions.load.first() else {
        return 0.0;
    };
    // At a standstill the friction may have either sign: its mean.
    let speeds = motions.load.speed.iter();
    let most = speeds.fold(0.0_f64, |most, v| most.max(v.abs()));
    load.speed.retain(|v| v.abs() > STANDS * most);
    load.speed.resize(1, 0.0);
    let force = forces(axis, hooks, &load, motions.spring(axis), h)[0];
    let [stiffness, _] = wind_up.of(axis);
    let wound = (force + axis.mechanism.load_inertia() * load.acceleration[0]) / stiffness;
    wound / axis.travel_per_radian()
}

/// Forces on the load, against positive motion, N or N·m: friction, whose bristles go along
/// with the measured speed, loads, and those of effects.
fn forces(axis: &Axis, hooks: &Hooks, load: &Course, spring: Option<f64>, h: f64) -> Vec<f64> {
    let friction = axis.friction.share();
    let lever = friction.lever(axis.travel_per_radian());
    let unit_law = behind_a_spring(&friction.unit, spring, lever);
    let has_loads = hooks.has_loads() || !axis.loads.is_empty();
    let speed = |k: usize| load.speed[k] / lever;
    let own = self::friction(axis, load, spring, h);
    let mut before = load.speed.first().map_or(0.0, |v| v / lever);
    let mut unit = unit_law.steady_bristle(before);
    let start = Start {
        speed: load.speed.first().copied().unwrap_or(0.0),
        ..Start::at(load.position.first().copied().unwrap_or(0.0))
    };
    let (mut memory, _) = hooks.memories().settled(&start);
    let mass = axis.mechanism.load_inertia();
    let (mut transmitted, mut travelled) = (0.0, 0.0);
    let one = |k: usize| {
        let now = speed(k);
        let mut force = own[k];
        if has_loads {
            unit = unit_law.step(unit, before, now, h);
            let at = TableState {
                time: k as f64 * h,
                position: load.position[k],
                speed: load.speed[k],
                bristle: unit_law.torque(unit, now),
                loaded: 1.0,
                transmitted,
                travelled,
            };
            let last = k.saturating_sub(1);
            let step = TableStep {
                length: h,
                travel: load.position[k] - load.position[last],
                speed_before: load.speed[last],
                speed: load.speed[k],
            };
            travelled += step.travel.abs();
            force += hooks.loads_at(&at) + hooks.memories().step(&step, &mut memory);
            memory.accept();
            force += axis.loads.iter().map(|l| l.force(&at)).sum::<f64>();
        }
        before = now;
        transmitted = mass * load.acceleration[k] + force;
        force
    };
    (0..load.speed.len()).map(one).collect()
}

/// Force of the axis' own friction along a course, N or N·m.
fn friction(axis: &Axis, load: &Course, spring: Option<f64>, h: f64) -> Vec<f64> {
    let friction = axis.friction.share();
    let lever = friction.lever(axis.travel_per_radian());
    let law = behind_a_spring(&friction.law, spring, lever);
    let first = load.speed.first().map_or(0.0, |v| v / lever);
    friction_from(&law, law.steady_bristle(first), lever, load, h)
}

/// Force of a friction law along a course from a bristle on; the law's coordinate is the load's
/// by `lever`.
pub(super) fn friction_from(
    law: &LuGre,
    bristle: f64,
    lever: f64,
    load: &Course,
    h: f64,
) -> Vec<f64> {
    let mut before = load.speed.first().map_or(0.0, |v| v / lever);
    let mut bristle = bristle;
    let one = |v: &f64| {
        let now = v / lever;
        let (z, own) = law.step_torque(bristle, before, now, h);
        (bristle, before) = (z, now);
        own / lever
    };
    load.speed.iter().map(one).collect()
}

/// The actuator's own torque where what acts at `angle` with the hooks' is `all`.
fn own(hooks: &Hooks, angle: f64, all: f64) -> f64 {
    let mut own = all;
    for _ in 0..ROUNDS {
        let off = all - hooks.torque_at(angle, own);
        own += off;
        if off.abs() <= 1e-13 * all.abs() {
            break;
        }
    }
    own
}
