//! `heat --predict`: growth along a log of hours, from its reference or its duties.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_log::{Channel, Log};
use axis_pipeline::heat::{FollowOptions, Following, SlowLog, follow};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, SixDigits};
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::heat_slow::{Options, of_log, slow_log};
use crate::output::print;

/// What the command is about.
pub(super) struct Given<'a> {
    pub axis: &'a Axis,
    pub duties: &'a [SharedMotion],
    pub air: f64,
    /// m.
    pub places: Vec<f64>,
}

/// Runs the prediction.
pub(super) fn command(given: &Given<'_>, options: &Options, file: &Path) -> Result<()> {
    let log = slow_log(given.axis, file)?;
    let reading = options.reading(given.duties, given.air);
    let slow = of_log(
        file,
        SlowLog::new(given.axis, &log, &reading).into_diagnostic(),
    )?;
    let model = given.axis.thermal_model().into_diagnostic()?;
    let how = FollowOptions {
        homed: options.homed.unwrap_or(0.0),
        probe_each: options.probe_each,
        places: given.places.clone(),
        ..FollowOptions::default()
    };
    let found = of_log(file, follow(model, &slow, &how).into_diagnostic())?;
    if let Some(out) = &options.out {
        let channels = channels(&log, &slow, &found, &given.places)?;
        axis_log::write(out, &channels).into_diagnostic()?;
    }
    let name = file.display().to_string();
    let mut predicted = Predicted::of(given.axis, name, &how, &found);
    predicted.file = options.out.clone();
    print("heat", &predicted)
}

/// The log that is written: growth of the screw at each position; and growth that the controller does not see at the
/// reference, and the reference less that.
fn channels(log: &Log, slow: &SlowLog<'_>, found: &Following, places: &[f64]) -> Result<Log> {
    let channel = |name: &str, values: Vec<f64>| Channel::new(name, values).into_diagnostic();
    let mut all = vec![channel("t_s", log.time().to_vec())?];
    let mut grown = Vec::new();
    if let Some(reference) = slow.reference() {
        let growth = found.rows.iter().filter_map(|row| row.at_reference);
        grown = growth.collect();
        let corrected = reference.iter().zip(&grown).map(|(x, growth)| x - growth);
        all.push(channel("position_ref_m", reference.to_vec())?);
        all.push(channel("position_corrected_m", corrected.collect())?);
    }
    if !grown.is_empty() {
        all.push(channel("growth_m", grown)?);
    }
    for (i, place) in places.iter().enumerate() {
        let name = format!("growth_at_{}_mm_m", SixDigits(1e3 * place));
        let growth = found.rows.iter().map(|row| row.growth[i]).collect();
        all.push(channel(&name, growth)?);
    }
    for (i, name) in ["dry_factor_1", "viscous_factor_1"].into_iter().enumerate() {
        let factors = found.rows.iter().map(|row| row.friction[i]).collect();
        all.push(channel(name, factors)?);
    }
    Log::new(all).into_diagnostic()
}

/// How well the readings were predicted.
#[derive(Serialize)]
pub struct Predicted {
    axis: String,
    log: String,
    /// What growth was predicted from.
    #[serde(skip)]
    from: &'static str,
    hours: f64,
    homed_s: f64,
    /// Readings that the prediction was compared with.
    readings: usize,
    greatest_um: Option<f64>,
    rms_um: Option<f64>,
    /// Greatest growth that was read.
    growth_um: Option<f64>,
    /// Times that the prediction was set right.
    probings: usize,
    positions_mm: Vec<f64>,
    /// Of the screw, at the end of the log.
    growth_at_end_um: Vec<f64>,
    /// Dry and viscous friction then, as multiples of the cold axis'.
    friction_at_end: [f64; 2],
    file: Option<PathBuf>,
}

impl Predicted {
    /// Of a log of that name.
    pub fn of(axis: &Axis, log: String, how: &FollowOptions, found: &Following) -> Self {
        let errors: Vec<f64> = found.readings.iter().map(|[_, read, p]| p - read).collect();
        let is_read = !errors.is_empty();
        let greatest = |of: &mut dyn Iterator<Item = f64>| of.map(f64::abs).fold(0.0, f64::max);
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let last = found.rows.last();
        Self {
            axis: axis.name.clone(),
            log,
            from: match last.and_then(|row| row.at_reference) {
                Some(_) => "reference",
                None => "duties",
            },
            hours: last.map_or(0.0, |row| row.time / 3600.0),
            homed_s: how.homed,
            readings: errors.len(),
            greatest_um: is_read.then(|| 1e6 * greatest(&mut errors.iter().copied())),
            rms_um: is_read.then(|| 1e6 * (squares / errors.len() as f64).sqrt()),
            growth_um: is_read.then(|| 1e6 * greatest(&mut found.readings.iter().map(|r| r[1]))),
            probings: found.probings,
            positions_mm: how.places.iter().map(|x| 1e3 * x).collect(),
            growth_at_end_um: last.map_or(Vec::new(), |row| {
                row.growth.iter().map(|growth| 1e6 * growth).collect()
            }),
            friction_at_end: last.map_or([1.0; 2], |row| row.friction),
            file: None,
        }
    }
}

impl fmt::Display for Predicted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: growth of the screw along {}, {:.2} h, from its {} alone, since {} s",
            self.axis,
            self.log,
            self.hours,
            self.from,
            SixDigits(self.homed_s)
        )?;
        if let (Some(greatest), Some(rms), Some(of)) =
            (self.greatest_um, self.rms_um, self.growth_um)
        {
            writeln!(
                f,
                "{} readings of up to {of:.1} µm: greatest error {greatest:.2} µm, RMS {rms:.2} µm{}",
                self.readings,
                match self.probings {
                    0 => String::new(),
                    n => format!(", set right by {n} probings"),
                }
            )?;
        }
        for (place, growth) in self.positions_mm.iter().zip(&self.growth_at_end_um) {
            writeln!(
                f,
                "  at {:>8} mm {growth:>10.2} µm in the end",
                SixDigits(*place).to_string()
            )?;
        }
        let [dry, viscous] = self.friction_at_end;
        writeln!(
            f,
            "  friction in the end: dry × {dry:.3}, viscous × {viscous:.3}"
        )?;
        match &self.file {
            Some(path) => write!(f, "{}", path.display()),
            None => Ok(()),
        }
    }
}
