//! The control laws in the frequency domain: what they see, and what they make of it.
//!
//! At z = e^{jωT}, with the speed controller run every M cycles and the position controller every N:
//!
//! ```text
//! C   = (k_p + k_i M T/(1 − z⁻ᴹ)) F(zᴹ) H_M        H_M = Σ_{k<M} z⁻ᵏ/M       F: filters of the command
//! L   = C (S(zᴹ) G_ω + P H G_p)                    S: filter of the speed; H: mean of z⁻ᵃ, a the age
//! L_p = P H C G_p/(1 + C S G_ω)                       of the speed set point in cycles
//! ```
//!
//! A PID controller of the position is one loop, L = k_p S G_ω + (k_p + k_i T/(1 − z⁻¹)) P G_p with the speed
//! as the difference of the position over a cycle; both cuts are that.
//!
//! G_ω and G_p are the responses of the speed and of the position that the controllers go by to the
//! command. What a loop that is slower than the others folds down from above half its own rate is
//! left out: drives attenuate that by the inertia of the machine.

use compensator::{DriveFilter, SignalPath};

use crate::plant::{LoopModel, Number, PlantAt, Sensing};

/// Gains of the two controllers, in the units of the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoopGains {
    /// Command per speed error, and per angle error.
    pub speed: f64,
    pub integral: f64,
    /// Motor speed per position error, P = k_v/r.
    pub position: f64,
}

/// One frequency of the loop, everything but the gains.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoopAt {
    /// rad/s.
    pub frequency: f64,
    /// One more cycle of delay, z⁻¹.
    pub late: Number,
    /// k_i's factor beside k_p, M T/(1 − z⁻ᴹ).
    pub integral: Number,
    /// Filters and hold of the command, F H_M: in `speed` and `position` already.
    pub passed: Number,
    /// F H_M S G_ω and F H_M H G_p: the loop is (k_p + k_i …)(speed + P position).
    pub speed: Number,
    pub position: Number,
    /// The load's response to the command of the speed controller, F H_M G_y.
    pub load: Number,
    /// Motor's true speed to the same.
    pub motor_speed: Number,
    /// Responses to a force against the load: S D_ω, H D_p, D_y.
    pub force: [Number; 3],
    /// What the speed controller sees per step of the angle, S (1 − z⁻ᴹ)/(M T).
    pub per_angle: Number,
    /// Whether the integral sees the position alone.
    pub is_pid: bool,
}

const ONE: Number = Number::new(1.0, 0.0);

impl LoopAt {
    pub fn new(model: &LoopModel, plant: &PlantAt) -> Self {
        Self::through(model, &model.sensing, plant)
    }

    /// With responses to the command that were measured, as the sensors show them, in the place of the
    /// model's.
    pub fn of_measured(model: &LoopModel, measured: &PlantAt, plant: &PlantAt) -> Self {
        let seen = Self::through(model, &Sensing::AS_SHOWN, measured);
        Self {
            speed: seen.speed,
            position: seen.position,
            load: seen.load,
            motor_speed: seen.motor_speed,
            ..Self::new(model, plant)
        }
    }

    fn through(model: &LoopModel, sensing: &Sensing, plant: &PlantAt) -> Self {
        let (signal_path, period) = (model.signal_path(), model.period());
        let z = Number::from_polar(1.0, plant.frequency * period);
        let back = |cycles: f64| Number::from_polar(1.0, -plant.frequency * period * cycles);
        let every = f64::from(signal_path.speed_every.max(1));
        let mean_over = |cycles: u32| mean((0..cycles).map(|k| back(f64::from(k))));
        let differences = (ONE - back(every)) / (every * period);
        let z_speed = back(-every);
        let filter = |filter: &Option<DriveFilter>| filter.map_or(ONE, |f| response(&f, z_speed));
        let passed = mean_over(signal_path.speed_every.max(1))
            * filter(&signal_path.command[0])
            * filter(&signal_path.command[1]);
        let aged = mean(
            ages(signal_path)
                .into_iter()
                .map(|age| back(f64::from(age))),
        );
        let speed_filter = filter(&signal_path.speed);

        let travel = model.model.travel;
        let seen = |command: [Number; 3]| {
            let [angle, speed, load] = shown_at(model, sensing, command, back);
            let motor = angle * travel;
            let position = match (&signal_path.blend, model.cascade().from_motor) {
                (Some(blend), _) => {
                    let slow = response(blend, back(-f64::from(signal_path.position_every.max(1))));
                    motor + slow * (load - motor)
                }
                (None, true) => motor,
                (None, false) => load,
            };
            [speed_filter * speed, aged * position]
        };
        let [speed, position] = seen(plant.command);
        let [force_speed, force_position] = seen(plant.force);
        Self {
            frequency: plant.frequency,
            late: z.inv(),
            integral: every * period / (ONE - back(every)),
            passed,
            speed: passed * speed,
            position: passed * position,
            load: passed * plant.command[2],
            motor_speed: passed * plant.command[1],
            force: [force_speed, force_position, plant.force[2]],
            per_angle: speed_filter * differences,
            is_pid: model.is_pid,
        }
    }

    /// k_p + k_i ….
    pub fn controller(&self, gains: &LoopGains) -> Number {
        self.integral * gains.integral + gains.speed
    }

    /// The loop cut at the command, and the one cut at the position.
    pub fn cut(&self, gains: &LoopGains, is_late: bool) -> [Number; 2] {
        let late = if is_late { self.late } else { ONE };
        let [inner, outer] = self.answers(gains, self.speed, self.position);
        let [inner, outer] = [late * inner, late * outer];
        match self.is_pid {
            true => [inner + outer; 2],
            false => [inner + outer, outer / (inner + 1.0)],
        }
    }

    /// What the controllers answer to what they see of the command, by speed and by position.
    pub fn answered(&self, gains: &LoopGains) -> [Number; 2] {
        self.answers(gains, self.speed, self.position)
    }

    /// Command of the controllers to a speed and to a position that they see.
    fn answers(&self, gains: &LoopGains, speed: Number, position: Number) -> [Number; 2] {
        let c = self.controller(gains);
        let inner = match self.is_pid {
            true => speed * gains.speed,
            false => c * speed,
        };
        [inner, c * position * gains.position]
    }

    /// The load's motion per force on it.
    pub fn compliance(&self, gains: &LoopGains) -> Number {
        let [inner, outer] = self.answers(gains, self.speed, self.position);
        let [speed, position, load] = self.force;
        let [by_speed, by_position] = self.answers(gains, speed, position);
        load - self.load * (by_speed + by_position) / (inner + outer + 1.0)
    }

    /// The motor's speed per set point of the speed controller, its position loop open; of a PID
    /// controller it means nothing.
    pub fn speed_followed(&self, gains: &LoopGains) -> Number {
        let c = self.controller(gains);
        c * self.motor_speed / (c * self.speed + 1.0)
    }

    /// Command per step of the angle that the speed is derived from, the loop closed.
    pub fn ripple(&self, gains: &LoopGains) -> Number {
        let [inner, outer] = self.answers(gains, self.speed, self.position);
        let [answer, _] = self.answers(gains, self.per_angle, self.per_angle);
        answer * self.passed / (inner + outer + 1.0)
    }
}

/// What the sensors show of a drive's response to the command: motor's angle, its speed as the speed
/// controller goes by it, load's position.
pub(crate) fn shown(model: &LoopModel, plant: &PlantAt) -> [Number; 3] {
    let turn = plant.frequency * model.period();
    shown_at(model, &model.sensing, plant.command, |cycles| {
        Number::from_polar(1.0, -turn * cycles)
    })
}

fn shown_at(
    model: &LoopModel,
    sensing: &Sensing,
    [angle, speed, load]: [Number; 3],
    back: impl Fn(f64) -> Number,
) -> [Number; 3] {
    let signal_path = model.signal_path();
    let (travel, period) = (model.model.travel, model.period());
    let mut angle = angle * late_by(sensing.motor_delay, &back);
    let mut load = load * late_by(sensing.load_delay, &back);
    if sensing.motor_from_load {
        angle = load / travel;
    }
    if sensing.load_from_motor {
        load = angle * travel;
    }
    let every = f64::from(signal_path.speed_every.max(1));
    let speed = match (signal_path.speed_of_position, sensing.by_differences) {
        (true, _) => load * (ONE - back(2.0)) / (2.0 * period * travel),
        (false, true) => angle * (ONE - back(every)) / (every * period),
        (false, false) => speed,
    };
    [angle, speed, load]
}

/// Ages of the speed set point, in cycles, at the executions of the speed controller.
pub(crate) fn ages(signal_path: &SignalPath) -> Vec<u32> {
    let (every, position) = (
        signal_path.speed_every.max(1),
        signal_path.position_every.max(1),
    );
    let runs = position / common(every, position);
    (0..runs).map(|k| (k * every) % position).collect()
}

/// Greatest common divisor.
pub(crate) fn common(a: u32, b: u32) -> u32 {
    match b {
        0 => a,
        b => common(b, a % b),
    }
}

fn mean(values: impl Iterator<Item = Number>) -> Number {
    let (mut sum, mut count) = (Number::new(0.0, 0.0), 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    sum / count
}

/// Delayed by `cycles`, linear between samples, as sensors are.
fn late_by(cycles: f64, back: impl Fn(f64) -> Number) -> Number {
    let whole = cycles.floor();
    let part = cycles - whole;
    back(whole) * (1.0 - part) + back(whole + 1.0) * part
}

fn response(filter: &DriveFilter, z: Number) -> Number {
    let back = z.inv();
    let above = back * (back * filter.b[2] + filter.b[1]) + filter.b[0];
    let below = back * (back * filter.a[1] + filter.a[0]) + 1.0;
    above / below
}
