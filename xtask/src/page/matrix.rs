//! The page on the matrix of hidden effects.

use std::fmt::Write;

use axis_sim::Axis;
use discover_matrix::matrix::{CaseOutcome, NamedEffect, Rate, Score};

/// A share of the cases: what it is called, and its target.
type RateRow = (&'static str, fn(&Score) -> &Rate, &'static str);

const RATES: [RateRow; 18] = [
    (
        "clean machines of which anything is said",
        |score| &score.false_alarms,
        "≤ 1 %",
    ),
    (
        "single effects that can be seen",
        |score| &score.detectable,
        "",
    ),
    (
        "of these, distinguishable from all others",
        |score| &score.separable,
        "",
    ),
    (
        "seen and distinguishable: named first",
        |score| &score.right_first,
        "≥ 95 %",
    ),
    (
        "seen: named first, with look-alikes or without",
        |score| &score.seen_first,
        "",
    ),
    (
        "seen: named first, or in the class of the first",
        |score| &score.in_class,
        "≥ 99 %",
    ),
    (
        "seen, and named first: the verdict is explained",
        |score| &score.explained,
        "",
    ),
    (
        "effects of the library: any name that is neither hidden nor alike",
        |score| &score.confident_wrong,
        "≤ 1 %",
    ),
    (
        "not to be seen: silence, or right",
        |score| &score.silence,
        "",
    ),
    (
        "both of a pair named, if both are seen and distinguishable",
        |score| &score.both_of_pair,
        "≥ 95 %",
    ),
    (
        "all three of a triple, likewise",
        |score| &score.all_of_triple,
        "",
    ),
    (
        "outside the library, seen: effects that the library can imitate",
        |score| &score.imitated,
        "",
    ),
    (
        "the others: unknown, partly explained, or by a predicted look-alike",
        |score| &score.outside,
        "≥ 95 %",
    ),
    (
        "taken out of the library, seen: unknown, partly explained, or by a predicted look-alike",
        |score| &score.left_out,
        "≥ 95 %",
    ),
    (
        "95 % intervals that hold the truth",
        |score| &score.coverage,
        "90 to 98 %",
    ),
    (
        "on poor motion, seen: named first, or in the class of the first",
        |score| &score.poor,
        "",
    ),
    (
        "hidden effects in a class: an experiment was proposed",
        |score| &score.proposed,
        "",
    ),
    (
        "proposed experiments, run, that split their class",
        |score| &score.splits,
        "≥ 90 %",
    ),
];

/// The figures, one a line, as a table in Markdown.
pub fn figures(score: &Score) -> String {
    let mut text = String::from("| figure | value | 95 % interval | target |\n|---|---|---|---|\n");
    for (name, rate, target) in RATES {
        let [value, interval] = rate_cells(rate(score));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {name} | {value} | {interval} | {target} |");
    }
    for (name, errors, target) in [
        (
            "error of sizes, known parameters exact: median, 90 %",
            score.error,
            "≤ 2 %, ≤ 8 %",
        ),
        (
            "error of sizes as estimated: median, 90 %",
            score.raw_error,
            "",
        ),
    ] {
        let _ = writeln!(text, "| {name} | {} | | {target} |", both(errors));
    }
    let reduction = score.reduction.map_or("none".to_owned(), percent);
    let _ = writeln!(
        text,
        "| gap gone on check motion, single effects named first: median | {reduction} | | ≥ 95 % |"
    );
    text
}

/// A share and its interval.
fn rate_cells(rate: &Rate) -> [String; 2] {
    if rate.of == 0 {
        return ["none asked".to_owned(), String::new()];
    }
    let [low, high] = rate.interval().map(|v| 100.0 * v);
    [
        format!("{} ({:.1} %)", out_of(rate), 100.0 * rate.share()),
        format!("{low:.1} to {high:.1} %"),
    ]
}

pub(super) fn out_of(rate: &Rate) -> String {
    format!("{} of {}", rate.hits, rate.of)
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn both(errors: Option<[f64; 2]>) -> String {
    errors.map_or("none".to_owned(), |e| e.map(percent).join(", "))
}

/// First line of a page.
const TITLE: &str = "# Hidden effects, searched blind";

/// The whole page.
pub fn page(axis: &Axis, seed: u64, all: usize, outcomes: &[CaseOutcome], score: &Score) -> String {
    let mut text = format!(
        "{TITLE}\n\nMachine: {}. Seed {seed}. {} of {all} cases run.\n\
        `cargo xtask discover-matrix --seed {seed} --page FILE` makes this page; docs/theory/discover-matrix.md says how cases\n\
        are made and counted. Intervals are Wilson's. Everything here is simulated.\n\n{}\n\
        ## Each effect, hidden alone\n\nErrors are those of sizes where it was named first, known parameters exact.\n\n\
        | effect | can be seen | named first | or in the class | error: median, largest | 95 % intervals |\n\
        |---|---|---|---|---|---|\n",
        axis.name,
        outcomes.len(),
        figures(score)
    );
    for of in &score.effects {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            of.effect,
            out_of(&of.detectable),
            out_of(&of.first),
            out_of(&of.in_class),
            both(of.error),
            out_of(&of.coverage)
        );
    }
    let mut sorted: Vec<&CaseOutcome> = outcomes.iter().collect();
    sorted.sort_by(|a, b| a.case.id.cmp(&b.case.id));
    let _ = writeln!(text, "\n## What counts against it\n");
    let mut none = true;
    for outcome in &sorted {
        let mut faults = outcome.faults();
        faults.extend(outcome.failed.as_deref());
        none &= faults.is_empty();
        if !faults.is_empty() {
            let _ = writeln!(text, "- {}: {}", outcome.case.id, faults.join("; "));
        }
    }
    if none {
        let _ = writeln!(text, "Nothing.");
    }
    let _ = writeln!(
        text,
        "\n## Cases\n\nGain: expected fall of D, known beforehand; in brackets where the effect cannot be seen.\n\
        Class: effects predicted to look alike.\n\n\
        | case | motion | noise | hidden | gain | class | verdict | named (alike) | gap gone |\n|---|---|---|---|---|---|---|---|---|"
    );
    for outcome in sorted {
        let _ = writeln!(text, "{}", row(outcome));
    }
    text
}

/// The seed that a page says it was made with; `None` of what is no such page.
pub fn seed_of(page: &str) -> Option<u64> {
    seed_in(page, TITLE)
}

/// The seed that a page with this first line says.
pub(super) fn seed_in(page: &str, title: &str) -> Option<u64> {
    let after = page.strip_prefix(title)?.split(" Seed ").nth(1)?;
    after.split('.').next()?.parse().ok()
}

/// One after another, each with those that were said to be alike.
pub(super) fn names(named: &[NamedEffect]) -> String {
    let name = |n: &NamedEffect| match n.alike.as_slice() {
        [] => n.name.clone(),
        alike => format!("{} ({})", n.name, alike.join(", ")),
    };
    join(named.iter().map(name).collect())
}

fn join(all: Vec<String>) -> String {
    match all.is_empty() {
        true => "–".to_owned(),
        false => all.join("; "),
    }
}

fn row(outcome: &CaseOutcome) -> String {
    let case = &outcome.case;
    let hidden = case.hidden.iter().map(|h| {
        let values: Vec<String> = h.values.iter().map(|v| format!("{v:.3e}")).collect();
        format!("{} {}", h.name, values.join(" "))
    });
    let gains = outcome.predicted.iter().map(|f| match f.detectable {
        true => format!("{:.0}", f.gain),
        false => format!("({:.0})", f.gain),
    });
    let classes = outcome.predicted.iter().flat_map(|f| f.class.clone());
    let imitated = outcome.predicted.iter().filter_map(|f| {
        let imitation = f.imitation.as_ref().filter(|i| i.complete)?;
        Some(format!("imitated by {}", imitation.by.join(" + ")))
    });
    let classes = classes.chain(imitated);
    let mut named = names(&outcome.named);
    if let Some(split) = &outcome.split {
        let _ = write!(named, "; proposed motion run: {}", names(&split.named));
    }
    let verdict = outcome.verdict.map_or("none", discrepancy::Verdict::name);
    format!(
        "| {} | {} | {:.2} | {} | {} | {} | {verdict} | {} | {:.1} % |",
        case.id,
        case.exercise.name(),
        case.noise,
        join(hidden.collect()),
        join(gains.collect()),
        join(classes.collect()),
        named,
        100.0 * outcome.reduction
    )
}
