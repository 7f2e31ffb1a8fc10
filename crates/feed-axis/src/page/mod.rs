//! The report: results to a page. Order and words are here, looks in `axis-report`.

mod answers;
pub mod channel;
pub mod check;
pub mod compare;
mod compensation;
pub mod contour;
pub mod contour_laps;
pub mod discovery;
mod envelope;
pub mod frf;
pub mod heat;
pub mod loops;
mod mechanics;
pub mod motion;
mod network;
pub mod robustness;
mod tracking;

use axis_pipeline::strategies::{NETWORK, NETWORK_LUGRE, StrategyKind};
use axis_report::{Block, Cell, KeyValues, Mark, Notice, Page, Section, Table, fixed};
use axis_sim::mechanism::SolutionMethod;

use crate::context::Context;
use crate::paper::Pair;
use crate::results::Results;

/// The whole page.
pub fn page(context: &Context, results: &Results) -> Page {
    let axis = &context.axis;
    let page = Page::new(format!("Dynamic error of {}", axis.name))
        .lead(axis.description.clone())
        .first(Block::Answers(answers::answers(context, results)))
        .section(overview(context, results))
        .section(tracking::profiles(results))
        .section(tracking::model_and_machine(context, results))
        .section(network::network(results))
        .section(tracking::prediction(results))
        .section(compensation::compensation(context, results));
    let page = match robustness::Robustness::of(context) {
        Some(made) => page.section(robustness::robustness(&made)),
        None => page,
    };
    page.section(mechanics::friction(context, results))
        .section(mechanics::vibration(results))
        .section(mechanics::modes(results))
        .section(loops::of_pipeline(context, &results.loops))
        .section(network::study(results))
        .section(settings(context, results))
}

fn overview(context: &Context, results: &Results) -> Section {
    let unit = context.unit();
    let mut table = Table::new(
        "Peak of the tracking error on the machine and how much of it compensation takes away",
        [
            "Trajectory".to_owned(),
            format!("none, {unit}"),
            format!("network, {unit}"),
            format!("network + LuGre, {unit}"),
            "peak less by".to_owned(),
            "mean less by".to_owned(),
        ],
    );
    let (mut best_peak, mut best_mean) = (0.0_f64, 0.0_f64);
    for t in &results.summary.trajectories {
        let under = |kind: &StrategyKind| t.errors.compensated.under(kind.name);
        let none = t.errors.machine;
        let (Some(network), Some(both)) = (under(&NETWORK), under(&NETWORK_LUGRE)) else {
            continue;
        };
        let less = |before: f64, after: f64| 100.0 * (1.0 - after / before);
        let (peak, mean) = (less(none.max, both.max), less(none.mean, both.mean));
        best_peak = best_peak.max(peak);
        best_mean = best_mean.max(mean);
        table = table.row([
            Cell::text(t.id.to_string()),
            Cell::number(none.max, 2),
            Cell::number(network.max, 2),
            Cell::number(both.max, 2),
            Cell::text(format!("{} %", fixed(peak, 1))),
            Cell::text(format!("{} %", fixed(mean, 1))),
        ]);
    }
    let machine = if context.has_machine {
        format!(
            "\u{201c}Machine\u{201d} means the simulated stand-in {} ({}). Nothing on this page was measured but the columns headed \u{201c}paper\u{201d}, which are the printed figures of Liu et al. 2025, doi:10.3390/machines13050433.",
            context.machine.name, context.machine.description
        )
    } else {
        "No axis file stood for the machine, so \u{201c}machine\u{201d} is the model itself. Nothing on this page was measured.".to_owned()
    };
    let mut section = Section::new("Overview").notice(Notice::Info, machine);
    if context.quick {
        section = section.notice(
            Notice::Warn,
            "Made with --quick: fewer samples, a smaller network, fewer epochs and seeds. Run without it for figures to quote.",
        );
    }
    section
        .notice(
            Notice::Good,
            format!(
                "Network and LuGre feed-forward take away up to {best_peak:.1} % of the peak and {best_mean:.1} % of the mean tracking error (the paper: 76.7 % and 63.7 %)."
            ),
        )
        .table(table)
}

fn settings(context: &Context, results: &Results) -> Section {
    let (checks, unit) = (&results.validation.checks, context.unit());
    let list = KeyValues::new("What made this page")
        .entry("Axis", &context.axis.name)
        .entry("Fingerprint of the axis", &context.axis.fingerprint)
        .entry("Machine", &context.machine.name)
        .entry("Fingerprint of the machine", &context.machine.fingerprint)
        .entry("Seed", context.seed)
        .entry("Version", env!("CARGO_PKG_VERSION"))
        .entry(
            "Control period",
            axis_report::engineering(context.axis.period, "s", 4),
        )
        .entry(
            "Internal step",
            axis_report::engineering(context.axis.simulation.step, "s", 4),
        )
        .entry("Mechanism", context.axis.mechanism.kind().summary)
        .entry(
            "Method of solution",
            match context.axis.simulation.method {
                SolutionMethod::Fast => "fast",
                SolutionMethod::Exact => "exact",
            },
        )
        .entry(
            "Halving the step moves the figures by at most",
            format!(
                "{:.1e} {unit} (max), {:.1e} {unit} (mean)",
                checks.half_step.max, checks.half_step.mean
            ),
        )
        .entry(
            "The mechanism's other method moves them by at most",
            match checks.exact_method {
                Some(by) => format!("{:.1e} {unit} (max), {:.1e} {unit} (mean)", by.max, by.mean),
                None => "it has none".to_owned(),
            },
        );
    Section::new("Settings").key_values(list)
}

/// Maximum and mean as two cells.
fn pair(figures: axis_pipeline::Figures) -> [Cell; 2] {
    [Cell::number(figures.max, 2), Cell::number(figures.mean, 3)]
}

/// Printed maximum and mean as two cells; a gap where there is no paper.
fn printed(pair: Option<Pair>) -> [Cell; 2] {
    match pair {
        Some([max, mean]) if max.is_finite() && mean.is_finite() => {
            [Cell::number(max, 2), Cell::number(mean, 3)]
        }
        _ => [Cell::Missing, Cell::Missing],
    }
}

/// Marks the first cell as best where `condition` holds.
fn best_if(condition: bool, cells: [Cell; 2]) -> [Cell; 2] {
    let [first, second] = cells;
    let first = if condition {
        first.marked(Mark::Best)
    } else {
        first
    };
    [first, second]
}

/// Instants of thinned samples, s.
fn times(count: usize, period: f64) -> Vec<f64> {
    let step = axis_pipeline::tracking::DISPLAY_EVERY as f64 * period;
    (0..count).map(|k| k as f64 * step).collect()
}
