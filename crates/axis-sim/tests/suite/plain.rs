//! A slow, obvious simulation of an axis of two masses or one, for comparison: the
//! equations of the plant by the classical Runge–Kutta method with steps of a
//! microsecond, and the controller spelled out. It shares no code with the crate.

use std::collections::VecDeque;
use std::f64::consts::TAU;

/// LuGre friction at the load.
#[derive(Clone, Copy)]
pub struct Rub {
    pub coulomb: f64,
    pub stiction: f64,
    pub stribeck: f64,
    pub stiffness: f64,
    pub damping: f64,
    pub viscous: f64,
}

impl Rub {
    /// Coulomb's and viscous friction with a pre-sliding distance.
    pub fn coulomb(coulomb: f64, viscous: f64, presliding: f64) -> Self {
        Self {
            coulomb,
            stiction: coulomb,
            stribeck: 1.0,
            stiffness: coulomb / presliding,
            damping: 0.0,
            viscous,
        }
    }

    /// Force, and rate of the bristles.
    fn at(&self, z: f64, v: f64) -> [f64; 2] {
        let above = (self.stiction - self.coulomb) * (-(v / self.stribeck).powi(2)).exp();
        let rate = v - self.stiffness * v.abs() * z / (self.coulomb + above);
        let force = self.stiffness * z + self.damping * rate + self.viscous * v;
        [force, rate]
    }
}

/// What moves.
#[derive(Clone, Copy)]
pub enum Masses {
    /// Motor inertia, load inertia, travel per radian, stiffness, damping time.
    Two(f64, f64, f64, f64, f64),
    /// Motor and load as one.
    One(f64),
}

/// The actuator: its command comes late by a number of cycles, is limited and followed
/// with a bandwidth (Hz).
#[derive(Clone, Copy)]
pub struct Source {
    pub bandwidth: f64,
    pub cycles_late: f64,
    pub limit: f64,
}

/// The controller.
#[derive(Clone, Copy)]
pub enum Law {
    /// Kv, gain and integral time of the speed loop, cycles between executions of the
    /// position and of the speed loop; all of the velocity is fed forward.
    Cascade {
        kv: f64,
        gain: f64,
        time: f64,
        every: [usize; 2],
    },
    /// Gains of error, integral and derivative, and the low pass of the last, Hz.
    Pid { gains: [f64; 3], lowpass: f64 },
}

/// The axis.
#[derive(Clone, Copy)]
pub struct Plain<'a> {
    pub masses: Masses,
    pub friction: Rub,
    /// Force on the load at a position.
    pub load: &'a dyn Fn(f64) -> f64,
    /// Displacement and rate of the transmission's error at the motor's angle and speed.
    pub error: &'a dyn Fn(f64, f64) -> [f64; 2],
    pub source: Source,
    pub law: Law,
    pub period: f64,
}

/// Load position and speed, motor angle and speed, bristles, torque.
type State = [f64; 6];

/// Load position, motor angle and torque at a sampling instant.
pub type Row = [f64; 3];

impl Plain<'_> {
    fn travel(&self) -> f64 {
        match self.masses {
            Masses::Two(_, _, r, _, _) => r,
            Masses::One(_) => 1.0,
        }
    }

    /// By how much more the load moves per radian at an angle of the motor.
    fn growth(&self, angle: f64) -> f64 {
        (self.error)(angle, 1.0)[1]
    }

    fn rates(&self, offset: f64, command: f64, s: &State) -> State {
        let [y, v, angle, speed, z, torque] = *s;
        let [rub, slip] = self.friction.at(z, v);
        let against = rub + (self.load)(y);
        let (pull, turn) = match self.masses {
            Masses::One(mass) => {
                let a = (torque - against) / mass;
                (a, a)
            }
            Masses::Two(motor, mass, r, k, damping) => {
                let [by, rate] = (self.error)(angle, speed);
                let stretch = r * angle - y + by - offset;
                let stretch_rate = r * speed - v + rate;
                let force = k * (stretch + damping * stretch_rate);
                // The transmission takes no power: what moves the load by dx/dθ pushes back by it.
                let lever = r + self.growth(angle);
                ((force - against) / mass, (torque - lever * force) / motor)
            }
        };
        let follow = TAU * self.source.bandwidth * (command - torque);
        [v, pull, speed, turn, slip, follow]
    }

    /// Follows `reference` (position and velocity) from rest at its start for `cycles`
    /// control cycles, with Runge–Kutta steps of a microsecond.
    pub fn run(&self, cycles: usize, reference: impl Fn(f64) -> [f64; 2]) -> Vec<Row> {
        let (r, start) = (self.travel(), reference(0.0)[0]);
        // Settled under the load.
        let load = (self.load)(start);
        let wound = match self.masses {
            Masses::Two(_, _, _, k, _) => load / k,
            Masses::One(_) => 0.0,
        };
        let angle = (start + wound) / r;
        let torque = (r + self.growth(angle)) * load;
        let mut s: State = [start, 0.0, angle, 0.0, 0.0, torque];
        let offset = (self.error)(angle, 0.0)[0];
        let mut late: VecDeque<f64> = VecDeque::from(vec![torque; 8]);
        let mut sum = torque;
        let (mut wanted, mut effort) = (0.0, torque);
        let (mut before, mut slope) = (0.0, 0.0);
        let limit = self.source.limit;
        let mut rows = Vec::new();
        for k in 0..cycles {
            rows.push([s[0], s[2], s[5]]);
            let [s_ref, v_ref] = reference(k as f64 * self.period);
            match self.law {
                Law::Cascade {
                    kv,
                    gain,
                    time,
                    every,
                } => {
                    if k % every[0] == 0 {
                        wanted = (kv * (s_ref - s[0]) + v_ref) / r;
                    }
                    if k % every[1] == 0 {
                        let error = wanted - s[3];
                        let t = every[1] as f64 * self.period;
                        let next = sum + gain / time * error * t;
                        let asked = gain * error + next;
                        if asked.abs() <= limit || asked * error < 0.0 {
                            sum = next;
                        }
                        effort = asked.clamp(-limit, limit);
                    }
                }
                Law::Pid { gains, lowpass } => {
                    let error = s_ref - s[0];
                    let keep = (-TAU * lowpass * self.period).exp();
                    let change = if k == 0 { 0.0 } else { error - before };
                    slope = keep * slope + (1.0 - keep) * change / self.period;
                    before = error;
                    let next = sum + gains[1] * error * self.period;
                    let asked = gains[0] * error + next + gains[2] * slope;
                    if asked.abs() <= limit || asked * error < 0.0 {
                        sum = next;
                    }
                    effort = asked.clamp(-limit, limit);
                }
            }
            late.push_front(effort);
            late.pop_back();
            let whole = self.source.cycles_late as usize;
            let part = self.source.cycles_late - whole as f64;
            let command = (1.0 - part) * late[whole] + part * late[whole + 1];
            let steps = (self.period / 1e-6).round() as usize;
            let h = self.period / steps as f64;
            for _ in 0..steps {
                let rate = |s: &State| self.rates(offset, command, s);
                let by = |s: &State, k: &State, h: f64| -> State {
                    std::array::from_fn(|i| s[i] + h * k[i])
                };
                let a = rate(&s);
                let b = rate(&by(&s, &a, 0.5 * h));
                let c = rate(&by(&s, &b, 0.5 * h));
                let d = rate(&by(&s, &c, h));
                for (k, part) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
                    s = by(&s, &k, h * part / 6.0);
                }
            }
        }
        rows
    }
}
