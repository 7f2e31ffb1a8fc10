//! `robustness`: what compensation leaves when the model is wrong, draw by draw.

use std::ops::Range;
use std::path::{Path, PathBuf};

use axis_pipeline::ErrorUnit;
use axis_pipeline::robustness::{Draws, Goal, Point, Sense, Study, make, studies};
use axis_report::{Page, render};
use axis_sim::Measured;
use axis_sim::NoiseLevels;
use campaign::{Column, Failure, Inputs, Job, Merged, Value};
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};

use crate::context::{Claim, Common, Context};
use crate::file_set::FileSet;
use crate::jobs::{JobOptions, Sharding, failure};
use crate::output::{Worded, print};
use crate::page::robustness as robustness_page;
use crate::page::robustness::{Asked, Limit, Robustness, Row};

/// The table, and its page.
const TABLE: &str = "robustness.json";
const PAGE: &str = "robustness.html";

/// Options of `robustness`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Number of wrong models in the rows that draw them at random, and of random programs
    /// [default: 50
    /// and 12]
    #[arg(long, value_name = "N")]
    draws: Option<usize>,
    #[command(flatten)]
    sharding: Sharding,
}

impl JobOptions for Options {
    fn job(&self) -> Result<Box<dyn Job>> {
        let context = self.common.open()?;
        let draws = match (self.draws, context.quick) {
            (Some(n), _) => Draws {
                models: n.max(1),
                programs: n.max(1),
            },
            (None, true) => Draws::QUICK,
            (None, false) => Draws::FULL,
        };
        let rows = studies(&context.axis, &context.machine, context.seed, draws);
        Ok(Box::new(AllDraws {
            rows: rows.into_diagnostic()?,
            folder: context.out.join("robustness"),
            context,
            draws,
        }))
    }

    fn sharding(&self) -> &Sharding {
        &self.sharding
    }

    fn claim(&self) -> Result<Option<Claim>> {
        self.common.open()?.claim().map(Some)
    }
}

/// The table as a job: a case is a draw, those of one row after those of another.
struct AllDraws {
    context: Context,
    folder: PathBuf,
    draws: Draws,
    rows: Vec<Study>,
}

impl AllDraws {
    /// Each row with its cases.
    fn ranges(&self) -> impl Iterator<Item = (&Study, Range<usize>)> {
        let mut end = 0;
        self.rows.iter().map(move |row| {
            let start = end;
            end += row.draws;
            (row, start..end)
        })
    }

    fn point(&self, case: usize) -> std::result::Result<Point, Failure> {
        let mut ranges = self.ranges();
        let found = ranges.find(|(_, cases)| cases.contains(&case));
        let (row, cases) = found.ok_or("no such draw")?;
        let draw = row.draw(case - cases.start)?;
        let noise = NoiseLevels::good(&draw.machine);
        let sense = |seed: u64| -> Box<dyn FnMut(&mut Measured)> { Box::new(noise.sensors(seed)) };
        let sense = row.noise.then_some(&sense as Sense<'_>);
        let point = make(&self.context.axis, row.strategy, &draw, sense);
        point.map_err(|e| format!("{}, under {}: {e}", row.name, row.strategy).into())
    }
}

impl AllDraws {
    /// Writes the table, and the page that shows each draw.
    fn write(&self, rows: Vec<Row>) -> Result<()> {
        let context = &self.context;
        let table = Robustness {
            axis: context.axis.name.clone(),
            axis_fingerprint: context.axis.fingerprint.clone(),
            machine: context.machine.name.clone(),
            machine_fingerprint: context.machine.fingerprint.clone(),
            seed: context.seed,
            quick: self.draws != Draws::FULL,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            unit: context.unit(),
            rows,
        };
        let mut files = FileSet::new(&context.out, &[TABLE, PAGE])?;
        let json = crate::json::pretty(&table).into_diagnostic()?;
        files.put(TABLE, &json)?;
        let title = format!("Compensation of {}", table.axis);
        let page = Page::new(title).section(robustness_page::robustness(&table));
        let page = render(&page)
            .into_diagnostic()
            .wrap_err("the page cannot be made")?;
        files.put(PAGE, page.as_bytes())?;
        files.publish()?;
        let [json, html] = [TABLE, PAGE].map(|name| context.out.join(name));
        let [json, html] = [json.display(), html.display()];
        let text = format!(
            "{}each draw is a point in {json} and {html}",
            words(&table.rows)
        );
        let value = table;
        print("robustness", &Worded { text, value })
    }
}

impl Job for AllDraws {
    fn name(&self) -> &'static str {
        "robustness"
    }

    fn inputs(&self) -> Inputs {
        self.context
            .inputs()
            .with("draws", format!("{:?}", self.draws))
    }

    fn folder(&self) -> &Path {
        &self.folder
    }

    fn columns(&self) -> &'static [Column] {
        const COLUMNS: [Column; 1] = [Column::text("point")];
        &COLUMNS
    }

    fn cases(&self) -> usize {
        self.rows.iter().map(|row| row.draws).sum()
    }

    fn is_kept(&self) -> bool {
        true
    }

    fn rows(&self, cases: Range<usize>) -> std::result::Result<Vec<campaign::Row>, Failure> {
        let row = |case| {
            Ok(vec![Value::Text(serde_json::to_string(
                &self.point(case)?,
            )?)])
        };
        cases.map(row).collect()
    }

    fn finish(&self, merged: &Merged) -> std::result::Result<(), Failure> {
        let points = |cases: Range<usize>| -> std::result::Result<Vec<Point>, Failure> {
            let read = |row: std::result::Result<campaign::Row, _>| {
                let row: campaign::Row = row.map_err(|e: campaign::CampaignError| e)?;
                Ok(serde_json::from_str(row[0].text()?)?)
            };
            merged.range(cases).map(read).collect()
        };
        let judged = self
            .ranges()
            .map(|(row, cases)| Ok(judge(row, points(cases)?, self.context.unit())));
        let rows = judged.collect::<std::result::Result<Vec<_>, Failure>>()?;
        self.write(rows).map_err(failure)
    }
}

fn judge(row: &Study, points: Vec<Point>, unit: ErrorUnit) -> Row {
    let mut counted: Vec<Counted> = row.moves.iter().map(|_| Counted::default()).collect();
    for point in &points {
        for (i, counted) in counted.iter_mut().enumerate() {
            counted.left = counted.left.max(point.compensated[i].max);
            counted.none = counted.none.max(point.none[i].max);
            counted.peaks.push(point.peak_taken(i));
            counted.means.push(point.mean_taken(i));
        }
    }
    let moves = row.moves.iter().zip(&mut counted);
    Row {
        what: row.name.clone(),
        strategy: row.strategy.to_owned(),
        noise: row.noise,
        moves: moves
            .map(|((words, goal), counted)| asked(words, goal, counted, unit))
            .collect(),
        points,
    }
}

/// What the draws made of one counted move.
#[derive(Default)]
struct Counted {
    /// Greatest error with and without compensation, µm or µrad.
    left: f64,
    none: f64,
    /// Shares taken of the peak and of the mean, %.
    peaks: Vec<f64>,
    means: Vec<f64>,
}

fn asked(words: &str, goal: &Goal, counted: &mut Counted, unit: ErrorUnit) -> Asked {
    counted.peaks.sort_by(f64::total_cmp);
    counted.means.sort_by(f64::total_cmp);
    let worst = |of: &[f64]| of.first().copied().unwrap_or(f64::NAN);
    let median = |of: &[f64]| of.get(of.len() / 2).copied().unwrap_or(f64::NAN);
    let (asked, found, kept) = match *goal {
        Goal::Left(most) => {
            let found = format!("{:.3} {unit} (none: {:.0})", counted.left, counted.none);
            (format!("≤ {most} {unit}"), found, counted.left <= most)
        }
        Goal::Taken {
            peak,
            mean,
            median: middle,
        } => {
            let [of_peak, of_mean] = [&counted.peaks, &counted.means].map(|of| worst(of));
            let [peaks, means] = [&counted.peaks, &counted.means].map(|of| median(of));
            let asked = match (mean, middle) {
                (Some(mean), _) => format!("≥ {peak} / {mean} %"),
                (None, Some(middle)) => format!("≥ {peak} %, median {middle} %"),
                (None, None) => format!("≥ {peak} %"),
            };
            let kept = of_peak >= peak
                && mean.is_none_or(|mean| of_mean >= mean)
                && middle.is_none_or(|middle| peaks >= middle);
            let found = format!("{of_peak:.2} / {of_mean:.2} %, median {peaks:.2} / {means:.2} %");
            (asked, found, kept)
        }
    };
    Asked {
        counted: words.to_owned(),
        asked,
        goal: match *goal {
            Goal::Left(most) => Limit::left(unit, most),
            Goal::Taken { peak, .. } => Limit::Percent(100.0 - peak),
        },
        worst: found,
        kept,
    }
}

/// The rows as a table.
fn words(table: &[Row]) -> String {
    let mut text =
        "| case | strategy | draws | counted | asked | found: worst draw, peak / mean | |\n\
        |---|---|---|---|---|---|---|\n"
            .to_owned();
    for row in table {
        for asked in &row.moves {
            let noise = if row.noise { ", noisy sensors" } else { "" };
            let kept = if asked.kept { "" } else { "missed" };
            text += &format!(
                "| {}{noise} | {} | {} | {} | {} | {} | {kept} |\n",
                row.what,
                row.strategy.replace('_', " "),
                row.points.len(),
                asked.counted,
                asked.asked,
                asked.worst,
            );
        }
    }
    text
}
