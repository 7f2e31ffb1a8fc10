//! Friction, self-excited vibration, modes.

use axis_pipeline::vibration::Vibration;
use axis_report::{Cell, Figure, Section, Series, Table};
use lugre::LuGre;

use crate::commands::identify::Friction;
use crate::context::Context;
use crate::results::Results;

/// Identification: parameters and curve.
pub fn friction(context: &Context, results: &Results) -> Section {
    let friction = &results.friction;
    let section = Section::new("Friction")
        .paragraph("From stretches of constant speed both ways and small motions about a standstill, as the sensors log them. Runs in which the axis vibrates by itself are recognised by their own speed and left out: their mean torque is not a point of the curve. Intervals hold what the logs scatter; the torque constant of the axis file scales all forces with it.");
    let lines = friction.open.iter().chain(&friction.notes);
    lines
        .fold(section, |section, line| section.paragraph(line.clone()))
        .table(friction_table(friction))
        .figure(friction_figure(context, results))
}

/// What was found, beside what is true if that is known.
fn friction_table(friction: &Friction) -> Table {
    let of = match friction.simulated {
        true => "Friction as identified on the simulated machine",
        false => "Friction as identified from logs",
    };
    let mut table = Table::new(
        of,
        ["Parameter", "found", "95 % from", "to", "true", "off by, %"],
    );
    for p in &friction.parameters {
        let end = |place: usize| match p.interval_95 {
            Some(ends) => Cell::quantity(ends[place], &p.unit, 5),
            None => Cell::text(p.source.clone()),
        };
        let [truth, off] = match p.truth {
            Some(truth) => [
                Cell::quantity(truth, &p.unit, 5),
                match truth {
                    0.0 => Cell::Missing,
                    _ => Cell::number(100.0 * (p.value / truth - 1.0), 2),
                },
            ],
            None => [Cell::text("not known"), Cell::text("")],
        };
        table = table.row([
            Cell::text(p.name.clone()),
            Cell::quantity(p.value, &p.unit, 5),
            end(0),
            end(1),
            truth,
            off,
        ]);
    }
    table
}

/// The curve, with the runs that it was found from.
fn friction_figure(context: &Context, results: &Results) -> Figure {
    let runs = |name: &str, left_out: bool| {
        let forward = results.friction.runs.iter().filter(|run| run.speed > 0.0);
        let (x, y): (Vec<f64>, Vec<f64>) = forward
            .filter(|run| run.left_out.is_some() == left_out)
            .map(|run| (run.speed, run.torque))
            .unzip();
        (!x.is_empty()).then(|| Series::dots(name, x, y))
    };
    // A little beyond the runs, evenly on the logarithmic axis.
    let run_speeds = || results.friction.runs.iter().map(|run| run.speed.abs());
    let slowest = 0.8 * run_speeds().fold(f64::MAX, f64::min);
    let fastest = 1.06 * run_speeds().fold(f64::MIN_POSITIVE, f64::max);
    let speeds: Vec<f64> = (0..=200)
        .map(|i| slowest * (fastest / slowest).powf(f64::from(i) / 200.0))
        .collect();
    let units = context.machine.friction.at.units();
    let curve = |law: &LuGre| {
        speeds
            .iter()
            .map(|&w| law.steady_state(w))
            .collect::<Vec<f64>>()
    };
    let mut figure = Figure::new(
        "Steady-state friction",
        format!("speed at {}", units.at),
        "friction",
    )
    .units(units.speed, units.force)
    .series(Series::line(
        "axis file",
        speeds.clone(),
        curve(&context.axis.friction.law),
    ))
    .series(Series::line("identified", speeds.clone(), curve(&results.friction_law)).dashed())
    .log_x()
    .alt("Steady-state friction torque against speed");
    if results.friction.simulated {
        let machine = curve(&context.machine.friction.law);
        figure = figure.series(Series::line("machine", speeds.clone(), machine));
    }
    let dots = [runs("runs used", false), runs("runs left out", true)];
    for series in dots.into_iter().flatten() {
        figure = figure.series(series);
    }
    figure
}

/// Constant-speed runs.
pub fn vibration(results: &Results) -> Section {
    let unit = results.validation.unit;
    let mut table = Table::new(
        "Tracking error at constant speed, last second of four",
        [
            format!("Speed, {}/s", unit.thousand()),
            format!("peak to peak, {unit}"),
            "frequency, Hz".to_owned(),
            format!("peak to peak, {unit}"),
            "frequency, Hz".to_owned(),
        ],
    )
    .group("", 1)
    .group("Model", 2)
    .group("Machine (simulated)", 2);
    let cells = |v: &Vibration| {
        [
            Cell::number(*v.peak_to_peak, 2),
            v.frequency_hz
                .map_or(Cell::text("quiet"), |f| Cell::number(f, 1)),
        ]
    };
    let v = &results.validation;
    for (a, b) in v.vibration_model.iter().zip(&v.vibration_machine) {
        let speed = [Cell::number(*a.speed, 0)];
        table = table.row(speed.into_iter().chain(cells(a)).chain(cells(b)));
    }
    Section::new("Self-excited vibration")
        .paragraph("Where friction falls with speed it feeds the load's vibration on the transmission's stiffness.")
        .table(table)
}

/// Frequencies against position.
pub fn modes(results: &Results) -> Section {
    let modes = &results.validation.modes;
    let x: Vec<f64> = modes.iter().map(|m| *m.position).collect();
    let count = modes.first().map_or(0, |m| m.frequencies_hz.len());
    if count == 0 {
        return Section::new("Modes")
            .paragraph("This mechanism moves as one with its motor: it has no natural frequency.");
    }
    let mut figure = Figure::new("Natural frequencies", "position of the load", "frequency")
        .units(results.validation.unit.million(), "Hz")
        .log_y()
        .alt("Natural frequencies of the drive against the load's position");
    for mode in 0..count {
        let y = modes.iter().map(|m| m.frequencies_hz[mode]).collect();
        figure = figure.series(Series::line(format!("mode {}", mode + 1), x.clone(), y));
    }
    Section::new("Modes").figure(figure)
}
