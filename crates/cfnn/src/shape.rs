use alloc::vec::Vec;

use crate::Error;
use crate::pack::count;

/// The largest number of parameters of a network: 4 MB of weights, some
/// hundred times what a feed axis asks for. Training has its own limit, see
/// `train::MAX_TRAINING_BYTES`.
pub const MAX_PARAMETERS: usize = 1 << 19;

/// Layer sizes of a cascade-forward network.
///
/// ```
/// let shape = cfnn::Shape { inputs: 4, hidden: vec![34, 19, 8], outputs: 1 };
/// assert_eq!(shape.parameters(), 1441);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", deny_unknown_fields)
)]
pub struct Shape {
    /// Number of inputs, at least 1.
    pub inputs: usize,
    /// Neurons of each hidden layer (tansig), first layer first; may be
    /// empty, which leaves an affine map.
    pub hidden: Vec<usize>,
    /// Number of outputs (purelin), at least 1.
    pub outputs: usize,
}

/// One layer's place among activations, neurons and parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layer {
    /// Length of the prefix of activations that the layer sees: bias, inputs
    /// and all earlier layers.
    pub seen: usize,
    /// Neurons of the layer.
    pub neurons: usize,
    /// Index of the layer's first parameter. The parameter from activation
    /// `i` to neuron `j` has index `first_parameter + i * neurons + j`.
    pub first_parameter: usize,
    /// Index of the layer's first neuron, counted over hidden and output
    /// layers.
    pub first_neuron: usize,
}

impl Layer {
    /// Number of parameters of the layer; saturates instead of overflowing.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.seen.saturating_mul(self.neurons)
    }
}

impl Shape {
    /// Checks that no layer is empty and that the size is manageable.
    ///
    /// # Errors
    /// [`Error::EmptyLayer`] or [`Error::TooLarge`].
    pub fn validate(&self) -> Result<(), Error> {
        let empty = |what, index| Err(Error::EmptyLayer { what, index });
        if self.inputs == 0 {
            return empty("inputs", 0);
        }
        if self.outputs == 0 {
            return empty("outputs", 0);
        }
        if let Some(index) = self.hidden.iter().position(|&n| n == 0) {
            return empty("hidden", index);
        }
        let found = self.parameters();
        if found > MAX_PARAMETERS {
            return Err(Error::TooLarge {
                found,
                limit: MAX_PARAMETERS,
            });
        }
        Ok(())
    }

    /// Number of weights and biases together; saturates instead of overflowing.
    #[must_use]
    pub fn parameters(&self) -> usize {
        count(self.inputs, &self.hidden, self.outputs).1
    }

    /// Length of the activation vector: 1 (bias), inputs and hidden neurons;
    /// saturates instead of overflowing.
    #[must_use]
    pub fn activations(&self) -> usize {
        count(self.inputs, &self.hidden, self.outputs).0
    }

    /// Neurons of the hidden and output layers together; saturates instead of
    /// overflowing.
    #[must_use]
    pub fn neurons(&self) -> usize {
        let hidden = self.hidden.iter();
        hidden.fold(self.outputs, |sum, &n| sum.saturating_add(n))
    }

    /// The layers from the first hidden one to the output layer. Their numbers
    /// saturate, which a shape that [`Shape::validate`] accepts cannot reach.
    #[must_use]
    pub fn layers(&self) -> Vec<Layer> {
        let mut seen = self.inputs.saturating_add(1);
        let mut first_parameter = 0usize;
        let mut first_neuron = 0usize;
        let mut layers = Vec::with_capacity(self.hidden.len() + 1);
        for &neurons in self.hidden.iter().chain([&self.outputs]) {
            let layer = Layer {
                seen,
                neurons,
                first_parameter,
                first_neuron,
            };
            layers.push(layer);
            first_parameter = first_parameter.saturating_add(layer.parameters());
            first_neuron = first_neuron.saturating_add(neurons);
            seen = seen.saturating_add(neurons);
        }
        layers
    }
}
