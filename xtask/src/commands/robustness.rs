//! `robustness`: what compensation leaves where what is believed is wrong, draw by draw.

use std::path::PathBuf;

use axis_sim::Measured;
use clap::Args;
use discover_matrix::hidden::Noise;
use miette::{IntoDiagnostic, Result, WrapErr};
use pipeline::robustness::{Draw, Goal, Point, Study, make, studies};
use rayon::prelude::*;
use report::{Page, render};
use serde::{Deserialize, Serialize};

use super::residuals;
use crate::context::{Common, Context};
use crate::output::{ready, say, write_whole};
use crate::page;
use crate::page::robustness::{Asked, Limit, Robustness, Row};
use crate::progress::bar;

/// What is kept of a draw: the point, and a hash of what it was made from.
#[derive(Serialize, Deserialize)]
struct Kept {
    key: String,
    point: Point,
}

/// Options of `robustness`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Instead of the table: what no parameter holds (cogging, local and asymmetric friction,
    /// drawn) learned by tables, by a network trained on simulated machines, and as named
    /// effects, side by side
    #[arg(long)]
    residuals: bool,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    if options.residuals {
        return residuals::run(&context);
    }
    let folder = context.out.join("robustness");
    ready(&folder)?;
    let _claim = context.claim()?;
    let rows = studies(&context.axis, &context.machine, context.seed, context.quick);
    let rows = rows.into_diagnostic()?;
    // Points of another program are made again.
    let program = std::env::current_exe().and_then(std::fs::read);
    let program = program
        .into_diagnostic()
        .wrap_err("cannot read this program")?;
    let program = blake3::hash(&program).to_hex().to_string();
    let count: usize = rows.iter().map(|row| row.draws.len()).sum();
    let progress = bar("robustness", count as u64);
    let mut made = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let points: Vec<Point> = (row.draws.par_iter().enumerate())
            .map(|(k, draw)| {
                let path = folder.join(format!("{i:02}-{k:03}.json"));
                let point = kept_or_made(&context, &program, row, draw, path)?;
                progress.inc(1);
                Ok(point)
            })
            .collect::<Result<_>>()?;
        made.push(points);
    }
    progress.finish_and_clear();
    let table = Robustness {
        axis: context.axis.name.clone(),
        axis_fingerprint: context.axis.fingerprint.clone(),
        machine: context.machine.name.clone(),
        machine_fingerprint: context.machine.fingerprint.clone(),
        seed: context.seed,
        quick: context.quick,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        rows: rows
            .iter()
            .zip(made)
            .map(|(row, points)| judge(row, points))
            .collect(),
    };
    let json = context.out.join("robustness.json");
    write_whole(&json, &serde_json::to_vec_pretty(&table).into_diagnostic()?)?;
    let title = format!("Compensation of {}", table.axis);
    let page = Page::new(title).section(page::robustness::robustness(&table));
    let page = render(&page)
        .into_diagnostic()
        .wrap_err("the page cannot be made")?;
    let html = context.out.join("robustness.html");
    write_whole(&html, page.as_bytes())?;
    tell(&table.rows)?;
    say(format!(
        "each draw is a point in {} and {}",
        json.display(),
        html.display()
    ))
}

/// The point of a draw: the one that lies there, where it was made from the same.
fn kept_or_made(
    context: &Context,
    program: &str,
    row: &Study,
    draw: &Draw,
    path: PathBuf,
) -> Result<Point> {
    let motions: Vec<_> = draw
        .motions
        .iter()
        .map(|m| {
            (
                m.name.as_str(),
                m.motion.duration(),
                m.motion.at(f64::INFINITY),
            )
        })
        .collect();
    let inputs = format!(
        "{} {} {} {} {:?} {:?} {motions:?} {} {}",
        program,
        context.axis.fingerprint,
        draw.machine.fingerprint,
        row.strategy,
        draw.believed,
        draw.machine
            .effects
            .iter()
            .map(|e| (e.effect.name, &e.values))
            .collect::<Vec<_>>(),
        draw.seed,
        row.noise,
    );
    // The mechanism of a changed machine is not in its file's fingerprint.
    let inputs = format!(
        "{inputs} {:?} {:?}",
        draw.machine.mechanism, draw.machine.friction
    );
    let key = blake3::hash(inputs.as_bytes()).to_hex().to_string();
    let kept = std::fs::read(&path).ok();
    let kept = kept.and_then(|bytes| serde_json::from_slice::<Kept>(&bytes).ok());
    if let Some(kept) = kept.filter(|kept| kept.key == key) {
        return Ok(kept.point);
    }
    let noise = Noise::good(&draw.machine);
    let sense = |seed: u64| -> Box<dyn FnMut(&mut Measured)> { Box::new(noise.sensors(seed)) };
    let sense = row
        .noise
        .then_some(&sense as pipeline::robustness::Sense<'_>);
    let point = make(&context.axis, row.strategy, draw, sense)
        .into_diagnostic()
        .wrap_err_with(|| format!("{}, under {}", row.name, row.strategy))?;
    let kept = Kept { key, point };
    write_whole(&path, &serde_json::to_vec(&kept).into_diagnostic()?)?;
    Ok(kept.point)
}

fn judge(row: &Study, points: Vec<Point>) -> Row {
    let moves: Vec<Asked> = (row.moves.iter().enumerate())
        .map(|(i, (counted, goal))| {
            let worst =
                |of: &dyn Fn(&Point) -> f64| points.iter().map(of).fold(f64::INFINITY, f64::min);
            let (asked, found, kept) = match *goal {
                Goal::Left(most) => {
                    let left = -worst(&|p| -p.compensated[i].max);
                    let none = -worst(&|p| -p.none[i].max);
                    let found = format!("{left:.3} µm (none: {none:.0})");
                    (format!("≤ {most} µm"), found, left <= most)
                }
                Goal::Taken { peak, mean, median } => {
                    let [of_peak, of_mean] =
                        [worst(&|p| p.peak_taken(i)), worst(&|p| p.mean_taken(i))];
                    let mut peaks: Vec<f64> = points.iter().map(|p| p.peak_taken(i)).collect();
                    peaks.sort_by(f64::total_cmp);
                    let middle = peaks[peaks.len() / 2];
                    let asked = match (mean, median) {
                        (Some(mean), _) => format!("≥ {peak} / {mean} %"),
                        (None, Some(median)) => format!("≥ {peak} %, median {median} %"),
                        (None, None) => format!("≥ {peak} %"),
                    };
                    let kept = of_peak >= peak
                        && mean.is_none_or(|mean| of_mean >= mean)
                        && median.is_none_or(|median| middle >= median);
                    let found = format!(
                        "{of_peak:.2} / {of_mean:.2} %, median {middle:.2} / {:.2} %",
                        {
                            let mut means: Vec<f64> =
                                points.iter().map(|p| p.mean_taken(i)).collect();
                            means.sort_by(f64::total_cmp);
                            means[means.len() / 2]
                        }
                    );
                    (asked, found, kept)
                }
            };
            Asked {
                counted: (*counted).to_owned(),
                asked,
                goal: match *goal {
                    Goal::Left(most) => Limit::LeftUm(most),
                    Goal::Taken { peak, .. } => Limit::LeftPercent(100.0 - peak),
                },
                worst: found,
                kept,
            }
        })
        .collect();
    Row {
        what: row.name.clone(),
        strategy: row.strategy.to_owned(),
        noise: row.noise,
        moves,
        points,
    }
}

fn tell(table: &[Row]) -> Result<()> {
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
                row.points.len(),
                asked.counted,
                asked.asked,
                asked.worst,
            ))?;
        }
    }
    Ok(())
}
