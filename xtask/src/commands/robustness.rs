//! `robustness`: what compensation leaves where what is believed is wrong, draw by draw.

use std::cell::RefCell;
use std::ops::Range;
use std::path::{Path, PathBuf};

use axis_sim::Measured;
use campaign::{CampaignError, Column, Failure, Inputs, Job, Merged, Value};
use clap::Args;
use discover_matrix::hidden::Noise;
use miette::{IntoDiagnostic, Result};
use pipeline::robustness::{Draws, Goal, Point, Sense, Study, make, studies};
use serde::ser::{Error as _, Serialize, Serializer};

use crate::context::{Claim, Common, Context};
use crate::jobs::{JobOptions, Sharding, failure};
use crate::output::{say, write_whole_by};

/// Options of `robustness`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Wrong beliefs in the rows where chance draws them, and random programs [default: 50
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
                beliefs: n.max(1),
                programs: n.max(1),
            },
            (None, true) => Draws::QUICK,
            (None, false) => Draws::FULL,
        };
        let rows = studies(&context.axis, &context.machine, context.seed, draws);
        Ok(Box::new(Robustness {
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
struct Robustness {
    context: Context,
    folder: PathBuf,
    draws: Draws,
    rows: Vec<Study>,
}

impl Robustness {
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
        let noise = Noise::good(&draw.machine);
        let sense = |seed: u64| -> Box<dyn FnMut(&mut Measured)> { Box::new(noise.sensors(seed)) };
        let sense = row.noise.then_some(&sense as Sense<'_>);
        let point = make(&self.context.axis, row.strategy, &draw, sense);
        point.map_err(|e| format!("{}, under {}: {e}", row.name, row.strategy).into())
    }
}

impl Job for Robustness {
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
        let judged = self.ranges().map(|(row, cases)| judge(row, cases, merged));
        let table = judged.collect::<std::result::Result<Vec<_>, _>>()?;
        let json = self.context.out.join("robustness.json");
        let write = |file: &mut _| Ok(serde_json::to_writer_pretty(file, &table)?);
        write_whole_by(&json, write).map_err(failure)?;
        tell(&table).map_err(failure)?;
        say(format!("each draw is a point in {}", json.display())).map_err(failure)
    }
}

/// A row of robustness.json.
#[derive(serde::Serialize)]
struct Row<'a> {
    what: &'a str,
    strategy: &'static str,
    noise: bool,
    moves: Vec<Asked<'a>>,
    points: Points<'a>,
}

/// What was asked of a counted move, and whether all draws keep it.
#[derive(serde::Serialize)]
struct Asked<'a> {
    counted: &'a str,
    asked: String,
    worst: String,
    kept: bool,
}

/// The points of a row, which are read again whenever they are asked for.
struct Points<'a> {
    merged: &'a Merged,
    cases: Range<usize>,
}

impl Points<'_> {
    fn iter(&self) -> impl Iterator<Item = std::result::Result<Point, Failure>> {
        let read = |row: std::result::Result<campaign::Row, CampaignError>| {
            Ok(serde_json::from_str(row?[0].text()?)?)
        };
        self.merged.range(self.cases.clone()).map(read)
    }
}

impl Serialize for Points<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        // A sequence takes no errors: the first one ends it.
        let failed = RefCell::new(None);
        let points = self.iter().map_while(|point| {
            let note = |e: Failure| *failed.borrow_mut() = Some(e.to_string());
            point.map_err(note).ok()
        });
        let done = to.collect_seq(points)?;
        match failed.into_inner() {
            Some(why) => Err(S::Error::custom(why)),
            None => Ok(done),
        }
    }
}

/// What the draws made of one counted move.
#[derive(Default)]
struct Counted {
    /// Greatest error with and without compensation, µm.
    left: f64,
    none: f64,
    /// Shares taken of the peak and of the mean, %.
    peaks: Vec<f64>,
    means: Vec<f64>,
}

fn judge<'a>(
    row: &'a Study,
    cases: Range<usize>,
    merged: &'a Merged,
) -> std::result::Result<Row<'a>, Failure> {
    let points = Points { merged, cases };
    let mut counted: Vec<Counted> = row.moves.iter().map(|_| Counted::default()).collect();
    for point in points.iter() {
        let point = point?;
        for (i, counted) in counted.iter_mut().enumerate() {
            counted.left = counted.left.max(point.compensated[i].max);
            counted.none = counted.none.max(point.none[i].max);
            counted.peaks.push(point.peak_taken(i));
            counted.means.push(point.mean_taken(i));
        }
    }
    let moves = row.moves.iter().zip(&mut counted);
    Ok(Row {
        what: &row.name,
        strategy: row.strategy,
        noise: row.noise,
        moves: moves
            .map(|((words, goal), counted)| asked(words, goal, counted))
            .collect(),
        points,
    })
}

fn asked<'a>(words: &'a str, goal: &Goal, counted: &mut Counted) -> Asked<'a> {
    counted.peaks.sort_by(f64::total_cmp);
    counted.means.sort_by(f64::total_cmp);
    let worst = |of: &[f64]| of.first().copied().unwrap_or(f64::NAN);
    let median = |of: &[f64]| of.get(of.len() / 2).copied().unwrap_or(f64::NAN);
    let (asked, found, kept) = match *goal {
        Goal::Left(most) => {
            let found = format!("{:.3} µm (none: {:.0})", counted.left, counted.none);
            (format!("≤ {most} µm"), found, counted.left <= most)
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
        counted: words,
        asked,
        worst: found,
        kept,
    }
}

fn tell(table: &[Row<'_>]) -> Result<()> {
    say("| case | strategy | draws | counted | asked | found: worst draw, peak / mean | |")?;
    say("|---|---|---|---|---|---|---|")?;
    for row in table {
        for asked in &row.moves {
            let noise = if row.noise { ", noisy sensors" } else { "" };
            let kept = if asked.kept { "" } else { "missed" };
            say(format!(
                "| {}{noise} | {} | {} | {} | {} | {} | {kept} |",
                row.what,
                row.strategy.replace('_', " "),
                row.points.cases.len(),
                asked.counted,
                asked.asked,
                asked.worst,
            ))?;
        }
    }
    Ok(())
}
