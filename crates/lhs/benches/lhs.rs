//! The hot paths at the sizes of the performance page. Run with `cargo bench
//! -p lhs`; the number of threads is rayon's (`RAYON_NUM_THREADS`).

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lhs::criteria::centred_discrepancy;
use lhs::{Budget, Halton, LatinHypercube, Marginal, Normal, Scrambling, Sobol, optimise};
use std::hint::black_box;

fn hypercube(n: usize) -> LatinHypercube {
    LatinHypercube::new(n, 4, 1).expect("n and dims are valid")
}

fn designs(c: &mut Criterion) {
    let mut group = c.benchmark_group("design");
    for n in [5_000, 600_000, 1_000_000] {
        let hypercube = hypercube(n);
        group.bench_with_input(BenchmarkId::new("n x 4", n), &n, |b, _| {
            b.iter(|| black_box(hypercube.design()));
        });
    }
    let hypercube = hypercube(1 << 50);
    let mut row = [0.0; 4];
    let mut i = 0;
    group.bench_function("one row of 2^50 x 4", |b| {
        b.iter(|| {
            i = (i + 1_000_003) % hypercube.len();
            hypercube.row(i, &mut row).expect("a row of the design");
            black_box(&row);
        });
    });
    group.finish();
}

fn sequences(c: &mut Criterion) {
    let mut group = c.benchmark_group("sequence, 2^20 x 4");
    for (name, sobol) in [
        ("sobol", Sobol::new(4)),
        ("sobol by Owen", Sobol::scrambled(4, Scrambling::Owen, 1)),
        (
            "sobol by matrix",
            Sobol::scrambled(4, Scrambling::LinearMatrix, 1),
        ),
    ] {
        let sobol = sobol.expect("4 variables");
        group.bench_function(name, |b| b.iter(|| black_box(sobol.design(1 << 20))));
    }
    for (name, halton) in [
        ("halton", Halton::new(4)),
        ("halton permuted", Halton::scrambled(4, 1)),
    ] {
        let halton = halton.expect("4 variables");
        group.bench_function(name, |b| b.iter(|| black_box(halton.design(1 << 20))));
    }
    group.finish();
}

fn optimised(c: &mut Criterion) {
    let hypercube = hypercube(5000);
    let plain = hypercube.design().expect("some kB");
    let mut group = c.benchmark_group("5000 x 4");
    group.sample_size(10);
    group.bench_function("centred discrepancy, all pairs", |b| {
        b.iter(|| centred_discrepancy(black_box(&plain)));
    });
    for (name, criterion) in [
        ("centred discrepancy", lhs::Criterion::CentredDiscrepancy),
        ("maximin", lhs::Criterion::Maximin),
    ] {
        group.bench_function(BenchmarkId::new("lattice", name), |b| {
            b.iter(|| hypercube.lattice(criterion));
        });
        let budget = Budget { iterations: 1000 };
        group.bench_function(BenchmarkId::new("1000 pairs tried", name), |b| {
            b.iter(|| optimise(plain.clone(), criterion, budget, 1));
        });
        group.bench_function(BenchmarkId::new("optimised, 1000 pairs", name), |b| {
            b.iter(|| hypercube.optimised(criterion, budget));
        });
    }
    group.finish();
}

fn marginals(c: &mut Criterion) {
    let normal = Normal::new(0.0, 1.0).expect("valid");
    let mut p = 0.0;
    c.bench_function("normal quantile", |b| {
        b.iter(|| {
            p = (p + 0.618_033_988_749_895) % 1.0;
            black_box(normal.inverse_cdf(p))
        });
    });
}

criterion_group!(benches, designs, sequences, optimised, marginals);
criterion_main!(benches);
