//! One test program: designs, marginals, criteria and their optimisation.

mod any_input;
mod augment;
mod correlation;
mod coverage;
mod criteria;
mod discrepancies;
mod latin;
mod levels;
mod limits;
mod marginals;
mod optimise;
mod orthogonal;
mod sequences;
mod sliced;
#[cfg(feature = "serde")]
mod stored;

/// Each of the n strata of each column holds exactly one point.
fn is_latin(design: &lhs::Design) -> bool {
    (0..design.dims()).all(|dim| levels_are_balanced(design.column(dim), design.len(), 1))
}

/// Each of `count` equal intervals of [0, 1) holds exactly `each` values.
fn levels_are_balanced(column: impl Iterator<Item = f64>, count: usize, each: usize) -> bool {
    let mut seen = vec![0; count];
    for v in column {
        match seen.get_mut((v * count as f64) as usize) {
            Some(seen) => *seen += 1,
            None => return false,
        }
    }
    seen.iter().all(|&s| s == each)
}
