use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::block::BlockWork;
use super::cholesky::Symmetric;
use super::dataset::blocks;
use super::engine::Engine;
use super::{Dataset, nguyen_widrow, starting_weights};
use crate::{Activation, Architecture, Links, Network, Scaling, Shape};

fn samples(shape: &Shape, count: usize) -> (Dataset, Scaling) {
    let fraction = |x: f64| x - libm::floor(x);
    let value = |k: usize| 2.0 * fraction(k as f64 * 0.754_877_666_246_692_8) - 1.0;
    let input: Vec<f64> = (0..count * shape.inputs).map(value).collect();
    let target: Vec<f64> = (0..count * shape.outputs)
        .map(|k| 0.5 * value(7 * k + 3))
        .collect();
    let data = Dataset::new(shape.inputs, shape.outputs, input, target).unwrap();
    let scaling = Scaling::from_ranges(
        &vec![(-1.0, 1.0); shape.inputs],
        &vec![(-1.0, 1.0); shape.outputs],
    )
    .unwrap();
    (data, scaling)
}

/// The Jacobian of all scaled outputs, one row for each output and sample,
/// from the deltas and activations: `(rows, values)`, row-major.
fn analytic_jacobian(engine: &Engine, work: &BlockWork) -> Vec<Vec<f64>> {
    let layout = &engine.layout;
    let rows = work.rows;
    let mut jacobian = Vec::new();
    for k in 0..layout.outputs {
        for s in 0..rows {
            let mut row = vec![0.0; layout.parameters];
            for layer in &layout.layers {
                for i in 0..layer.seen {
                    for j in 0..layer.neurons {
                        let neuron = k * layout.neurons + layer.first_neuron + j;
                        row[layer.first_parameter + i * layer.neurons + j] =
                            work.deltas[neuron * rows + s] * work.activations[i * rows + s];
                    }
                }
            }
            jacobian.push(row);
        }
    }
    jacobian
}

fn shapes() -> impl Strategy<Value = Shape> {
    (1..4usize, prop::collection::vec(1..6usize, 0..4), 1..4usize).prop_map(
        |(inputs, hidden, outputs)| Shape {
            inputs,
            hidden,
            outputs,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Central differences with step 1e-5 err by h² f'''/6, about 1e-10 for
    /// weights of a few units, and by rounding 1e-16/h = 1e-11: 2.6e-10 measured.
    #[test]
    fn jacobian_agrees_with_finite_differences(shape in shapes(), seed in 0..1000u64) {
        let (data, scaling) = samples(&shape, 7);
        let chosen: Vec<usize> = (0..data.len()).collect();
        let block = &blocks(&data, &chosen, &scaling)[0];
        let engine = Engine::new(&Architecture::from(shape.clone()), 1);
        let mut work = BlockWork::new(&engine.layout);
        let weights = nguyen_widrow(&shape, seed).unwrap();
        work.forward_hidden(&engine.layout, &weights, block);
        work.residuals(&engine.layout, &weights, block);
        work.backward(&engine.layout, &weights, block);
        let jacobian = analytic_jacobian(&engine, &work);
        let h = 1e-5;
        for c in 0..shape.parameters() {
            let residuals = |change: f64| {
                let mut moved = weights.clone();
                moved[c] += change;
                let mut work = work.clone();
                work.forward_hidden(&engine.layout, &moved, block);
                work.residuals(&engine.layout, &moved, block);
                work.residuals
            };
            let (above, below) = (residuals(h), residuals(-h));
            for (r, row) in jacobian.iter().enumerate() {
                let difference = (above[r] - below[r]) / (2.0 * h);
                prop_assert!(
                    (row[c] - difference).abs() <= 2e-9 * (1.0 + difference.abs()),
                    "parameter {c}, row {r}: {} against {difference}", row[c]
                );
            }
        }
    }

    /// The products of pairs against `JᵀJ` and `Jᵀr` of the explicit matrix;
    /// what differs is the order of at most 1800 additions: 2.3e-15 measured.
    #[test]
    fn blocked_normal_equations_equal_dense_ones(shape in shapes(), seed in 0..1000u64) {
        let (data, scaling) = samples(&shape, 600);
        let chosen: Vec<usize> = (0..data.len()).collect();
        let blocks = blocks(&data, &chosen, &scaling);
        prop_assert_eq!(blocks.len(), 3);
        let weights = nguyen_widrow(&shape, seed).unwrap();
        // Room for two blocks only, so that they come in two groups.
        let mut engine = Engine::new(&Architecture::from(shape.clone()), 2);
        engine.normal_equations(&blocks, &weights);
        let n = shape.parameters();
        let (mut square, mut gradient) = (vec![0.0; n * n], vec![0.0; n]);
        for block in &blocks {
            let mut work = BlockWork::new(&engine.layout);
            work.forward_hidden(&engine.layout, &weights, block);
            work.residuals(&engine.layout, &weights, block);
            work.backward(&engine.layout, &weights, block);
            for (row, r) in analytic_jacobian(&engine, &work).iter().zip(&work.residuals) {
                for c in 0..n {
                    gradient[c] += row[c] * r;
                    for d in 0..n {
                        square[c * n + d] += row[c] * row[d];
                    }
                }
            }
        }
        let largest = square.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (a, b) in engine.dense().iter().zip(&square) {
            prop_assert!((a - b).abs() <= 2e-14 * largest, "{a} against {b}");
        }
        for (a, b) in engine.gradient.iter().zip(&gradient) {
            prop_assert!((a - b).abs() <= 2e-14 * largest, "{a} against {b}");
        }
    }
}

/// The paper's network, whose entries are cut into many tiles: every entry
/// against the plain sum, and the same bits on one thread and on three.
#[test]
fn tiled_normal_equations_equal_dense_ones() {
    let shape = Shape {
        inputs: 4,
        hidden: vec![34, 19, 8],
        outputs: 1,
    };
    let (data, scaling) = samples(&shape, 261);
    let chosen: Vec<usize> = (0..data.len()).collect();
    let blocks = blocks(&data, &chosen, &scaling);
    let weights = nguyen_widrow(&shape, 1).unwrap();
    let on_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let mut engine = Engine::new(&Architecture::from(shape.clone()), 1);
        pool.build().unwrap().install(|| {
            engine.normal_equations(&blocks, &weights);
            engine.dense()
        })
    };
    let square = on_threads(1);
    let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&square), bits(&on_threads(3)));

    let n = shape.parameters();
    let mut plain = vec![0.0; n * n];
    for block in &blocks {
        let engine = Engine::new(&Architecture::from(shape.clone()), 1);
        let mut work = BlockWork::new(&engine.layout);
        work.forward_hidden(&engine.layout, &weights, block);
        work.residuals(&engine.layout, &weights, block);
        work.backward(&engine.layout, &weights, block);
        for row in analytic_jacobian(&engine, &work) {
            for (column, x) in plain.chunks_exact_mut(n).zip(&row) {
                for (sum, y) in column.iter_mut().zip(&row) {
                    *sum += x * y;
                }
            }
        }
    }
    // What differs is the order of 261 additions: 8.7e-16 measured.
    let largest = plain.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    for (a, b) in square.iter().zip(&plain) {
        assert!((a - b).abs() <= 8e-15 * largest, "{a} against {b}");
    }
}

/// Training's deltas and the derivatives of a network are separate programs: the same Jacobian on scaled
/// outputs of half-range 1, 1.1e-15 of the largest entry measured.
#[test]
fn training_has_the_jacobian_of_the_network() {
    let shape = Shape {
        inputs: 3,
        hidden: vec![7, 1, 5],
        outputs: 2,
    };
    let transfers = [Activation::Logsig, Activation::Tansig, Activation::Poslin];
    for links in [Links::Cascade, Links::FeedForward] {
        let architecture = Architecture::from(shape.clone())
            .with_links(links)
            .with_transfers(&transfers)
            .unwrap()
            .without_inputs(&[1])
            .unwrap();
        let (data, scaling) = samples(&shape, 20);
        let chosen: Vec<usize> = (0..data.len()).collect();
        let block = &blocks(&data, &chosen, &scaling)[0];
        let weights = starting_weights(&architecture, 4).unwrap();
        let engine = Engine::new(&architecture, 1);
        let mut work = BlockWork::new(&engine.layout);
        work.forward_hidden(&engine.layout, &weights, block);
        work.residuals(&engine.layout, &weights, block);
        work.backward(&engine.layout, &weights, block);
        let ours = analytic_jacobian(&engine, &work);
        let network = Network::new(architecture, scaling, weights.clone()).unwrap();
        let rows: Vec<f64> = (0..20)
            .flat_map(|s| data.input(s).unwrap().to_vec())
            .collect();
        let jacobian = network.jacobian(&rows).unwrap();
        let largest = jacobian.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (r, row) in jacobian.chunks(weights.len()).enumerate() {
            let own = &ours[r % 2 * 20 + r / 2];
            let free = network.architecture().free().unwrap();
            for c in free {
                let off = (row[c] - own[c]).abs() / largest;
                assert!(off < 3e-15, "weight {c}: {} against {}", row[c], own[c]);
            }
        }
    }
}

/// The trace of the inverse of `D + u uᵀ` (Sherman and Morrison 1950): `Σ 1/d - Σ (u/d)² / (1 + Σ u²/d)`,
/// 1.2e-15 measured; three tiles.
#[test]
fn trace_of_an_inverse_has_its_closed_form() {
    let n = 300;
    let d = |i: usize| 1.0 + (i * 37 % 101) as f64;
    let u = |i: usize| (i * 53 % 89) as f64 / 89.0 - 0.4;
    let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
    let expected = sum(&|i| 1.0 / d(i))
        - sum(&|i| (u(i) / d(i)) * (u(i) / d(i))) / (1.0 + sum(&|i| u(i) * u(i) / d(i)));
    let mut matrix = Symmetric::new(n);
    let mut fill = |sign: f64| {
        matrix.fill(|c, column| {
            for (r, to) in column.iter_mut().enumerate().skip(c) {
                *to = u(r) * u(c);
            }
            column[c] += sign * d(c);
        });
        matrix.trace_of_inverse()
    };
    let trace = fill(1.0).unwrap();
    assert!(
        (trace / expected - 1.0).abs() < 3.5e-15,
        "{trace} against {expected}"
    );
    assert_eq!(fill(-1.0), None);
}

/// Large enough for several panels and tiles: `A = B Bᵀ + n I` is well
/// conditioned: the solution is good to 3.0e-15 measured.
#[test]
fn cholesky_solves_and_refuses() {
    let n = 307;
    let b = |i: usize, j: usize| ((i * 37 + j * 101) % 211) as f64 / 211.0 - 0.5;
    let mut a = vec![0.0; n * n];
    for c in 0..n {
        for r in 0..n {
            a[r + c * n] = (0..n).map(|k| b(r, k) * b(c, k)).sum::<f64>();
        }
        a[c + c * n] += n as f64;
    }
    let truth: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let mut x: Vec<f64> = (0..n)
        .map(|r| (0..n).map(|c| a[r + c * n] * truth[c]).sum())
        .collect();
    let fill = |matrix: &mut Symmetric, a: &[f64]| {
        matrix.fill(|c, column| {
            // What lies above the diagonal must not matter.
            column[..c].fill(f64::NAN);
            column[c..].copy_from_slice(&a[c * n + c..(c + 1) * n]);
        });
    };
    let mut matrix = Symmetric::new(n);
    fill(&mut matrix, &a);
    assert!(matrix.solve(&mut x));
    for (x, t) in x.iter().zip(&truth) {
        assert!((x - t).abs() < 2.5e-14, "{x} against {t}");
    }
    a[250 + 250 * n] = -1.0;
    fill(&mut matrix, &a);
    assert!(!matrix.solve(&mut x));
}

/// The factorisation is cut by the size alone: the same bits on any number of
/// threads.
#[test]
fn cholesky_bits_do_not_depend_on_the_threads() {
    let n = 523;
    let right: Vec<f64> = (0..n).map(|i| (i % 7) as f64 - 3.0).collect();
    let solved = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut matrix = Symmetric::new(n);
            matrix.fill(|c, column| {
                for (r, value) in column.iter_mut().enumerate().skip(c) {
                    *value = ((r * 31 + c * 17) % 101) as f64 / 101.0;
                }
                column[c] += n as f64;
            });
            let mut x = right.clone();
            assert!(matrix.solve(&mut x));
            x.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = solved(1);
    for threads in [2, 3, 4] {
        assert_eq!(one, solved(threads), "{threads} threads");
    }
}
