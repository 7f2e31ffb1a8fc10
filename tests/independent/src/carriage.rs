//! A carriage on a rack, a belt or a linear motor, whose drive may be pushed and late.
//!
//! What differs on purpose from the library: the machine is integrated by the classical Runge–Kutta rule in tenths
//! of a control period, the current by the same rule apart from it, and dry friction comes on as
//! tanh(v / 0.3 mm/s).
//!
//! ```text
//! J θ'' = T − r S          m x'' = S − F_c tanh(x' / 0.3 mm/s) − B x' + force
//! S = k(x) (r θ − x) + β k(x) (r θ' − x')        of a belt k = EA (1/(a + x) + 1/(b − a − x))
//! ```
//!
//! a being the driven strand where the carriage is at 0, b both strands together. Of a rigid transmission x = r θ.

use crate::carriage_drive::{CarriageControl, CarriageDrive, CarriageMotor, CarriageReading};
use crate::motion::{Motion, Setpoint};
use crate::random::Random;
use crate::run::{LoopNoise, Push};

/// Steps of the machine in a control period.
const STEPS: u32 = 10;
/// Speed over which dry friction comes on, m/s.
const ONSET: f64 = 3e-4;

/// What is between motor and carriage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transmission {
    /// Nothing: the motor is on the carriage.
    Rigid,
    /// A spring, N/m.
    Spring(f64),
    /// Two strands of a belt.
    Belt {
        /// EA, N.
        specific: f64,
        /// a, m.
        at_zero: f64,
        /// b, m.
        together: f64,
    },
}

impl Transmission {
    fn stiffness(&self, x: f64) -> f64 {
        match self {
            Self::Rigid => 0.0,
            Self::Spring(k) => *k,
            Self::Belt {
                specific,
                at_zero,
                together,
            } => specific * (1.0 / (at_zero + x) + 1.0 / (together - at_zero - x)),
        }
    }
}

/// The machine with its drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carriage {
    /// r, m per coordinate of the motor: m/rad, or 1 of a linear motor.
    pub travel: f64,
    /// J, kg·m²; of a rigid transmission all that turns.
    pub motor_inertia: f64,
    /// m, kg.
    pub mass: f64,
    /// Between them.
    pub transmission: Transmission,
    /// β, s.
    pub damping: f64,
    /// F_c, N.
    pub coulomb: f64,
    /// B, N·s/m.
    pub viscous: f64,
    /// What drives it.
    pub motor: CarriageMotor,
    /// Its controllers.
    pub control: CarriageControl,
    /// Steps in which the load's position (m) and the motor's coordinate (rad) are read; 0 for none.
    pub read_in_steps: [f64; 2],
    /// Whether the motor is read by the load's sensor.
    pub one_sensor: bool,
}

/// A control period of it.
#[derive(Clone, Copy, Debug)]
pub struct CarriageSample {
    /// s.
    pub time: f64,
    /// Reference.
    pub wanted: Setpoint,
    /// Load as read, without what was added, m.
    pub position: f64,
    /// Motor as read, rad or m.
    pub angle: f64,
    /// Difference of that over a period.
    pub speed: f64,
    /// What the speed controller asks for with what was added, A or N·m.
    pub command: f64,
    /// Current (A) or torque (N·m) as read.
    pub effort: f64,
}

/// θ, x, θ', x'.
type State = [f64; 4];

impl Carriage {
    fn rates(&self, [angle, x, turning, v]: State, torque: f64, force: f64) -> State {
        let against = self.coulomb * (v / ONSET).tanh() + self.viscous * v - force;
        if self.transmission == Transmission::Rigid {
            let all = self.motor_inertia + self.mass * self.travel * self.travel;
            let rate = (torque - self.travel * against) / all;
            return [turning, self.travel * turning, rate, self.travel * rate];
        }
        let k = self.transmission.stiffness(x);
        let strain = self.travel * angle - x;
        let spring = k * (strain + self.damping * (self.travel * turning - v));
        let turned = (torque - self.travel * spring) / self.motor_inertia;
        [turning, v, turned, (spring - against) / self.mass]
    }

    fn move_on(&self, state: State, torque: f64, force: f64, h: f64) -> State {
        let along =
            |rate: &State, by: f64| -> State { std::array::from_fn(|i| state[i] + by * rate[i]) };
        let a = self.rates(state, torque, force);
        let b = self.rates(along(&a, 0.5 * h), torque, force);
        let c = self.rates(along(&b, 0.5 * h), torque, force);
        let d = self.rates(along(&c, h), torque, force);
        std::array::from_fn(|i| state[i] + h * (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0)
    }
}

/// Runs a motion with what comes in from outside at each time, s; every control period is shown to `each`.
pub fn run_carriage(
    c: &Carriage,
    motion: &Motion,
    (noise, random): (&LoopNoise, &mut Random),
    push: impl Fn(f64) -> Push,
    mut each: impl FnMut(&CarriageSample),
) {
    let start = motion.start();
    let mut state = [start / c.travel, start, 0.0, 0.0];
    let mut drive = CarriageDrive::new(c.control, c.motor, c.travel, state[0]);
    let step = c.control.period / f64::from(STEPS);
    for k in 0..=(motion.duration() / c.control.period) as usize {
        let time = k as f64 * c.control.period;
        let from_outside = push(time);
        let position = read(
            state[1] + noise.position * random.normal(),
            c.read_in_steps[0],
        );
        let own = read(state[0] + noise.angle * random.normal(), c.read_in_steps[1]);
        let angle = if c.one_sensor {
            position / c.travel
        } else {
            own
        };
        let moved = from_outside.position;
        let seen = CarriageReading {
            position: position + moved,
            // Of a position loop at the motor the speed does not see what is added.
            angle,
            noise: [0; 2].map(|_| noise.current * random.normal()),
        };
        let wanted = motion.at(time);
        let asked = match c.control.from_motor {
            true => Setpoint {
                position: wanted.position - moved,
                ..wanted
            },
            false => wanted,
        };
        let [speed, command, effort] = drive.step(&asked, &seen, from_outside.current);
        each(&CarriageSample {
            time,
            wanted,
            position,
            angle,
            speed,
            command,
            effort,
        });
        for i in 0..STEPS {
            // In the middle of the step, as its forces are.
            let force = push(time + (f64::from(i) + 0.5) * step).force;
            let torque = drive.torque(state[2], step);
            state = c.move_on(state, torque, force, step);
        }
    }
}

fn read(value: f64, step: f64) -> f64 {
    match step > 0.0 {
        true => (value / step).round() * step,
        false => value,
    }
}
