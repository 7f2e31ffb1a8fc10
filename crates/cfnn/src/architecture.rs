use alloc::vec;
use alloc::vec::Vec;

use crate::error::same_length;
use crate::{Activation, Error, Shape};

/// Which earlier activations a layer sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Links {
    /// The inputs and all earlier layers (MATLAB's `cascadeforwardnet`).
    #[default]
    Cascade,
    /// The layer before, the first layer the inputs (MATLAB's
    /// `feedforwardnet`).
    FeedForward,
}

/// A shape with its links, transfer functions and inputs that are not used.
///
/// Every network has the weights of the whole cascade, in its order; those of
/// links that the architecture does not have are zero and stay zero. So
/// whatever evaluates a cascade evaluates any architecture, transfer functions
/// apart.
///
/// ```
/// use cfnn::{Architecture, Links, Shape, Activation};
/// let shape = Shape { inputs: 4, hidden: vec![34, 19, 8], outputs: 1 };
/// let plain = Architecture::from(shape)
///     .with_links(Links::FeedForward)
///     .with_transfer(Activation::Logsig)
///     .without_inputs(&[2])?;
/// // Without the third input: 4 x 34, 35 x 19, 20 x 8, 9.
/// assert_eq!(plain.parameters(), 970);
/// assert_eq!(plain.shape().parameters(), 1441);
/// # Ok::<(), cfnn::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Architecture {
    shape: Shape,
    links: Links,
    /// One for each hidden layer, or none at all: tansig everywhere.
    transfers: Vec<Activation>,
    /// Rising.
    dropped: Vec<usize>,
}

/// The full cascade with tansig layers.
impl From<Shape> for Architecture {
    fn from(shape: Shape) -> Self {
        Self {
            shape,
            links: Links::Cascade,
            transfers: Vec::new(),
            dropped: Vec::new(),
        }
    }
}

impl Architecture {
    /// With these links.
    #[must_use]
    pub fn with_links(mut self, links: Links) -> Self {
        self.links = links;
        self
    }

    /// With one transfer function in all hidden layers.
    #[must_use]
    pub fn with_transfer(mut self, transfer: Activation) -> Self {
        self.transfers = match transfer {
            Activation::Tansig => Vec::new(),
            other => vec![other; self.shape.hidden.len()],
        };
        self
    }

    /// With a transfer function for each hidden layer.
    ///
    /// # Errors
    /// [`Error::Length`] for another number of them than hidden layers.
    pub fn with_transfers(mut self, transfers: &[Activation]) -> Result<Self, Error> {
        let layers = self.shape.hidden.len();
        same_length("transfer functions", transfers.len(), layers)?;
        let plain = transfers.iter().all(|&t| t == Activation::Tansig);
        self.transfers = if plain {
            Vec::new()
        } else {
            transfers.to_vec()
        };
        Ok(self)
    }

    /// With inputs that no layer sees (MATLAB's `removeconstantrows`): a
    /// network still takes the whole row of inputs, and leaves these out.
    /// Replaces what was dropped before.
    ///
    /// # Errors
    /// [`Error::DroppedInputs`] for an input that the shape does not have, or
    /// if no input would be left.
    pub fn without_inputs(mut self, dropped: &[usize]) -> Result<Self, Error> {
        let inputs = self.shape.inputs;
        let mut dropped = dropped.to_vec();
        dropped.sort_unstable();
        dropped.dedup();
        let there = dropped.last().is_none_or(|&last| last < inputs);
        if !there || (dropped.len() >= inputs && !dropped.is_empty()) {
            return Err(Error::DroppedInputs {
                found: dropped.len(),
                inputs,
            });
        }
        self.dropped = dropped;
        Ok(self)
    }

    /// Layer sizes.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Which earlier activations a layer sees.
    #[must_use]
    pub fn links(&self) -> Links {
        self.links
    }

    /// Activation function of a hidden layer, counted from 0; tansig for one
    /// that does not exist.
    #[must_use]
    pub fn transfer(&self, layer: usize) -> Activation {
        self.transfers.get(layer).copied().unwrap_or_default()
    }

    /// Inputs that no layer sees, in rising order.
    #[must_use]
    pub fn dropped_inputs(&self) -> &[usize] {
        &self.dropped
    }

    /// What code for tansig layers alone (an export, say) asks first.
    ///
    /// # Errors
    /// [`Error::NotTansig`] with the first layer that is not.
    pub fn require_tansig(&self) -> Result<(), Error> {
        match self.transfers.iter().position(|&t| t != Activation::Tansig) {
            Some(layer) => Err(Error::NotTansig { layer }),
            None => Ok(()),
        }
    }

    /// Number of weights and biases that the architecture has, those that are
    /// always zero not counted; saturates instead of overflowing.
    #[must_use]
    pub fn parameters(&self) -> usize {
        let kept = 1usize.saturating_add(self.shape.inputs - self.dropped.len());
        let mut seen = kept;
        let mut parameters = 0usize;
        for &neurons in self.shape.hidden.iter().chain([&self.shape.outputs]) {
            parameters = parameters.saturating_add(seen.saturating_mul(neurons));
            seen = match self.links {
                Links::Cascade => seen.saturating_add(neurons),
                Links::FeedForward => neurons.saturating_add(1),
            };
        }
        parameters
    }

    /// Checks the shape.
    ///
    /// # Errors
    /// As [`Shape::validate`].
    pub fn validate(&self) -> Result<(), Error> {
        self.shape.validate()
    }

    /// Whether each activation that a cascade's layer would see (the bias
    /// first; hidden layers from 0, then the output layer) is seen. For a
    /// valid shape.
    pub(crate) fn seen(&self, layer: usize) -> Vec<bool> {
        let inputs = self.shape.inputs;
        let hidden: usize = self.shape.hidden[..layer].iter().sum();
        let seen = 1 + inputs + hidden;
        let mut sees = vec![true; seen];
        if self.links == Links::FeedForward
            && let Some(before) = layer.checked_sub(1)
        {
            sees[1..seen - self.shape.hidden[before]].fill(false);
        }
        for &input in &self.dropped {
            sees[1 + input] = false;
        }
        sees
    }

    /// Indices of the weights that the architecture has; none if all. For a
    /// valid shape.
    pub(crate) fn free(&self) -> Option<Vec<usize>> {
        if self.links == Links::Cascade && self.dropped.is_empty() {
            return None;
        }
        let mut free = Vec::with_capacity(self.parameters());
        for (number, layer) in self.shape.layers().iter().enumerate() {
            let seen = self.seen(number);
            let rows = seen.iter().enumerate().filter(|&(_, &sees)| sees);
            for (i, _) in rows {
                let first = layer.first_parameter + i * layer.neurons;
                free.extend(first..first + layer.neurons);
            }
        }
        Some(free)
    }

    /// Empty where all are tansig.
    pub(crate) fn transfers(&self) -> &[Activation] {
        &self.transfers
    }
}
