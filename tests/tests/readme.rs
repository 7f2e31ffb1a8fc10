//! Figures that docs/paper.md quotes, against the program as it is.

use std::path::PathBuf;

use axis_sim::{Axis, ClosedLoop};
use compensator::NoCompensation;

fn root(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(file)
}

/// Largest and mean tracking error of a trajectory, as the page prints them.
fn printed(axis: &str, trajectory: usize) -> String {
    let axis = Axis::read(&root("data/axes").join(axis)).unwrap();
    let motion = axis.plan(&axis.trajectories[trajectory]).unwrap();
    let (mut most, mut sum, mut cycles) = (0.0_f64, 0.0, 0);
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| {
            most = most.max(cycle.error().abs());
            sum += cycle.error().abs();
            cycles += 1;
        })
        .completed()
        .unwrap();
    format!("{:.2} / {:.3}", 1e6 * most, 1e6 * sum / f64::from(cycles))
}

#[test]
fn tracking_errors_of_model_and_machine() {
    let page = std::fs::read_to_string(root("docs/paper.md")).unwrap();
    let heading = page
        .lines()
        .position(|l| l.starts_with("| trajectory | paper's model | ours |"));
    let rows = page.lines().skip(heading.unwrap() + 2);
    let rows: Vec<Vec<&str>> = rows
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 6);
    for (trajectory, row) in rows.iter().enumerate() {
        assert_eq!(row[0], (trajectory + 1).to_string());
        assert_eq!(row[2], printed("liu2025.toml", trajectory), "{row:?}");
        assert_eq!(
            row[5],
            printed("liu2025-machine.toml", trajectory),
            "{row:?}"
        );
    }
}

/// Each test that docs/crates-compared.md names in a table is there, in the file that the page names: `file.rs`: `name`, ...
#[test]
fn tests_that_the_comparison_names_are_there() {
    let page = std::fs::read_to_string(root("docs/crates-compared.md")).unwrap();
    let (mut folder, mut count) = (String::new(), 0);
    for line in page.lines().filter(|line| line.starts_with('|')) {
        let cell = line.trim_end_matches('|').rsplit('|').next().unwrap();
        if let Some((_, named)) = cell.split_once("tests in `") {
            folder = named.split('`').next().unwrap().to_owned();
            continue;
        }
        let mut file = String::new();
        for word in cell.split('`').skip(1).step_by(2) {
            if word.ends_with(".rs") {
                let path = match word.starts_with("crates/") {
                    true => root(word),
                    false => root(&folder).join(word),
                };
                file = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path:?}: {e}"));
            } else if !file.is_empty() {
                let name = word.rsplit("::").next().unwrap();
                assert!(file.contains(&format!("fn {name}(")), "{line}");
                count += 1;
            }
        }
    }
    assert!(count > 150, "{count}");
}
