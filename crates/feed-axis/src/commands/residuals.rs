//! `residuals`: what no parameter holds, learned in three ways, side by side.

use axis_pipeline::ErrorUnit;
use axis_pipeline::residuals::{
    AFTER, Compared, NetworkSettings, ResidualMethod, compare, comparisons, trained_basis,
};
use axis_pipeline::robustness::room;
use axis_sim::Measured;
use axis_sim::NoiseLevels;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use crate::context::Common;
use crate::output::{Worded, print, write_whole};
use crate::progress::bar;

/// residuals.json.
#[derive(Serialize)]
struct Report<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    machine: &'a str,
    machine_fingerprint: &'a str,
    seed: u64,
    version: &'a str,
    /// Programs learned from before each count.
    after: [usize; 4],
    machines: &'a [Vec<Compared>],
}

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = &common.open()?;
    let _claim = context.claim()?;
    let (axis, machine) = (&context.axis, &context.machine);
    let count = if context.quick { 2 } else { 6 };
    let comparisons = comparisons(axis, machine, context.seed, count).into_diagnostic()?;
    // The network knows other machines than those it meets.
    let settings = NetworkSettings {
        seed: 1_000_000 + context.seed,
        ..NetworkSettings::default()
    };
    let network = trained_basis(axis, room(axis), &settings).into_diagnostic()?;
    let progress = bar(
        "residuals",
        (comparisons.len() * ResidualMethod::ALL.len()) as u64,
    );
    let noise = NoiseLevels::good(machine);
    let sense = |seed: u64| -> Box<dyn FnMut(&mut Measured)> { Box::new(noise.sensors(seed)) };
    let made =
        compare(axis, &comparisons, &network, &sense, || progress.inc(1)).into_diagnostic()?;
    progress.finish_and_clear();
    let path = context.out.join("residuals.json");
    let report = Report {
        axis: &axis.name,
        axis_fingerprint: &axis.fingerprint,
        machine: &machine.name,
        machine_fingerprint: &machine.fingerprint,
        seed: context.seed,
        version: env!("CARGO_PKG_VERSION"),
        after: AFTER,
        machines: &made,
    };
    write_whole(&path, &crate::json::pretty(&report).into_diagnostic()?)?;
    let text = format!(
        "{}each move is a number in {}",
        words(&made, context.unit()),
        path.display()
    );
    let value = report;
    print("residuals", &Worded { text, value })
}

/// The comparison as a table.
fn words(made: &[Vec<Compared>], unit: ErrorUnit) -> String {
    let after: Vec<String> = AFTER.iter().map(|n| format!("after {n}")).collect();
    let mut text = format!(
        "| peak left, {unit}: median / worst | {} |\n|---|{}\n",
        after.join(" | "),
        "---|".repeat(AFTER.len())
    );
    for (w, method) in ResidualMethod::ALL.iter().enumerate() {
        let cells = (0..AFTER.len()).map(|i| {
            let of_way = made.iter().map(|machine| &machine[w]);
            let mut left: Vec<f64> = of_way.clone().flat_map(|c| c.left[i].clone()).collect();
            left.sort_by(f64::total_cmp);
            let used = of_way.clone().filter(|c| c.used[i]).count();
            let worst = left.last().copied().unwrap_or(0.0);
            let middle = left.get(left.len() / 2).copied().unwrap_or(0.0);
            match method {
                ResidualMethod::Adapted => format!("{middle:.2} / {worst:.2}"),
                _ => format!(
                    "{middle:.2} / {worst:.2} (used on {used} of {})",
                    made.len()
                ),
            }
        });
        let cells: Vec<String> = cells.collect();
        text += &format!("| {} | {} |\n", method.name(), cells.join(" | "));
    }
    text
}
