//! What compensation leaves where the assumed model is wrong: every draw a point.

use axis_pipeline::ErrorUnit;
use axis_pipeline::robustness::Point;
use axis_report::{Cell, Figure, Mark, Section, Series, Table};
use serde::{Deserialize, Serialize};

use crate::context::Context;

/// robustness.json.
#[derive(Serialize, Deserialize)]
pub struct Robustness {
    pub axis: String,
    pub axis_fingerprint: String,
    pub machine: String,
    pub machine_fingerprint: String,
    pub seed: u64,
    /// Whether fewer draws were made.
    pub quick: bool,
    pub version: String,
    /// Unit of the maxima and means.
    pub unit: ErrorUnit,
    pub rows: Vec<Row>,
}

/// A row: draws of one kind under one strategy.
#[derive(Serialize, Deserialize)]
pub struct Row {
    pub what: String,
    pub strategy: String,
    pub noise: bool,
    pub moves: Vec<Asked>,
    pub points: Vec<Point>,
}

/// What was asked of a counted move, and whether all draws keep it.
#[derive(Serialize, Deserialize)]
pub struct Asked {
    pub counted: String,
    pub asked: String,
    pub goal: Limit,
    pub worst: String,
    pub kept: bool,
}

/// The goal of the greatest error.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub enum Limit {
    /// Share of what is there without compensation that may be left, %.
    #[serde(rename = "left_percent")]
    Percent(f64),
    /// What may be left, µm.
    #[serde(rename = "left_um")]
    Micrometres(f64),
    /// The same of an axis that turns, µrad.
    #[serde(rename = "left_urad")]
    Microradians(f64),
}

impl Limit {
    /// What may be left, in the unit of the axis' errors.
    pub fn left(unit: ErrorUnit, most: f64) -> Self {
        match unit {
            ErrorUnit::Micrometre => Self::Micrometres(most),
            ErrorUnit::Microradian => Self::Microradians(most),
        }
    }
}

impl Robustness {
    /// Those of an axis and its machine, where they were made.
    pub fn of(context: &Context) -> Option<Self> {
        let bytes = std::fs::read(context.out.join("robustness.json")).ok()?;
        let made: Self = serde_json::from_slice(&bytes).ok()?;
        let same = made.axis_fingerprint == context.axis.fingerprint
            && made.machine_fingerprint == context.machine.fingerprint
            && made.version == env!("CARGO_PKG_VERSION");
        same.then_some(made)
    }
}

/// A strip of the plot: a counted move of a row.
struct Strip<'a> {
    name: String,
    strategy: String,
    limit: f64,
    left: Vec<f64>,
    asked: &'a Asked,
    draws: usize,
}

/// The section.
pub fn robustness(made: &Robustness) -> Section {
    let [shares, sizes] = [true, false].map(|shares| strips(made, shares));
    let mut section = Section::new("Compensation when the model is wrong").paragraph(format!(
        "Simulated, seed {}. Each point is the peak of the tracking error in one draw of model, machine, motion and sensor noise; the black one is the goal: all points of its row should lie to its left.",
        made.seed
    ));
    let left = format!("peak left, {}", made.unit);
    let figures = [
        (
            &shares,
            "Share of the uncompensated peak that is left",
            "peak left, %",
        ),
        (&sizes, "Peak that is left", left.as_str()),
    ];
    for (strips, title, label) in figures {
        if !strips.is_empty() {
            section = section.figure(figure(strips, title, label));
        }
    }
    section.table(table(shares.iter().chain(&sizes)))
}

/// Counted moves of one kind of goal, numbered from the first of the page on.
fn strips(made: &Robustness, shares: bool) -> Vec<Strip<'_>> {
    let mut found = Vec::new();
    let mut number = 0;
    for row in &made.rows {
        for (i, asked) in row.moves.iter().enumerate() {
            number += 1;
            let limit = match (asked.goal, shares) {
                (Limit::Percent(limit), true)
                | (Limit::Micrometres(limit) | Limit::Microradians(limit), false) => limit,
                _ => continue,
            };
            let left = row.points.iter().map(|p| match shares {
                true => 100.0 - p.peak_taken(i),
                false => p.compensated[i].max,
            });
            // In what all such rows share there is nothing to tell them apart by.
            let what = row.what.trim_end_matches(", assumed wrong");
            let name = match row.moves.len() {
                1 => format!("{number} {what}"),
                _ => format!("{number} {what}, {}", asked.counted),
            };
            found.push(Strip {
                name,
                strategy: row.strategy.replace('_', " "),
                limit,
                left: left.collect(),
                asked,
                draws: row.points.len(),
            });
        }
    }
    found
}

/// Golden section: neighbours in a list lie far apart in their row.
const SCATTER: f64 = 0.618;

fn figure(strips: &[Strip<'_>], title: &str, label: &str) -> Figure {
    let mut strategies: Vec<&str> = strips.iter().map(|s| s.strategy.as_str()).collect();
    strategies.sort_unstable();
    strategies.dedup();
    let mut figure = Figure::new(title, label, "")
        .rows(strips.iter().map(|s| s.name.clone()))
        .log_x();
    for strategy in strategies {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for (row, strip) in strips.iter().enumerate() {
            if strip.strategy == strategy {
                x.extend(strip.left.iter().map(|left| left.max(1e-6)));
                let scattered = |k: usize| row as f64 + 0.6 * ((k as f64 * SCATTER) % 1.0 - 0.5);
                y.extend((0..strip.left.len()).map(scattered));
            }
        }
        figure = figure.series(Series::dots(strategy, x, y));
    }
    let goals = strips.iter().map(|strip| strip.limit).collect();
    let rows = (0..strips.len()).map(|row| row as f64).collect();
    figure
        .series(Series::dots("goal", goals, rows).colour(6))
        .caption("Each draw is a point; its height within a row has no meaning.")
}

fn table<'a>(strips: impl Iterator<Item = &'a Strip<'a>>) -> Table {
    let columns = [
        "Case",
        "counted",
        "strategy",
        "draws",
        "asked",
        "worst draw, peak / mean",
    ];
    let mut table = Table::new("Goals, and the worst of all draws", columns);
    for strip in strips {
        let worst = Cell::text(strip.asked.worst.clone());
        table = table.row([
            Cell::text(strip.name.clone()),
            Cell::text(strip.asked.counted.clone()),
            Cell::text(strip.strategy.clone()),
            Cell::text(strip.draws.to_string()),
            Cell::text(strip.asked.asked.clone()),
            match strip.asked.kept {
                true => worst.marked(Mark::Best),
                false => worst,
            },
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use axis_pipeline::Figures;
    use axis_report::{Page, render};

    use super::*;

    /// Every draw of every row is drawn, in both sizes of the plot, and goals besides.
    #[test]
    fn each_draw_is_a_point() {
        let figures = |max: f64| {
            vec![Figures {
                max,
                mean: 0.1 * max,
            }]
        };
        let point = |k: usize| Point {
            none: figures(50.0),
            compensated: figures(0.5 * 1.1_f64.powi(k as i32)),
        };
        let row = |goal, count: usize| Row {
            what: "assumed wrong".to_owned(),
            strategy: "adaptive_feedback".to_owned(),
            noise: true,
            moves: vec![Asked {
                counted: "first move".to_owned(),
                asked: String::new(),
                goal,
                worst: String::new(),
                kept: true,
            }],
            points: (0..count).map(point).collect(),
        };
        let made = Robustness {
            axis: String::new(),
            axis_fingerprint: String::new(),
            machine: String::new(),
            machine_fingerprint: String::new(),
            seed: 1,
            quick: false,
            version: String::new(),
            unit: ErrorUnit::Micrometre,
            rows: vec![
                row(Limit::Percent(4.0), 20),
                row(Limit::Micrometres(0.6), 7),
            ],
        };
        let html = render(&Page::new("").section(robustness(&made))).unwrap();
        // A dot is a line of no length.
        let points = html.matches("h0").count();
        assert_eq!(points, 2 * (20 + 1 + 7 + 1), "{points}");
        assert!(html.contains("1 assumed wrong"));
    }
}
