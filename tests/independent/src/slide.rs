//! A slide on a linear motor, whose drive may have more in it than its axis file says.
//!
//! The values are those of `data/axes/linear-motor.toml`. What differs on purpose from the library:
//! steps of 10 µs by symplectic Euler, the current as a low pass of its reference, dry friction
//! with the onset tanh(v / 0.3 mm/s), and a scale whose error has a phase of its own. The drive may
//! low-pass its speed and command a cycle late.
//!
//! ```text
//! 40 kg y'' = 93 N/A i − 25 N tanh(y' / 0.3 mm/s) − 50 N·s/m y' − hidden(y, y')
//! i' = 2π 800 Hz (i_ref − i)
//! i_ref = 180 A·s/m (e + ∫ e dt / 10 ms),   e = 83.3 1/s (r − y) + r' − v
//! ```

use std::f64::consts::TAU;

use crate::logger::Table;
use crate::motion::Motion;
use crate::random::Random;

/// Control period, s.
const PERIOD: f64 = 1e-4;
/// Steps of the machine in a control period.
const STEPS: u32 = 10;
/// Control periods from one sample of a log to the next: 2 kHz.
const EVERY: usize = 5;

const MASS: f64 = 40.0;
const FORCE_CONSTANT: f64 = 93.0;
const COULOMB: f64 = 25.0;
const VISCOUS: f64 = 50.0;
const CURRENT_LOOP_HZ: f64 = 800.0;
const CURRENT_LIMIT: f64 = 16.0;
const KV: f64 = 5000.0 / 60.0;
const SPEED_GAIN: f64 = 180.0;
const INTEGRAL_TIME: f64 = 0.010;
/// Noise of the current sensor, A.
const CURRENT_NOISE: f64 = 4e-3;

/// What the drive has beside what its file says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlideDrive {
    /// Corner of a low pass of first order on the speed, Hz.
    pub speed_lowpass: Option<f64>,
    /// Whether the current's reference acts a control period late.
    pub late: bool,
}

impl SlideDrive {
    /// A low pass at 500 Hz, and a command that is late.
    pub const OTHER: Self = Self {
        speed_lowpass: Some(500.0),
        late: true,
    };
}

/// Forces against positive motion that the axis file does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlideHidden {
    /// Amplitude (N), length of a period (m) and phase (rad) of a ripple over the position.
    pub ripple: [f64; 3],
    /// A cable chain's pull, N/m, from 0.1 m on.
    pub cable: f64,
    /// Drag by the square of the speed, N·s²/m².
    pub drag: f64,
    /// Force (N) that turns at a place (m) along the way, over a width (m).
    pub edge: [f64; 3],
    /// Force that grows with the square of the way from a place (N/m², m).
    pub bend: [f64; 2],
}

/// What may be hidden in a slide, by name.
pub const SLIDE_CASES: [(&str, SlideHidden); 6] = {
    let none = SlideHidden {
        ripple: [0.0; 3],
        cable: 0.0,
        drag: 0.0,
        edge: [0.0; 3],
        bend: [0.0; 2],
    };
    // Two periods in an electrical one of 24 mm: one period would be an offset of a current sensor too.
    let ripple = [9.0, 0.012, 0.7];
    let edge = [60.0, 0.35, 0.01];
    [
        ("nothing", none),
        ("ripple", SlideHidden { ripple, ..none }),
        (
            "cable",
            SlideHidden {
                cable: 60.0,
                ..none
            },
        ),
        ("drag", SlideHidden { drag: 40.0, ..none }),
        ("edge", SlideHidden { edge, ..none }),
        (
            "bend",
            SlideHidden {
                bend: [200.0, 0.55],
                ..none
            },
        ),
    ]
};

/// The motions of a log to fit and one to check.
pub fn slide_motions() -> [Motion; 2] {
    let there = |start: f64, way: f64, speed: f64| {
        Motion::from(start)
            .rest(0.25)
            .by(way, speed, 0.08)
            .rest(0.25)
            .by(-0.7 * way, 0.3 * speed, 0.1)
            .rest(0.25)
            .by(-0.2 * way, 0.05 * speed, 0.05)
            .rest(0.25)
    };
    [there(0.1, 0.4, 1.0), there(0.55, -0.3, 0.7)]
}

impl SlideHidden {
    fn force(&self, y: f64, v: f64) -> f64 {
        let [amplitude, length, phase] = self.ripple;
        let ripple = match length > 0.0 {
            true => amplitude * (TAU * y / length + phase).sin(),
            false => 0.0,
        };
        let [turning, place, width] = self.edge;
        let edge = match width > 0.0 {
            true => turning * ((y - place) / width).tanh(),
            false => 0.0,
        };
        let [bend, from] = self.bend;
        ripple + self.cable * (y - 0.1) + self.drag * v * v.abs() + edge + bend * (y - from).powi(2)
    }
}

/// The machine and its drive on their way.
struct Slide {
    position: f64,
    speed: f64,
    current: f64,
    integral: f64,
    last_read: f64,
    speed_seen: f64,
    waiting: f64,
}

impl Slide {
    fn at(position: f64) -> Self {
        let mut slide = Self {
            position,
            speed: 0.0,
            current: 0.0,
            integral: 0.0,
            last_read: 0.0,
            speed_seen: 0.0,
            waiting: 0.0,
        };
        slide.last_read = slide.read();
        slide
    }

    /// Of the scale: steps of 5 nm, an error of 40 nm over 20 µm.
    fn read(&self) -> f64 {
        let error = 40e-9 * (TAU * self.position / 20e-6 + 1.0).sin();
        ((self.position + error) / 5e-9).round() * 5e-9
    }

    /// A control period, from what the scale reads to the reference of the current.
    fn command(&mut self, drive: &SlideDrive, wanted: f64, next: f64) -> [f64; 2] {
        let read = self.read();
        let speed = (read - self.last_read) / PERIOD;
        self.last_read = read;
        let share = drive
            .speed_lowpass
            .map_or(1.0, |corner| 1.0 - (-TAU * corner * PERIOD).exp());
        self.speed_seen += share * (speed - self.speed_seen);
        let off = KV * (wanted - read) + (next - wanted) / PERIOD - self.speed_seen;
        self.integral += SPEED_GAIN / INTEGRAL_TIME * off * PERIOD;
        let command = (SPEED_GAIN * off + self.integral).clamp(-CURRENT_LIMIT, CURRENT_LIMIT);
        [read, command]
    }

    fn run(&mut self, hidden: &SlideHidden, reference: f64) {
        let step = PERIOD / f64::from(STEPS);
        for _ in 0..STEPS {
            self.current += step * TAU * CURRENT_LOOP_HZ * (reference - self.current);
            let v = self.speed;
            let against =
                COULOMB * (v / 3e-4).tanh() + VISCOUS * v + hidden.force(self.position, v);
            self.speed += step * (FORCE_CONSTANT * self.current - against) / MASS;
            self.position += step * self.speed;
        }
    }
}

/// Names of the columns of [`slide_log`].
const NAMES: [&str; 5] = ["t_s", "position_ref_m", "position_m", "iq_a", "iq_ref_a"];

/// The log of a motion at 2 kHz: time, reference, position, current and its reference.
pub fn slide_log(
    drive: &SlideDrive,
    hidden: &SlideHidden,
    motion: &Motion,
    random: &mut Random,
) -> Table {
    let cycles = (motion.duration() / PERIOD) as usize;
    let wanted = |k: usize| motion.at(k as f64 * PERIOD).position;
    let mut slide = Slide::at(wanted(0));
    let mut rows = Vec::new();
    for k in 0..cycles {
        let [read, command] = slide.command(drive, wanted(k), wanted(k + 1));
        let current = slide.current + CURRENT_NOISE * random.normal();
        if k % EVERY == 0 {
            rows.push(vec![k as f64 * PERIOD, wanted(k), read, current, command]);
        }
        let acts = std::mem::replace(&mut slide.waiting, command);
        slide.run(hidden, if drive.late { acts } else { command });
    }
    Table {
        names: NAMES.to_vec(),
        rows,
    }
}
