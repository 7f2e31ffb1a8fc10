//! Motions: the paper's S-curve, and moves with polynomial ramps, rests and a chirp.

use std::f64::consts::TAU;

/// Reference at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// m.
    pub position: f64,
    /// m/s.
    pub velocity: f64,
}

/// One motion after another.
#[derive(Clone, Debug)]
pub struct Motion {
    start: f64,
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
enum Part {
    Rest(f64),
    Move(SmoothMove),
    Chirp(Chirp),
    /// Jerks with the time that each lasts.
    Jerks(Vec<[f64; 2]>),
}

/// A move whose speed comes up and goes down by 10τ³ − 15τ⁴ + 6τ⁵.
#[derive(Clone, Copy, Debug)]
pub struct SmoothMove {
    /// By how much, m.
    pub by: f64,
    /// At which speed, m/s, above 0.
    pub speed: f64,
    /// Time of each ramp, s.
    pub ramp: f64,
}

impl SmoothMove {
    /// Time at full speed, s. A move too short for its ramps has none, and less speed.
    fn cruise(&self) -> f64 {
        (self.by.abs() / self.speed - self.ramp).max(0.0)
    }

    fn duration(&self) -> f64 {
        2.0 * self.ramp + self.cruise()
    }

    fn at(&self, t: f64) -> [f64; 2] {
        let speed = self.by / (self.cruise() + self.ramp);
        let up = |t: f64| {
            let u = (t / self.ramp).clamp(0.0, 1.0);
            let way = u.powi(4) * (2.5 + u * (u - 3.0));
            [way * self.ramp, u.powi(3) * (10.0 + u * (6.0 * u - 15.0))]
        };
        let cruised = (t - self.ramp).clamp(0.0, self.cruise());
        let end = up(self.duration() - t);
        if t < self.ramp + self.cruise() {
            let [way, share] = up(t);
            [speed * (way + cruised), speed * share]
        } else {
            [self.by - speed * end[0], speed * end[1]]
        }
    }
}

/// amplitude · w(t) · sin(phase), the frequency rising linearly, w smooth at both ends.
#[derive(Clone, Copy, Debug)]
pub struct Chirp {
    /// m.
    pub amplitude: f64,
    /// Hz, at the beginning and in the end.
    pub frequency: [f64; 2],
    /// s.
    pub duration: f64,
}

/// Time over which a chirp comes up and fades, s.
const FADE: f64 = 0.12;

impl Chirp {
    fn at(&self, t: f64) -> [f64; 2] {
        let [low, high] = self.frequency;
        let rise = (high - low) / self.duration;
        let (sin, cos) = (TAU * t * (low + 0.5 * rise * t)).sin_cos();
        let rate = TAU * (low + rise * t);
        let fade = |t: f64| {
            let u = (t / FADE).clamp(0.0, 1.0);
            [
                u.powi(3) * (10.0 + u * (6.0 * u - 15.0)),
                30.0 * u * u * (1.0 - u) * (1.0 - u) / FADE,
            ]
        };
        let ([a, da], [b, db]) = (fade(t), fade(self.duration - t));
        let amplitude = self.amplitude;
        [
            amplitude * a * b * sin,
            amplitude * (a * b * rate * cos + (da * b - a * db) * sin),
        ]
    }
}

impl Part {
    fn duration(&self) -> f64 {
        match self {
            Self::Rest(time) => *time,
            Self::Move(m) => m.duration(),
            Self::Chirp(c) => c.duration,
            Self::Jerks(jerks) => jerks.iter().map(|j| j[1]).sum(),
        }
    }

    /// Way and speed since its start.
    fn at(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Rest(_) => [0.0; 2],
            Self::Move(m) => m.at(t),
            Self::Chirp(c) => c.at(t),
            Self::Jerks(jerks) => {
                let (mut left, mut x, mut v, mut a) = (t, 0.0, 0.0, 0.0);
                for &[jerk, time] in jerks {
                    let h = left.min(time);
                    x += h * (v + h * (a / 2.0 + h * jerk / 6.0));
                    v += h * (a + h * jerk / 2.0);
                    a += h * jerk;
                    left -= h;
                }
                [x, v]
            }
        }
    }
}

impl Motion {
    /// Nothing yet, at a place, m.
    pub fn from(start: f64) -> Self {
        Self {
            start,
            parts: Vec::new(),
        }
    }

    /// Then a rest, s.
    pub fn rest(mut self, time: f64) -> Self {
        self.parts.push(Part::Rest(time));
        self
    }

    /// Then a move by so many m at so many m/s, with ramps of so many s.
    pub fn by(mut self, by: f64, speed: f64, ramp: f64) -> Self {
        self.parts.push(Part::Move(SmoothMove { by, speed, ramp }));
        self
    }

    /// Then a chirp of 2 to 90 Hz.
    pub fn chirp(mut self, amplitude: f64, duration: f64) -> Self {
        self.parts.push(Part::Chirp(Chirp {
            amplitude,
            frequency: [2.0, 90.0],
            duration,
        }));
        self
    }

    /// Then a move of seven constant jerks: displacement, greatest speed, acceleration and jerk, SI,
    /// each of which it reaches.
    pub fn jerks(mut self, [way, speed, acceleration, jerk]: [f64; 4]) -> Self {
        let short = acceleration / jerk;
        let even = speed / acceleration - short;
        let cruise = way.abs() / speed - speed / acceleration - short;
        let signs = [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0];
        let times = [short, even, short, cruise, short, even, short];
        let jerk = jerk.copysign(way);
        let jerks = signs.into_iter().zip(times).map(|(s, t)| [s * jerk, t]);
        self.parts.push(Part::Jerks(jerks.collect()));
        self
    }

    /// s.
    pub fn duration(&self) -> f64 {
        self.parts.iter().map(Part::duration).sum()
    }

    /// Where it begins, m.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The reference at time `t` since the beginning.
    pub fn at(&self, t: f64) -> Setpoint {
        let (mut left, mut position) = (t.max(0.0), self.start);
        for part in &self.parts {
            let duration = part.duration();
            if left < duration {
                let [way, velocity] = part.at(left);
                return Setpoint {
                    position: position + way,
                    velocity,
                };
            }
            position += part.at(duration)[0];
            left -= duration;
        }
        Setpoint {
            position,
            velocity: 0.0,
        }
    }
}

/// The paper's S-curve from 0.6 m on: way, greatest speed, acceleration and jerk, SI, each
/// of which it reaches.
pub fn s_curve(of: [f64; 4]) -> Motion {
    Motion::from(0.6).jerks(of)
}

/// Two motions to fit to and two to check on, each with its name. None stays between 3 and
/// 7 mm/s, where the axis vibrates by itself.
pub fn exercises() -> [(&'static str, Motion); 4] {
    let fit_1 = Motion::from(0.6)
        .rest(0.3)
        .by(0.2, 0.1, 0.4)
        .rest(0.25)
        .by(-0.2, 0.15, 0.5)
        .rest(0.25)
        .chirp(30e-6, 2.5)
        .rest(0.25)
        .by(0.02, 0.012, 0.15)
        .rest(0.2);
    let fit_2 = Motion::from(0.6)
        .rest(0.3)
        .by(0.26, 0.25, 0.6)
        .rest(0.25)
        .by(-0.26, 0.2, 0.5)
        .rest(0.2)
        .by(0.06, 0.03, 0.2)
        .rest(0.2)
        .by(-0.05, 0.05, 0.25)
        .rest(0.2)
        .by(-0.01, 0.01, 0.15)
        .rest(0.3);
    let check_1 = Motion::from(0.55)
        .rest(0.25)
        .by(0.24, 0.12, 0.45)
        .rest(0.2)
        .by(-0.15, 0.08, 0.35)
        .rest(0.2)
        .chirp(25e-6, 2.2)
        .rest(0.2)
        .by(-0.03, 0.02, 0.2)
        .rest(0.25);
    let check_2 = Motion::from(0.82)
        .rest(0.25)
        .by(-0.22, 0.18, 0.5)
        .rest(0.2)
        .by(0.07, 0.04, 0.25)
        .rest(0.25)
        .by(0.12, 0.22, 0.45)
        .rest(0.2)
        .by(-0.015, 0.015, 0.15)
        .rest(0.25);
    [
        ("fit-1", fit_1),
        ("fit-2", fit_2),
        ("check-1", check_1),
        ("check-2", check_2),
    ]
}
