//! `check`: the axis against the data sheets of its parts, under a duty.

use std::path::PathBuf;

use axis_sim::rating::AxisDuty;
use axis_sim::{Axis, LoadSensor, MoveSpec, SixDigits};
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};

use super::check_words::{Checked, CheckedRow};
use super::discover::read_as_one;
use super::heat_program::repeated;
use super::motions::listed;
use crate::context::{DEFAULT_AXIS, axis_with};
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::{note, print, write_whole};
use crate::page::check as check_page;
use crate::set_key::SetKey;

/// Options of `check`.
#[derive(Args)]
pub struct Options {
    /// Axis file; its [rating] says what the data sheets allow
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Set a key of the axis file to another value for this run, such as
    /// rating.nut_preload_n=2000 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<SetKey>,
    /// Trajectories of the axis file, from 1, one after the other, each there and back
    /// [default: all]
    #[arg(long, value_name = "N", num_args = 1.., conflicts_with_all = ["program", "log"])]
    trajectory: Vec<usize>,
    /// Standstill after each move and each return, s
    #[arg(
        long,
        value_name = "S",
        default_value_t = 0.0,
        conflicts_with_all = ["program", "log"],
        allow_negative_numbers = true
    )]
    dwell: f64,
    /// Motion program (TOML) that ends where it begins
    #[arg(long, value_name = "FILE", conflicts_with = "log")]
    program: Option<PathBuf>,
    /// Logs instead of a simulation: position or motor's angle, and torque, force, current or a command of one; a log in several
    /// files as their paths with + between
    #[arg(long, value_name = "LOG", num_args = 1..)]
    log: Vec<PathBuf>,
    /// Where to write the result as JSON
    #[arg(long, value_name = "FILE", value_parser = out_file::file())]
    json: Option<PathBuf>,
    /// Where to write a page of the result
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = axis_with(&options.axis, &options.set)?;
    let (duty, from) = options.duty(&axis)?;
    let items = axis.checked(&duty).into_diagnostic()?;
    let checked = Checked {
        axis: axis.name.clone(),
        axis_fingerprint: axis.fingerprint.clone(),
        duty: from,
        is_measured: !options.log.is_empty(),
        duty_s: duty.duration(),
        keys_of_the_file: axis.rating.stated,
        items: items.iter().map(CheckedRow::of).collect(),
        json: options.json.clone(),
        report: options.report.clone(),
    };
    if let Some(path) = &options.json {
        let bytes = crate::json::pretty(&checked).into_diagnostic()?;
        write_whole(path, &bytes)?;
    }
    if let Some(path) = &options.report {
        axis_report::write_atomic(path, &check_page::page(&checked)).into_diagnostic()?;
    }
    print("check", &checked)
}

impl Options {
    /// The duty, and what it is made of.
    fn duty(&self, axis: &Axis) -> Result<(AxisDuty, String)> {
        if !self.log.is_empty() {
            return self.of_logs(axis);
        }
        let (motion, from) = match &self.program {
            Some(file) => (repeated(file, axis)?, file.display().to_string()),
            None => {
                let (moves, named) = self.moves(axis)?;
                let motion = axis.there_and_back(&moves, self.dwell);
                (motion.into_diagnostic().wrap_err("--dwell")?, named)
            }
        };
        let duty = axis.duty_of_motion(&motion).into_diagnostic()?;
        Ok((duty, from))
    }

    fn of_logs(&self, axis: &Axis) -> Result<(AxisDuty, String)> {
        let mut duty = AxisDuty::of(axis).into_diagnostic()?;
        let mut notes = Vec::new();
        for path in &self.log {
            let log = read_as_one(path, axis, &[], &mut notes)?;
            let shows_motor = ["motor_angle_rad", "motor_speed_rad_s"];
            let is_load = !matches!(axis.sensors.load, LoadSensor::Missing);
            if axis.mechanism.has_motor_encoder()
                && is_load
                && !shows_motor.iter().any(|c| log.has(c))
            {
                notes.push(format!(
                    "{}: no motor_angle_rad, so greatest forces in the transmission are from the load's position: they \
                     come out too low while it swings",
                    path.display()
                ));
            }
            let added = duty.add_log(axis, &log).into_diagnostic();
            added.wrap_err_with(|| path.display().to_string())?;
        }
        notes.iter().for_each(note);
        let names: Vec<String> = self.log.iter().map(|p| p.display().to_string()).collect();
        Ok((duty, names.join(", ")))
    }

    /// The moves that are meant, and their name.
    fn moves(&self, axis: &Axis) -> Result<(Vec<MoveSpec>, String)> {
        let count = axis.trajectories.len();
        let numbers: Vec<usize> = match self.trajectory.is_empty() {
            true => (1..=count).collect(),
            false => self.trajectory.clone(),
        };
        if numbers.is_empty() {
            return Err(wrong_use(format!(
                "the motion is missing: the axis file has {}; valid: --program FILE or --log LOG",
                listed(axis)
            )));
        }
        let spec = |number: &usize| {
            let index = number.checked_sub(1);
            let spec = index.and_then(|index| axis.trajectories.get(index));
            spec.copied().ok_or_else(|| {
                wrong_use(format!(
                    "--trajectory {number}: there is no such trajectory; the axis file has {}",
                    listed(axis)
                ))
            })
        };
        let moves = numbers.iter().map(spec).collect::<Result<_>>()?;
        let named: Vec<String> = numbers.iter().map(usize::to_string).collect();
        let word = if named.len() == 1 {
            "trajectory"
        } else {
            "trajectories"
        };
        let rest = match self.dwell == 0.0 {
            true => "without a pause".to_owned(),
            false => format!("standstills of {} s", SixDigits(self.dwell)),
        };
        Ok((
            moves,
            format!("{word} {} there and back, {rest}", named.join(", ")),
        ))
    }
}
