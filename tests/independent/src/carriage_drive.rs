//! The drive of a carriage: position, speed and current controllers, and the motor.

use std::collections::VecDeque;

use crate::drive::Proportional;
use crate::motion::Setpoint;
use crate::motor::Motor;

/// What makes the torque (N·m), or the force of a linear motor (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CarriageMotor {
    /// A torque that follows its command by a lag of first order, a control period late.
    Torque {
        /// Corner of the lag, Hz.
        bandwidth: f64,
        /// Greatest torque, N·m.
        limit: f64,
    },
    /// A motor with magnets and L_d = L_q under current controllers.
    Current {
        /// Torque per ampere, N·m/A, or N/A.
        constant: f64,
        /// Electrical angle per coordinate of the motor, rad/rad or rad/m.
        pole_pairs: f64,
        /// Ω.
        resistance: f64,
        /// H.
        inductance: f64,
        /// Both current controllers, V/A and V/(A·s).
        gains: [f64; 2],
        /// Greatest q current, A.
        limit: f64,
        /// V.
        dc_link: f64,
    },
}

/// The cascade of the drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriageControl {
    /// s.
    pub period: f64,
    /// Periods from one execution of the position controller to the next.
    pub position_every: usize,
    /// Whether the position is that of the motor.
    pub from_motor: bool,
    /// Kv, 1/s.
    pub kv: f64,
    /// Speed controller: command per speed of the motor, and per its angle.
    pub speed: [f64; 2],
    /// Periods by which the command is late.
    pub late: usize,
}

/// Controllers and what is on its way.
pub(crate) struct CarriageDrive {
    control: CarriageControl,
    travel: f64,
    motor: CarriageMotor,
    wanted: f64,
    speed: Proportional,
    d: Proportional,
    q: Proportional,
    on_its_way: VecDeque<f64>,
    last_angle: f64,
    cycle: usize,
    electric: Motor,
    /// Currents d, q, A; of a torque the second is the torque.
    currents: [f64; 2],
    /// What is held over the period: voltages d, q, or the torque's command in the second.
    held: [f64; 2],
}

/// What a drive reads: the load's position (m) and the motor's coordinate (rad, m), and what noise its current has, A.
pub(crate) struct CarriageReading {
    pub position: f64,
    pub angle: f64,
    pub noise: [f64; 2],
}

impl CarriageDrive {
    pub fn new(control: CarriageControl, motor: CarriageMotor, travel: f64, angle: f64) -> Self {
        let controller = |[p, i]: [f64; 2]| Proportional { p, i, held: 0.0 };
        let (gains, electric, own_late) = match motor {
            CarriageMotor::Torque { .. } => ([0.0; 2], Motor::of(1.0, 0.0, 1.0, [1.0; 2]), 1),
            CarriageMotor::Current {
                constant,
                pole_pairs,
                resistance,
                inductance,
                gains,
                ..
            } => {
                // T = 1.5 p ψ i.
                let flux = constant / (1.5 * pole_pairs);
                (
                    gains,
                    Motor::of(pole_pairs, flux, resistance, [inductance; 2]),
                    0,
                )
            }
        };
        Self {
            travel,
            motor,
            wanted: 0.0,
            speed: controller(control.speed),
            d: controller(gains),
            q: controller(gains),
            on_its_way: VecDeque::from(vec![0.0; control.late + own_late]),
            last_angle: angle,
            cycle: 0,
            electric,
            currents: [0.0; 2],
            held: [0.0; 2],
            control,
        }
    }

    /// A control period: the speed that it saw, what it commands, and the current or torque that it read.
    pub fn step(&mut self, wanted: &Setpoint, seen: &CarriageReading, added: f64) -> [f64; 3] {
        let period = self.control.period;
        if self.cycle.is_multiple_of(self.control.position_every) {
            let position = match self.control.from_motor {
                true => self.travel * seen.angle,
                false => seen.position,
            };
            let error = wanted.position - position;
            self.wanted = (self.control.kv * error + wanted.velocity) / self.travel;
        }
        self.cycle += 1;
        let speed = (seen.angle - self.last_angle) / period;
        self.last_angle = seen.angle;
        let slow = self.wanted - speed;
        let mut asked = self.speed.ask(slow, period);
        asked.0 += added;
        let limit = match self.motor {
            CarriageMotor::Torque { limit, .. } | CarriageMotor::Current { limit, .. } => limit,
        };
        let command = asked.0.clamp(-limit, limit);
        self.speed.keep(asked, command, slow);
        self.on_its_way.push_back(command);
        let arrived = self.on_its_way.pop_front().unwrap_or(command);
        let read = self.currents[1] + seen.noise[1];
        self.held = match self.motor {
            CarriageMotor::Torque { .. } => [0.0, arrived],
            CarriageMotor::Current { dc_link, .. } => {
                let errors = [-self.currents[0] - seen.noise[0], arrived - read];
                let asked = [self.d.ask(errors[0], period), self.q.ask(errors[1], period)];
                let length = asked[0].0.hypot(asked[1].0);
                let most = dc_link / 3f64.sqrt();
                let by = (most / length.max(f64::MIN_POSITIVE)).min(1.0);
                let voltage = [by * asked[0].0, by * asked[1].0];
                self.d.keep(asked[0], voltage[0], errors[0]);
                self.q.keep(asked[1], voltage[1], errors[1]);
                voltage
            }
        };
        [speed, command, read]
    }

    /// Torque (force) in the middle of a step of `h` seconds at a speed of the motor; moves currents on.
    pub fn torque(&mut self, speed: f64, h: f64) -> f64 {
        let before = self.currents;
        self.currents = match self.motor {
            CarriageMotor::Torque { bandwidth, .. } => {
                let lag = (-std::f64::consts::TAU * bandwidth * h).exp();
                [0.0, self.held[1] + lag * (before[1] - self.held[1])]
            }
            CarriageMotor::Current { .. } => self.electric.after(before, self.held, speed, h),
        };
        let middle = [0, 1].map(|i| 0.5 * (before[i] + self.currents[i]));
        match self.motor {
            CarriageMotor::Torque { .. } => middle[1],
            CarriageMotor::Current { .. } => self.electric.torque(middle),
        }
    }
}
