use alloc::vec;
use alloc::vec::Vec;

use crate::error::{all_finite, same_length};
use crate::forward::forward;
use crate::pack::pack_layers;
use crate::simd::{Kernel, Vectors};
use crate::{Error, Scaling, Shape, packed_len};

/// A cascade-forward network with its scaling: immutable once made.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    shape: Shape,
    scaling: Scaling,
    weights: Vec<f64>,
    /// The weights again, in the order of evaluation.
    packed: Vec<f64>,
}

/// Working memory of one evaluation, made by [`Network::scratch`].
#[derive(Debug, Clone)]
pub struct Scratch {
    activations: Vec<f64>,
    vectors: Vectors,
}

impl Network {
    /// A network from its layer sizes, scaling and weights (order: see the
    /// crate's documentation).
    ///
    /// # Errors
    /// What [`Shape::validate`] refuses, [`Error::Length`] if the scaling
    /// or the weights do not fit the shape, [`Error::NotFinite`] for a weight.
    pub fn new(shape: Shape, scaling: Scaling, weights: Vec<f64>) -> Result<Self, Error> {
        shape.validate()?;
        same_length("input ranges", scaling.input().len(), shape.inputs)?;
        same_length("output ranges", scaling.output().len(), shape.outputs)?;
        same_length("weights", weights.len(), shape.parameters())?;
        all_finite("weights", &weights)?;
        Ok(Self::from_valid(shape, scaling, weights))
    }

    /// [`Network::new`] for parts that are known to fit each other and to be
    /// finite.
    pub(crate) fn from_valid(shape: Shape, scaling: Scaling, weights: Vec<f64>) -> Self {
        let mut packed = vec![0.0; packed_len(shape.inputs, &shape.hidden, shape.outputs)];
        let Shape {
            inputs,
            hidden,
            outputs,
        } = &shape;
        pack_layers(*inputs, hidden, *outputs, &weights, &mut packed);
        Self {
            shape,
            scaling,
            weights,
            packed,
        }
    }

    /// Layer sizes.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
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
        let mut activations = vec![0.0; self.shape.activations()];
        activations[0] = 1.0;
        Scratch {
            activations,
            vectors: Vectors::detect(),
        }
    }

    /// Writes the outputs for one vector of inputs, both in the caller's
    /// units. Does not allocate. [`Predictor`] is the form that cannot fail.
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
        same_length("input", input.len(), self.shape.inputs)?;
        same_length("output", output.len(), self.shape.outputs)?;
        same_length(
            "scratch",
            scratch.activations.len(),
            self.shape.activations(),
        )?;
        self.run(input, scratch, output);
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

    #[inline(always)]
    fn run(&self, input: &[f64], scratch: &mut Scratch, output: &mut [f64]) {
        scratch.vectors.run(Evaluation {
            network: self,
            input,
            activations: &mut scratch.activations,
            output,
        });
    }
}

struct Evaluation<'a> {
    network: &'a Network,
    input: &'a [f64],
    activations: &'a mut [f64],
    output: &'a mut [f64],
}

impl Kernel for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Network {
            shape,
            scaling,
            packed,
            ..
        } = self.network;
        let scaled = &mut self.activations[1..=shape.inputs];
        for ((to, &from), range) in scaled.iter_mut().zip(self.input).zip(scaling.input()) {
            *to = range.to_unit(from);
        }
        let (activations, output) = (self.activations, self.output);
        forward(shape.inputs, &shape.hidden, packed, activations, output);
        for (value, range) in output.iter_mut().zip(scaling.output()) {
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
        same_length("inputs", network.shape.inputs, I)?;
        same_length("outputs", network.shape.outputs, O)?;
        let scratch = network.scratch();
        Ok(Self { network, scratch })
    }

    /// The outputs for one vector of inputs, both in the caller's units.
    #[must_use]
    pub fn predict(&mut self, input: &[f64; I]) -> [f64; O] {
        let mut output = [0.0; O];
        self.network.run(input, &mut self.scratch, &mut output);
        output
    }

    /// The network inside.
    #[must_use]
    pub fn network(&self) -> &Network {
        &self.network
    }
}
