//! `heat-proof`: errors of an hour of heat, of fitted models, and of both corrections together, all
//! against a simulator of its own (`independent_axis::HeatedScrew`).

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use axis_sim::thermal::LossModel;
use axis_sim::{Axis, ClosedLoop};
use axis_thermal::{Duty, FrictionLaws, ThermalAccuracy, ThermalModel, ThermalParameters};
use clap::Args;
use compensator::NoCompensation;
use feed_axis::output::{Worded, note, print};
use independent_axis::{HeatedScrew, Motion, there_and_back};
use miette::{IntoDiagnostic, Result};
use trajectories::{Program, Step};

use super::heat_both::{AFTER, Cases, kept};
use super::heat_found::{Found, Row};
use super::heat_identified::identified;
use super::heat_table;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = "data/axes/screw-heat.toml")]
    axis: PathBuf,
    /// Axis file of the rows with a scale
    #[arg(
        long,
        value_name = "FILE",
        default_value = "data/axes/liu2025-machine.toml"
    )]
    scale: PathBuf,
    /// Folder of rows that are done: a run that was stopped goes on
    #[arg(long, value_name = "DIR", default_value = "runs/heat")]
    rows: PathBuf,
    /// Where to write the tables; not with --numerics
    #[arg(long, value_name = "FILE", default_value = "data/outcomes/heat.md")]
    out: PathBuf,
    /// The rows against brute force alone: neither fitted models nor both corrections
    #[arg(long)]
    numerics: bool,
}

const PLACE: f64 = 0.95;

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = Axis::read(&options.axis)?;
    let program = duty_of_the_file(&axis)?;
    let motion = there_and_back(0.45, 0.95, 0.2, 1.0);
    let model = axis.thermal_model().into_diagnostic()?;
    let reference = axis.duty_of(&model, &program).into_diagnostic()?;
    let simulated = simulated(&axis, &model, &program)?;
    let constant = ThermalModel::new(ThermalParameters {
        friction: FrictionLaws::CONSTANT,
        ..model.parameters().clone()
    });
    let constant = constant.into_diagnostic()?;
    let hour = brute_force(&motion, 1);
    let mut rows = vec![
        row("losses from the reference", &model, &reference, &hour)?,
        row("losses from the simulated loop", &model, &simulated, &hour)?,
        row(
            "friction that does not change",
            &constant,
            &reference,
            &hour,
        )?,
    ];
    rows.push(row(
        "losses from the reference",
        &model,
        &reference,
        &brute_force(&motion, 24),
    )?);
    let (mut found_models, mut motor, mut scale) = (Vec::new(), Vec::new(), Vec::new());
    if !options.numerics {
        let (rows, fitted) = identified(&model)?;
        found_models = rows;
        let scaled = Axis::read(&options.scale)?;
        let key = feed_axis::program::inputs()
            .with("motor", &axis.fingerprint)
            .with("scale", &scaled.fingerprint)
            .key();
        let tables = [
            (Cases::of_motor(&axis, &fitted), true, &mut motor),
            (Cases::of_scale(&scaled, &fitted), false, &mut scale),
        ];
        for (cases, with_growth, rows) in tables {
            for (number, what) in cases.names().into_iter().enumerate() {
                let name = format!("{}-{number}", if with_growth { "motor" } else { "scale" });
                let compute = || cases.row(number, with_growth);
                rows.push(kept(&options.rows, &name, &key, compute)?);
                note(format!("{name}: {what}"));
            }
        }
    }
    let watts = |duty: &Duty| duty.friction_power().iter().sum::<f64>();
    let found = Found {
        against_brute_force: rows,
        tolerance_um: tolerance(&model, &reference)?,
        losses_w: [watts(&reference), watts(&simulated)],
        identified: found_models,
        motor,
        scale,
    };
    if !options.numerics {
        std::fs::write(&options.out, heat_table::page(&found)).into_diagnostic()?;
        note(format!("{} written", options.out.display()));
    }
    let text = words(&found);
    print("heat-proof", &Worded { text, value: found })
}

/// The first trajectory of the file there and back, standstills of 1 s.
fn duty_of_the_file(axis: &Axis) -> Result<Program> {
    let spec = axis.trajectories.first();
    let spec = spec.ok_or_else(|| miette::miette!("the axis file has no trajectory"))?;
    let (start, limits) = (axis.stroke.start, spec.limits);
    let rest = Step::Dwell { duration: 1.0 };
    let to = |to: f64| Step::Move { to, limits };
    let steps = vec![to(start + spec.displacement), rest, to(start), rest];
    Program::new(start, steps).into_diagnostic()
}

fn simulated(axis: &Axis, model: &ThermalModel, program: &Program) -> Result<Duty> {
    let losses = LossModel::of(axis).into_diagnostic()?;
    let mut duty = model.duty();
    let add = |cycle: &axis_sim::Cycle| losses.add_cycle(&mut duty, axis.period, cycle);
    let closed_loop = ClosedLoop::new(axis).into_diagnostic()?;
    let outcome = closed_loop.run(program, &mut NoCompensation, add);
    outcome.completed().into_diagnostic()?;
    Ok(duty)
}

/// Growth at [`PLACE`] after each minute.
fn brute_force(motion: &Motion, hours: u32) -> Vec<f64> {
    let begun = Instant::now();
    let mut screw = HeatedScrew::assumed(20.0);
    let mut minute = |_| {
        screw.run(Some(motion), 60.0, |_| 20.0);
        screw.growth(20.0, PLACE)
    };
    let growth = (0..60 * hours).map(&mut minute).collect();
    let took = begun.elapsed().as_secs_f64();
    note(format!("brute force of {hours} h: {took:.1} s"));
    growth
}

fn row(what: &'static str, model: &ThermalModel, duty: &Duty, truth: &[f64]) -> Result<Row> {
    let begun = Instant::now();
    let cold = model.at_rest(20.0);
    let mut state = cold.clone();
    let at_work = model.under(duty).into_diagnostic()?;
    let (mut worst, mut last, mut steps) = (0.0_f64, 0.0, 0);
    for growth in truth {
        steps += at_work.run(&mut state, 20.0, 60.0).into_diagnostic()?.steps;
        last = 1e6 * (model.growth(&cold, &state, PLACE).screw - growth);
        worst = worst.max(last.abs());
    }
    let hours = truth.len() as u32 / 60;
    let took = 1e3 * begun.elapsed().as_secs_f64();
    note(format!("{what}, {hours} h: {took:.0} ms"));
    Ok(Row {
        what,
        hours,
        greatest_um: worst,
        in_the_end_um: last,
        growth_um: 1e6 * truth.last().copied().unwrap_or(0.0),
        steps,
    })
}

fn tolerance(model: &ThermalModel, duty: &Duty) -> Result<f64> {
    let at_work = model.under(duty).into_diagnostic()?;
    let cold = model.at_rest(20.0);
    let usual = ThermalAccuracy::default();
    let fine = ThermalAccuracy {
        tolerance: 1e-3 * usual.tolerance,
        ..usual
    };
    let mut states = [cold.clone(), cold.clone()];
    let mut worst = 0.0_f64;
    for _ in 0..60 {
        for (state, accuracy) in states.iter_mut().zip([usual, fine]) {
            let ran = at_work.run_in(state, |_| 20.0, 60.0, &accuracy);
            ran.into_diagnostic()?;
        }
        let [a, b] = states
            .each_ref()
            .map(|s| model.growth(&cold, s, PLACE).screw);
        worst = worst.max(1e6 * (a - b).abs());
    }
    Ok(worst)
}

fn words(found: &Found) -> String {
    let mut text = String::from("growth at 950 mm against brute force, µm\n");
    let _ = writeln!(
        text,
        "{:<34}{:>6}{:>10}{:>12}{:>9}{:>7}",
        "", "hours", "greatest", "in the end", "growth", "steps"
    );
    for row in &found.against_brute_force {
        let _ = writeln!(
            text,
            "{:<34}{:>6}{:>10.2}{:>12.2}{:>9.1}{:>7}",
            row.what, row.hours, row.greatest_um, row.in_the_end_um, row.growth_um, row.steps
        );
    }
    let [reference, simulated] = found.losses_w;
    let _ = writeln!(
        text,
        "the usual tolerance changes it by {:.4} µm; friction at 20 °C: {reference:.2} W from the reference, {simulated:.2} W from the loop",
        found.tolerance_um
    );
    if !found.identified.is_empty() {
        let _ = writeln!(
            text,
            "\nfitted to another machine, growth on 3 h of other duties, µm"
        );
        let _ = writeln!(
            text,
            "{:<100}{:>10}{:>7}{:>8}",
            "log", "greatest", "RMS", "of"
        );
    }
    for row in &found.identified {
        let _ = writeln!(
            text,
            "{:<100}{:>10.1}{:>7.2}{:>8.0}",
            row.log, row.greatest_um, row.rms_um, row.of_um
        );
    }
    let tables = [
        (
            "peak of the table's error on strokes there and back, motor feedback, µm",
            &found.motor,
        ),
        (
            "dynamic part of it, position from a scale, µm",
            &found.scale,
        ),
    ];
    for (title, rows) in tables {
        if rows.is_empty() {
            continue;
        }
        let _ = write!(text, "\n{title}\n{:<100}", "after min");
        for minutes in AFTER {
            let _ = write!(text, "{minutes:>8}");
        }
        text.push('\n');
        for row in rows {
            let _ = write!(text, "{:<100}", row.what);
            for peak in row.peaks_um {
                let _ = write!(text, "{peak:>8.1}");
            }
            text.push('\n');
        }
    }
    text
}
