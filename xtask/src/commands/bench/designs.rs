//! Latin hypercube designs.

use std::hint::black_box;

use lhs::criteria::centred_discrepancy;
use lhs::{Budget, Criterion, LatinHypercube};
use miette::{IntoDiagnostic, Result};

use super::timing::least;
use super::{Plan, Row};

const DIMS: usize = 4;

pub fn rows(plan: &Plan) -> Result<Vec<Row>> {
    let mut rows = vec![large(plan)?];
    rows.extend(optimised(plan)?);
    Ok(rows)
}

fn large(plan: &Plan) -> Result<Row> {
    let n = plan.size(1_000_000, 20_000);
    let hypercube = LatinHypercube::new(n, DIMS, 1).into_diagnostic()?;
    let [keyed, shuffled] = least(
        plan.repetitions,
        [
            &mut || {
                plan.pool.install(|| drop(black_box(hypercube.design())));
            },
            &mut || {
                black_box(shuffle_design(n));
            },
        ],
    );
    Ok(Row {
        name: format!("{n} × {DIMS} Latin hypercube"),
        value: keyed,
        unit: "s",
        ratio: shuffled / keyed,
        against: "a shuffle of each column",
    })
}

/// What one would write without the crate: shuffled strata and a uniform place in each.
fn shuffle_design(n: usize) -> Vec<f64> {
    let mut random = SplitMix(1);
    let mut values = vec![0.0; n * DIMS];
    let mut strata: Vec<usize> = (0..n).collect();
    for column in 0..DIMS {
        for i in (1..n).rev() {
            let other = ((random.next() as u128 * (i as u128 + 1)) >> 64) as usize;
            strata.swap(i, other);
        }
        for (row, &stratum) in strata.iter().enumerate() {
            let place = (random.next() >> 11) as f64 / (1u64 << 53) as f64;
            values[row * DIMS + column] = (stratum as f64 + place) / n as f64;
        }
    }
    values
}

/// Steele, Lea and Flood's generator (doi 10.1145/2660193.2660195).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

fn optimised(plan: &Plan) -> Result<Vec<Row>> {
    let n = plan.size(5000, 300);
    let hypercube = LatinHypercube::new(n, DIMS, 1).into_diagnostic()?;
    let plain = hypercube.design().into_diagnostic()?;
    let budget = Budget {
        iterations: plan.size(1000, 50),
    };
    let optimise = || hypercube.optimised(Criterion::CentredDiscrepancy, budget);
    let [time, once] = plan.pool.install(|| {
        least(
            plan.repetitions.div_ceil(2),
            [
                &mut || {
                    drop(black_box(optimise()));
                },
                &mut || {
                    black_box(centred_discrepancy(black_box(&plain)));
                },
            ],
        )
    });
    let (design, _) = optimise().into_diagnostic()?;
    let (before, after) = (centred_discrepancy(&plain), centred_discrepancy(&design));
    Ok(vec![
        Row {
            name: format!("optimised {n} × {DIMS} design, time"),
            value: time,
            unit: "s",
            ratio: once / time,
            against: "judging one design by the full formula",
        },
        Row {
            name: format!("optimised {n} × {DIMS} design, centred discrepancy"),
            value: after,
            unit: "1",
            ratio: before / after,
            against: "the plain design",
        },
    ])
}
