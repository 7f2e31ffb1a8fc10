//! Pairs of axes of different kinds on a circle.

use axis_machine::CoupledMachine;
use axis_pipeline::strategies::NONE;
use axis_sim::Axis;
use miette::Result;
use rayon::prelude::*;
use toolpath::named::Direction;

use super::contour_bench::{Bench, Task, laps, strategy};
use super::contour_measured::Measured;

/// An axis file of each kind of mechanism that moves along a line; of the linear motor one with currents and one that takes a force.
const KINDS: [(&str, &str); 7] = [
    ("screw", "liu2025-y"),
    ("screw of a data sheet", "screw-datasheet"),
    ("rack", "rack"),
    ("belt", "belt"),
    ("linear motor", "linear-motor"),
    ("force source", "linear-stage"),
    ("rigid mass", "emps"),
];

/// Pairs that no circle can be run on: a load that turns, an axis without a controller.
const REFUSED: [[&str; 2]; 2] = [["liu2025", "rotary-table"], ["rack-push", "linear-stage"]];

/// Each pair of kinds on a circle of 20 mm at 3 m/min, and those that are refused.
pub fn pairs(bench: &Bench) -> Result<Measured> {
    let mut asked: Vec<([&str; 2], String)> = Vec::new();
    for (i, (x, x_file)) in KINDS.iter().enumerate() {
        let partners = KINDS[i..].iter();
        asked.extend(partners.map(|(y, y_file)| ([*x_file, *y_file], format!("{x} and {y}"))));
    }
    let pairs = asked.len();
    asked.extend(REFUSED.map(|pair| (pair, pair.join(" and "))));
    let all: Vec<(bool, String)> = (asked.par_iter())
        .map(|(pair, name)| one(bench, *pair, name))
        .collect();
    let ran = all.iter().filter(|(ran, _)| *ran).count();
    let words: Vec<&str> = all.iter().map(|(_, words)| words.as_str()).collect();
    Ok(Measured {
        what: format!(
            "pairs of {} kinds of axis, R 20 mm, 3 m/min: none, plan, adaptive feedback second lap",
            KINDS.len()
        ),
        goal: "each runs, or one sentence why not".to_owned(),
        found: format!("{ran} of {pairs} ran; {} others refused", REFUSED.len()),
        met: Some(ran == pairs),
        note: words.join("; "),
    })
}

fn one(bench: &Bench, [x, y]: [&str; 2], name: &str) -> (bool, String) {
    let read = |name: &str| Axis::read(&bench.folder.join(format!("{name}.toml")));
    let axes = match (read(x), read(y)) {
        (Ok(x), Ok(y)) => [x, y],
        (Err(error), _) | (_, Err(error)) => return (false, format!("{name}: {error}")),
    };
    let machine = match CoupledMachine::new([&axes[0], &axes[1]]) {
        Ok(machine) => machine,
        Err(error) => return (false, format!("{name}: refused, {error}")),
    };
    let task = match Task::circle(0.02, 3.0, Direction::Counterclockwise) {
        Ok(task) => task,
        Err(error) => return (false, format!("{name}: {error}")),
    };
    let run = |kind: &str, count: usize| {
        let kind = if kind == "none" {
            Ok(&NONE)
        } else {
            strategy(kind)
        };
        let laps = kind.and_then(|kind| laps(&machine, &[], kind, &task, (count, None)));
        laps.map(|laps| laps[count - 1].0)
    };
    match run("none", 1) {
        Err(error) => (false, format!("{name}: {error}")),
        Ok(none) => {
            let words = |found: Result<f64>| match found {
                Ok(error) => format!("{error:.2}"),
                Err(error) => format!("none ({error})"),
            };
            let (plan, feedback) = (run("plan", 1), run("adaptive_feedback", 2));
            (
                true,
                format!("{name} {none:.1}, {}, {}", words(plan), words(feedback)),
            )
        }
    }
}
