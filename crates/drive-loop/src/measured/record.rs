//! What a log shows of an excited axis: channels, and when it was excited.

use std::borrow::Cow;

use axis_log::Log;
use axis_sim::actuator::Effort;
use axis_sim::{Axis, excitation_in, position_shown};
use frequency_response::{Averaging, Record, period_of};

use super::MeasureSettings;
use crate::error::LoopError;

/// Zeros in a row that end an excitation, samples.
const SILENT: usize = 64;
/// Distance of two lines where the excitation has none of its own, Hz.
const STEP: f64 = 1.2;
/// Segments that an excited time holds at least, half over one another: 7.
const SEGMENTS: usize = 4;
/// Periods from which on whole ones are averaged: one to settle, and these.
const PERIODS: usize = 3;
/// Deviation of a sampling period from the mean that is a gap, as a share.
const GAP: f64 = 0.5;

/// A log's channels, and where it was excited.
pub(crate) struct Recorded<'a> {
    pub period: f64,
    pub excitation: Option<&'a [f64]>,
    pub command: &'a [f64],
    /// Channels of the command and of what was taken in its place, where the log has no command.
    pub instead: Option<[&'static str; 2]>,
    pub command_unit: &'static str,
    /// What the drive really exerts, where the log has it beside the command.
    pub effort: Option<&'a [f64]>,
    pub angle: Option<&'a [f64]>,
    pub speed: Option<&'a [f64]>,
    pub load: Cow<'a, [f64]>,
    /// Of d and q, V.
    pub voltages: Option<[&'a [f64]; 2]>,
    /// From which to which sample.
    pub windows: Vec<[usize; 2]>,
    /// Mean position in the windows, and least and greatest.
    pub position: f64,
    pub stretch: [f64; 2],
    /// Mean of the load's |speed| over the windows.
    pub mean_speed: f64,
    pub notes: Vec<String>,
}

/// The period of a log whose samples are even.
fn even_period(time: &[f64]) -> Result<f64, LoopError> {
    let n = time.len();
    if n < 64 {
        return Err(LoopError::Log(format!(
            "it has {n} samples; valid: 64 at least, and some seconds of a slide"
        )));
    }
    let period = (time[n - 1] - time[0]) / (n - 1) as f64;
    let off = |w: &[f64]| ((w[1] - w[0]) / period - 1.0).abs() > GAP;
    match time.windows(2).position(off) {
        Some(i) => Err(LoopError::Log(format!(
            "its samples are not evenly spaced at {} s; valid: one period throughout",
            axis_sim::SixDigits(time[i])
        ))),
        None => Ok(period),
    }
}

/// Says that samples of a channel are missing.
fn holes(log: &Log, name: &str) -> Option<String> {
    let missing: usize = log.missing(name).iter().map(|range| range.len()).sum();
    (missing > 0).then(|| {
        format!(
            "{missing} samples of {name} were not measured: straight lines stand in their place"
        )
    })
}

impl<'a> Recorded<'a> {
    pub fn of(axis: &Axis, log: &'a Log) -> Result<Self, LoopError> {
        let period = even_period(log.time())?;
        let (names, command_unit) = match axis.actuator.effort() {
            Effort::Current => (["iq_ref_a", "iq_a"], "A"),
            Effort::Torque => (["torque_ref_n_m", "torque_n_m"], "N·m"),
            Effort::Force => (["force_ref_n", "force_n"], "N"),
            Effort::Voltage => (["drive_command_v", "drive_command_v"], "V"),
        };
        let name = names
            .into_iter()
            .find(|name| log.has(name))
            .unwrap_or(names[0]);
        let missing = |error: axis_log::LogError| LoopError::Log(error.to_string());
        let command = log.channel(name).map_err(missing)?;
        let load = position_shown(log, axis).map_err(missing)?;
        let angle = log.channel("motor_angle_rad").ok();
        // A speed loop that is slower than the control holds its speed over cycles, which the law of the
        // loop counts by itself: the angle shows the motor then.
        let is_held = axis.control.speed_every(axis.period) > 1 && angle.is_some();
        let speed = log.channel("motor_speed_rad_s").ok().filter(|_| !is_held);
        let read = [
            name,
            "motor_speed_rad_s",
            "motor_angle_rad",
            axis.position_channel(),
        ];
        let notes = read.iter().filter_map(|name| holes(log, name)).collect();
        let excitation = excitation_in(log);
        let windows = match excitation {
            Some(r) => windows(r),
            None => Vec::new(),
        };
        let (windows, excitation) = match windows.is_empty() {
            true => (vec![[0, load.len()]], None),
            false => (windows, excitation),
        };
        let inside = || windows.iter().flat_map(|[from, to]| &load[*from..*to]);
        let count = inside().count() as f64;
        let ends = |[from, to]: &[usize; 2]| (load[*to - 1] - load[*from]).abs();
        let samples: usize = windows.iter().map(|[from, to]| to - from).sum();
        Ok(Self {
            mean_speed: windows.iter().map(ends).sum::<f64>() / (samples as f64 * period),
            position: inside().sum::<f64>() / count,
            stretch: [
                inside().copied().fold(f64::INFINITY, f64::min),
                inside().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
            period,
            excitation,
            command,
            instead: (name != names[0]).then_some([names[0], name]),
            command_unit,
            effort: Some(names[1])
                .filter(|effort| *effort != name)
                .and_then(|effort| log.channel(effort).ok()),
            angle,
            speed,
            load,
            voltages: log
                .channel("ud_v")
                .ok()
                .zip(log.channel("uq_v").ok())
                .map(Into::into),
            windows,
            notes,
        })
    }

    pub fn is_excited(&self) -> bool {
        self.excitation.is_some()
    }

    /// Excited time, s.
    pub fn seconds(&self) -> f64 {
        let samples: usize = self.windows.iter().map(|[from, to]| to - from).sum();
        samples as f64 * self.period
    }

    /// Whole periods where the excitation repeats itself often enough in each window, or segments.
    pub fn averaging(&self, settings: &MeasureSettings) -> Result<Averaging, LoopError> {
        let longest = self
            .windows
            .iter()
            .map(|[from, to]| to - from)
            .max()
            .unwrap_or(0);
        if let Some(step) = settings.step_hz {
            if !(step.is_finite() && step > 0.0) {
                let valid = "above 0 Hz";
                return Err(LoopError::Setting {
                    name: "the distance of lines",
                    value: step,
                    valid,
                });
            }
            let segment = (1.0 / (step * self.period)).round().min(1e9) as usize;
            return Ok(Averaging::Welch { segment });
        }
        if let Some(r) = self.excitation {
            let all = self
                .windows
                .iter()
                .map(|[from, to]| period_of(&r[*from..*to]));
            let periods: Option<Vec<usize>> = all.collect();
            if let Some(period) = periods.as_deref().and_then(<[usize]>::first)
                && periods.iter().flatten().all(|p| p == period)
                && longest / period > PERIODS
            {
                let (period, skip) = (*period, 1);
                return Ok(Averaging::Periods { period, skip });
            }
        }
        let segment = (1.0 / (STEP * self.period)).round() as usize;
        let segment = segment.min(2 * longest / (SEGMENTS + 1));
        Ok(Averaging::Welch { segment })
    }

    /// Of each window, from the command to this output.
    pub fn records<'b>(
        &'b self,
        output: &'b [f64],
        differenced: bool,
    ) -> impl Iterator<Item = Record<'b>> {
        self.records_from(self.command, output, differenced)
    }

    /// The same from another input.
    pub fn records_from<'b>(
        &'b self,
        input: &'b [f64],
        output: &'b [f64],
        differenced: bool,
    ) -> impl Iterator<Item = Record<'b>> {
        self.windows.iter().map(move |[from, to]| Record {
            period_s: self.period,
            excitation: self.excitation.map(|r| &r[*from..*to]),
            input: &input[*from..*to],
            output: &output[*from..*to],
            differenced,
        })
    }

    /// From the excitation to the command.
    pub fn sensitivity_records(&self) -> impl Iterator<Item = Record<'_>> {
        let r = self.excitation.unwrap_or(self.command);
        self.windows.iter().map(move |[from, to]| Record {
            period_s: self.period,
            excitation: None,
            input: &r[*from..*to],
            output: &self.command[*from..*to],
            differenced: false,
        })
    }
}

/// Stretches in which an excitation is not silent.
fn windows(r: &[f64]) -> Vec<[usize; 2]> {
    let mut all: Vec<[usize; 2]> = Vec::new();
    for (k, value) in r.iter().enumerate() {
        if *value == 0.0 {
            continue;
        }
        match all.last_mut() {
            Some([_, to]) if k < *to + SILENT => *to = k + 1,
            _ => all.push([k, k + 1]),
        }
    }
    all.retain(|[from, to]| to - from >= SILENT);
    all
}
