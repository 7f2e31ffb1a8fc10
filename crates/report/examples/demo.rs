//! A page with every kind of block, written to the path given (or `demo.html`):
//! `cargo run -p report --example demo -- demo.html`.

use std::error::Error;
use std::time::Instant;

use report::{Block, Cell, Figure, KeyValues, Mark, Notice, Page, Section, Series, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("demo.html".into());
    let page = Page::new("Tracking errors of a made-up axis")
        .lead("Every kind of block that a report can hold; all numbers are made up.")
        .section(verdict())
        .section(errors())
        .section(details());
    let start = Instant::now();
    let size = report::render(&page)?.len();
    println!("{size} bytes in {:?}", start.elapsed());
    report::write_atomic(&path, &page)?;
    println!("wrote {path}");
    Ok(())
}

fn verdict() -> Section {
    let row = |name: &str, paper: [f64; 2], ours: [f64; 2]| {
        let ours_mark = if ours[0] <= paper[0] {
            Mark::Best
        } else {
            Mark::Failing
        };
        Table::new("", [""; 0]).row([
            Cell::text(name),
            Cell::number(paper[0], 2),
            Cell::number(paper[1], 3),
            Cell::number(ours[0], 2).marked(ours_mark),
            Cell::number(ours[1], 3),
            Cell::scientific(ours[1] * 1e-6, 2),
        ])
    };
    let mut table = Table::new(
        "Errors with and without compensation",
        [
            "case",
            "max (µm)",
            "mean (µm)",
            "max (µm)",
            "mean (µm)",
            "mean (m)",
        ],
    )
    .group("", 1)
    .group("Paper", 2)
    .group("Ours", 3)
    .note("Best where ours is at or below the paper's; underlined where it is not.");
    for made in [
        row("none", [54.86, 6.753], [55.89, 6.556]),
        row("network", [30.1, 4.1], [29.9, 3.95]),
        row(
            "network and friction feed-forward",
            [17.1, 2.45],
            [8.71, 1.93],
        ),
    ] {
        table.rows.extend(made.rows);
    }
    table.rows.push(
        [
            vec![Cell::text("transfer function")],
            vec![Cell::Missing; 5],
        ]
        .concat(),
    );
    Section::new("Verdict")
        .notice(Notice::Good, "The peak error falls from 55.9 to 8.7 µm.")
        .notice(Notice::Warn, "Nothing on this page was measured.")
        .notice(Notice::Info, "Text is escaped: 1 < 2 & \"three\".")
        .table(table)
}

fn errors() -> Section {
    let t: Vec<f64> = (0..36_000).map(|k| f64::from(k) * 1e-4).collect();
    // A lag that follows the speed, ripple, and one spike of a single sample.
    let error = |scale: f64, phase: f64| -> Vec<f64> {
        t.iter()
            .enumerate()
            .map(|(k, t)| {
                let spike = if k == 20_000 { 30.0 * scale } else { 0.0 };
                let ripple = 3.0 * (380.0 * t + phase).sin() * (0.7 * t).cos();
                scale * (40.0 * (1.7 * t + phase).sin() + ripple) + spike
            })
            .collect()
    };
    let epochs: Vec<f64> = (0..=500).map(f64::from).collect();
    let loss = |rate: f64| {
        epochs
            .iter()
            .map(|e| 1e-2 * (1.0 + e).powf(-rate))
            .collect()
    };
    let epoch_series = |name, rate| Series::line(name, epochs.clone(), loss(rate));
    let small = |n: usize| {
        Figure::new(format!("Trajectory {n}"), "t (s)", "error (µm)")
            .series(Series::line("none", t.clone(), error(1.0, n as f64)))
            .series(Series::line("compensated", t.clone(), error(0.2, n as f64)))
    };
    Section::new("Errors in time")
        .paragraph("36 000 samples a series; the spike at 2 s is one sample wide.")
        .figure(
            Figure::new("Tracking error, trajectory 1", "t (s)", "error (µm)")
                .series(Series::line("none", t.clone(), error(1.0, 0.0)))
                .series(Series::line("network", t.clone(), error(0.5, 0.4)).dashed())
                .series(Series::line("network + LuGre", t.clone(), error(0.15, 0.8)))
                .caption("Error = reference − position at the sampling instants."),
        )
        .figure(
            Figure::new("Training history", "epoch", "mean squared error")
                .series(epoch_series("training", 4.4))
                .series(epoch_series("validation", 4.2).dashed())
                .log_y(),
        )
        .figure_grid((1..=4).map(small).collect(), 2)
}

fn details() -> Section {
    let speed: Vec<f64> = (0..60)
        .map(|k| 10f64.powf(-2.0 + f64::from(k) / 20.0))
        .collect();
    let torque = |v: &f64| 1e-4 * (0.4 + 0.6 * (-v * v).exp() + 0.05 * v);
    let steps: Vec<f64> = (0..20).map(f64::from).collect();
    let levels = steps.iter().map(|k| (k / 3.0).sin().round()).collect();
    let mut long = Table::new("Every sample", ["k", "value"]).folded();
    for k in 0..100 {
        long = long.row([
            Cell::text(k.to_string()),
            Cell::number(f64::from(k).sqrt(), 4),
        ]);
    }
    Section::new("Details")
        .figure_grid(
            vec![
                Figure::new("Friction", "speed (rad/s)", "torque (N·m)")
                    .series(Series::line(
                        "law",
                        speed.clone(),
                        speed.iter().map(torque).collect(),
                    ))
                    .series(Series::dots(
                        "runs",
                        speed.clone(),
                        speed.iter().map(|v| torque(v) * 1.03).collect(),
                    ))
                    .log_x(),
                Figure::new("Switch states", "cycle", "state")
                    .series(Series::step("leg A", steps, levels)),
                Figure::new(
                    "Constant",
                    "t (s)",
                    "position of the table on the guideway (m)",
                )
                .series(Series::line("x", vec![0.0, 1.0], vec![0.6, 0.6])),
            ],
            3,
        )
        .table(long)
        .key_values(
            KeyValues::new("Settings")
                .entry("seed", 433)
                .entry("threads", 2)
                .entry("version", env!("CARGO_PKG_VERSION"))
                .entry(
                    "input hash",
                    "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
                ),
        )
        .folded(
            "Command",
            vec![Block::Preformatted(
                "cargo run -p report --example demo -- demo.html".into(),
            )],
        )
}
