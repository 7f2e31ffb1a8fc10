//! What can be told of a channel alone, and against another.

use std::fmt;

use super::hold::{Hold, Saturation, hold, saturation};
use super::jitter::{SampleJitter, sample_jitter};
use super::noise::{ChannelNoise, Colour, noise};
use super::outliers::outliers;
use super::quantum::{Quantum, quantum};
use crate::log::Log;
use crate::numeric::align::{Free, align};
use crate::numeric::grid::Grid;
use crate::plus_minus::PlusMinus;

/// How a log is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Sampling period, s.
    pub period: f64,
    /// Greatest distance of an instant from the even grid, in periods.
    pub jitter: f64,
    /// The same, RMS.
    pub jitter_rms: f64,
    /// Rows that are missing between time stamps.
    pub missing_rows: usize,
}

/// The clock of a log; `None` of a single instant.
pub fn clock(log: &Log) -> Option<Clock> {
    let grid = Grid::of(log.time())?;
    Some(Clock {
        period: grid.period,
        jitter: grid.jitter[0],
        jitter_rms: grid.jitter[1],
        missing_rows: grid.length() - log.len(),
    })
}

/// By how much a channel is late.
#[derive(Debug, Clone, PartialEq)]
pub struct Delay {
    /// The channel that it is late against.
    pub against: String,
    /// s; negative where early.
    pub seconds: f64,
    /// s.
    pub standard_error: f64,
    /// Correlation of the two at that delay.
    pub correlation: f64,
}

/// What can be told of a channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelQuality {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Samples marked as missing, and of the longest run of them.
    pub missing: [usize; 2],
    /// Isolated outliers that are still in it.
    pub outliers: usize,
    /// Its quantisation.
    pub quantum: Option<Quantum>,
    /// Sample-and-hold.
    pub hold: Option<Hold>,
    /// Limits that it runs into.
    pub saturation: Vec<Saturation>,
    /// Noise.
    pub noise: Option<ChannelNoise>,
    /// Frequency in Hz from which on its spectrum falls off as behind a filter.
    pub corner: Option<f64>,
    /// How far its samples are off the time stamps, where it is a position or an angle that tells.
    pub jitter: Option<SampleJitter>,
    /// Its delay against another channel, where one was given and they correlate.
    pub delay: Option<Delay>,
}

/// Judges a channel of a log, and its delay against another where one is named.
///
/// In logs of many samples some figures are taken from a part: the quantum from 2.6 · 10⁵
/// samples, the delay from the 65 536 in which the channel moves most, the spectrum from 512
/// segments. Needs 16 bytes a sample beside the log. Samples marked as missing are judged
/// as they stand there. A delay of up to a tenth of a second is looked for.
///
/// # Errors
/// [`LogError::MissingChannel`](crate::LogError::MissingChannel).
pub fn channel_quality(
    log: &Log,
    name: &str,
    against: Option<&str>,
) -> Result<ChannelQuality, crate::LogError> {
    let x = log.channel(name)?;
    let period = clock(log).map_or(1.0, |c| c.period);
    let quantum = quantum(x);
    let (noise, corner) = noise(x, period);
    let missing = log.missing(name);
    let delay = match against {
        Some(other) => delay(log.channel(other)?, x, period, other),
        None => None,
    };
    Ok(ChannelQuality {
        name: name.to_owned(),
        unit: crate::unit_of(name).unwrap_or_default().to_owned(),
        range: (x.iter()).fold([f64::MAX, f64::MIN], |[a, b], v| [a.min(*v), b.max(*v)]),
        missing: [
            missing.iter().map(std::ops::Range::len).sum(),
            missing.iter().map(std::ops::Range::len).max().unwrap_or(0),
        ],
        outliers: outliers(x).len(),
        hold: hold(x, period, quantum.map_or(0.0, |q| q.step)),
        quantum,
        saturation: saturation(x),
        jitter: match crate::unit_of(name) {
            Some("m" | "mm" | "µm" | "rad" | "°" | "rev") => sample_jitter(log, name),
            _ => None,
        },
        noise,
        corner,
        delay,
    })
}

/// Longest delay that is looked for, s.
const LONGEST: f64 = 0.1;
/// Correlation below which there is none.
const SURE: f64 = 0.9;

fn delay(reference: &[f64], x: &[f64], period: f64, against: &str) -> Option<Delay> {
    let most = ((LONGEST / period).round() as usize).max(2);
    let free = Free {
        delay: Some(most),
        drift: false,
    };
    let fit = align(reference, x, free).filter(|fit| fit.correlation > SURE)?;
    Some(Delay {
        against: against.to_owned(),
        seconds: fit.delay * period,
        standard_error: fit.delay_error * period,
        correlation: fit.correlation,
    })
}

impl fmt::Display for ChannelQuality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = &self.unit;
        write!(
            f,
            "{}: {:.6e} to {:.6e} {unit}",
            self.name, self.range[0], self.range[1]
        )?;
        if self.missing[0] > 0 {
            write!(
                f,
                "; {} missing, at most {} in a row",
                self.missing[0], self.missing[1]
            )?;
        }
        if self.outliers > 0 {
            write!(f, "; {} outliers", self.outliers)?;
        }
        if let Some(q) = self.quantum {
            write!(
                f,
                "; steps of {:.4e} {unit} ({:.1} % on them)",
                q.step,
                100.0 * q.on_grid
            )?;
        }
        if let Some(h) = self.hold {
            write!(
                f,
                "; held for {:.4} ms ({:.0} % repeated)",
                1e3 * h.period,
                100.0 * h.repeated
            )?;
        }
        for s in &self.saturation {
            write!(
                f,
                "; stays at {:.6e} {unit} ({:.1} %)",
                s.value,
                100.0 * s.share
            )?;
        }
        if let Some(n) = self.noise {
            write!(f, "; noise {:.3e} {unit}, {}", n.level, n.colour)?;
        }
        if let Some(corner) = self.corner {
            write!(f, "; filtered from {corner:.0} Hz on")?;
        }
        if let Some(jitter) = self.jitter {
            write!(
                f,
                "; samples jitter under even stamps by {} % of a period ({:.2} us)",
                PlusMinus::new(
                    100.0 * jitter.share,
                    100.0 * jitter.share * jitter.standard_error / jitter.rms,
                    2
                ),
                1e6 * jitter.rms
            )?;
        }
        match &self.delay {
            Some(d) => write!(
                f,
                "; {} ms behind {}",
                PlusMinus::new(1e3 * d.seconds, 1e3 * d.standard_error, 4),
                d.against
            ),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::White => "white",
            Self::Falling => "falling with frequency",
            Self::Rising => "rising with frequency",
        })
    }
}
