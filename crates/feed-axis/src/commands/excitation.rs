//! `[excitation]` of a motion program: what is added to the command while the axis moves.

use axis_sim::Axis;
use axis_sim::actuator::Effort;
use frequency_response::{ChirpExcitation, ChirpSweep, Excitation, Multisine, Prbs};
use miette::{IntoDiagnostic, Result, miette};
use serde::Deserialize;
use trajectories::{Motion, Program};

use crate::context::from_toml;

/// Acceleration below which a motion has a constant speed, as a share of its greatest: rounding.
const STEADY: f64 = 1e-9;

/// The table as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    signal: Signal,
    amplitude_a: Option<f64>,
    amplitude_n_m: Option<f64>,
    amplitude_n: Option<f64>,
    amplitude_v: Option<f64>,
    clock_cycles: Option<usize>,
    register: Option<u32>,
    from_hz: Option<f64>,
    to_hz: Option<f64>,
    sweep: Option<Sweep>,
    period_cycles: Option<usize>,
    line_ratio: Option<f64>,
    #[serde(default)]
    seed: u64,
    from_s: Option<f64>,
    to_s: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Signal {
    Prbs,
    Chirp,
    Multisine,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Sweep {
    Linear,
    Logarithmic,
}

/// The text of a program without its `[excitation]`, each line where it was, and that.
pub fn split(text: &str) -> Result<(String, Option<Asked>)> {
    let (mut rest, mut own) = (String::new(), String::new());
    let (mut inside, mut found) = (false, false);
    for line in text.lines() {
        let start = line.trim_start();
        if start.starts_with('[') {
            inside = start.starts_with("[excitation]");
            found |= inside;
        }
        let (to, other) = match inside {
            true => (&mut own, &mut rest),
            false => (&mut rest, &mut own),
        };
        to.push_str(line);
        to.push('\n');
        other.push('\n');
    }
    #[derive(Deserialize)]
    struct Only {
        excitation: Asked,
    }
    let asked = match found {
        true => Some(from_toml::<Only>(&own)?.excitation),
        false => None,
    };
    Ok((rest, asked))
}

impl Asked {
    /// A value for each cycle of the program on this axis.
    pub fn samples(&self, axis: &Axis, program: &Program) -> Result<Vec<f64>> {
        let excitation = self.excitation(axis)?;
        let cycles = (program.duration() / axis.period).floor() as usize + 1;
        let windows = self.windows(axis, program, cycles)?;
        let mut all = vec![0.0; cycles];
        for [from, to] in windows {
            let samples = excitation.samples(1.0 / axis.period, to - from);
            all[from..to].copy_from_slice(&samples.into_diagnostic()?);
        }
        Ok(all)
    }

    fn excitation(&self, axis: &Axis) -> Result<Excitation> {
        let amplitude = self.amplitude(axis)?;
        let unused = |keys: &[(&str, bool)]| match keys.iter().find(|(_, is_there)| *is_there) {
            Some((key, _)) => Err(miette!(
                "{key} does not go with signal = \"{}\"",
                format!("{:?}", self.signal).to_lowercase()
            )),
            None => Ok(()),
        };
        let of_prbs = [
            ("clock_cycles", self.clock_cycles.is_some()),
            ("register", self.register.is_some()),
        ];
        let of_sines = [
            ("period_cycles", self.period_cycles.is_some()),
            ("line_ratio", self.line_ratio.is_some()),
        ];
        let of_chirp = [("sweep", self.sweep.is_some())];
        let of_both = [
            ("from_hz", self.from_hz.is_some()),
            ("to_hz", self.to_hz.is_some()),
        ];
        if self.signal != Signal::Prbs {
            unused(&of_prbs)?;
        } else {
            unused(&of_both)?;
        }
        if self.signal != Signal::Chirp {
            unused(&of_chirp)?;
        }
        if self.signal != Signal::Multisine {
            unused(&of_sines)?;
        }
        let top = 0.4 / axis.period;
        Ok(match self.signal {
            Signal::Prbs => Excitation::Prbs(Prbs {
                amplitude,
                register: self.register.unwrap_or(Prbs::default().register),
                clock: self.clock_cycles.unwrap_or(Prbs::default().clock),
                seed: self.seed,
            }),
            Signal::Chirp => Excitation::Chirp(ChirpExcitation {
                amplitude,
                from_hz: self.from_hz.unwrap_or(ChirpExcitation::default().from_hz),
                to_hz: self
                    .to_hz
                    .unwrap_or(ChirpExcitation::default().to_hz.min(top)),
                sweep: match self.sweep {
                    Some(Sweep::Logarithmic) => ChirpSweep::Logarithmic,
                    _ => ChirpSweep::Linear,
                },
            }),
            Signal::Multisine => Excitation::Multisine(Multisine {
                amplitude,
                period: self.period_cycles.unwrap_or(Multisine::default().period),
                from_hz: self.from_hz.unwrap_or(Multisine::default().from_hz),
                to_hz: self.to_hz.unwrap_or(Multisine::default().to_hz.min(top)),
                ratio: self.line_ratio.unwrap_or(1.0),
                seed: self.seed,
            }),
        })
    }

    /// In the unit of the axis' command.
    fn amplitude(&self, axis: &Axis) -> Result<f64> {
        let given = [
            (Effort::Current, "amplitude_a", self.amplitude_a),
            (Effort::Torque, "amplitude_n_m", self.amplitude_n_m),
            (Effort::Force, "amplitude_n", self.amplitude_n),
            (Effort::Voltage, "amplitude_v", self.amplitude_v),
        ];
        let own = axis.actuator.effort();
        let wanted = given.iter().find(|(effort, ..)| *effort == own);
        let name = wanted.map_or("", |(_, name, _)| name);
        let other = given
            .iter()
            .find(|(effort, _, value)| *effort != own && value.is_some());
        match (wanted.and_then(|(.., value)| *value), other) {
            (Some(amplitude), None) => Ok(amplitude),
            (_, Some((_, other, _))) => Err(miette!(
                "{other} is not in the unit of this axis' command; valid: {name}"
            )),
            (None, None) => Err(miette!(
                "the amplitude is missing; valid: {name}, such as a tenth of the greatest command, {}",
                axis_sim::SixDigits(0.1 * axis.actuator.limit())
            )),
        }
    }

    /// Cycles from which to which it is added.
    fn windows(&self, axis: &Axis, program: &Program, cycles: usize) -> Result<Vec<[usize; 2]>> {
        if self.from_s.is_some() || self.to_s.is_some() {
            let from = self.from_s.unwrap_or(0.0);
            let to = self.to_s.unwrap_or(program.duration());
            if !(0.0 <= from && from < to && to <= program.duration() + axis.period) {
                return Err(miette!(
                    "from_s = {from} and to_s = {to} are no part of the program; valid: from 0 to {} s",
                    axis_sim::SixDigits(program.duration())
                ));
            }
            let at = |t: f64| ((t / axis.period).round() as usize).min(cycles);
            return Ok(vec![[at(from), at(to)]]);
        }
        // Where the reference moves at constant speed.
        let extremes = program.extremes();
        let quiet = STEADY * extremes.acceleration.abs();
        let steady = |k: usize| {
            let at = program.at(k as f64 * axis.period);
            at.velocity != 0.0 && at.acceleration.abs() <= quiet && at.jerk == 0.0
        };
        let mut all: Vec<[usize; 2]> = Vec::new();
        let mut from = None;
        for k in 0..=cycles {
            match (from, k < cycles && steady(k)) {
                (None, true) => from = Some(k),
                (Some(start), false) => {
                    all.push([start, k]);
                    from = None;
                }
                _ => {}
            }
        }
        match all.is_empty() {
            true => Err(miette!(
                "the program never moves at constant speed, so there is nothing to excite; valid: a longer move, or from_s and to_s"
            )),
            false => Ok(all),
        }
    }
}
