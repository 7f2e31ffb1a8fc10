//! A page with every kind of block and figure: `cargo run -p axis-report --example demo -- demo.html`.

use std::error::Error;

use axis_report::{
    Block, Cell, Figure, KeyValues, Mark, Notice, Page, Section, Series, Table, write_atomic,
};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("demo.html".to_owned());
    let answers = vec![
        ("What it is".to_owned(), vec!["Made-up curves.".to_owned()]),
        (
            "What next".to_owned(),
            vec!["Drag over a figure.".to_owned()],
        ),
    ];
    let page = Page::new("Every kind of block")
        .lead("Nothing here was measured or simulated.")
        .first(Block::Answers(answers))
        .section(
            Section::new("Text")
                .notice(Notice::Info, "A note.")
                .table(table()),
        )
        .section(
            Section::new("Figures")
                .figure(lines())
                .figure_grid(small(), 2),
        )
        .section(Section::new("Folded").folded("More", vec![Block::Figure(lines())]))
        .section(Section::new("Settings").key_values(KeyValues::new("").entry("Seed", 1)));
    write_atomic(path, &page)?;
    Ok(())
}

fn table() -> Table {
    Table::new("Numbers", ["name", "fixed", "power of ten", "with unit"]).row([
        Cell::text("one"),
        Cell::number(-1.25, 2).marked(Mark::Best),
        Cell::scientific(6.433e-7, 3),
        Cell::quantity(6.433e-7, "m", 3),
    ])
}

/// `count` points of a function from 0 to `end`.
fn curve(count: u32, end: f64, of: fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let x = (0..count).map(|k| end * f64::from(k) / f64::from(count - 1));
    x.map(|x| (x, of(x))).unzip()
}

fn lines() -> Figure {
    let (time, error) = curve(36_000, 3.6, |t| 5e-5 * (9.0 * t).sin() * (-t).exp());
    let (coarse, held) = curve(40, 3.6, |t| 5e-5 * (-t).exp());
    Figure::new("A line and a step", "time", "error")
        .units("s", "m")
        .linked("time")
        .series(Series::line("error", time, error))
        .series(Series::step("envelope", coarse, held).dashed())
}

fn small() -> Vec<Figure> {
    let (time, force) = curve(500, 3.6, |t| 1200.0 * (2.0 * t).cos());
    let (speed, friction) = curve(200, 5.0, |u| 1.0 + (-u).exp() + 0.02 * 10f64.powf(u / 2.0));
    let speed: Vec<f64> = speed.iter().map(|u| 1e-4 * 10f64.powf(*u)).collect();
    let (angle, _) = curve(200, std::f64::consts::TAU, f64::sin);
    let (x, y) = angle.iter().map(|a| (a.cos(), (a - 0.4).cos())).unzip();
    vec![
        Figure::new("Shares the time of figure 1", "time", "force")
            .units("s", "N")
            .linked("time")
            .series(Series::line("force", time, force)),
        Figure::new("Logarithmic axes", "speed", "friction")
            .units("m/s", "N·m")
            .log_x()
            .log_y()
            .series(Series::line("law", speed.clone(), friction.clone()))
            .series(Series::dots(
                "runs",
                speed[..40].to_vec(),
                friction[..40].to_vec(),
            )),
        Figure::new("Named rows", "left, %", "")
            .rows(["1 first case", "2 second case", "3 third case"])
            .log_x()
            .series(Series::dots("a", vec![0.1, 10.0, 3.0], vec![0.0, 1.1, 2.0]))
            .series(Series::dots("b", vec![0.2, 5.0, 1.0], vec![0.1, 1.0, 1.9])),
        Figure::new("A loop, which stays a picture", "x", "force")
            .units("mm", "kN")
            .series(Series::line("hysteresis", x, y)),
    ]
}
