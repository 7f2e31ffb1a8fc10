use crate::backward::Evaluated;
use crate::error::same_length;
use crate::forward::{Layers, forward};
use crate::pack::count;
use crate::{Activation, AllTansig, Error, NetworkScalar, ScalingRange, Transfers};

/// A network that borrows its weights, for use without an allocator.
///
/// `I` inputs, `O` outputs, and `A` activations: `1 + I` plus the number of
/// hidden neurons ([`FixedNetwork::new`] checks it and says what it must be).
/// The working memory, `A` scalars, lies on the stack of
/// [`FixedNetwork::evaluate`], which cannot fail. The hidden layers are tansig
/// unless [`FixedNetwork::with_transfers`] says otherwise.
///
/// ```
/// use cfnn::{FixedNetwork, ScalingRange};
/// // y = x + tanh(2 x - 1) on scaled values: one hidden neuron.
/// // Order: [bias, input] of the hidden neuron, then [bias, input, hidden].
/// const WEIGHTS: [f64; 5] = [-1.0, 2.0, 0.0, 1.0, 1.0];
/// let mut packed = [0.0; cfnn::packed_len(1, &[1], 1)];
/// cfnn::pack(1, &[1], 1, &WEIGHTS, &mut packed)?;
/// let unit = ScalingRange::new("input", -1.0, 1.0)?;
/// let network = FixedNetwork::<f64, 1, 1, 3>::new(&[1], &packed, [unit], [unit])?;
/// let [y] = network.evaluate(&[0.25]);
/// assert!((y - (0.25 + (-0.5f64).tanh())).abs() < 1e-15);
/// # Ok::<(), cfnn::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FixedNetwork<'a, T, const I: usize, const O: usize, const A: usize, X = AllTansig> {
    hidden: &'a [usize],
    weights: &'a [T],
    input: [ScalingRange<T>; I],
    output: [ScalingRange<T>; O],
    transfers: X,
}

impl<'a, T: NetworkScalar, const I: usize, const O: usize, const A: usize>
    FixedNetwork<'a, T, I, O, A>
{
    /// A network with the given hidden layer sizes and weights (in the order
    /// that [`crate::pack`] makes), and the scaling of each input and output.
    ///
    /// # Errors
    /// [`Error::EmptyLayer`], [`Error::Length`] (of `A` or of the weights) or
    /// [`Error::NotFinite`].
    pub fn new(
        hidden: &'a [usize],
        weights: &'a [T],
        input: [ScalingRange<T>; I],
        output: [ScalingRange<T>; O],
    ) -> Result<Self, Error> {
        if I == 0 || O == 0 {
            let what = if I == 0 { "inputs" } else { "outputs" };
            return Err(Error::EmptyLayer { what, index: 0 });
        }
        if let Some(index) = hidden.iter().position(|&n| n == 0) {
            return Err(Error::EmptyLayer {
                what: "hidden",
                index,
            });
        }
        let activations = count(I, hidden, O).0;
        same_length("activations A", A, activations)?;
        let length = crate::packed_len(I, hidden, O);
        same_length("packed weights", weights.len(), length)?;
        for (index, &w) in weights.iter().enumerate() {
            if !w.is_finite() {
                return Err(Error::NotFinite {
                    what: "weights",
                    index,
                    value: w.to_f64(),
                });
            }
        }
        Ok(Self {
            hidden,
            weights,
            input,
            output,
            transfers: AllTansig,
        })
    }

    /// The same network with these transfer functions, one for each hidden layer.
    ///
    /// ```
    /// use cfnn::{FixedNetwork, ScalingRange, Activation};
    /// // y = max(0, 2 x - 1), the links from bias and input to the output zero.
    /// let mut packed = [0.0; cfnn::packed_len(1, &[1], 1)];
    /// cfnn::pack(1, &[1], 1, &[-1.0, 2.0, 0.0, 0.0, 1.0], &mut packed)?;
    /// let unit = ScalingRange::new("input", -1.0, 1.0)?;
    /// let network = FixedNetwork::<f64, 1, 1, 3>::new(&[1], &packed, [unit], [unit])?
    ///     .with_transfers(&[Activation::Poslin])?;
    /// assert_eq!(network.evaluate(&[0.25]), [0.0]);
    /// assert_eq!(network.evaluate(&[0.75]), [0.5]);
    /// # Ok::<(), cfnn::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Length`] for another number of them than hidden layers.
    pub fn with_transfers(
        self,
        transfers: &'a [Activation],
    ) -> Result<FixedNetwork<'a, T, I, O, A, &'a [Activation]>, Error> {
        same_length("transfer functions", transfers.len(), self.hidden.len())?;
        Ok(FixedNetwork {
            hidden: self.hidden,
            weights: self.weights,
            input: self.input,
            output: self.output,
            transfers,
        })
    }
}

impl<T: NetworkScalar, const I: usize, const O: usize, const A: usize, X: Transfers>
    FixedNetwork<'_, T, I, O, A, X>
{
    /// The outputs, in the caller's units, for one vector of inputs in theirs.
    #[must_use]
    pub fn evaluate(&self, input: &[T; I]) -> [T; O] {
        self.run(input, &mut [T::ZERO; A])
    }

    /// The outputs and their derivatives by the inputs, all in the caller's
    /// units: element `[o][i]` of the second is `∂y_o/∂x_i`. A linearisation
    /// for a controller or an observer, without finite differences.
    #[must_use]
    pub fn sensitivities(&self, input: &[T; I]) -> ([T; O], [[T; I]; O]) {
        let mut activations = [T::ZERO; A];
        let out = self.run(input, &mut activations);
        let evaluated = Evaluated {
            hidden: self.hidden,
            outputs: O,
            transfers: self.transfers,
            weights: self.weights,
            activations: &activations,
        };
        let mut derivatives = [[T::ZERO; I]; O];
        let mut adjoint = [T::ZERO; A];
        for (o, row) in derivatives.iter_mut().enumerate() {
            evaluated.derivatives(o, &mut adjoint);
            for (i, to) in row.iter_mut().enumerate() {
                *to = adjoint[1 + i] * self.output[o].half_width() * self.input[i].gain();
            }
        }
        (out, derivatives)
    }

    #[inline(always)]
    fn run(&self, input: &[T; I], activations: &mut [T; A]) -> [T; O] {
        activations[0] = T::ONE;
        for i in 0..I {
            activations[1 + i] = self.input[i].to_unit(input[i]);
        }
        let mut out = [T::ZERO; O];
        let layers = Layers {
            inputs: I,
            hidden: self.hidden,
            weights: self.weights,
        };
        forward(&layers, self.transfers, activations, &mut out);
        for (value, range) in out.iter_mut().zip(&self.output) {
            *value = range.from_unit(*value);
        }
        out
    }
}
