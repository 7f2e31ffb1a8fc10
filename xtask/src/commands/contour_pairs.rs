//! Pairs of axes of different kinds on a circle.

use axis_machine::CoupledMachine;
use axis_pipeline::strategies::NONE;
use axis_sim::Axis;
use miette::Result;
use rayon::prelude::*;
use toolpath::named::Direction;

use super::contour::Measured;
use super::contour_rows::{Bench, Task, laps, strategy};

/// Pairs by their axis files.
const PAIRS: [[&str; 2]; 12] = [
    ["liu2025", "liu2025-y"],
    ["screw-datasheet", "belt"],
    ["belt", "belt"],
    ["rack", "belt"],
    ["rack", "rack"],
    ["linear-motor", "linear-motor"],
    ["linear-stage", "linear-stage"],
    ["linear-motor", "screw-heat"],
    ["rack", "linear-motor"],
    ["emps", "linear-stage"],
    ["liu2025", "rotary-table"],
    ["rack-push", "linear-stage"],
];

/// All pairs on a circle of 20 mm at 3 m/min.
pub fn pairs(bench: &Bench) -> Result<Measured> {
    let all: Vec<(bool, String)> = PAIRS.par_iter().map(|pair| one(bench, *pair)).collect();
    let ran = all.iter().filter(|(ran, _)| *ran).count();
    let words: Vec<&str> = all.iter().map(|(_, words)| words.as_str()).collect();
    Ok(Measured {
        what: "pairs of kinds, R 20 mm, 3 m/min: none, plan, adaptive feedback second lap"
            .to_owned(),
        goal: "ten run, or one sentence why not".to_owned(),
        found: format!("{ran} of {} ran", PAIRS.len()),
        met: Some(ran >= 10),
        note: words.join("; "),
    })
}

fn one(bench: &Bench, [x, y]: [&str; 2]) -> (bool, String) {
    let read = |name: &str| Axis::read(&bench.folder.join(format!("{name}.toml")));
    let name = format!("{x} and {y}");
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
