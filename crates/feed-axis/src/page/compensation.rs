//! Figure 13, Tables 15 and 16.

use axis_pipeline::ErrorUnit;
use axis_pipeline::compensation::{CompensatedRun, find};
use axis_pipeline::strategies::{ReportTable as Group, STRATEGIES, StrategyKind, of_table};
use axis_pipeline::tracking::Run;
use axis_pipeline::validation::ValidatedTrajectory;
use axis_report::{Cell, Notice, Section, Series, Table};

use super::loops::sentence;
use super::{best_if, pair, printed, times, tracking};
use crate::context::Context;
use crate::paper::{Pair, Row};
use crate::results::Results;

/// What the paper prints for a strategy in one row of its tables, where it has the strategy.
fn column(strategy: &StrategyKind) -> Option<fn(&Row) -> Pair> {
    match strategy.name {
        "network" => Some(|row| row.network),
        "transfer_function" => Some(|row| row.transfer),
        "network_lugre" => Some(|row| row.network_lugre),
        "transfer_function_lugre" => Some(|row| row.transfer_lugre),
        _ => None,
    }
}

/// The section.
pub fn compensation(context: &Context, results: &Results) -> Section {
    let unit = results.validation.unit;
    let [without, with] = [
        Group::WithoutFrictionFeedforward,
        Group::WithFrictionFeedforward,
    ]
    .map(|group| of_table(STRATEGIES, group));
    let grid = results.validation.trajectories.iter().map(|t| {
        let time = |run: &[f64]| times(run.len(), results.transfer[0].period);
        let line = |name: &str, error: &[f64]| Series::line(name, time(error), error.to_vec());
        let figure = tracking::figure(t, unit).series(line("none", &t.machine.error));
        without
            .iter()
            .chain(&with)
            .fold(figure, |figure, kind| match under(results, t.id, kind) {
                Some(run) => figure.series(line(kind.heading, &run.error)),
                None => figure,
            })
    });
    let grid = grid.collect();
    let left_out = left_out(&results.compensation);
    let section = Section::new("Compensation")
        .paragraph("On the simulated machine. The compensator sees what a controller samples: reference, position of the load, motor speed, currents. Network: ΔS = S_ref − S + Ê, Ê predicted for the end of the cycle (Section 4.4). Transfer function: a linear model of the tracking error, driven by the reference and led by the position loop's time constant; with LuGre, the model of the error that LuGre leaves. LuGre: current for the friction along the reference, with the parameters identified on the machine. A figure is marked where its peak is at or below the paper's.");
    let others = context.other_control();
    let section = others.iter().fold(section, |section, difference| {
        section.notice(Notice::Warn, sentence(difference))
    });
    let section = match left_out.is_empty() {
        true => section,
        false => section.paragraph(format!(
            "Left out, as no such compensation can be made for this axis: {}.",
            left_out.join(", ")
        )),
    };
    let section = section
        .table(beside_paper(
            results,
            format!("Without friction feed-forward, {unit} (Table 16)"),
            &without,
        ))
        .table(beside_paper(
            results,
            format!("With LuGre feed-forward, identified parameters, {unit} (Table 15)"),
            &with,
        ));
    let others = ran(&of_table(STRATEGIES, Group::More), &results.compensation);
    let trajectories = &results.validation.trajectories;
    more(trajectories, &results.compensation, &others, unit)
        .into_iter()
        .fold(section, Section::table)
        .table(transfer_models(results))
        .figure_grid(grid, 2)
}

/// Those of the strategies that have runs.
fn ran<'a>(strategies: &[&'a StrategyKind], runs: &[CompensatedRun]) -> Vec<&'a StrategyKind> {
    let has_run = |kind: &&StrategyKind| runs.iter().any(|run| run.strategy == kind.name);
    strategies.iter().copied().filter(has_run).collect()
}

/// Headings of the strategies that have none.
fn left_out(runs: &[CompensatedRun]) -> Vec<&'static str> {
    let ran = ran(STRATEGIES, runs);
    let without = |kind: &&&StrategyKind| ran.iter().all(|other| other.name != kind.name);
    let kinds = STRATEGIES.iter().filter(without);
    kinds.map(|kind| kind.heading).collect()
}

/// Strategies beside the servo alone, and each beside the paper's figures for it.
fn beside_paper(results: &Results, caption: String, strategies: &[&StrategyKind]) -> Table {
    let groups = 1 + strategies
        .iter()
        .map(|kind| 1 + usize::from(column(kind).is_some()))
        .sum::<usize>();
    let mut table = Table::new(caption, columns(groups))
        .group("", 1)
        .group("None", 2);
    for kind in strategies {
        table = table.group(kind.heading, 2);
        if column(kind).is_some() {
            table = table.group(format!("Paper's, {}", kind.heading), 2);
        }
    }
    for (i, t) in results.validation.trajectories.iter().enumerate() {
        let paper = results.paper.as_ref().and_then(|p| p.trajectories.get(i));
        let mut row = vec![Cell::text(t.id.to_string())];
        row.extend(pair(t.machine.figures));
        for kind in strategies {
            let theirs = column(kind).map(|column| paper.map(column));
            let peak = theirs.flatten().map(|[max, _]| max);
            row.extend(cells(under(results, t.id, kind), peak));
            row.extend(theirs.map(printed).into_iter().flatten());
        }
        table = table.row(row);
    }
    table
}

/// Strategies of one table, each with two columns: as many as a page is wide.
const MOST_BESIDE: usize = 5;

/// Strategies that the paper does not have.
fn more(
    trajectories: &[ValidatedTrajectory],
    runs: &[CompensatedRun],
    strategies: &[&StrategyKind],
    unit: ErrorUnit,
) -> Vec<Table> {
    let parts = strategies.chunks(MOST_BESIDE);
    let count = parts.len();
    let caption = |part: usize| match count {
        1 => format!("More strategies, {unit}"),
        _ => format!("More strategies, {unit} ({} of {count})", part + 1),
    };
    let table = |(part, kinds)| one_more(caption(part), trajectories, runs, kinds);
    parts.enumerate().map(table).collect()
}

fn one_more(
    caption: String,
    trajectories: &[ValidatedTrajectory],
    runs: &[CompensatedRun],
    strategies: &[&StrategyKind],
) -> Table {
    let mut table = Table::new(caption, columns(strategies.len())).group("", 1);
    for kind in strategies {
        table = table.group(kind.heading, 2);
    }
    for t in trajectories {
        let mut row = vec![Cell::text(t.id.to_string())];
        for kind in strategies {
            row.extend(cells(find(runs, t.id, kind.name), None));
        }
        table = table.row(row);
    }
    table
}

/// Headings of a table with a maximum and a mean for each of so many groups.
fn columns(groups: usize) -> Vec<&'static str> {
    let pairs = std::iter::repeat_n(["max", "mean"], groups);
    std::iter::once("Trajectory")
        .chain(pairs.flatten())
        .collect()
}

/// Maximum and mean of a run, marked where the maximum is at most `peak`.
fn cells(run: Option<&Run>, peak: Option<f64>) -> [Cell; 2] {
    match run {
        Some(run) => {
            let met = peak.is_some_and(|peak| run.figures.max <= peak);
            best_if(met, pair(run.figures))
        }
        None => [Cell::Missing, Cell::Missing],
    }
}

fn under<'a>(results: &'a Results, id: usize, strategy: &StrategyKind) -> Option<&'a Run> {
    find(&results.compensation, id, strategy.name)
}

/// The transfer functions themselves.
fn transfer_models(results: &Results) -> Table {
    let unit = results.validation.unit;
    let mut table = Table::new(
        "Transfer functions of the tracking error, identified from simulated motion of the model",
        [
            "Servo".to_owned(),
            "order".to_owned(),
            "poles, ms".to_owned(),
            format!("missed on training motions, RMS {unit}"),
            format!("on other motions, RMS {unit}"),
            "candidates tried".to_owned(),
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
            Cell::number(*t.training_rms, 3),
            Cell::number(*t.validation_rms, 3),
            Cell::text(t.candidates.to_string()),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use axis_pipeline::Figures;
    use axis_pipeline::measured::ErrorSeries;
    use axis_pipeline::strategies::NONE;
    use axis_pipeline::tracking::Profile;
    use axis_report::{Page, render};

    use super::*;

    static NEW: StrategyKind = StrategyKind {
        name: "new",
        label: "a new one",
        heading: "A new one",
        summary: "does nothing",
        table: Group::More,
        needs: &[],
        build: NONE.build,
    };

    /// A strategy more in the list is a pair of columns more, with its figures.
    #[test]
    fn a_new_strategy_stands_among_more_strategies() {
        let run = |max: f64| Run {
            figures: Figures { max, mean: 1.125 },
            error: ErrorSeries::default(),
        };
        let trajectory = ValidatedTrajectory {
            id: 1,
            motion_time_s: 1.0,
            profile: Profile::default(),
            model: run(0.0),
            machine: run(0.0),
            network: run(0.0),
            transfer_function: run(0.0),
            network_deviation: Figures::default(),
            transfer_function_deviation: Figures::default(),
        };
        let runs = [CompensatedRun {
            id: 1,
            strategy: "new".to_owned(),
            run: run(47.25),
        }];
        let mut strategies = STRATEGIES.to_vec();
        strategies.push(&NEW);
        let strategies = of_table(&strategies, Group::More);
        let tables = more(&[trajectory], &runs, &strategies, ErrorUnit::Microradian);
        // Eleven columns at most: more do not fit beside each other on a page.
        assert!(tables.iter().all(|table| table.columns.len() <= 11));
        let columns: usize = tables.iter().map(|table| table.columns.len() - 1).sum();
        assert_eq!(columns, 2 * strategies.len());
        let section = tables.into_iter().fold(Section::new(""), Section::table);
        let page = Page::new("").section(section);
        let html = render(&page).unwrap();
        for text in [
            "More strategies, µrad",
            "LuGre alone",
            "A new one",
            "47.25",
            "1.125",
        ] {
            assert!(html.contains(text), "{text}");
        }
        assert!(
            !html.contains("Network + LuGre</th>"),
            "a strategy of Table 15"
        );
    }
}
