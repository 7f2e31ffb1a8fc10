//! Margins of an open loop that is known on lines.

use std::f64::consts::{PI, TAU};

use axis_fourier::Complex;

use crate::error::ResponseError;

/// An open loop L on one line: stable with negative feedback where it keeps clear of −1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LoopLine {
    /// Hz.
    pub frequency_hz: f64,
    /// L.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::complex"))]
    pub value: Complex<f64>,
    /// Standard deviation of its error in each direction of the complex plane.
    pub deviation: f64,
}

/// The maximum sensitivity, 1/|1 + L|.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SensitivityPeak {
    /// Its height.
    pub value: f64,
    /// Standard deviation of that: |S|² times that of L, as dS = −S² dL. The greatest of many lines
    /// that each err is too high in the mean, by about this where several are near it.
    pub deviation: f64,
    /// Its line, Hz.
    pub frequency_hz: f64,
}

/// Margins of a loop on lines; between them L goes in straight lines of the complex plane.
///
/// They mean what margins do where the loop is stable, which lines from a machine that runs show: it
/// does so with its present gains. With others, Nyquist's criterion has to be asked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LoopMargins {
    /// Maximum sensitivity on the lines.
    pub sensitivity: SensitivityPeak,
    /// Factor by which the gain may rise, above 1; none without a crossing there.
    pub gain_up: Option<f64>,
    /// Factor by which the gain may fall, below 1.
    pub gain_down: Option<f64>,
    /// Least phase margin of all crossings of gain 1, rad.
    pub phase: Option<f64>,
    /// Delay that the loop takes: the least of phase over frequency of all crossings, s.
    pub delay_s: Option<f64>,
    /// Highest frequency at which the gain is 1, Hz.
    pub crossover_hz: Option<f64>,
}

impl LoopMargins {
    /// Of lines from low to high frequency.
    ///
    /// # Errors
    /// [`ResponseError`] for less than two lines, or one that is no number.
    pub fn of(lines: &[LoopLine]) -> Result<Self, ResponseError> {
        if lines.len() < 2 {
            let (found, wanted) = (lines.len(), 2);
            return Err(ResponseError::TooFewLines { found, wanted });
        }
        let mut peak = SensitivityPeak {
            value: 0.0,
            deviation: 0.0,
            frequency_hz: 0.0,
        };
        for (index, line) in lines.iter().enumerate() {
            let sum = line.value.norm() + line.deviation + line.frequency_hz;
            if !sum.is_finite() {
                let (signal, value) = ("open loop", sum);
                return Err(ResponseError::NotFinite {
                    signal,
                    index,
                    value,
                });
            }
            let size = 1.0 / (line.value + 1.0).norm();
            if size > peak.value {
                peak = SensitivityPeak {
                    value: size,
                    deviation: size * size * line.deviation,
                    frequency_hz: line.frequency_hz,
                };
            }
        }
        let mut found = Self {
            sensitivity: peak,
            gain_up: None,
            gain_down: None,
            phase: None,
            delay_s: None,
            crossover_hz: None,
        };
        lines.windows(2).for_each(|pair| found.cross(pair));
        Ok(found)
    }

    /// What the straight line between two neighbours crosses.
    fn cross(&mut self, pair: &[LoopLine]) {
        let [a, b] = [pair[0].value, pair[1].value];
        let least = |of: &mut Option<f64>, value: f64| {
            *of = Some(of.map_or(value, |before| before.min(value)));
        };
        // The negative real axis.
        if (a.im < 0.0) != (b.im < 0.0) {
            let at = a.re + (b.re - a.re) * a.im / (a.im - b.im);
            if at < 0.0 {
                let factor = -1.0 / at;
                match factor > 1.0 {
                    true => least(&mut self.gain_up, factor),
                    false => {
                        self.gain_down = Some(self.gain_down.map_or(factor, |f| f.max(factor)));
                    }
                }
            }
        }
        // The unit circle: |a + t (b − a)|² = 1.
        if (a.norm() < 1.0) != (b.norm() < 1.0) {
            let d = b - a;
            let half = (a.conj() * d).re / d.norm_sqr();
            let rest = (a.norm_sqr() - 1.0) / d.norm_sqr();
            let root = (half * half - rest).max(0.0).sqrt();
            let inside = |t: &f64| (0.0..=1.0).contains(t);
            let t = [-half - root, -half + root]
                .into_iter()
                .find(inside)
                .unwrap_or(0.5);
            let frequency =
                pair[0].frequency_hz + t * (pair[1].frequency_hz - pair[0].frequency_hz);
            let lead = (-(a + d * t)).arg();
            least(&mut self.phase, lead.abs());
            let turn = if lead < 0.0 { lead + TAU } else { lead };
            least(&mut self.delay_s, turn / (TAU * frequency));
            self.crossover_hz = Some(frequency);
        }
    }

    /// Least phase margin, degrees.
    #[must_use]
    pub fn phase_deg(&self) -> Option<f64> {
        self.phase.map(|phase| phase * 180.0 / PI)
    }
}
