//! One Levenberg–Marquardt epoch of the 4-34-19-8-1 cascade on 5000 samples,
//! beside faer's own triangular product on the whole 5000 x 1441 Jacobian; its
//! two large parts, each beside faer's own; and one prediction of that network.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::hint::black_box;

use cfnn::train::{Dataset, Trainer, TrainingSettings, nguyen_widrow};
use cfnn::{FixedNetwork, Network, Predictor, Scaling, ScalingRange, Shape};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, Par};

/// The library's own factorisation, which is not public.
#[allow(dead_code, reason = "what the library's tests look at")]
#[path = "../src/train/cholesky.rs"]
mod cholesky;

const SAMPLES: usize = 5000;
const THREADS: usize = 2;

fn shape() -> Shape {
    Shape {
        inputs: 4,
        hidden: vec![34, 19, 8],
        outputs: 1,
    }
}

fn data() -> Dataset {
    // An additive recurrence with irrational steps fills the cube evenly.
    let input: Vec<f64> = (1..=SAMPLES)
        .flat_map(|s| [2.0f64, 3.0, 5.0, 7.0].map(|p| (s as f64 * p.sqrt()).fract() * 2.0 - 1.0))
        .collect();
    let target = input
        .chunks(4)
        .map(|x| x[0] + 0.1 * (20.0 * x[1]).tanh() + 0.05 * x[2] * x[3])
        .collect();
    Dataset::new(4, 1, input, target).expect("a valid data set")
}

fn epoch(c: &mut Criterion) {
    let data = data();
    let settings = TrainingSettings {
        threads: THREADS,
        epochs: usize::MAX,
        ..TrainingSettings::default()
    };
    let scaling = data.scaling().expect("the columns vary");
    let mut trainer = Trainer::new(shape(), scaling, &data, settings).expect("valid settings");
    c.bench_function("epoch 4-34-19-8-1, 5000 samples", |b| {
        b.iter(|| black_box(trainer.epoch()));
    });
    let trials: usize = trainer.history().iter().map(|e| e.trials).sum();
    println!(
        "trial steps an epoch: {:.2}",
        trials as f64 / trainer.history().len() as f64
    );
}

fn product(c: &mut Criterion) {
    let n = shape().parameters();
    let jacobian = Mat::from_fn(SAMPLES, n, |i, j| ((i * 31 + j * 17) % 101) as f64 / 101.0);
    let mut square = Mat::<f64>::zeros(n, n);
    c.bench_function("faer triangular product, 5000 x 1441", |b| {
        b.iter(|| {
            triangular::matmul(
                square.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Replace,
                jacobian.transpose(),
                BlockStructure::Rectangular,
                jacobian.as_ref(),
                BlockStructure::Rectangular,
                1.0,
                Par::rayon(THREADS),
            );
        });
    });
}

/// `JᵀJ` and `Jᵀr` alone, with all that leads to them: an epoch without trial
/// steps. Beside it, faer's product on the same rectangles of distinct entries,
/// block by block, with the tables of products given.
fn normal_equations(c: &mut Criterion) {
    let data = data();
    let settings = TrainingSettings {
        threads: THREADS,
        max_damping: 1e-6,
        ..TrainingSettings::default()
    };
    let scaling = data.scaling().expect("the columns vary");
    let trainer = || Trainer::new(shape(), scaling.clone(), &data, settings.clone());
    let mut group = c.benchmark_group("normal equations, 5000 samples");
    group.bench_function("tiles", |b| {
        b.iter_batched_ref(
            || trainer().expect("valid settings"),
            |trainer| black_box(trainer.epoch()),
            BatchSize::PerIteration,
        );
    });
    let sizes = [(1358, 185), (216, 1336), (190, 595)];
    let table =
        |rows, columns| Mat::from_fn(rows, columns, |i, j| ((i * 31 + j * 17) % 101) as f64);
    let tables = sizes.map(|(rows, columns)| (table(rows, 256), table(256, columns)));
    let mut sums = sizes.map(|(rows, columns)| Mat::<f64>::zeros(rows, columns));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS);
    let pool = pool.build().expect("two threads");
    group.bench_function("faer, rectangles of given tables", |b| {
        b.iter(|| {
            pool.install(|| {
                for _ in 0..SAMPLES.div_ceil(256) {
                    for (sum, (left, right)) in sums.iter_mut().zip(&tables) {
                        let par = Par::rayon(THREADS);
                        matmul(sum.as_mut(), Accum::Add, left, right, 1.0, par);
                    }
                }
            });
        });
    });
    group.finish();
}

/// Factorisation of the network's normal equations, with the filling of the
/// triangle: tiles against faer's own on one square.
fn factorisation(c: &mut Criterion) {
    let n = shape().parameters();
    let entry = |r: usize, c: usize| {
        let diagonal = if r == c { n as f64 } else { 0.0 };
        ((r * 31 + c * 17) % 101) as f64 / 101.0 + diagonal
    };
    let right: Vec<f64> = (0..n).map(|i| (i % 7) as f64 - 3.0).collect();
    let mut group = c.benchmark_group("Cholesky 1441");
    for threads in [1, THREADS] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("two threads at most");
        let mut tiles = cholesky::Symmetric::new(n);
        group.bench_function(format!("tiles, {threads} threads"), |b| {
            b.iter(|| {
                pool.install(|| {
                    tiles.fill(|c, column| {
                        let below = column.iter_mut().enumerate().skip(c);
                        below.for_each(|(r, value)| *value = entry(r, c));
                    });
                    let mut x = right.clone();
                    assert!(tiles.solve(&mut x));
                    x
                })
            });
        });
        let par = if threads == 1 {
            Par::Seq
        } else {
            Par::rayon(threads)
        };
        let mut square = Mat::<f64>::zeros(n, n);
        let request = cholesky_in_place_scratch::<f64>(n, par, Default::default());
        let mut memory = MemBuffer::new(request);
        group.bench_function(format!("faer, {threads} threads"), |b| {
            b.iter(|| {
                pool.install(|| {
                    for c in 0..n {
                        (c..n).for_each(|r| square[(r, c)] = entry(r, c));
                    }
                    let (usual, stack) = (Default::default(), MemStack::new(&mut memory));
                    cholesky_in_place(square.as_mut(), usual, par, stack, Default::default())
                        .expect("positive definite");
                });
            });
        });
    }
    group.finish();
}

fn prediction(c: &mut Criterion) {
    let scaling = Scaling::from_ranges(&[(-1.0, 1.0); 4], &[(-1.0, 1.0)]).expect("valid ranges");
    let weights = nguyen_widrow(&shape(), 1).expect("a valid shape");
    let network = Network::new(shape(), scaling, weights).expect("a valid network");
    let packed = network.packed_weights().to_vec();
    let mut predictor = Predictor::<4, 1>::new(network).expect("four inputs, one output");
    rows(c, predictor.network());
    let mut x = [0.1, -0.2, 0.3, 0.4];
    c.bench_function("prediction f64, Predictor", |b| {
        b.iter(|| {
            let [y] = predictor.predict(black_box(&x));
            black_box(y)
        });
    });
    c.bench_function("prediction f64, Predictor, each after the last", |b| {
        b.iter(|| {
            let [y] = predictor.predict(&x);
            x[0] = y * 1e-3;
            y
        });
    });
    let unit = ScalingRange::new("input", -1.0, 1.0).expect("a valid range");
    let fixed = FixedNetwork::<f64, 4, 1, 66>::new(&[34, 19, 8], &packed, [unit; 4], [unit])
        .expect("a valid network");
    c.bench_function("prediction f64, FixedNetwork", |b| {
        b.iter(|| fixed.evaluate(black_box(&[0.1, -0.2, 0.3, 0.4])));
    });
    let single: Vec<f32> = packed.iter().map(|&w| w as f32).collect();
    let unit = ScalingRange::new("input", -1.0f32, 1.0).expect("a valid range");
    let fixed = FixedNetwork::<f32, 4, 1, 66>::new(&[34, 19, 8], &single, [unit; 4], [unit])
        .expect("a valid network");
    c.bench_function("prediction f32, FixedNetwork", |b| {
        b.iter(|| fixed.evaluate(black_box(&[0.1, -0.2, 0.3, 0.4])));
    });
}

/// A thousand rows at once, their derivatives by the inputs, and those by the weights.
fn rows(c: &mut Criterion, network: &Network) {
    let inputs: Vec<f64> = (0..4000).map(|k| (f64::from(k) * 0.618).fract()).collect();
    let mut outputs = vec![0.0; 1000];
    let mut scratch = network.scratch();
    c.bench_function("1000 rows at once", |b| {
        b.iter(|| {
            let done = network.evaluate_rows(black_box(&inputs), &mut scratch, &mut outputs);
            done.expect("a thousand rows");
        });
    });
    c.bench_function("1000 rows, sensitivities", |b| {
        b.iter(|| network.sensitivities(black_box(&inputs)));
    });
    c.bench_function("1000 rows, Jacobian", |b| {
        b.iter(|| network.jacobian(black_box(&inputs)));
    });
}

fn setup(c: &mut Criterion) {
    c.bench_function("starting weights", |b| {
        b.iter_batched(shape, |s| nguyen_widrow(&s, 1), BatchSize::SmallInput);
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = factorisation, normal_equations, product, epoch, prediction, setup
}
criterion_main!(benches);
