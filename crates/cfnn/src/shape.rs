use alloc::vec::Vec;

use crate::Error;

/// The largest number of parameters accepted: beyond it the normal equations
/// of the training would need more than 2 TB.
pub const MAX_PARAMETERS: usize = 1 << 19;

/// Layer sizes of a cascade-forward network.
///
/// ```
/// let shape = cfnn::Shape { inputs: 4, hidden: vec![34, 19, 8], outputs: 1 };
/// assert_eq!(shape.parameters(), 1441);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
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
    /// Number of parameters of the layer.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.seen * self.neurons
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
        if self.parameters() > MAX_PARAMETERS {
            return Err(Error::TooLarge {
                limit: MAX_PARAMETERS,
            });
        }
        Ok(())
    }

    /// Number of weights and biases together; saturates instead of overflowing.
    #[must_use]
    pub fn parameters(&self) -> usize {
        crate::count(self.inputs, &self.hidden, self.outputs).1
    }

    /// Length of the activation vector: 1 (bias), inputs and hidden neurons.
    #[must_use]
    pub fn activations(&self) -> usize {
        crate::count(self.inputs, &self.hidden, self.outputs).0
    }

    /// Neurons of the hidden and output layers together.
    #[must_use]
    pub fn neurons(&self) -> usize {
        self.hidden.iter().sum::<usize>() + self.outputs
    }

    /// The layers from the first hidden one to the output layer.
    #[must_use]
    pub fn layers(&self) -> Vec<Layer> {
        let mut seen = 1 + self.inputs;
        let mut first_parameter = 0;
        let mut first_neuron = 0;
        let mut layers = Vec::with_capacity(self.hidden.len() + 1);
        for &neurons in self.hidden.iter().chain([&self.outputs]) {
            layers.push(Layer {
                seen,
                neurons,
                first_parameter,
                first_neuron,
            });
            first_parameter += seen * neurons;
            first_neuron += neurons;
            seen += neurons;
        }
        layers
    }
}
