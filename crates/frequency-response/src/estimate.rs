//! Estimates of a frequency response, line by line, with what they are uncertain by.
//!
//! With r the excitation, u the input (the whole command) and y the output, y = G u + v:
//!
//! ```text
//! three signals   G = S_ry/S_ru             S_ab = mean of A* B over the segments
//! H1              G = S_uy/S_uu             H2:  G = S_yy/S_yu
//! ```
//!
//! In closed loop u holds a part of the disturbance v, which came back through the controller. H1 then
//! tends to a mean of G and −1/C, weighted by the powers of excitation and disturbance, and H2 is no better. The first
//! divides two responses to r, which no disturbance correlates with: it has no bias (P. E. Wellstead,
//! Automatica 17 (1981) 55–69, doi:10.1016/0005-1098(81)90084-4; R. Pintelon, J. Schoukens, System
//! Identification: A Frequency Domain Approach, 2nd ed., Wiley 2012, chapter 2).
//!
//! Its error is S_rv/S_ru to first order. With v uncorrelated with r, E|S_rv|² = S_rr S_vv/n for n
//! independent averages, so
//!
//! ```text
//! E|Ĝ − G|² = S_vv S_rr/(n |S_ru|²)       S_vv = n/(n − 1) (S_yy + |Ĝ|² S_uu − 2 Re Ĝ* S_uy)
//! ```
//!
//! half of it in each of the two directions of the plane. H1 is the same with r = u, which gives
//! (1 − γ²)|G|²/(γ² n).

use std::f64::consts::PI;

use axis_fourier::Complex;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::error::{ResponseError, check};
use crate::segments::{Averaging, Powers, of_difference};

/// Share of the strongest line's power below which a line is not excited.
const EXCITED: f64 = 1e-9;

/// What was recorded, sampled at the same instants.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a> {
    /// Time between two samples, s.
    pub period_s: f64,
    /// What was added to the input from outside the loop; none where nothing was, or nothing is known.
    pub excitation: Option<&'a [f64]>,
    /// The whole input of what is estimated.
    pub input: &'a [f64],
    /// Its output.
    pub output: &'a [f64],
    /// Whether the output is differenced before its transform, and the line divided by (1 − z⁻¹)/T
    /// again: for outputs that run away, such as positions of what moves at constant speed.
    pub differenced: bool,
}

/// How a response is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Estimator {
    /// By the excitation: no bias in closed loop.
    #[default]
    ThreeSignals,
    /// Noise at the output alone; in closed loop biased.
    H1,
    /// Noise at the input alone; in closed loop biased.
    H2,
}

/// The response on one line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ResponseLine {
    /// Hz.
    pub frequency_hz: f64,
    /// Output per input.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::complex"))]
    pub value: Complex<f64>,
    /// Standard deviation of its error in each direction of the complex plane.
    pub deviation: f64,
    /// Share of the power that is explained, from 0 to 1: by the excitation, of the input and of the
    /// output, whichever is less; without an excitation of the output by the input. It says nothing of
    /// friction that sticks, which follows the excitation too.
    pub coherence: f64,
}

/// A frequency response with its uncertainty.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FrequencyResponse {
    /// Lines, from low to high frequency, as far as they are excited.
    pub lines: Vec<ResponseLine>,
    /// Independent averages.
    pub averages: f64,
    /// Distance of two lines, Hz.
    pub step_hz: f64,
    /// Time between two samples, s.
    pub period_s: f64,
    /// By how much the errors of neighbouring lines that go together raise the variance of what is
    /// fitted to many: 1 where they are independent. Under Hann's window the Fourier coefficients of
    /// noise are correlated by −2/3 with the next line and by 1/6 with the one after; products with
    /// those of the excitation by the squares: 1 + 2 (4/9 + 1/36) = 35/18.
    pub correlation: f64,
}

impl FrequencyResponse {
    /// Estimates one response.
    ///
    /// # Errors
    /// [`ResponseError`] where signals are not valid, too short for two segments, or constant.
    pub fn of(
        record: &Record<'_>,
        estimator: Estimator,
        averaging: Averaging,
    ) -> Result<Self, ResponseError> {
        Self::of_all(std::slice::from_ref(record), estimator, averaging)
    }

    /// Estimates one response from several records of the same machine: segments are cut within each.
    ///
    /// # Errors
    /// As [`FrequencyResponse::of`]; [`ResponseError::Setting`] where their sampling periods differ.
    pub fn of_all(
        records: &[Record<'_>],
        estimator: Estimator,
        averaging: Averaging,
    ) -> Result<Self, ResponseError> {
        let Some(first) = records.first() else {
            let (found, wanted) = (0, 2);
            return Err(ResponseError::TooShort { found, wanted });
        };
        let period_s = checked_records(records, estimator)?;
        let of_record = |record: &Record<'_>| -> Vec<f64> {
            let pairs = record.output.windows(2).filter(|_| record.differenced);
            pairs.map(|w| (w[1] - w[0]) / period_s).collect()
        };
        let differences: Vec<Vec<f64>> = records.iter().map(of_record).collect();
        let signals: Vec<[&[f64]; 3]> = records
            .iter()
            .zip(&differences)
            .map(|(record, differences)| {
                let r = excitation(record, estimator).1;
                // The first sample has no difference: it is left out of all three.
                match record.differenced {
                    true => [
                        &r[1.min(r.len())..],
                        &record.input[1.min(r.len())..],
                        differences,
                    ],
                    false => [r, record.input, record.output],
                }
            })
            .collect();
        let averaged = averaging.average(&signals)?;
        let step_hz = 1.0 / (averaged.segment as f64 * period_s);
        let n = averaged.averages;
        let powers = averaged.powers.iter().map(|p| p.rr);
        let strongest = powers.skip(averaged.lowest).fold(0.0, f64::max);
        if strongest <= 0.0 {
            return Err(ResponseError::Constant(excitation(first, estimator).0));
        }
        let mut lines = Vec::new();
        for (i, p) in averaged.powers.iter().enumerate().skip(averaged.lowest) {
            let frequency_hz = i as f64 * step_hz;
            let is_excited = p.rr > EXCITED * strongest && p.ru.norm() > 0.0;
            let mut line = line(frequency_hz, p, estimator, n);
            if first.differenced {
                let by = of_difference(frequency_hz, period_s);
                line.value /= by;
                line.deviation /= by.norm();
            }
            let sum = line.value.norm() + line.deviation;
            if is_excited && sum.is_finite() {
                lines.push(line);
            }
        }
        Ok(Self {
            lines,
            averages: n,
            step_hz,
            period_s,
            correlation: match averaging {
                Averaging::Welch { .. } => 35.0 / 18.0,
                Averaging::Periods { .. } => 1.0,
            },
        })
    }

    /// Standard deviations that a 95 % interval reaches to either side: Student's t of 2(n − 1)
    /// degrees of freedom, as the noise is estimated from n complex averages.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let freedom = (2.0 * (self.averages - 1.0)).max(1.0);
        // Valid for all that is above 0.
        StudentsT::new(0.0, 1.0, freedom).map_or(1.96, |t| t.inverse_cdf(0.975))
    }

    /// 95 % interval of the magnitude on a line.
    #[must_use]
    pub fn magnitude_interval(&self, line: &ResponseLine) -> [f64; 2] {
        let (size, reach) = (line.value.norm(), self.reach() * line.deviation);
        [(size - reach).max(0.0), size + reach]
    }

    /// Half the width of the 95 % interval of the phase on a line, rad; π where it is unknown.
    #[must_use]
    pub fn phase_reach(&self, line: &ResponseLine) -> f64 {
        let ratio = self.reach() * line.deviation / line.value.norm();
        match ratio < 1.0 {
            true => ratio.asin(),
            false => PI,
        }
    }

    /// The lines from one frequency to another (Hz) whose coherence is at least `coherence`.
    pub fn trusted(
        &self,
        band_hz: [f64; 2],
        coherence: f64,
    ) -> impl Iterator<Item = &ResponseLine> {
        self.lines.iter().filter(move |line| {
            (band_hz[0]..=band_hz[1]).contains(&line.frequency_hz) && line.coherence >= coherence
        })
    }

    /// The response at a frequency between two lines, and the standard deviation of its error: by a
    /// straight line over the frequency for phase and for the logarithm of the magnitude. None
    /// outside the lines.
    #[must_use]
    pub fn at(&self, frequency_hz: f64) -> Option<(Complex<f64>, f64)> {
        let above = self
            .lines
            .partition_point(|l| l.frequency_hz < frequency_hz);
        let high = self.lines.get(above)?;
        if high.frequency_hz == frequency_hz {
            return Some((high.value, high.deviation));
        }
        let low = self.lines.get(above.checked_sub(1)?)?;
        let part = (frequency_hz - low.frequency_hz) / (high.frequency_hz - low.frequency_hz);
        let ratio = high.value / low.value;
        let value = low.value * Complex::from_polar(ratio.norm().powf(part), ratio.arg() * part);
        let deviation = low.deviation + part * (high.deviation - low.deviation);
        value.is_finite().then_some((value, deviation))
    }
}

/// The estimate from powers that are means of `n` independent ones.
fn line(frequency_hz: f64, p: &Powers, estimator: Estimator, n: f64) -> ResponseLine {
    let share = |cross: Complex<f64>, a: f64, b: f64| match a * b > 0.0 {
        true => (cross.norm_sqr() / (a * b)).min(1.0),
        false => 0.0,
    };
    let coherence = share(p.ry, p.rr, p.yy).min(share(p.ru, p.rr, p.uu));
    let (value, variance) = match estimator {
        Estimator::H2 => {
            let value = p.uy * (p.yy / p.uy.norm_sqr());
            let lost = (1.0 - coherence) / coherence.max(f64::MIN_POSITIVE);
            (value, value.norm_sqr() * lost / n)
        }
        _ => {
            let value = p.ry / p.ru;
            let fitted = value.norm_sqr() * p.uu - 2.0 * (value.conj() * p.uy).re;
            let noise = (p.yy + fitted).max(0.0) * n / (n - 1.0);
            (value, noise * p.rr / (n * p.ru.norm_sqr()))
        }
    };
    ResponseLine {
        frequency_hz,
        value,
        deviation: (0.5 * variance).sqrt(),
        coherence,
    }
}

/// Refuses records that do not go together or hold what is no number; their sampling period.
fn checked_records(records: &[Record<'_>], estimator: Estimator) -> Result<f64, ResponseError> {
    let first = records.first().map_or(f64::NAN, |record| record.period_s);
    let valid = "from 1e-9 to 1e9 s";
    let period_s = check("the sampling period", first, [1e-9, 1e9], valid)?;
    let valid = "as of the first record";
    for record in records {
        check("the sampling period", record.period_s, [period_s; 2], valid)?;
        if record.differenced != records[0].differenced {
            let (name, value) = ("whether the output is differenced", f64::NAN);
            return Err(ResponseError::Setting { name, value, valid });
        }
        let (name, r) = excitation(record, estimator);
        checked("input", record.input, record.input.len())?;
        checked(name, r, record.input.len())?;
        checked("output", record.output, record.input.len())?;
    }
    Ok(period_s)
}

/// What stands for the excitation, and its name.
fn excitation<'a>(record: &Record<'a>, estimator: Estimator) -> (&'static str, &'a [f64]) {
    match (record.excitation, estimator) {
        (Some(r), Estimator::ThreeSignals) => ("excitation", r),
        _ => ("input", record.input),
    }
}

fn checked(signal: &'static str, values: &[f64], wanted: usize) -> Result<(), ResponseError> {
    if values.len() != wanted {
        let found = values.len();
        return Err(ResponseError::Length {
            signal,
            found,
            wanted,
        });
    }
    let bad = values
        .iter()
        .enumerate()
        .find(|(_, value)| !value.is_finite());
    match bad {
        Some((index, value)) => Err(ResponseError::NotFinite {
            signal,
            index,
            value: *value,
        }),
        None if wanted > 0 && values.iter().all(|value| *value == values[0]) => {
            Err(ResponseError::Constant(signal))
        }
        None => Ok(()),
    }
}
