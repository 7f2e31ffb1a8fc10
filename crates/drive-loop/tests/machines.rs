//! Machines of a second simulator (`independent_axis`), which shares no code with what is tested: a ball screw, and
//! carriages on a rack, a belt and a linear motor, with drives of their own.

use std::f64::consts::{PI, TAU};

use axis_log::{Channel, Log};
use independent_axis::{
    Carriage, CarriageControl, CarriageMotor, Hidden, LoopNoise, Motion, Parameters, Push, Random,
    Transmission, run_carriage, run_pushed,
};

/// A machine.
#[derive(Clone, Debug)]
pub enum Machine {
    /// The paper's; the command is late by so many periods.
    Screw(Parameters, usize),
    Carriage(Carriage),
}

/// How it is moved and excited while it is measured.
#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// m, m/s.
    pub from: f64,
    pub speed: f64,
    /// Of the random binary signal, A or N·m.
    pub amplitude: f64,
}

/// A control period.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub time: f64,
    pub reference: f64,
    pub position: f64,
    pub angle: f64,
    pub speed: f64,
    pub command: f64,
    pub effort: f64,
}

/// Time until it slides evenly, and for which it is excited, s.
const BEGIN: f64 = 0.6;
const EXCITED: f64 = 7.0;
/// Time for which it slides while its loop is swept, s.
const SWEPT: f64 = 3.2;

impl Slide {
    pub fn motion(&self) -> Motion {
        let way = self.speed * (EXCITED + 0.8);
        Motion::from(self.from).rest(0.2).by(way, self.speed, 0.1)
    }
}

impl Machine {
    pub fn period(&self) -> f64 {
        match self {
            Self::Screw(p, _) => p.period,
            Self::Carriage(c) => c.control.period,
        }
    }

    /// m per coordinate of the motor.
    pub fn travel(&self) -> f64 {
        match self {
            Self::Screw(p, _) => p.travel(),
            Self::Carriage(c) => c.travel,
        }
    }

    /// Its inertia at the motor, by hand: kg·m², or kg of a linear motor.
    pub fn inertia(&self) -> f64 {
        match self {
            Self::Screw(p, _) => {
                // Motor, sensor and solid screw turn, the table moves along.
                let screw = p.density * PI * p.screw_diameter.powi(4) * p.screw_length / 32.0;
                let along = p.table_mass * p.travel().powi(2);
                p.motor_inertia + p.sensor_inertia + screw + along
            }
            Self::Carriage(c) => c.motor_inertia + c.mass * c.travel * c.travel,
        }
    }

    /// The same with the command so many periods later.
    pub fn later(&self, by: usize) -> Self {
        match self {
            Self::Screw(p, late) => Self::Screw(*p, late + by),
            Self::Carriage(c) => {
                let mut other = *c;
                other.control.late += by;
                Self::Carriage(other)
            }
        }
    }

    /// The same with gains: Kv (1/s), command per speed of the motor, and per its angle.
    pub fn with_gains(&self, kv: f64, speed: [f64; 2]) -> Self {
        match self {
            Self::Screw(p, late) => {
                let mut other = *p;
                other.position_gain = kv / p.travel();
                [other.speed_p, other.speed_i] = speed;
                Self::Screw(other, *late)
            }
            Self::Carriage(c) => {
                let mut other = *c;
                (other.control.kv, other.control.speed) = (kv, speed);
                Self::Carriage(other)
            }
        }
    }

    pub fn run(&self, motion: &Motion, noisy: bool, push: impl Fn(f64) -> Push) -> Vec<Seen> {
        let mut all = Vec::new();
        let mut random = Random::new(3, 0);
        let noise = if noisy {
            LoopNoise::GOOD
        } else {
            LoopNoise::default()
        };
        match self {
            Self::Screw(p, late) => {
                let hidden = Hidden {
                    delay_cycles: *late,
                    ..Hidden::default()
                };
                run_pushed((p, &hidden), motion, (&noise, &mut random), push, |s| {
                    all.push(Seen {
                        time: s.time,
                        reference: s.wanted.position,
                        position: s.seen.position,
                        angle: s.seen.angle,
                        speed: s.seen.speed,
                        command: s.command.current,
                        effort: s.seen.current[1],
                    });
                })
                .unwrap();
            }
            Self::Carriage(c) => {
                let mut quiet = *c;
                if !noisy {
                    quiet.read_in_steps = [0.0; 2];
                }
                run_carriage(&quiet, motion, (&noise, &mut random), push, |s| {
                    all.push(Seen {
                        time: s.time,
                        reference: s.wanted.position,
                        position: s.position,
                        angle: s.angle,
                        speed: s.speed,
                        command: s.command,
                        effort: s.effort,
                    });
                });
            }
        }
        all
    }

    /// Its log under a random binary signal that repeats itself each second.
    pub fn log(&self, slide: &Slide) -> Log {
        let mut random = Random::new(5, 1);
        let count = (1.0 / self.period()).round() as usize;
        let sign = |random: &mut Random| if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        let signs: Vec<f64> = (0..count / 2)
            .map(|_| slide.amplitude * sign(&mut random))
            .collect();
        let added = |t: f64| {
            let k = ((t - BEGIN) / self.period()).round();
            match (0.0..EXCITED).contains(&(t - BEGIN)) {
                true => signs[(k as usize / 2) % signs.len()],
                false => 0.0,
            }
        };
        let all = self.run(&slide.motion(), true, |t| Push {
            current: added(t),
            ..Push::default()
        });
        let (command, effort, excitation) = match self.is_of_torque() {
            true => ("torque_ref_n_m", "torque_n_m", "excitation_n_m"),
            false => ("iq_ref_a", "iq_a", "excitation_a"),
        };
        let mut channels = Vec::new();
        let mut channel = |name: &str, of: &dyn Fn(&Seen) -> f64| {
            channels.push(Channel::new(name, all.iter().map(of).collect()).unwrap());
        };
        channel("t_s", &|s| s.time);
        channel("position_ref_m", &|s| s.reference);
        channel("position_m", &|s| s.position);
        if !matches!(self, Self::Carriage(c) if c.one_sensor) {
            channel("motor_angle_rad", &|s| s.angle);
            channel("motor_speed_rad_s", &|s| s.speed);
        }
        channel(command, &|s| s.command);
        channel(effort, &|s| s.effort);
        channel(excitation, &|s| added(s.time));
        Log::new(channels).unwrap()
    }

    fn is_of_torque(&self) -> bool {
        matches!(self, Self::Carriage(c) if matches!(c.motor, CarriageMotor::Torque { .. }))
    }

    /// Motion of the load per force on it at these whole frequencies (Hz), as complex amplitudes over 2 s: with the
    /// forces (N each) less without them.
    pub fn answers_to_forces(&self, slide: &Slide, forced: &[f64], size: f64) -> Vec<[f64; 2]> {
        let force = |t: f64| -> f64 { tones(forced, size, t) };
        let pushed = self.run(&slide.motion(), false, |t| Push {
            force: if t > 1.0 { force(t) } else { 0.0 },
            ..Push::default()
        });
        let free = self.run(&slide.motion(), false, |_| Push::default());
        let (from, count) = self.window();
        let of = |f: &f64| {
            let moved = |k: usize| pushed[k].position - free[k].position;
            let [a, b] = amplitude(&pushed, from..from + count, *f, moved);
            let by = |k: usize| force(pushed[k].time);
            let [c, d] = amplitude(&pushed, from..from + count, *f, by);
            let square = c * c + d * d;
            [(a * c + b * d) / square, (b * c - a * d) / square]
        };
        forced.iter().map(of).collect()
    }

    /// Greatest |1/(1 + L)| at these whole frequencies (Hz), the loop cut at the command (`sizes[0]`, A or N·m each) and at
    /// the position (`sizes[1]`, m each): what goes in per what is added. Infinite of a loop that runs away.
    pub fn sensitivities(&self, slide: &Slide, at: &[f64], sizes: [f64; 2]) -> [f64; 2] {
        let way = slide.speed * SWEPT;
        let motion = Motion::from(slide.from).rest(0.1).by(way, slide.speed, 0.1);
        let free = self.run(&motion, false, |_| Push::default());
        [Cut::Command, Cut::Position].map(|cut| {
            let added = |t: f64| match t > 0.5 {
                true => tones(at, sizes[cut as usize], t),
                false => 0.0,
            };
            let pushed = self.run(&motion, false, |t| match cut {
                Cut::Command => Push {
                    current: added(t),
                    ..Push::default()
                },
                Cut::Position => Push {
                    position: added(t),
                    ..Push::default()
                },
            });
            self.greatest_in(cut, [&pushed, &free], at, added)
        })
    }

    fn greatest_in(
        &self,
        cut: Cut,
        [pushed, free]: [&[Seen]; 2],
        at: &[f64],
        added: impl Fn(f64) -> f64,
    ) -> f64 {
        let from_motor = matches!(self, Self::Carriage(c) if c.control.from_motor);
        let read = |s: &Seen| {
            if from_motor {
                self.travel() * s.angle
            } else {
                s.position
            }
        };
        // A second, a second and a half after the sines began.
        let of = |time: f64| (time / self.period()).round() as usize;
        let window = of(2.0)..of(3.0);
        let one = |f: &f64| {
            let goes_in = |k: usize| match cut {
                Cut::Command => pushed[k].command - free[k].command,
                Cut::Position => read(&pushed[k]) - read(&free[k]) + added(pushed[k].time),
            };
            let [a, b] = amplitude(pushed, window.clone(), *f, goes_in);
            let [c, d] = amplitude(pushed, window.clone(), *f, |k| added(pushed[k].time));
            a.hypot(b) / c.hypot(d)
        };
        let above = |most: f64, one: f64| match one.is_nan() {
            true => f64::INFINITY,
            false => most.max(one),
        };
        at.iter().map(one).fold(0.0, above)
    }

    /// Samples of 2 s from 4 s on.
    fn window(&self) -> (usize, usize) {
        let of = |time: f64| (time / self.period()).round() as usize;
        (of(4.0), of(2.0))
    }
}

/// Where a loop is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cut {
    Command = 0,
    Position = 1,
}

/// Sines of one size whose phases are apart, or all crests come together.
fn tones(at: &[f64], size: f64, t: f64) -> f64 {
    let n = at.len() as f64;
    let of = |(i, f): (usize, &f64)| (TAU * f * t - PI * (i * i) as f64 / n).cos();
    size * at.iter().enumerate().map(of).sum::<f64>()
}

fn amplitude(
    all: &[Seen],
    window: std::ops::Range<usize>,
    f: f64,
    of: impl Fn(usize) -> f64,
) -> [f64; 2] {
    let (mut re, mut im) = (0.0, 0.0);
    for k in window {
        let angle = TAU * f * all[k].time;
        re += of(k) * angle.cos();
        im -= of(k) * angle.sin();
    }
    [re, im]
}

pub fn screw(p: &Parameters, late: usize) -> Machine {
    Machine::Screw(*p, late)
}

/// The rack of `data/axes/rack.toml`.
pub fn rack() -> Carriage {
    // Half the pinion's diameter, m.
    let radius = 31.831e-3;
    let gearbox = 2.4e5 / (radius * radius);
    Carriage {
        travel: radius / 10.0,
        motor_inertia: 0.0035 + 6e-4,
        mass: 300.0,
        transmission: Transmission::Spring(1.0 / (1.0 / gearbox + 1.0 / 150e6)),
        damping: 20e-6,
        coulomb: 90.0,
        viscous: 300.0,
        motor: CarriageMotor::Torque {
            bandwidth: 800.0,
            limit: 40.0,
        },
        control: CarriageControl {
            period: 125e-6,
            position_every: 2,
            from_motor: false,
            kv: 1000.0 / 60.0,
            speed: [1.0, 40.0],
            late: 0,
        },
        // 0.3″.
        read_in_steps: [1e-7, 0.3 / 3600.0 * PI / 180.0],
        one_sensor: false,
    }
}

/// The slide of `data/axes/linear-motor.toml`.
pub fn linear_motor() -> Carriage {
    Carriage {
        travel: 1.0,
        motor_inertia: 0.0,
        mass: 40.0,
        transmission: Transmission::Rigid,
        damping: 0.0,
        coulomb: 25.0,
        viscous: 50.0,
        motor: CarriageMotor::Current {
            constant: 93.0,
            pole_pairs: PI / 12e-3,
            resistance: 2.5,
            inductance: 18e-3,
            gains: [90.0, 12500.0],
            limit: 16.0,
            dc_link: 540.0,
        },
        control: CarriageControl {
            period: 1e-4,
            position_every: 1,
            from_motor: false,
            kv: 5000.0 / 60.0,
            speed: [180.0, 18000.0],
            late: 0,
        },
        read_in_steps: [5e-9, 0.0],
        one_sensor: true,
    }
}

/// The belt of `data/axes/belt.toml`; its load is read by a scale, as for a measurement.
pub fn belt() -> Carriage {
    Carriage {
        travel: 31.831e-3 / 5.0,
        motor_inertia: 1.8e-4 + 6e-4 / 25.0,
        mass: 12.0,
        transmission: Transmission::Belt {
            specific: 632_500.0,
            at_zero: 0.3,
            together: 2.6,
        },
        damping: 1e-4,
        coulomb: 25.0,
        viscous: 30.0,
        motor: CarriageMotor::Current {
            constant: 0.7,
            pole_pairs: 4.0,
            resistance: 1.5,
            inductance: 8e-3,
            gains: [30.0, 5650.0],
            limit: 15.0,
            dc_link: 540.0,
        },
        control: CarriageControl {
            period: 125e-6,
            position_every: 1,
            from_motor: true,
            kv: 12.0,
            speed: [0.1143, 0.1143 / 0.030],
            late: 0,
        },
        // 14 bits of a third of a turn.
        read_in_steps: [1e-7, TAU / 3.0 / 16384.0],
        one_sensor: false,
    }
}
