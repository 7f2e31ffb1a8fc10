//! The page on the matrix that is as hard as reality.

use std::collections::BTreeMap;
use std::fmt::Write;

use axis_sim::Axis;
use discover_matrix::matrix2::{CaseOutcome, GROUPS, Group, Limit, ScoreTarget, TARGETS};

use super::matrix::{names, out_of, seed_in};

/// First line of a page.
const TITLE: &str = "# Hidden effects, as hard as reality, searched blind";

/// Seeds whose cases and laws were looked at while the matrix was written.
const SEEN: &str = "Cases and laws of seeds 101, 202, 303 and 404 were seen while the search and the counting were developed, 225 cases of seed 606, 69 of seed\n\
    707, 29 of seed 505, 40 each of seeds 4040 and 4141, 256 of seed 808, 101 of seed 909, 216 of seed 1010 (all its torque balances and 24 replays) and all torque balances of seeds 1111 and\n\
    1212 (192 each), 1313 and 1414 (204 each), and 1515 (192); of replays\n\
    clean machines with coloured noise in the loop of seeds 1616, 1717 and 1818 (58), and 24 cases of seed 1818, 12 of 1919 and 39 of 2121 beside,\n\
    238 cases of seed 2222, 900 of seed 2323, and 24 clean machines each of seeds 2727 and 2828; no other.";

/// All figures, one a line, as a table in Markdown.
pub fn figures(outcomes: &[CaseOutcome]) -> String {
    let mut text = String::from(
        "| figure | value | 95 % interval | target | by the interval |\n|---|---|---|---|---|\n",
    );
    for target in TARGETS {
        let rate = target.rate(outcomes);
        let (value, interval) = match rate.of {
            0 => ("none asked".to_owned(), String::new()),
            _ => {
                let [low, high] = rate.interval().map(|v| 100.0 * v);
                let value = format!("{} ({:.1} %)", out_of(&rate), 100.0 * rate.share());
                (value, format!("{low:.1} to {high:.1} %"))
            }
        };
        let (wanted, met) = (target.limit.words(), target.limit.met(&rate));
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| {} | {value} | {interval} | {wanted} | {met} |",
            target.name
        );
    }
    text
}

/// The whole page.
pub fn page(machines: &[Axis], seed: u64, all: usize, outcomes: &[CaseOutcome]) -> String {
    let machines: Vec<&str> = machines.iter().map(|axis| axis.name.as_str()).collect();
    let mut text = format!(
        "{TITLE}\n\nMachines: {}. Seed {seed}. {} of {all} cases run.\n\
        `cargo xtask discover-matrix --version 2 --seed {seed} --size {all} --page FILE` makes this page;\n\
        docs/theory/discover-matrix.md says how cases are made and counted. Intervals are Wilson's, cases taken as independent.\n\
        {SEEN} Everything here is simulated.\n\n\
        \"By the interval\": met or missed where ten cases are asked and the whole interval says so, open otherwise.\n\n{}",
        machines.join(", "),
        outcomes.len(),
        figures(outcomes)
    );
    for group in GROUPS {
        let _ = write!(text, "\n{}", by(group, outcomes));
    }
    for target in asked() {
        let _ = write!(text, "\n{}", against(target, outcomes));
    }
    let failed = outcomes
        .iter()
        .filter_map(|o| Some((o, o.failed.as_ref()?)));
    let failed: Vec<String> = failed
        .map(|(o, why)| format!("- {}: {why}\n", o.case.id))
        .collect();
    if !failed.is_empty() {
        let _ = write!(
            text,
            "\n## Cases that could not be run\n\n{}",
            failed.concat()
        );
    }
    text
}

/// The seed that a page says it was made with; `None` of what is no such page.
pub fn seed_of(page: &str) -> Option<u64> {
    seed_in(page, TITLE)
}

/// Figures of which something is asked.
fn asked() -> impl Iterator<Item = &'static ScoreTarget> {
    TARGETS.iter().filter(|t| t.limit != Limit::Told)
}

/// The figures of each part of a group.
fn by(group: &Group, outcomes: &[CaseOutcome]) -> String {
    let mut parts: BTreeMap<String, Vec<&CaseOutcome>> = BTreeMap::new();
    for outcome in outcomes {
        parts.entry((group.of)(outcome)).or_default().push(outcome);
    }
    let heads: Vec<&str> = asked().map(|t| t.name).collect();
    let mut text = format!(
        "## By {}\n\n| {} | cases | {} |\n|---|---|{}\n",
        group.name,
        group.name,
        heads.join(" | "),
        "---|".repeat(heads.len())
    );
    for (name, own) in parts {
        let cells: Vec<String> = asked().map(|t| cell(t, &own)).collect();
        let _ = writeln!(text, "| {name} | {} | {} |", own.len(), cells.join(" | "));
    }
    text
}

fn cell(target: &ScoreTarget, outcomes: &[&CaseOutcome]) -> String {
    let rate = target.rate(outcomes.iter().copied());
    if rate.of == 0 {
        return "–".to_owned();
    }
    let [low, high] = rate.interval().map(|v| 100.0 * v);
    format!("{} ({low:.0} to {high:.0} %)", out_of(&rate))
}

/// The cases that count against a figure.
fn against(target: &ScoreTarget, outcomes: &[CaseOutcome]) -> String {
    let mut text = format!("## Against: {} ({})\n\n", target.name, target.limit.words());
    let mut hurt: Vec<&CaseOutcome> = outcomes.iter().filter(|o| target.is_hurt_by(o)).collect();
    if hurt.is_empty() {
        return text + "No case.\n";
    }
    hurt.sort_by(|a, b| a.case.id.cmp(&b.case.id));
    text += "| case | machine, motion | tolerance | channels | noise | form, start | hidden (fall of D predicted) | verdict | named (alike) | left over |\n\
        |---|---|---|---|---|---|---|---|---|---|\n";
    for outcome in hurt {
        let _ = writeln!(text, "{}", row(outcome));
    }
    text
}

fn row(outcome: &CaseOutcome) -> String {
    let (case, setting) = (&outcome.case, &outcome.case.setting);
    let hidden = case.hidden.iter().enumerate().map(|(i, h)| {
        let law = case.law.as_ref().map(|law| law.name());
        let gain = outcome.predicted.get(i).map_or(0.0, |f| f.gain);
        format!("{} ({gain:.0})", law.unwrap_or_else(|| h.name.clone()))
    });
    let hidden: Vec<String> = hidden.collect();
    let left = outcome.unknown.as_ref();
    let verdict = outcome.verdict.map_or("none", discrepancy::Verdict::name);
    format!(
        "| {} | {}, {} | {:.0} % | {} | {} × {:.1} | {}, {:+.1} | {} | {verdict} | {} | {} |",
        case.id,
        setting.machine,
        setting.exercise.name(),
        100.0 * setting.tolerance,
        setting.channels.name(),
        case.noise.name(),
        case.noise.level,
        case.form.name(),
        case.wound,
        match hidden.is_empty() {
            true => "–".to_owned(),
            false => hidden.join("; "),
        },
        names(&outcome.named),
        left.map_or("–", |u| u.depends_on.as_str()),
    )
}
