//! Sobol's and Halton's sequences against SciPy, and by counting what lies where.

use lhs::criteria::centred_discrepancy;
use lhs::{Design, Halton, LatinHypercube, Scrambling, Sobol};
use proptest::prelude::*;

const BOTH: [Scrambling; 2] = [Scrambling::Owen, Scrambling::LinearMatrix];

/// `python3 crates/lhs/tests/golden/scipy_sequences.py`. SciPy adds the digits of Halton's points
/// in f64, up to 20 of them here, each sum and each power with an error of its own.
#[test]
fn plain_sequences_are_those_of_scipy() {
    let sobol = Sobol::new(1024).unwrap();
    let halton = Halton::new(1024).unwrap();
    let mut row = vec![0.0; 1024];
    let mut seen = 0;
    for line in include_str!("golden/scipy_sequences.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let (point, variable): (u64, usize) =
            (fields[1].parse().unwrap(), fields[2].parse().unwrap());
        let value: f64 = fields[3].parse().unwrap();
        if fields[0] == "sobol" {
            sobol.row(point, &mut row).unwrap();
            assert_eq!(row[variable], value, "{line}");
        } else {
            halton.row(point, &mut row).unwrap();
            assert!(
                (row[variable] - value).abs() < 1e-15,
                "{line}: {}",
                row[variable]
            );
        }
        seen += 1;
    }
    assert_eq!(seen, 100);
}

/// Counts of points in the boxes of `cells[j]` equal parts along variable j: all equal to `each`.
fn fills(points: &Design, cells: &[u64], each: usize) -> bool {
    let boxes = cells.iter().product::<u64>() as usize;
    let mut counts = vec![0; boxes];
    for row in points.rows() {
        let at = (row.iter().zip(cells)).fold(0, |at, (x, &c)| at * c + (x * c as f64) as u64);
        counts[at as usize] += 1;
    }
    counts.iter().all(|&c| c == each)
}

/// All ways to write `sum` as `parts` whole numbers.
fn compositions(sum: u32, parts: usize) -> Vec<Vec<u32>> {
    if parts == 1 {
        return vec![vec![sum]];
    }
    (0..=sum)
        .flat_map(|first| {
            compositions(sum - first, parts - 1)
                .into_iter()
                .map(move |mut rest| {
                    rest.insert(0, first);
                    rest
                })
        })
        .collect()
}

/// Sobol's quality t = Σ (degree − 1) (1967): each box of 2^(t − k) volume of 2ᵏ points from a
/// multiple of 2ᵏ on holds 2ᵗ of them. Degrees of the first primitive polynomials: 1, 2, 3, 3, and
/// none for the first variable.
fn is_net(sequence: &Sobol, k: u32, block: u64) -> bool {
    let t: u32 = [0, 0, 1, 2, 2][..sequence.dims()].iter().sum();
    let points = sequence.shard(block << k..(block + 1) << k).unwrap();
    compositions(k - t, sequence.dims()).iter().all(|powers| {
        let cells: Vec<u64> = powers.iter().map(|p| 1 << p).collect();
        fills(&points, &cells, 1 << t)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn sobol_is_a_net_plain_and_scrambled(dims in 1..=5_usize, k in 5..10_u32, block in 0..1000_u64, seed: u64) {
        prop_assert!(is_net(&Sobol::new(dims).unwrap(), k, block));
        for scrambling in BOTH {
            prop_assert!(is_net(&Sobol::scrambled(dims, scrambling, seed).unwrap(), k, block), "{:?}", scrambling);
        }
    }

    /// Each variable alone is Latin in blocks of a power of two.
    #[test]
    fn every_variable_of_sobol_is_even(k in 0..9_u32, block in 0..1_000_000_u64, seed: u64) {
        let sequences = [Sobol::new(1024), Sobol::scrambled(1024, BOTH[(seed % 2) as usize], seed)];
        for sequence in sequences {
            let points = sequence.unwrap().shard(block << k..(block + 1) << k).unwrap();
            prop_assert!(crate::is_latin(&points));
        }
    }

    /// p₁^a p₂^b p₃^c points in a row fill the boxes once each.
    #[test]
    fn halton_fills_its_boxes(a in 0..6_u32, b in 0..4_u32, c in 0..3_u32, first in 0..1_000_000_000_u64, seed: u64) {
        let cells = [2_u64.pow(a), 3_u64.pow(b), 5_u64.pow(c)];
        let n: u64 = cells.iter().product();
        for sequence in [Halton::new(3), Halton::scrambled(3, seed)] {
            let points = sequence.unwrap().shard(first..first + n).unwrap();
            // Clear of the bounds of boxes by the last digits' rounding: a point on a bound of
            // the plain sequence is a fraction that f64 may have below it.
            let inside: Vec<f64> = points.values().iter().map(|x| x + 1e-13).collect();
            prop_assert!(fills(&Design::from_rows(3, inside).unwrap(), &cells, 1));
        }
    }

    #[test]
    fn shards_rows_and_wholes_have_the_same_bits(dims in 1..20_usize, start in 0..3000_u64, len in 1..3000_u64, seed: u64) {
        let mut row = vec![0.0; dims];
        let sobol = Sobol::scrambled(dims, BOTH[(seed % 2) as usize], seed).unwrap();
        let whole = sobol.design(start + len).unwrap();
        let shard = sobol.shard(start..start + len).unwrap();
        prop_assert_eq!(&whole.values()[start as usize * dims..], shard.values());
        sobol.row(start, &mut row).unwrap();
        prop_assert_eq!(shard.row(0), Some(&row[..]));
        let halton = Halton::scrambled(dims, seed).unwrap();
        let shard = halton.shard(start..start + len).unwrap();
        halton.row(start + len - 1, &mut row).unwrap();
        prop_assert_eq!(shard.row(len as usize - 1), Some(&row[..]));
        prop_assert!(shard.values().iter().chain(whole.values()).all(|v| *v > 0.0 && *v < 1.0));
    }
}

/// Mean and root mean square, over 400 seeds, of the error of the mean of `f` over the points.
fn deviation(points: impl Fn(u64) -> Design, f: impl Fn(&[f64]) -> f64, exact: f64) -> (f64, f64) {
    let errors: Vec<f64> = (0..400)
        .map(|seed| {
            let points = points(seed);
            points.rows().map(&f).sum::<f64>() / points.len() as f64 - exact
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / 400.0;
    let squares = errors.iter().map(|e| e * e).sum::<f64>() / 400.0;
    (mean, squares.sqrt())
}

/// The mean over seeds is exact within 4 of its standard errors, and the deviation falls as n^(−3/2)
/// times a power of log n for smooth functions (Owen 1997); independent points have 4 here.
#[test]
fn scrambled_means_have_no_bias_and_converge_as_owen_says() {
    let f = |x: &[f64]| libm::exp(x[0] + x[1] * x[2]);
    // ∫ exp(x) dx · ∫∫ exp(yz) dy dz = (e − 1) Σ 1/(k!(k + 1)²).
    let series: f64 = (0..20)
        .scan(1.0, |factorial, k| {
            let k = f64::from(k);
            *factorial *= k.max(1.0);
            Some(1.0 / (*factorial * (k + 1.0) * (k + 1.0)))
        })
        .sum();
    let exact = (std::f64::consts::E - 1.0) * series;
    for scrambling in BOTH {
        let made = |n| {
            deviation(
                |seed| {
                    Sobol::scrambled(3, scrambling, seed)
                        .unwrap()
                        .design(n)
                        .unwrap()
                },
                f,
                exact,
            )
        };
        let ((few_bias, few), (bias, many)) = (made(64), made(1024));
        assert!(few_bias.abs() < 4.0 * few / 20.0, "{few_bias} {few}");
        assert!(bias.abs() < 4.0 * many / 20.0, "{bias} {many}");
        // 16^1.5 = 64 without the logarithm, log(1024)/log(64) = 1.7 from it; 43 and 41 measured.
        let ratio = few / many;
        assert!(ratio > 30.0, "{scrambling:?}: {ratio}");
    }
    let halton = deviation(
        |seed| Halton::scrambled(3, seed).unwrap().design(1000).unwrap(),
        f,
        exact,
    );
    assert!(halton.0.abs() < 4.0 * halton.1 / 20.0, "{halton:?}");
    let latin = deviation(
        |seed| {
            LatinHypercube::new(1000, 3, seed)
                .unwrap()
                .design()
                .unwrap()
        },
        f,
        exact,
    );
    assert!(halton.1 < 0.3 * latin.1, "{halton:?} {latin:?}");
}

/// Digits of one point over 4000 seeds: uniform in each of 16 cells of each variable, and of
/// every two neighbouring variables, by chi-square within 5 deviations of its mean.
#[test]
fn points_are_uniform_over_the_seeds() {
    for kind in [Some(BOTH[0]), Some(BOTH[1]), None] {
        let point = |seed: u64| {
            let mut row = [0.0; 6];
            match kind {
                Some(scrambling) => Sobol::scrambled(6, scrambling, seed)
                    .unwrap()
                    .row(11, &mut row),
                None => Halton::scrambled(6, seed).unwrap().row(11, &mut row),
            }
            .unwrap();
            row
        };
        let points: Vec<[f64; 6]> = (0..4000).map(point).collect();
        for dim in 0..6 {
            let mut counts = [[0.0_f64; 16]; 2];
            for x in &points {
                counts[0][(x[dim] * 16.0) as usize] += 1.0;
                counts[1][(x[dim] * 4.0) as usize * 4 + (x[(dim + 1) % 6] * 4.0) as usize] += 1.0;
            }
            for counts in counts {
                let chi: f64 = counts
                    .iter()
                    .map(|c| (c - 250.0) * (c - 250.0) / 250.0)
                    .sum();
                assert!(
                    (chi - 15.0).abs() < 5.0 * 30_f64.sqrt(),
                    "{kind:?} {dim}: {chi}"
                );
            }
        }
    }
}

/// In 20 variables the digits of large primes go together; permuted they do not (0.249 and 0.107 to
/// 0.111 measured).
#[test]
fn permuted_digits_break_the_bands_of_halton() {
    let plain = centred_discrepancy(&Halton::new(20).unwrap().design(500).unwrap());
    for seed in 0..5 {
        let permuted =
            centred_discrepancy(&Halton::scrambled(20, seed).unwrap().design(500).unwrap());
        assert!(permuted < 0.5 * plain, "{permuted} {plain}");
    }
}

#[test]
fn seeds_differ_and_repeat() {
    for scrambling in BOTH {
        let made = |seed| {
            Sobol::scrambled(3, scrambling, seed)
                .unwrap()
                .design(8)
                .unwrap()
        };
        assert_eq!(made(1), made(1));
        assert_ne!(made(1), made(2));
    }
    let made = |seed| Halton::scrambled(3, seed).unwrap().design(8).unwrap();
    assert_eq!(made(1), made(1));
    assert_ne!(made(1), made(2));
}

#[test]
fn what_is_not_there_is_refused() {
    let (sobol, halton) = (Sobol::new(2).unwrap(), Halton::scrambled(2, 1).unwrap());
    let end = 1_u64 << 53;
    let mut row = [0.5; 2];
    let refused = [
        Sobol::new(0).unwrap_err(),
        Sobol::scrambled(1025, Scrambling::Owen, 1).unwrap_err(),
        Halton::new(0).unwrap_err(),
        Halton::scrambled(1025, 1).unwrap_err(),
        sobol.design(0).unwrap_err(),
        sobol.shard(end..end + 1).unwrap_err(),
        sobol.shard(0..u64::MAX).unwrap_err(),
        halton.shard(5..5).unwrap_err(),
        sobol.row(end, &mut row).unwrap_err(),
        halton.row(0, &mut [0.0; 3]).unwrap_err(),
    ];
    for error in refused {
        let message = error.to_string();
        assert!(message.contains("must be"), "{message}");
    }
    assert_eq!(row, [0.5; 2]);
    // Whole sequences fit in no memory; their last points can be had.
    assert!(
        sobol
            .design(end)
            .unwrap_err()
            .to_string()
            .contains("memory")
    );
    for made in [sobol.row(end - 1, &mut row), halton.row(end - 1, &mut row)] {
        made.unwrap();
        assert!(row.iter().all(|v| (0.0..1.0).contains(v)), "{row:?}");
    }
}
