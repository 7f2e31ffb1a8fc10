//! The paper's design of experiments: 5000 samples over its Table 5, plain
//! and evened out, with the first rows in the manner of its Table 6.
//!
//! `cargo run --release -p lhs --example paper_samples`

use lhs::criteria::{centred_discrepancy, minimum_distance};
use lhs::{Budget, Criterion, Design, LatinHypercube, LhsError, Uniform, map};
use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let hypercube = LatinHypercube::new(5000, 4, 2025)?;
    let budget = Budget { iterations: 2000 };
    let (even, _) = hypercube.optimised(Criterion::CentredDiscrepancy, budget)?;
    let (spread, _) = hypercube.optimised(Criterion::Maximin, budget)?;
    let mut out = std::io::stdout().lock();
    writeln!(out, "5000 x 4            CD^2      least distance")?;
    for (name, design) in [
        ("plain", &hypercube.design()?),
        ("centred discrepancy", &even),
        ("maximin", &spread),
    ] {
        let (cd2, distance) = (centred_discrepancy(design), minimum_distance(design));
        writeln!(out, "{name:<19} {cd2:.2e}  {distance:.4}")?;
    }
    writeln!(
        out,
        "\nposition m  velocity m/s  acceleration m/s2  current A"
    )?;
    for row in in_units(&even)?.rows().take(6) {
        let [x, v, a, i] = row else { continue };
        writeln!(out, "{x:10.4}  {v:12.4}  {a:17.4}  {i:9.3}")?;
    }
    Ok(())
}

/// The ranges of the paper's Table 5, in SI units.
fn in_units(design: &Design) -> Result<Design, LhsError> {
    let position = Uniform::new(0.0, 1.5)?;
    let velocity = Uniform::new(-0.333, 0.333)?;
    let acceleration = Uniform::new(-1.0, 1.0)?;
    let current = Uniform::new(-15.0, 15.0)?;
    map(design, &[&position, &velocity, &acceleration, &current])
}
