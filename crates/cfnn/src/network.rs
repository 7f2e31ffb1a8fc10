use alloc::vec;
use alloc::vec::Vec;

use crate::error::{all_finite, same_length};
use crate::forward::{Layers, forward};
use crate::pack::pack_layers;
use crate::simd::{Kernel, Vectors};
use crate::{AllTansig, Architecture, Error, Scaling, Shape, Transfers, packed_len};

/// A cascade-forward network with its scaling: immutable once made.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    pub(crate) architecture: Architecture,
    scaling: Scaling,
    weights: Vec<f64>,
    /// The weights again, in the order of evaluation.
    pub(crate) packed: Vec<f64>,
}

/// Working memory of one evaluation, made by [`Network::scratch`].
#[derive(Debug, Clone)]
pub struct Scratch {
    pub(crate) activations: Vec<f64>,
    pub(crate) vectors: Vectors,
}

impl Network {
    /// A network from its layer sizes (a [`Shape`], or an [`Architecture`] for
    /// other links and transfer functions), scaling and weights (order: see
    /// the crate's documentation).
    ///
    /// # Errors
    /// What [`Shape::validate`] refuses, [`Error::Length`] if the scaling
    /// or the weights do not fit the shape, [`Error::NotFinite`] for a weight,
    /// [`Error::AbsentLink`] for one other than 0 that the architecture lacks.
    pub fn new(
        architecture: impl Into<Architecture>,
        scaling: Scaling,
        weights: Vec<f64>,
    ) -> Result<Self, Error> {
        let architecture = architecture.into();
        architecture.validate()?;
        let shape = architecture.shape();
        same_length("input ranges", scaling.input().len(), shape.inputs)?;
        same_length("output ranges", scaling.output().len(), shape.outputs)?;
        same_length("weights", weights.len(), shape.parameters())?;
        all_finite("weights", &weights)?;
        absent_are_zero(&architecture, &weights)?;
        Ok(Self::from_valid(architecture, scaling, weights))
    }

    /// [`Network::new`] for parts that are known to fit each other and to be
    /// finite.
    pub(crate) fn from_valid(
        architecture: Architecture,
        scaling: Scaling,
        weights: Vec<f64>,
    ) -> Self {
        let Shape {
            inputs,
            hidden,
            outputs,
        } = architecture.shape();
        let mut packed = vec![0.0; packed_len(*inputs, hidden, *outputs)];
        pack_layers(*inputs, hidden, *outputs, &weights, &mut packed);
        Self {
            architecture,
            scaling,
            weights,
            packed,
        }
    }

    /// Layer sizes.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        self.architecture.shape()
    }

    /// Shape, links, transfer functions and inputs that are not used.
    #[must_use]
    pub fn architecture(&self) -> &Architecture {
        &self.architecture
    }

    /// Scaling of inputs and outputs.
    #[must_use]
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// All weights and biases.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The weights in the order that [`crate::FixedNetwork`] reads, to be
    /// exported to a controller.
    #[must_use]
    pub fn packed_weights(&self) -> &[f64] {
        &self.packed
    }

    /// Working memory for [`Network::evaluate`]; may be used for any number of
    /// evaluations of this network.
    #[must_use]
    pub fn scratch(&self) -> Scratch {
        let mut activations = vec![0.0; self.shape().activations()];
        activations[0] = 1.0;
        Scratch {
            activations,
            vectors: Vectors::detect(),
        }
    }

    /// Writes the outputs for one vector of inputs, both in the caller's
    /// units. Does not allocate. [`Predictor`] is the form that cannot fail,
    /// [`Network::evaluate_rows`] takes many vectors at once.
    ///
    /// # Errors
    /// [`Error::Length`] when a slice, or a scratch made by another network,
    /// has the wrong length.
    pub fn evaluate(
        &self,
        input: &[f64],
        scratch: &mut Scratch,
        output: &mut [f64],
    ) -> Result<(), Error> {
        let shape = self.shape();
        same_length("input", input.len(), shape.inputs)?;
        same_length("output", output.len(), shape.outputs)?;
        self.check_scratch(scratch)?;
        self.run::<false>(input, scratch, output);
        Ok(())
    }

    /// The output of a network that has exactly one.
    ///
    /// # Errors
    /// As [`Network::evaluate`].
    pub fn predict_one(&self, input: &[f64], scratch: &mut Scratch) -> Result<f64, Error> {
        let mut output = [0.0];
        self.evaluate(input, scratch, &mut output)?;
        Ok(output[0])
    }

    pub(crate) fn check_scratch(&self, scratch: &Scratch) -> Result<(), Error> {
        let expected = self.shape().activations();
        same_length("scratch", scratch.activations.len(), expected)
    }

    /// One row of inputs, or with `MANY` several and as many rows of outputs.
    #[inline(always)]
    pub(crate) fn run<const MANY: bool>(
        &self,
        input: &[f64],
        scratch: &mut Scratch,
        output: &mut [f64],
    ) {
        if self.architecture.transfers().is_empty() {
            scratch.vectors.run(Evaluation::<_, MANY> {
                network: self,
                transfers: AllTansig,
                input,
                activations: &mut scratch.activations,
                output,
            });
        } else {
            self.run_listed::<MANY>(input, scratch, output);
        }
    }

    /// [`Network::run`] for other transfer functions; apart, so that the usual
    /// one stays small.
    #[inline(never)]
    fn run_listed<const MANY: bool>(
        &self,
        input: &[f64],
        scratch: &mut Scratch,
        output: &mut [f64],
    ) {
        scratch.vectors.run(Evaluation::<_, MANY> {
            network: self,
            transfers: self.architecture.transfers(),
            input,
            activations: &mut scratch.activations,
            output,
        });
    }
}

/// Refuses a weight other than 0 of a link that the architecture lacks.
fn absent_are_zero(architecture: &Architecture, weights: &[f64]) -> Result<(), Error> {
    let mut free = architecture.free().into_iter().flatten().peekable();
    if free.peek().is_none() {
        return Ok(());
    }
    for (index, &value) in weights.iter().enumerate() {
        if free.next_if_eq(&index).is_none() && value != 0.0 {
            return Err(Error::AbsentLink { index, value });
        }
    }
    Ok(())
}

struct Evaluation<'a, X, const MANY: bool> {
    network: &'a Network,
    transfers: X,
    input: &'a [f64],
    activations: &'a mut [f64],
    output: &'a mut [f64],
}

impl<X: Transfers, const MANY: bool> Kernel for Evaluation<'_, X, MANY> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (activations, transfers) = (self.activations, self.transfers);
        if !MANY {
            // Without the divisions that a number of rows takes.
            self.network
                .evaluate_row(transfers, self.input, activations, self.output);
            return;
        }
        let shape = self.network.shape();
        let rows = self.output.chunks_exact_mut(shape.outputs);
        for (input, output) in self.input.chunks_exact(shape.inputs).zip(rows) {
            self.network
                .evaluate_row(transfers, input, activations, output);
        }
    }
}

impl Network {
    #[inline(always)]
    fn evaluate_row(
        &self,
        transfers: impl Transfers,
        input: &[f64],
        activations: &mut [f64],
        output: &mut [f64],
    ) {
        let shape = self.architecture.shape();
        let scaled = &mut activations[1..=shape.inputs];
        for ((to, &from), range) in scaled.iter_mut().zip(input).zip(self.scaling.input()) {
            *to = range.to_unit(from);
        }
        for &dropped in self.architecture.dropped_inputs() {
            // Whatever it is, NaN too: nothing looks at it.
            scaled[dropped] = 0.0;
        }
        let layers = Layers {
            inputs: shape.inputs,
            hidden: &shape.hidden,
            weights: &self.packed,
        };
        forward(&layers, transfers, activations, output);
        for (value, range) in output.iter_mut().zip(self.scaling.output()) {
            *value = range.from_unit(*value);
        }
    }
}

/// A network together with its working memory and its numbers of inputs and
/// outputs in the type: prediction cannot fail and does not allocate.
#[derive(Debug, Clone)]
pub struct Predictor<const I: usize, const O: usize> {
    network: Network,
    scratch: Scratch,
}

impl<const I: usize, const O: usize> Predictor<I, O> {
    /// Takes a network with `I` inputs and `O` outputs.
    ///
    /// # Errors
    /// [`Error::Length`] when the network has other numbers of them.
    pub fn new(network: Network) -> Result<Self, Error> {
        same_length("inputs", network.shape().inputs, I)?;
        same_length("outputs", network.shape().outputs, O)?;
        let scratch = network.scratch();
        Ok(Self { network, scratch })
    }

    /// The outputs for one vector of inputs, both in the caller's units.
    #[must_use]
    pub fn predict(&mut self, input: &[f64; I]) -> [f64; O] {
        let mut output = [0.0; O];
        self.network
            .run::<false>(input, &mut self.scratch, &mut output);
        output
    }

    /// The network inside.
    #[must_use]
    pub fn network(&self) -> &Network {
        &self.network
    }
}
