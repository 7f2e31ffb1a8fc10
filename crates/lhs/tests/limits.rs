//! Values of any kind, whatever they are: a number, or an error that names the
//! limit. Nothing here panics, hangs or fills the memory.

use lhs::{
    Budget, Criterion, Cumulative, Design, LatinHypercube, LhsError, LogUniform, MAX_DIMS, Mixture,
    Normal, Tabulated, Triangular, Truncated, Uniform, criteria, map, optimise,
};
use proptest::prelude::*;

/// All bit patterns: NaN, infinities, zeros and subnormal numbers among them.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -2.0..2.0f64,
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(f64::MAX),
        Just(f64::MIN),
        Just(0.0),
        Just(-0.0),
        Just(5e-324)
    ]
}

/// Mostly finite, so that whole tables are.
fn any_value() -> impl Strategy<Value = f64> {
    let finite = any_number().prop_filter("not finite", |v| v.is_finite());
    prop_oneof![20 => finite, 1 => any_number()]
}

fn any_size() -> impl Strategy<Value = usize> {
    prop_oneof![
        0..9usize,
        any::<usize>(),
        Just(usize::MAX),
        Just(1 << 53),
        Just((1 << 53) + 1),
        Just(4096),
        Just(4097)
    ]
}

/// Every marginal that the numbers allow.
fn marginals(v: [f64; 4]) -> Vec<Box<dyn Cumulative>> {
    let mut all: Vec<Box<dyn Cumulative>> = Vec::new();
    let mut take = |made: Result<Box<dyn Cumulative>, LhsError>| match made {
        Ok(marginal) => all.push(marginal),
        Err(error) => assert!(error.to_string().contains(':'), "{error}"),
    };
    fn boxed<M: Cumulative + 'static>(
        made: Result<M, LhsError>,
    ) -> Result<Box<dyn Cumulative>, LhsError> {
        made.map(|marginal| Box::new(marginal) as Box<dyn Cumulative>)
    }
    let [a, b, c, d] = v;
    take(boxed(Uniform::new(a, b)));
    take(boxed(LogUniform::new(a, b)));
    take(boxed(Triangular::new(a, b, c)));
    take(boxed(Normal::new(a, b)));
    take(boxed(
        Normal::new(a, b).and_then(|n| Truncated::new(n, c, d)),
    ));
    take(boxed(
        Uniform::new(a, b).and_then(|n| Truncated::new(n, c, d)),
    ));
    take(boxed(Tabulated::new(&[(a, 0.0), (b, c), (d, 1.0)])));
    take(boxed(Tabulated::new(&v.map(|x| (x, x)))));
    let parts = [Normal::new(a, b), Normal::new(c, d)];
    if let [Ok(one), Ok(two)] = parts {
        let parts: Vec<(f64, Box<dyn Cumulative>)> = vec![(a, Box::new(one)), (d, Box::new(two))];
        take(boxed(Mixture::new(parts)));
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn any_marginal_is_refused_or_answers(v in prop::array::uniform4(any_number()), p in any_number(), x in any_number()) {
        for marginal in marginals(v) {
            let found = marginal.inverse_cdf(p);
            if (0.0..=1.0).contains(&p) {
                prop_assert!(!found.is_nan(), "{v:?} at {p}");
            } else {
                prop_assert!(found.is_nan(), "{v:?} at {p}");
            }
            marginal.inverse_survival(p);
            for probability in [marginal.cdf(x), marginal.survival(x)] {
                prop_assert!((0.0..=1.0).contains(&probability) || x.is_nan(), "{v:?} at {x}: {probability}");
            }
            let design = Design::from_rows(1, vec![0.1, 0.5, 0.9]).unwrap();
            let mapped = map(&design, &[&|p: f64| marginal.inverse_cdf(p)]);
            prop_assert!(mapped.is_err() || mapped.is_ok_and(|d| d.values().iter().all(|v| v.is_finite())));
        }
    }
}

proptest! {
    #[test]
    fn any_size_is_refused_or_answers(n in any_size(), dims in any_size(), row in any_size(), dim in any_size(), end in any_size()) {
        let made = LatinHypercube::new(n, dims, 1);
        let valid = (1..=1 << 53).contains(&n) && (1..=MAX_DIMS).contains(&dims);
        prop_assert_eq!(made.is_ok(), valid);
        let Ok(hypercube) = made else { return Ok(()) };
        prop_assert_eq!(hypercube.cell(row, dim).is_ok(), row < n && dim < dims);
        let mut out = vec![0.0; dims + 1];
        prop_assert_eq!(hypercube.row(row, &mut out[1..]).is_ok(), row < n);
        prop_assert!(hypercube.row(row, &mut out).is_err());
        if n > 1 << 40 {
            let whole = hypercube.design();
            prop_assert!(matches!(whole, Err(LhsError::Memory { .. })), "{n} rows in memory");
            prop_assert!(hypercube.lattice(Criterion::Maximin).is_err());
            let budget = Budget { iterations: 1 };
            prop_assert!(hypercube.optimised(Criterion::Maximin, budget).is_err());
        }
        #[expect(clippy::reversed_empty_ranges)]
        let shards = [hypercube.shard(row..end), hypercube.shard(9..5)];
        prop_assert!(shards[1].is_err());
    }

    #[test]
    fn any_table_is_refused_or_judged(
        dims in any_size(), values in prop::collection::vec(any_value(), 0..13), p in any_number(), seed: u64,
    ) {
        let made = Design::from_rows(dims, values.clone());
        let whole = dims > 0 && dims <= MAX_DIMS && !values.is_empty() && values.len().is_multiple_of(dims);
        prop_assert_eq!(made.is_ok(), whole && values.iter().all(|v| v.is_finite()));
        let Ok(design) = made else { return Ok(()) };
        prop_assert_eq!(design.row(design.len()), None);
        prop_assert_eq!(design.row(usize::MAX), None);
        prop_assert_eq!(design.column(dims).len(), 0);
        prop_assert!(criteria::minimum_distance(&design) >= 0.0);
        criteria::centred_discrepancy(&design);
        criteria::phi_p(&design, p);
        for criterion in [Criterion::CentredDiscrepancy, Criterion::Maximin] {
            let (end, _) = optimise(design.clone(), criterion, Budget { iterations: 20 }, seed);
            prop_assert!(end.values().iter().all(|v| v.is_finite()));
        }
    }
}

/// n m = 2^63 values are 2^66 bytes, and with four times the variables n m
/// itself would wrap to zero: that many variables are refused.
#[test]
fn designs_beyond_the_words_of_a_machine_are_errors_that_name_it() {
    let refused = LatinHypercube::new(1 << 53, 1024, 1).unwrap().design();
    let message = refused.unwrap_err().to_string();
    assert!(
        message.contains("9007199254740992 rows of 1024 values"),
        "{message}"
    );
    let refused = LatinHypercube::new(5, 1025, 1).unwrap_err().to_string();
    assert!(refused.contains("between 1 and 1024"), "{refused}");
}

/// The largest design: its products stay finite, so it can be judged.
#[test]
fn the_most_variables_are_judged() {
    let design = LatinHypercube::new(3, MAX_DIMS, 1).unwrap().design();
    let cd2 = criteria::centred_discrepancy(&design.unwrap());
    assert!(cd2.is_finite() && cd2 > 0.0, "{cd2}");
}

#[test]
fn a_table_wider_than_f64_is_refused() {
    let refused = Tabulated::new(&[(f64::MIN, 0.0), (f64::MAX, 1.0)]).unwrap_err();
    assert!(refused.to_string().contains("1.8e308"), "{refused}");
}
