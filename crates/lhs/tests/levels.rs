//! Integers and categories as marginals.

use lhs::{DesignVariable, Integers, LatinHypercube, Levels, Marginal, Uniform, map, map_balanced};
use proptest::prelude::*;
use std::collections::BTreeMap;

fn counts(column: impl Iterator<Item = f64>) -> BTreeMap<i64, usize> {
    let mut counts = BTreeMap::new();
    column.for_each(|v| *counts.entry(v as i64).or_default() += 1);
    counts
}

proptest! {
    #[test]
    fn every_level_comes_as_often(n in 1..300_usize, k in 1..40_i64, lo in -50..50_i64, seed: u64, centred: bool) {
        let mut hypercube = LatinHypercube::new(n, 3, seed).unwrap();
        if centred {
            hypercube = hypercube.centred();
        }
        let design = hypercube.design().unwrap();
        let integers = Integers::new(lo, lo + k - 1).unwrap();
        let levels = Levels::categories(k as u32).unwrap();
        let uniform = Uniform::new(2.0, 3.0).unwrap();
        let variables = [DesignVariable::Continuous(&uniform), DesignVariable::Integers(integers), DesignVariable::Levels(&levels)];
        let balanced = map_balanced(&design, &variables).unwrap();
        let plain = map(&design, &[&uniform, &integers, &levels]).unwrap();
        prop_assert!(balanced.column(0).eq(plain.column(0)));
        let k = k as usize;
        for (dim, first) in [(1, lo), (2, 0)] {
            let counts = counts(balanced.column(dim));
            for level in first..first + k as i64 {
                let count = counts.get(&level).copied().unwrap_or(0);
                prop_assert!(count == n / k || count == n.div_ceil(k), "{count} of {n}/{k}");
            }
            prop_assert!(counts.keys().all(|v| (first..first + k as i64).contains(v)));
            if n % k == 0 {
                prop_assert!(balanced.column(dim).eq(plain.column(dim)));
            } else {
                let exact = n as f64 / k as f64;
                let plain = crate::levels::counts(plain.column(dim));
                prop_assert!(plain.values().all(|&c| (c as f64 - exact).abs() < 2.0));
            }
        }
    }

    #[test]
    fn any_number_is_answered(p: f64, lo: i64, hi: i64, values in prop::collection::vec(any::<f64>(), 0..4)) {
        if let Ok(integers) = Integers::new(lo, hi) {
            let v = integers.inverse_cdf(p);
            let inside = (lo as f64..=hi as f64).contains(&v);
            prop_assert!(if (0.0..=1.0).contains(&p) { inside } else { v.is_nan() }, "{p}: {v}");
        }
        let made = Levels::new(&values);
        prop_assert_eq!(made.is_ok(), !values.is_empty() && values.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn ends_and_refusals() {
    let die = Integers::new(1, 6).unwrap();
    assert_eq!(
        [0.0, 0.17, 0.5, 1.0].map(|p| die.inverse_cdf(p)),
        [1.0, 2.0, 4.0, 6.0]
    );
    let sizes = Levels::new(&[6.3, 8.0, 10.0]).unwrap();
    assert_eq!(
        [0.0, 0.34, 1.0].map(|p| sizes.inverse_cdf(p)),
        [6.3, 8.0, 10.0]
    );
    let widest = 1 << 53;
    let all = Integers::new(-widest, widest).unwrap();
    assert_eq!(
        [0.0, 1.0].map(|p| all.inverse_cdf(p)),
        [-widest as f64, widest as f64]
    );
    for (lo, hi) in [(2, 1), (i64::MIN, 0), (0, i64::MAX)] {
        let refused = Integers::new(lo, hi).unwrap_err().to_string();
        assert!(refused.contains("must be"), "{refused}");
    }
    assert!(Levels::categories(0).is_err());
    let design = LatinHypercube::new(4, 2, 1).unwrap().design().unwrap();
    assert!(map_balanced(&design, &[DesignVariable::Integers(die)]).is_err());
}
