//! Tables 7 to 11.

use crate::results::Results;
use axis_pipeline::Figures;
use axis_pipeline::study::StudyRow;
use axis_report::{Cell, Figure, Section, Series, Table, engineering};

/// Table 11 and the training history.
pub fn network(results: &Results) -> Section {
    let t = &results.training;
    let unit = t.unit.symbol();
    let row = |name: &str, figures: Figures| {
        [
            Cell::text(name),
            Cell::quantity(figures.max, unit, 3),
            Cell::quantity(figures.mean, unit, 3),
        ]
    };
    let mut table = Table::new(
        "Absolute error of the predicted position after one cycle (Table 11)",
        ["", "max", "mean"],
    )
    .row(row("Best linear map, unseen samples", t.linear))
    .row(row("Network, unseen samples", t.network))
    .row(row("Network, its training samples", t.seen));
    if let Some([max, mean]) = results.paper.as_ref().map(|p| p.network) {
        table = table.row(row("Paper's network", Figures { max, mean })).note(
            "The paper's figure lies below what friction leaves (docs/readings.md) and near the rounding of a position of 1.5 m in f64, 2.2e-10 µm.",
        );
    }
    let layers: Vec<String> = t.hidden.iter().map(usize::to_string).collect();
    let epochs: Vec<f64> = (1..=t.rms.len()).map(|epoch| epoch as f64).collect();
    let history = Figure::new("Training", "epoch", "RMS error on the training samples")
        .units("", unit)
        .series(Series::line("training samples", epochs, t.rms.to_vec()))
        .log_y()
        .alt("RMS error on the training samples against the epoch, falling");
    let times = |a: f64, b: f64| a / b;
    Section::new("Network")
        .paragraph(format!(
            "4-{}-1 cascade-forward network, {} epochs of Levenberg–Marquardt (initial damping {}), {} training samples, {} unseen ones evenly spread over Table 5. It learns what the best linear map leaves, scaled by itself; the map is then folded into its direct links. The training samples are denser near zero speed, where friction is all that the linear map leaves. Trained in {:.1} s.",
            layers.join("-"),
            t.epochs,
            t.initial_damping,
            t.train_samples,
            t.test_samples,
            t.seconds
        ))
        .paragraph(format!(
            "Against the linear map: maximum {:.1} times, mean {:.1} times smaller.",
            times(t.linear.max, t.network.max),
            times(t.linear.mean, t.network.mean)
        ))
        .table(table)
        .figure(history)
}

/// Tables 7 to 10.
pub fn study(results: &Results) -> Section {
    let mut section = Section::new("Study of damping, layers, neurons and epochs").paragraph(
        "Small networks that learn the position itself, from Nguyen–Widrow starting weights, judged by unseen samples: the median over seeds, and the range.",
    );
    if results.paper.is_some() {
        section = section.paragraph(
            "The paper prints one run of each, in mm. Its errors of millimetres are far above the best linear map's, which every cascade-forward network contains: its trainings had not converged.",
        );
    }
    let seeds = results.study.first().map_or(0, |row| row.errors.len());
    for table in 7..=10 {
        let caption = format!("Table {table} over {seeds} seeds: absolute error");
        let mut shown = Table::new(
            caption,
            [
                "Setting",
                "max, median",
                "max, range",
                "mean, median",
                "mean, range",
                "paper's max",
                "paper's mean",
            ],
        );
        let rows = results.study.iter().enumerate();
        for (i, row) in rows.filter(|(_, row)| row.setting.table == table) {
            let theirs = results.paper.as_ref().and_then(|p| p.study.get(i));
            shown = shown.row(study_row(row, theirs));
        }
        section = section.table(shown.note(trend(results, table)));
    }
    section
}

fn study_row(row: &StudyRow, theirs: Option<&[f64; 2]>) -> [Cell; 7] {
    let unit = row.unit.symbol();
    let column = |of: fn(&Figures) -> f64| {
        let mut values: Vec<f64> = row.errors.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        let range = [values[0], values[values.len() - 1]]
            .map(|v| engineering(v, unit, 2))
            .join(" to ");
        [Cell::quantity(median(&values), unit, 3), Cell::text(range)]
    };
    let [max, max_range] = column(|f| f.max);
    let [mean, mean_range] = column(|f| f.mean);
    let paper = |i: usize| theirs.map_or(Cell::Missing, |p| Cell::quantity(p[i], "mm", 3));
    let label = Cell::text(row.setting.label.clone());
    [label, max, max_range, mean, mean_range, paper(0), paper(1)]
}

/// Whether the medians fall along the table as the paper's figures do.
fn trend(results: &Results, table: u32) -> String {
    let rows = results
        .study
        .iter()
        .filter(|row| row.setting.table == table);
    let medians: Vec<f64> = rows
        .map(|row| {
            let mut values: Vec<f64> = row.errors.iter().map(|f| f.mean).collect();
            values.sort_by(f64::total_cmp);
            median(&values)
        })
        .collect();
    let what = match table {
        7 => "a higher initial damping",
        8 => "more layers",
        9 => "more neurons",
        _ => "more epochs",
    };
    let falls = medians.windows(2).all(|pair| pair[1] < pair[0]);
    let verdict = if falls { "holds" } else { "does not hold" };
    format!(
        "In the paper's figures {what} makes the error smaller; over the medians of the mean error here that {verdict}."
    )
}

fn median(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[middle]
    } else {
        0.5 * (sorted[middle - 1] + sorted[middle])
    }
}
