//! Figures 10 to 12, Tables 13 and 14.

use axis_pipeline::ErrorUnit;
use axis_pipeline::tracking::Profile;
use axis_pipeline::validation::ValidatedTrajectory;
use axis_report::{Cell, Figure, Section, Series, Table};

use super::{pair, printed, times};
use crate::context::Context;
use crate::results::Results;

/// Figure 10: velocity, acceleration, jerk.
pub fn profiles(results: &Results) -> Section {
    let length = results.validation.unit.thousand();
    let figure = |title: &str, per: &str, of: fn(&Profile) -> &Vec<f64>| {
        let mut figure = Figure::new(title, "time", title.to_lowercase())
            .units("s", format!("{length}{per}"))
            .linked("profile")
            .alt(format!("{title} of each trajectory against time"));
        for t in &results.validation.trajectories {
            let name = format!("trajectory {}", t.id);
            figure = figure.series(Series::line(
                name,
                t.profile.time_s.clone(),
                of(&t.profile).clone(),
            ));
        }
        figure
    };
    Section::new("Trajectories")
        .paragraph("Seven-segment, jerk-limited S-curves (the paper's Fig. 10, Table 12).")
        .figure_grid(
            vec![
                figure("Velocity", "/s", |p| &p.velocity),
                figure("Acceleration", "/s²", |p| &p.acceleration),
                figure("Jerk", "/s³", |p| &p.jerk),
            ],
            3,
        )
}

/// Figure 11 and Table 13.
pub fn model_and_machine(context: &Context, results: &Results) -> Section {
    let unit = context.unit();
    let mut table = Table::new(
        format!("Tracking error without compensation, {unit} (Table 13)"),
        [
            "Trajectory",
            "max",
            "mean",
            "max",
            "mean",
            "max",
            "mean",
            "max",
            "mean",
        ],
    )
    .group("", 1)
    .group("Model", 2)
    .group("Paper's model", 2)
    .group("Machine (simulated)", 2)
    .group("Paper's experiment", 2);
    for (i, t) in results.validation.trajectories.iter().enumerate() {
        let paper = results.paper.as_ref().and_then(|p| p.trajectories.get(i));
        table = table.row(
            [Cell::text(t.id.to_string())]
                .into_iter()
                .chain(pair(t.model.figures))
                .chain(printed(paper.map(|p| p.model)))
                .chain(pair(t.machine.figures))
                .chain(printed(paper.map(|p| p.experiment))),
        );
    }
    let grid = results.validation.trajectories.iter().map(|t| {
        let time = times(t.model.error.len(), context.axis.period);
        let deviation = t
            .machine
            .error
            .iter()
            .zip(t.model.error.iter())
            .map(|(a, b)| a - b);
        figure(t, unit)
            .series(Series::line(
                "machine",
                time.clone(),
                t.machine.error.to_vec(),
            ))
            .series(Series::line("model", time.clone(), t.model.error.to_vec()).dashed())
            .series(Series::line("machine − model", time, deviation.collect()))
    });
    Section::new("Model and machine")
        .paragraph("Error = reference − position of the load at the sampling instants, from the start to the end of the motion (the paper's Fig. 11).")
        .table(table)
        .figure_grid(grid.collect(), 2)
}

/// Figure 12 and Table 14.
pub fn prediction(results: &Results) -> Section {
    let unit = results.validation.unit;
    let mut table = Table::new(
        format!("The machine's tracking error as predicted, {unit} (Table 14)"),
        [
            "Trajectory",
            "max",
            "mean",
            "max",
            "mean",
            "max",
            "mean",
            "max",
            "mean",
            "max",
            "mean",
        ],
    )
    .group("", 1)
    .group("Machine (simulated)", 2)
    .group("Network", 2)
    .group("Paper's network", 2)
    .group("Transfer function", 2)
    .group("Paper's transfer f.", 2);
    let mut missed = Table::new(
        format!("Error of the predictions of the machine's error, {unit}"),
        ["Trajectory", "max", "mean", "max", "mean"],
    )
    .group("", 1)
    .group("Network", 2)
    .group("Transfer function", 2);
    for (i, t) in results.validation.trajectories.iter().enumerate() {
        let paper = results.paper.as_ref().and_then(|p| p.trajectories.get(i));
        table = table.row(
            [Cell::text(t.id.to_string())]
                .into_iter()
                .chain(pair(t.machine.figures))
                .chain(pair(t.network.figures))
                .chain(printed(paper.map(|p| p.predicted_network)))
                .chain(pair(t.transfer_function.figures))
                .chain(printed(paper.map(|p| p.predicted_transfer))),
        );
        missed = missed.row([
            Cell::text(t.id.to_string()),
            Cell::number(t.network_deviation.max, 4),
            Cell::number(t.network_deviation.mean, 5),
            Cell::number(t.transfer_function_deviation.max, 2),
            Cell::number(t.transfer_function_deviation.mean, 3),
        ]);
    }
    let grid = results.validation.trajectories.iter().map(|t| {
        let time = |run: &[f64]| times(run.len(), results.transfer[0].period);
        let miss: Vec<f64> = (t.machine.error.iter().zip(t.transfer_function.error.iter()))
            .map(|(a, b)| a - b)
            .collect();
        figure(t, unit)
            .series(Series::line(
                "machine",
                time(&t.machine.error),
                t.machine.error.to_vec(),
            ))
            .series(
                Series::line("network", time(&t.network.error), t.network.error.to_vec()).dashed(),
            )
            .series(Series::line(
                "transfer function",
                time(&t.transfer_function.error),
                t.transfer_function.error.to_vec(),
            ))
            .series(Series::line(
                "machine − transfer function",
                time(&miss),
                miss,
            ))
    });
    Section::new("Prediction")
        .paragraph("The network predicts one cycle ahead from what the controller samples of the machine, the transfer function from the reference alone; the two are not equals. The network's deviation does not show at this scale: over one cycle the motion is almost pure kinematics.")
        .table(table)
        .table(missed)
        .figure_grid(grid.collect(), 2)
}

/// An empty figure of tracking errors.
pub fn figure(t: &ValidatedTrajectory, unit: ErrorUnit) -> Figure {
    let title = format!("Trajectory {}", t.id);
    Figure::new(title.clone(), "time", "tracking error")
        .units("s", unit.symbol())
        .linked(&title)
        .alt(format!("{title}: tracking errors against time"))
}
