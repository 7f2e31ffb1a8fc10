//! The paper's pipeline for two axes: a one-cycle network and identified friction of each.

use std::path::Path;

use axis_machine::MachineFile;
use feed_axis::commands::contour_laps::{ReferenceCorrection, Run, run};
use feed_axis::commands::contour_results::{RUNS, ResultFolders};
use feed_axis::commands::contour_route::{AnyPath, PathChoice, Wanted};
use miette::{IntoDiagnostic, Result};
use rayon::prelude::*;
use toolpath::named::butterfly;

use super::contour_bench::{Bench, strategy};
use super::contour_measured::Measured;

/// Circles by radius (mm) and feed (m/min).
const CIRCLES: [[f64; 2]; 3] = [[25.0, 10.0], [50.0, 3.0], [100.0, 1.0]];

/// Strategies, the paper's two between what they are compared with.
const STRATEGIES: [&str; 5] = ["none", "network", "lugre", "network_lugre", "plan"];

/// Three circles and the butterfly under each of them.
pub fn networks(bench: &Bench) -> Result<Measured> {
    let mut file = MachineFile::of_axes(bench.x.clone(), bench.y.clone());
    file.text.axes.x = bench.folder.join("liu2025-machine.toml");
    file.text.axes.y = bench.folder.join("liu2025-y.toml");
    let results = ResultFolders {
        runs: Path::new(RUNS),
        quick: false,
        makes: true,
    };
    let mut cases: Vec<(PathChoice, f64)> = (CIRCLES.iter())
        .map(|[radius, feed]| {
            let radius = 1e-3 * radius;
            (PathChoice::Circle { radius, tilt: None }, feed / 60.0)
        })
        .collect();
    let curve = PathChoice::Whole {
        name: "butterfly".to_owned(),
        part: "butterfly".to_owned(),
        path: AnyPath::Flat(butterfly().into_diagnostic()?),
    };
    cases.push((curve, 0.05));
    let mut words = Vec::new();
    for name in STRATEGIES {
        let kind = strategy(name)?;
        let compensation = results.compensation(kind, &file)?;
        let worst = cases.par_iter().map(|(path, feed)| -> Result<String> {
            let found = run(&Run {
                file: &file,
                path,
                wanted: Wanted {
                    feed: *feed,
                    ..Wanted::default()
                },
                laps: 1,
                identify: Vec::new(),
                correct: ReferenceCorrection::Nothing,
                feeds: Vec::new(),
                compensation: compensation.clone(),
                noise: 1.0,
                seed: 1,
                each: &|| (),
            });
            let found = found.into_diagnostic()?;
            let laps = found.directions.iter().flat_map(|one| &one.laps);
            let worst = laps.map(|lap| lap.contour_error_um).fold(0.0, f64::max);
            Ok(format!("{worst:.3}"))
        });
        // In order, so that of several errors the first one is said.
        let worst: Vec<Result<String>> = worst.collect();
        let worst: Vec<String> = worst.into_iter().collect::<Result<_>>()?;
        words.push(format!("{}: {}", kind.label, worst.join(", ")));
    }
    let networks = results.networks(strategy("network")?, &file)?;
    let shown = networks.iter().map(|row| {
        format!(
            "{} {}: {} samples, unseen ones within {:.1e} µm (linear map {:.1e})",
            row.axis, row.name, row.samples, row.unseen_um[0], row.linear_um[0]
        )
    });
    Ok(Measured {
        what: "one-cycle network of each axis, as the paper's pipeline trains it on that axis, friction as identified on it: R 25 mm at 10 m/min, R 50 at 3, R 100 at 1, \
               butterfly at 3, worse of both directions"
            .to_owned(),
        goal: "network: 241, 67, 16, 242; network + LuGre: 144, 6.3, 10.6 (another simulation)".to_owned(),
        found: words.join("; "),
        met: None,
        note: format!(
            "{}. The network predicts one cycle",
            shown.collect::<Vec<_>>().join("; ")
        ),
    })
}
