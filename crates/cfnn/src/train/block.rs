//! One block of samples through the network and back.

use std::vec;
use std::vec::Vec;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use super::dataset::{BLOCK, SampleBlock};
use crate::simd::{Kernel, Vectors};
use crate::{Activation, Architecture, Layer};

/// Rows of delta products that are formed together.
pub(super) const LANES: usize = 8;

/// Sizes and places that every block shares.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// All layers, the output layer last.
    pub layers: Vec<Layer>,
    pub output: Layer,
    pub inputs: usize,
    pub outputs: usize,
    pub activations: usize,
    pub neurons: usize,
    pub parameters: usize,
    /// One for each hidden layer.
    pub transfers: Vec<Activation>,
    /// Parameters that the architecture has; none if all.
    pub free: Option<Vec<usize>>,
    /// Activations that the output layer sees.
    pub output_links: Vec<usize>,
}

impl Layout {
    /// For a valid architecture.
    pub fn new(architecture: &Architecture) -> Self {
        let shape = architecture.shape();
        let neurons = shape.neurons();
        let hidden = shape.hidden.len();
        let seen = architecture.seen(hidden);
        Self {
            transfers: (0..hidden).map(|l| architecture.transfer(l)).collect(),
            free: architecture.free(),
            output_links: (0..seen.len()).filter(|&i| seen[i]).collect(),
            layers: shape.layers(),
            output: Layer {
                seen: shape.activations(),
                neurons: shape.outputs,
                first_parameter: shape.parameters() - shape.activations() * shape.outputs,
                first_neuron: neurons - shape.outputs,
            },
            inputs: shape.inputs,
            outputs: shape.outputs,
            activations: shape.activations(),
            neurons,
            parameters: shape.parameters(),
        }
    }

    /// Number of parameters that are trained.
    pub fn trained(&self) -> usize {
        self.free.as_ref().map_or(self.parameters, Vec::len)
    }

    /// The layers before the output layer.
    pub fn hidden(&self) -> &[Layer] {
        &self.layers[..self.layers.len() - 1]
    }
}

/// Working memory of one block; all tables column-major with `rows` rows.
#[derive(Debug, Clone)]
pub(super) struct BlockWork {
    pub rows: usize,
    /// Bias, inputs, hidden outputs: `rows x activations`.
    pub activations: Vec<f64>,
    /// For output `k` the table `∂y_k/∂(net input of neuron p)`,
    /// `rows x neurons`; the tables one after the other.
    pub deltas: Vec<f64>,
    /// Output minus target, scaled: `rows x outputs`.
    pub residuals: Vec<f64>,
    /// `Jᵀ r` of this block.
    pub gradient: Vec<f64>,
    /// The deltas again, sample by sample: `neurons x (outputs, rows)`,
    /// column-major, and [`LANES`] numbers more, so that whole vectors can be
    /// read from any place.
    pub deltas_by_sample: Vec<f64>,
    weighted: Vec<f64>,
    vectors: Vectors,
}

/// The transfer function of every element in place.
struct Apply<'a>(Activation, &'a mut [f64]);

impl Kernel for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self(transfer, values) = self;
        if transfer == Activation::Tansig {
            // Known to the compiler: this is the usual one.
            apply(Activation::Tansig, values);
        } else {
            apply(transfer, values);
        }
    }
}

#[inline(always)]
fn apply(transfer: Activation, values: &mut [f64]) {
    let (eights, rest) = values.as_chunks_mut::<8>();
    for eight in eights {
        *eight = transfer.of(*eight);
    }
    for value in rest {
        [*value] = transfer.of([*value]);
    }
}

impl BlockWork {
    pub fn new(layout: &Layout) -> Self {
        Self {
            rows: 0,
            activations: vec![0.0; BLOCK * layout.activations],
            deltas: vec![0.0; BLOCK * layout.neurons * layout.outputs],
            residuals: vec![0.0; BLOCK * layout.outputs],
            gradient: vec![0.0; layout.parameters],
            deltas_by_sample: vec![0.0; BLOCK * layout.neurons * layout.outputs + LANES],
            weighted: vec![0.0; BLOCK * layout.neurons],
            vectors: Vectors::detect(),
        }
    }

    /// Activations of the inputs and the hidden layers.
    pub fn forward_hidden(&mut self, layout: &Layout, weights: &[f64], samples: &SampleBlock) {
        let rows = samples.rows;
        self.rows = rows;
        self.activations[..rows].fill(1.0);
        self.activations[rows..rows * (1 + layout.inputs)].copy_from_slice(&samples.inputs);
        for (layer, &transfer) in layout.hidden().iter().zip(&layout.transfers) {
            let (input, free) = self.activations.split_at_mut(rows * layer.seen);
            let out = &mut free[..rows * layer.neurons];
            affine(layer, weights, rows, input, out);
            self.vectors.run(Apply(transfer, out));
        }
    }

    /// Residuals from the activations, each times the root of its sample's
    /// weight; returns the sum of their squares.
    pub fn residuals(&mut self, layout: &Layout, weights: &[f64], samples: &SampleBlock) -> f64 {
        let rows = self.rows;
        let input = &self.activations[..rows * layout.activations];
        let out = &mut self.residuals[..rows * layout.outputs];
        affine(&layout.output, weights, rows, input, out);
        let mut sum = 0.0;
        let Some(roots) = &samples.roots else {
            for (r, t) in out.iter_mut().zip(&samples.targets) {
                *r -= t;
                sum += *r * *r;
            }
            return sum;
        };
        let roots = roots.iter().cycle();
        for ((r, t), root) in out.iter_mut().zip(&samples.targets).zip(roots) {
            *r = (*r - t) * root;
            sum += *r * *r;
        }
        sum
    }

    /// Deltas by backpropagation through the cascade, and the gradient.
    pub fn backward(&mut self, layout: &Layout, weights: &[f64], samples: &SampleBlock) {
        for k in 0..layout.outputs {
            self.deltas_of_output(layout, weights, k, samples.roots.as_deref());
        }
        self.weigh_deltas(layout);
        self.turn_deltas(layout);
        let rows = self.rows;
        for layer in &layout.layers {
            let input = &self.activations[..rows * layer.seen];
            let delta = &self.weighted[rows * layer.first_neuron..][..rows * layer.neurons];
            let into = &mut self.gradient[layer.first_parameter..][..layer.parameters()];
            matmul(
                MatMut::from_row_major_slice_mut(into, layer.seen, layer.neurons),
                Accum::Replace,
                MatRef::from_column_major_slice(input, rows, layer.seen).transpose(),
                MatRef::from_column_major_slice(delta, rows, layer.neurons),
                1.0,
                Par::Seq,
            );
        }
    }

    /// Deltas of one output, times the roots of the samples' weights: so are
    /// the rows of the Jacobian.
    fn deltas_of_output(
        &mut self,
        layout: &Layout,
        weights: &[f64],
        k: usize,
        roots: Option<&[f64]>,
    ) {
        let rows = self.rows;
        let (hidden, output) = (layout.hidden(), layout.output);
        let table = &mut self.deltas[k * rows * layout.neurons..][..rows * layout.neurons];
        let own = &mut table[rows * output.first_neuron..];
        own.fill(0.0);
        let first = &mut own[k * rows..(k + 1) * rows];
        match roots {
            Some(roots) => first.copy_from_slice(roots),
            None => first.fill(1.0),
        }
        for (index, layer) in hidden.iter().enumerate().rev() {
            let (before, later) = table.split_at_mut(rows * (layer.first_neuron + layer.neurons));
            let delta = &mut before[rows * layer.first_neuron..];
            let mut place = Accum::Replace;
            let mut later = &*later;
            for next in &layout.layers[index + 1..] {
                let (theirs, rest) = later.split_at(rows * next.neurons);
                later = rest;
                // The links from this layer are `layer.neurons` rows of the
                // later layer's weights.
                let start = next.first_parameter + layer.seen * next.neurons;
                let links = &weights[start..][..layer.neurons * next.neurons];
                matmul(
                    MatMut::from_column_major_slice_mut(delta, rows, layer.neurons),
                    place,
                    MatRef::from_column_major_slice(theirs, rows, next.neurons),
                    MatRef::from_row_major_slice(links, layer.neurons, next.neurons).transpose(),
                    1.0,
                    Par::Seq,
                );
                place = Accum::Add;
            }
            let values = &self.activations[rows * layer.seen..][..rows * layer.neurons];
            // Tansig apart, so that its loop has no choice in it.
            match layout.transfers[index] {
                Activation::Tansig => {
                    for (d, a) in delta.iter_mut().zip(values) {
                        *d *= Activation::Tansig.slope(*a);
                    }
                }
                other => {
                    for (d, a) in delta.iter_mut().zip(values) {
                        *d *= other.slope(*a);
                    }
                }
            }
        }
    }

    fn turn_deltas(&mut self, layout: &Layout) {
        let (rows, neurons) = (self.rows, layout.neurons);
        let size = layout.outputs * neurons;
        for (c, column) in self.deltas.chunks_exact(rows).take(size).enumerate() {
            let into = self.deltas_by_sample[c..].iter_mut().step_by(size);
            for (to, from) in into.zip(column) {
                *to = *from;
            }
        }
    }

    /// `D_p = Σ_k δ_kp r_k`, so that the gradient is one product per layer.
    fn weigh_deltas(&mut self, layout: &Layout) {
        let rows = self.rows;
        self.weighted.fill(0.0);
        for k in 0..layout.outputs {
            let r = &self.residuals[k * rows..][..rows];
            for p in 0..layout.neurons {
                let delta = &self.deltas[(k * layout.neurons + p) * rows..][..rows];
                let into = &mut self.weighted[p * rows..][..rows];
                for ((w, d), r) in into.iter_mut().zip(delta).zip(r) {
                    *w += d * r;
                }
            }
        }
    }
}

fn affine(layer: &Layer, weights: &[f64], rows: usize, input: &[f64], out: &mut [f64]) {
    let own = &weights[layer.first_parameter..][..layer.parameters()];
    matmul(
        MatMut::from_column_major_slice_mut(out, rows, layer.neurons),
        Accum::Replace,
        MatRef::from_column_major_slice(input, rows, layer.seen),
        MatRef::from_row_major_slice(own, layer.seen, layer.neurons),
        1.0,
        Par::Seq,
    );
}
