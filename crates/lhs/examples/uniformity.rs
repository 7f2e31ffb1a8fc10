//! Designs of several kinds and their figures as CSV, for
//! `docs/peers/lhs/run`, which computes the figures by SciPy.
//!
//! `cargo run -p lhs --example uniformity`

use lhs::criteria::{
    centred_discrepancy, l2_star_discrepancy, minimum_distance, mixture_discrepancy, spanning_tree,
    wrap_around_discrepancy,
};
use lhs::{
    Augmentation, Budget, CorrelationMatrix, Criterion, Design, Halton, LatinHypercube,
    OrthogonalArray, Placement, Scrambling, SlicedHypercube, Sobol, rank_correlated,
    rank_correlation,
};
use std::io::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "design,quantity,values")?;
    for (name, design) in designs()? {
        let mut line = |quantity: &str, values: &[f64]| {
            write!(out, "{name},{quantity}")?;
            values.iter().try_for_each(|v| write!(out, ",{v:e}"))?;
            writeln!(out)
        };
        for row in design.rows() {
            line("point", row)?;
        }
        line("CD", &[centred_discrepancy(&design)])?;
        line("WD", &[wrap_around_discrepancy(&design)])?;
        line("MD", &[mixture_discrepancy(&design)])?;
        line("L2-star", &[l2_star_discrepancy(&design)])?;
        line("mindist", &[minimum_distance(&design)])?;
        let tree = spanning_tree(&design).ok_or("a single point")?;
        line("mst", &[tree.mean])?;
        line("spearman", &rank_correlation(&design))?;
    }
    let mut line = |name: &str, quantity: &str, values: &[f64]| {
        write!(out, "{name},{quantity}")?;
        values.iter().try_for_each(|v| write!(out, ",{v:e}"))?;
        writeln!(out)
    };
    for (name, sequence) in [
        ("sobol", Sobol::new(64)?.design(512)?),
        ("halton", Halton::new(64)?.design(512)?),
    ] {
        for row in sequence.rows() {
            line(name, "sequence", row)?;
        }
    }
    for (name, made) in scrambled() {
        let discrepancies: Result<Vec<f64>, lhs::LhsError> = (0..SEEDS)
            .map(|seed| Ok(centred_discrepancy(&made(seed)?)))
            .collect();
        line(name, "scrambled", &discrepancies?)?;
    }
    Ok(())
}

/// Seeds of each scrambled sequence.
const SEEDS: u64 = 100;

type Made = fn(u64) -> Result<Design, lhs::LhsError>;

/// 256 points in 6 variables.
fn scrambled() -> [(&'static str, Made); 3] {
    [
        ("sobol by Owen", |seed| {
            Sobol::scrambled(6, Scrambling::Owen, seed)?.design(256)
        }),
        ("sobol by matrix", |seed| {
            Sobol::scrambled(6, Scrambling::LinearMatrix, seed)?.design(256)
        }),
        ("halton", |seed| Halton::scrambled(6, seed)?.design(256)),
    ]
}

fn designs() -> Result<Vec<(&'static str, Design)>, lhs::LhsError> {
    let plain = LatinHypercube::new(200, 3, 1)?.design()?;
    let target = CorrelationMatrix::new(3, &[1., 0.8, -0.3, 0.8, 1., 0., -0.3, 0., 1.])?;
    let correlated = rank_correlated(&plain, &target)?.design;
    let doubled = Augmentation {
        points: 200,
        placement: Placement::Random,
        candidates: 10,
        seed: 2,
    };
    let sliced = SlicedHypercube {
        slices: 4,
        points: 30,
        dims: 5,
        placement: Placement::Random,
        seed: 3,
    };
    let array = OrthogonalArray {
        prime: 11,
        dims: 8,
        placement: Placement::Centred,
        seed: 4,
    };
    let budget = Budget { iterations: 2000 };
    let (even, _) =
        LatinHypercube::new(100, 4, 5)?.optimised(Criterion::CentredDiscrepancy, budget)?;
    Ok(vec![
        ("augmented", doubled.of(&plain)?.design),
        ("plain", plain),
        ("correlated", correlated),
        ("sliced", sliced.design()?.design),
        ("orthogonal array", array.design()?),
        ("optimised", even),
        ("20 variables", LatinHypercube::new(50, 20, 6)?.design()?),
    ])
}
