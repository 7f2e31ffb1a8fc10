//! The Latin property, determinism and randomness of plain designs.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use lhs::{Criterion, Design, LatinHypercube, LhsError, Placement};
use proptest::prelude::*;

/// Each of the n strata of each column holds exactly one point.
fn is_latin(design: &Design) -> bool {
    let n = design.len();
    (0..design.dims()).all(|dim| {
        let mut seen = vec![false; n];
        design.column(dim).all(|v| {
            let stratum = (v * n as f64) as usize;
            stratum < n && !std::mem::replace(&mut seen[stratum], true)
        })
    })
}

fn bits(design: &Design) -> Vec<u64> {
    design.values().iter().map(|v| v.to_bits()).collect()
}

proptest! {
    #[test]
    fn every_stratum_is_hit_once(
        n in prop_oneof![1..5_usize, 1..6000_usize, Just(4096), Just(4097), Just(8192), Just(5003)],
        dims in 1..6_usize,
        seed: u64,
        centred: bool,
    ) {
        let mut hypercube = LatinHypercube::new(n, dims, seed).unwrap();
        if centred {
            hypercube = hypercube.centred();
        }
        let design = hypercube.design().unwrap();
        prop_assert_eq!((design.len(), design.dims()), (n, dims));
        prop_assert!(is_latin(&design));
        for (i, row) in design.rows().enumerate().step_by(1 + n / 50) {
            for (dim, &v) in row.iter().enumerate() {
                let cell = hypercube.cell(i, dim).unwrap();
                prop_assert_eq!((v * n as f64) as usize, cell);
                if centred {
                    prop_assert_eq!(v, (cell as f64 + 0.5) / n as f64);
                }
            }
        }
    }

    #[test]
    fn lattices_are_latin_too(n in 1..400_usize, dims in 1..6_usize, seed: u64, maximin: bool) {
        let criterion = if maximin { Criterion::Maximin } else { Criterion::CentredDiscrepancy };
        let design = LatinHypercube::new(n, dims, seed).unwrap().lattice(criterion).unwrap();
        prop_assert!(is_latin(&design));
    }

    #[test]
    fn a_shard_is_a_slice_of_the_whole(
        n in 1..20_000_usize,
        dims in 1..5_usize,
        seed: u64,
        a in 0.0..1.0_f64,
        b in 0.0..1.0_f64,
    ) {
        let hypercube = LatinHypercube::new(n, dims, seed).unwrap();
        let at = |share: f64| ((share * n as f64) as usize).min(n - 1);
        let (start, end) = (at(a.min(b)), at(a.max(b)) + 1);
        let shard = hypercube.shard(start..end).unwrap();
        let whole = hypercube.design().unwrap();
        prop_assert_eq!(shard.values(), &whole.values()[start * dims..end * dims]);
        let mut row = vec![0.0; dims];
        hypercube.row(start, &mut row).unwrap();
        prop_assert_eq!(&row[..], whole.row(start).unwrap());
    }

    /// Designs too large to make: probed rows stay in their cells, cells
    /// differ, and shards agree with single rows.
    #[test]
    fn huge_designs_are_probed_row_by_row(
        n in (1_usize << 33)..=(1 << 53),
        seed: u64,
        probes in prop::collection::vec(0.0..1.0_f64, 2..40),
    ) {
        let hypercube = LatinHypercube::new(n, 3, seed).unwrap();
        let rows: std::collections::BTreeSet<usize> =
            probes.iter().map(|p| (p * n as f64) as usize).filter(|&i| i < n).collect();
        for dim in 0..3 {
            let cells: std::collections::BTreeSet<usize> =
                rows.iter().map(|&i| hypercube.cell(i, dim).unwrap()).collect();
            prop_assert_eq!(cells.len(), rows.len(), "two rows in one stratum");
            prop_assert!(cells.iter().all(|&c| c < n));
        }
        let mut row = [0.0; 3];
        for &i in &rows {
            hypercube.row(i, &mut row).unwrap();
            prop_assert_eq!(hypercube.shard(i..i + 1).unwrap().into_values(), row.to_vec());
            for (dim, v) in row.into_iter().enumerate() {
                let low = hypercube.cell(i, dim).unwrap() as f64 / n as f64;
                // Two roundings of numbers below 1 are at most 2.3e-16.
                prop_assert!((low - 2.3e-16..=low + 1.0 / n as f64 + 2.3e-16).contains(&v));
            }
        }
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    // Not a multiple of the rows in a task, and large enough to be shared.
    let hypercube = LatinHypercube::new(50_021, 3, 11).unwrap();
    let made = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| {
            let lattice = hypercube.lattice(Criterion::CentredDiscrepancy).unwrap();
            (bits(&hypercube.design().unwrap()), bits(&lattice))
        })
    };
    let one = made(1);
    assert!(is_latin(&hypercube.design().unwrap()));
    assert_eq!(one, made(2));
    assert_eq!(one, made(4));
}

/// These bits are a promise: a change here changes every design in use. Made
/// from the definitions alone by
/// `python3 crates/lhs/tests/golden/bits_of_a_seed.py`.
#[test]
fn bits_of_a_seed_stay() {
    let cells = |n| -> Vec<usize> {
        let hypercube = LatinHypercube::new(n, 2, 42).unwrap();
        (0..8)
            .map(|i| hypercube.cell(i / 2, i % 2).unwrap())
            .collect()
    };
    assert_eq!(cells(10), GOLDEN_SMALL);
    assert_eq!(cells(1_000_000), GOLDEN_LARGE);
    let mut row = [0.0; 2];
    LatinHypercube::new(1_000_000, 2, 42)
        .unwrap()
        .row(3, &mut row)
        .unwrap();
    assert_eq!(row.map(f64::to_bits), GOLDEN_ROW);
}

const GOLDEN_SMALL: [usize; 8] = [3, 1, 2, 9, 9, 3, 8, 4];
const GOLDEN_LARGE: [usize; 8] = [
    699_645, 662_389, 998_558, 737_635, 206_949, 976_867, 113_051, 935_898,
];
const GOLDEN_ROW: [u64; 2] = [4_592_810_632_678_910_535, 4_606_605_042_602_298_052];

#[test]
fn seeds_and_columns_differ() {
    let design = |seed| {
        LatinHypercube::new(1000, 2, seed)
            .unwrap()
            .design()
            .unwrap()
    };
    let (a, b) = (design(1), design(2));
    // Two random permutations of 1000 agree in about 1 place; in 12 or more
    // with probability 8e-10.
    let same = |x: Vec<f64>, y: Vec<f64>| {
        let cell = |v: f64| (v * 1000.0) as usize;
        let pairs = x.into_iter().zip(y);
        pairs.filter(|&(p, q)| cell(p) == cell(q)).count()
    };
    assert!(same(a.column(0).collect(), b.column(0).collect()) < 12);
    assert!(same(a.column(0).collect(), a.column(1).collect()) < 12);
}

/// The correlation of two independent random permutations has mean 0 and
/// standard deviation 1/√(n − 1): five of them in 200 draws is a 1e-4 event.
#[test]
fn columns_are_uncorrelated() {
    for n in [100_usize, 1000, 5000, 40_000] {
        for seed in 0..8 {
            let hypercube = LatinHypercube::new(n, 4, seed).unwrap();
            let design = hypercube.design().unwrap();
            let mut columns: Vec<Vec<f64>> = (0..4).map(|d| design.column(d).collect()).collect();
            // The order of rows counts as a column: no trend along the file.
            columns.push((0..n).map(|i| (i as f64 + 0.5) / n as f64).collect());
            for (k, x) in columns.iter().enumerate() {
                for y in &columns[..k] {
                    let sum: f64 = x.iter().zip(y).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum();
                    let r = 12.0 * sum / n as f64;
                    assert!(
                        r.abs() < 5.0 / (n as f64).sqrt(),
                        "n {n} seed {seed}: r = {r}"
                    );
                }
            }
        }
    }
}

/// Points fall evenly into a 16 × 16 grid over every two columns. Row and
/// column totals are fixed, so chi-square has 225 degrees of freedom: mean
/// 225, standard deviation 21.2; allowed are six of them either way.
#[test]
fn pairs_of_columns_look_independent() {
    let n = 65_536;
    for seed in 0..5 {
        let design = LatinHypercube::new(n, 4, seed).unwrap().design().unwrap();
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let mut counts = [0.0; 256];
            for row in design.rows() {
                counts[16 * (row[a] * 16.0) as usize + (row[b] * 16.0) as usize] += 1.0;
            }
            let chi2: f64 = counts
                .iter()
                .map(|c: &f64| (c - 256.0).powi(2) / 256.0)
                .sum();
            assert!((98.0..352.0).contains(&chi2), "columns {a}, {b}: {chi2}");
        }
    }
}

/// u = n v − k of all points, in 64 bins: chi-square with 63 degrees of
/// freedom, mean 63, standard deviation 11.2; six of them either way.
#[test]
fn jitter_is_uniform_and_unrelated_to_its_stratum() {
    let n = 50_000;
    for seed in 0..4 {
        let design = LatinHypercube::new(n, 2, seed).unwrap().design().unwrap();
        let mut counts = [0.0; 64];
        let mut covariance = 0.0;
        for v in design.values() {
            let u = (v * n as f64).fract();
            counts[(u * 64.0) as usize] += 1.0;
            covariance += (u - 0.5) * (v - 0.5);
        }
        let expected = 2.0 * n as f64 / 64.0;
        let chi2: f64 = counts
            .iter()
            .map(|c: &f64| (c - expected).powi(2) / expected)
            .sum();
        assert!(chi2 < 130.0 && chi2 > 10.0, "chi2 = {chi2}");
        let r = 12.0 * covariance / (2.0 * n as f64);
        assert!(r.abs() < 5.0 / (2.0 * n as f64).sqrt(), "r = {r}");
    }
}

#[test]
fn misuse_is_an_error_that_says_what_is_valid() {
    let message = |e: LhsError| e.to_string();
    let new = |n, dims| LatinHypercube::new(n, dims, 0).map(|_| ()).map_err(message);
    assert!(new(0, 1).unwrap_err().contains("between 1 and 2^53"));
    assert!(
        new((1 << 53) + 1, 1)
            .unwrap_err()
            .contains("9007199254740993")
    );
    assert!(new(1, 0).unwrap_err().contains("between 1 and 1024"));
    assert_eq!(new(1 << 53, 1), Ok(()));

    let hypercube = LatinHypercube::new(1 << 50, 4, 0).unwrap();
    assert_eq!(hypercube.placement(), Placement::Random);
    #[expect(clippy::reversed_empty_ranges)]
    let refused = [
        hypercube.shard(3..3),
        hypercube.shard(5..3),
        hypercube.shard(0..(1 << 50) + 1),
    ];
    assert!(
        refused
            .iter()
            .all(|r| matches!(r, Err(LhsError::Rows { .. })))
    );
    let too_large = hypercube.shard(0..1 << 50);
    assert!(matches!(too_large, Err(LhsError::Memory { .. })));

    assert!(matches!(
        Design::from_rows(0, vec![1.0]),
        Err(LhsError::Dims { .. })
    ));
    assert!(matches!(
        Design::from_rows(2, vec![]),
        Err(LhsError::Shape { .. })
    ));
    assert!(matches!(
        Design::from_rows(2, vec![0.0; 3]),
        Err(LhsError::Shape { .. })
    ));
    let bad = Design::from_rows(2, vec![0.0, 0.0, 0.0, f64::NAN]).unwrap_err();
    assert!(message(bad).starts_with("row 1, column 1"));
}
