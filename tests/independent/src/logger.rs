//! What a logger makes of the drive's readings: a table at 1 kHz, with noise of its own.

use crate::random::Random;
use crate::run::Sample;

/// Control periods from one sample of a log to the next: 1 kHz.
const EVERY: usize = 10;

/// What the logger alone adds; the controllers do not see it. The default adds nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Logger {
    /// Standard deviation on the position, m.
    pub position: f64,
    /// On the q current, A.
    pub current: f64,
    /// Share of the last sample's noise in the next one's, 0 (white) to below 1.
    pub colour: f64,
    /// Steps of the position, m; none if 0.
    pub position_step: f64,
    /// Steps of the q current, A; none if 0.
    pub current_step: f64,
    /// Share of the q current's samples that are outliers.
    pub outliers: f64,
    /// Their standard deviation, A.
    pub outlier_size: f64,
}

impl Logger {
    /// 50 nm on the position and 20 mA on the q current.
    pub const NOISY: Self = Self {
        position: 50e-9,
        current: 20e-3,
        colour: 0.0,
        position_step: 0.0,
        current_step: 0.0,
        outliers: 0.0,
        outlier_size: 0.0,
    };
}

/// Noise whose neighbours are alike, with a standard deviation of 1.
struct Coloured {
    share: f64,
    last: f64,
}

impl Coloured {
    fn new(share: f64, random: &mut Random) -> Self {
        let last = random.normal();
        Self { share, last }
    }

    fn next(&mut self, random: &mut Random) -> f64 {
        let fresh = (1.0 - self.share * self.share).sqrt();
        self.last = self.share * self.last + fresh * random.normal();
        self.last
    }
}

/// Which columns a log has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// All that the library compares, and the reference velocity.
    All,
    /// Time, reference, position and q current.
    Few,
}

/// A log: columns by name, as text with as many digits as they hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Names with their units, as the library has them.
    pub names: Vec<&'static str>,
    /// A row a sample.
    pub rows: Vec<Vec<f64>>,
}

const NAMES: [&str; 9] = [
    "t_s",
    "position_ref_m",
    "velocity_ref_m_s",
    "position_m",
    "motor_angle_rad",
    "iq_ref_a",
    "iq_a",
    "ud_v",
    "uq_v",
];
const FEW: [&str; 4] = ["t_s", "position_ref_m", "position_m", "iq_a"];

impl Logger {
    /// The log of all samples of a run.
    pub fn log(&self, samples: &[Sample], columns: Columns, random: &mut Random) -> Table {
        let mut noise = [self.colour; 2].map(|share| Coloured::new(share, random));
        let kept: Vec<usize> = match columns {
            Columns::All => (0..NAMES.len()).collect(),
            Columns::Few => (0..NAMES.len())
                .filter(|&i| FEW.contains(&NAMES[i]))
                .collect(),
        };
        let row = |sample: &Sample| {
            let position = sample.seen.position + self.position * noise[0].next(random);
            let mut current = sample.seen.current[1] + self.current * noise[1].next(random);
            if random.uniform() < self.outliers {
                current += self.outlier_size * random.normal();
            }
            let all = [
                sample.time,
                sample.wanted.position,
                sample.wanted.velocity,
                stepped(position, self.position_step),
                sample.seen.angle,
                sample.command.current,
                stepped(current, self.current_step),
                sample.command.voltage[0],
                sample.command.voltage[1],
            ];
            kept.iter().map(|&i| all[i]).collect()
        };
        Table {
            names: kept.iter().map(|&i| NAMES[i]).collect(),
            rows: samples.iter().step_by(EVERY).map(row).collect(),
        }
    }
}

/// A value in whole steps.
fn stepped(value: f64, step: f64) -> f64 {
    match step > 0.0 {
        true => (value / step).round() * step,
        false => value,
    }
}
