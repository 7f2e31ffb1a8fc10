//! A drive that is known on measured lines, in the model's place.

use std::f64::consts::TAU;

use crate::plant::Number;

/// Responses from the command on one line, as the sensors show them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlantLine {
    /// Hz.
    pub frequency_hz: f64,
    /// Motor's angle and speed, load's position.
    pub command: [Number; 3],
    /// Standard deviations of their errors in each direction.
    pub deviation: [f64; 3],
}

/// A measured response in the model's place, for limits of the sensitivity: where its coherence is high
/// enough it is the drive, outside that the model is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredPlant {
    /// Position of the load, m or rad.
    pub(crate) position: f64,
    pub(crate) lines: Vec<PlantLine>,
}

impl MeasuredPlant {
    /// First and last line, Hz.
    pub fn band_hz(&self) -> Option<[f64; 2]> {
        Some([
            self.lines.first()?.frequency_hz,
            self.lines.last()?.frequency_hz,
        ])
    }

    /// At an angular frequency (rad/s) between its lines: straight in phase and logarithm of the magnitude.
    pub(crate) fn at(&self, frequency: f64) -> Option<[Number; 3]> {
        let hz = frequency / TAU;
        let above = self.lines.partition_point(|line| line.frequency_hz < hz);
        let high = self.lines.get(above)?;
        if high.frequency_hz == hz {
            return Some(high.command);
        }
        let low = self.lines.get(above.checked_sub(1)?)?;
        let part = (hz - low.frequency_hz) / (high.frequency_hz - low.frequency_hz);
        let between = |which: usize| {
            let ratio = high.command[which] / low.command[which];
            low.command[which] * Number::from_polar(ratio.norm().powf(part), ratio.arg() * part)
        };
        let all = [0, 1, 2].map(between);
        all.iter()
            .all(|c| c.re.is_finite() && c.im.is_finite())
            .then_some(all)
    }
}
