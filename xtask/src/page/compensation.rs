//! Figure 13, Tables 15 and 16.

use pipeline::strategies::Strategy;
use report::{Cell, Section, Series, Table};

use super::{best_if, pair, printed, times, tracking};
use crate::paper::{Pair, Row};
use crate::results::Results;

type PaperColumn = fn(&Row) -> Pair;

/// The five cases of the paper's Fig. 13 without the first, and how the paper prints them.
const CASES: [(Strategy, &str, PaperColumn); 4] = [
    (Strategy::Network, "Network", |row| row.network),
    (Strategy::TransferFunction, "Transfer function", |row| {
        row.transfer
    }),
    (Strategy::NetworkLugre, "Network + LuGre", |row| {
        row.network_lugre
    }),
    (
        Strategy::TransferFunctionLugre,
        "Transfer function + LuGre",
        |row| row.transfer_lugre,
    ),
];

/// The section.
pub fn compensation(results: &Results) -> Section {
    let [network, transfer, network_lugre, transfer_lugre] = CASES;
    let without = table(
        results,
        "Without friction feed-forward, µm (Table 16)",
        [network, transfer],
    );
    let with = table(
        results,
        "With LuGre feed-forward, identified parameters, µm (Table 15)",
        [network_lugre, transfer_lugre],
    );
    let grid = results.validation.trajectories.iter().map(|t| {
        let time = |run: &[f64]| times(run.len(), results.transfer[0].period);
        let mut figure = tracking::figure(t).series(Series::line(
            "none",
            time(&t.machine.error_um),
            t.machine.error_um.clone(),
        ));
        for (strategy, name, _) in CASES {
            if let Some(run) = find(results, t.id, strategy) {
                figure = figure.series(Series::line(
                    name,
                    time(&run.error_um),
                    run.error_um.clone(),
                ));
            }
        }
        figure
    });
    Section::new("Compensation")
        .paragraph("On the simulated machine. The compensator sees what a controller samples: reference, table position, motor speed, currents. Network: ΔS = S_ref − S + Ê, Ê predicted for the end of the cycle (Section 4.4). Transfer function: a linear model of the tracking error, driven by the reference and led by the position loop's time constant; beside LuGre, the model of the error that LuGre leaves. LuGre: current for the friction along the reference, with the parameters identified on the machine. A figure is marked where its peak is at or below the paper's.")
        .table(without)
        .table(with)
        .table(others(results))
        .table(transfer_models(results))
        .figure_grid(grid.collect(), 2)
}

fn table(results: &Results, caption: &str, cases: [(Strategy, &str, PaperColumn); 2]) -> Table {
    let mut table = Table::new(
        caption,
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
    .group("None", 2);
    for (_, name, _) in cases {
        table = table.group(name, 2).group(format!("Paper's, {name}"), 2);
    }
    for (i, t) in results.validation.trajectories.iter().enumerate() {
        let paper = results.paper.as_ref().and_then(|p| p.trajectories.get(i));
        let mut row = vec![Cell::text(t.id.to_string())];
        row.extend(pair(t.machine.figures));
        for (strategy, _, column) in cases {
            let theirs = paper.map(column);
            match find(results, t.id, strategy) {
                Some(run) => {
                    let met = theirs.is_some_and(|[max, _]| run.figures.max <= max);
                    row.extend(best_if(met, pair(run.figures)));
                }
                None => row.extend([Cell::Missing, Cell::Missing]),
            }
            row.extend(printed(theirs));
        }
        table = table.row(row);
    }
    table
}

fn others(results: &Results) -> Table {
    let mut table = Table::new(
        "Two more strategies, µm",
        ["Trajectory", "max", "mean", "max", "mean"],
    )
    .group("", 1)
    .group("LuGre alone, identified", 2)
    .group("Network + LuGre, the axis file's own parameters", 2);
    for t in &results.validation.trajectories {
        let mut row = vec![Cell::text(t.id.to_string())];
        for strategy in [Strategy::Lugre, Strategy::NetworkLugrePrinted] {
            match find(results, t.id, strategy) {
                Some(run) => row.extend(pair(run.figures)),
                None => row.extend([Cell::Missing, Cell::Missing]),
            }
        }
        table = table.row(row);
    }
    table
}

/// The transfer functions themselves.
fn transfer_models(results: &Results) -> Table {
    let mut table = Table::new(
        "Transfer functions of the tracking error, identified from simulated motion of the model",
        [
            "Servo",
            "order",
            "poles, ms",
            "missed on training motions, RMS µm",
            "on other motions, RMS µm",
            "candidates tried",
        ],
    );
    for (t, name) in results
        .transfer
        .iter()
        .zip(["alone", "with LuGre feed-forward"])
    {
        let mut times: Vec<f64> = t.poles.iter().map(|p| -1e3 * t.period / p.ln()).collect();
        times.dedup();
        times.truncate(2);
        let times: Vec<String> = times.iter().map(|ms| format!("{ms:.1}")).collect();
        table = table.row([
            Cell::text(name),
            Cell::text(t.poles.len().to_string()),
            Cell::text(times.join(" and ")),
            Cell::number(t.training_rms_um, 3),
            Cell::number(t.validation_rms_um, 3),
            Cell::text(t.candidates.to_string()),
        ]);
    }
    table
}

fn find(results: &Results, id: usize, strategy: Strategy) -> Option<&pipeline::tracking::Run> {
    let mut runs = results.compensation.iter();
    runs.find(|run| run.id == id && run.strategy == strategy)
        .map(|run| &run.run)
}
