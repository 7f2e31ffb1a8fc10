//! The model at the place of a measurement.

use std::f64::consts::TAU;

use axis_sim::Axis;
use frequency_response::FrequencyResponse;

use crate::error::LoopError;
use crate::law::{LoopAt, LoopGains};
use crate::loops::{CornerLoop, hertz};
use crate::plant::{Corner, LoopModel, Number, PlantAt, modes_at};

/// The model's loop at the place of a measurement, the load sliding.
pub(crate) struct ModelAt {
    pub model: LoopModel,
    pub corner: CornerLoop,
    pub gains: LoopGains,
    /// Elastic modes below half the sampling rate, Hz.
    pub modes_hz: Vec<f64>,
}

impl ModelAt {
    pub fn new(axis: &Axis, position: f64) -> Result<Self, LoopError> {
        let model = LoopModel::new(axis)?;
        let modes = modes_at(axis, position)?;
        let at = Corner {
            position,
            mass: 1.0,
            friction: 1.0,
            stuck: false,
        };
        let corner = CornerLoop::new(&model, &modes, &at);
        let cascade = model.cascade();
        let gains = LoopGains {
            speed: cascade.speed,
            integral: cascade.speed_integral,
            position: cascade.position,
        };
        let top = 0.5 / axis.period;
        let modes = modes.iter().map(|mode| hertz(mode.frequency));
        Ok(Self {
            modes_hz: modes.filter(|f| (1e-3..top).contains(f)).collect(),
            model,
            corner,
            gains,
        })
    }

    /// Maximum sensitivity of the model cut at the command; none where it is not stable.
    pub fn sensitivity(&self) -> Option<f64> {
        let margins = self.corner.margins(&self.model, &self.gains);
        margins.command.sensitivity
    }

    /// The drive's response at a frequency, Hz.
    pub fn plant(&self, frequency_hz: f64) -> Option<PlantAt> {
        self.corner.plant(TAU * frequency_hz)
    }

    /// Responses as sensors show them: motor's angle and speed, load's position.
    pub fn shown(&self, frequency_hz: f64) -> Option<[Number; 3]> {
        let plant = self.plant(frequency_hz)?;
        Some(crate::law::shown(&self.model, &plant))
    }

    /// The motor's speed of those on the lines of a response, as real and imaginary parts.
    pub fn speeds(&self, lines: &FrequencyResponse) -> Vec<[f64; 2]> {
        let zero = Number::new(0.0, 0.0);
        let of = |hz: f64| self.shown(hz).map_or(zero, |all| all[1]);
        let all = lines.lines.iter().map(|line| of(line.frequency_hz));
        all.map(|speed| [speed.re, speed.im]).collect()
    }

    /// Magnitude of the filters and the hold that the excitation passes on its way to the command.
    pub fn passed(&self, frequency_hz: f64) -> Option<f64> {
        let plant = self.plant(frequency_hz)?;
        let magnitude = LoopAt::new(&self.model, &plant).passed.norm();
        (magnitude > 1e-6).then_some(magnitude)
    }

    /// Frequency of the first antiresonance of the motor's speed, Hz: where, times the frequency, it
    /// has its first least; none of a rigid machine.
    pub fn antiresonance_hz(&self) -> Option<f64> {
        let first = self.modes_hz.first()?;
        let at = |i: usize| first * (i as f64 / 400.0);
        let height = |i: usize| self.plant(at(i)).map(|p| p.command[1].norm() * at(i));
        (20..400)
            .filter_map(|i| Some((height(i - 1)?, height(i)?, height(i + 1)?, i)))
            .find(|(a, b, c, _)| b < a && b <= c)
            .map(|(.., i)| at(i))
    }
}
