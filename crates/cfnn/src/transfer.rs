use crate::NetworkScalar;

/// What a neuron of a hidden layer makes of its net input `n`; the names are
/// MATLAB's. The output layer is always [`Activation::Purelin`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "lowercase")
)]
#[non_exhaustive]
pub enum Activation {
    /// `tanh n`, see [`NetworkScalar::tansig`].
    #[default]
    Tansig,
    /// `1 / (1 + e^-n)`, computed as `(1 + tanh(n/2)) / 2`: the error is a few
    /// units of rounding of 1, not of the value; below `n = -38.5` (`f64`)
    /// the value is 0.
    Logsig,
    /// `n`.
    Purelin,
    /// `max(0, n)`, also called ReLU.
    Poslin,
}

impl Activation {
    /// The value for each net input; NaN gives NaN.
    #[inline(always)]
    pub fn of<T: NetworkScalar, const C: usize>(self, net: [T; C]) -> [T; C] {
        match self {
            Self::Tansig => T::tansig_of(net),
            Self::Logsig => T::tansig_of(net.map(|n| n * T::HALF)).map(|t| (T::ONE + t) * T::HALF),
            Self::Purelin => net,
            Self::Poslin => net.map(|n| if n < T::ZERO { T::ZERO } else { n }),
        }
    }

    /// The derivative by the net input, from the value `a` that
    /// [`Activation::of`] gave: `1 - a²`, `a (1 - a)`, 1, and for `poslin` 1
    /// where `a > 0` (0 at the corner).
    #[inline(always)]
    pub fn slope<T: NetworkScalar>(self, a: T) -> T {
        match self {
            Self::Tansig => (T::ONE - a) * (T::ONE + a),
            Self::Logsig => a * (T::ONE - a),
            Self::Purelin => T::ONE,
            Self::Poslin if a > T::ZERO => T::ONE,
            Self::Poslin => T::ZERO,
        }
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::AllTansig {}
    impl Sealed for &[super::Activation] {}
}

/// The transfer functions of the hidden layers of a [`crate::FixedNetwork`]:
/// [`AllTansig`], or a list with one for each layer.
pub trait Transfers: sealed::Sealed + Copy {
    /// That of a hidden layer, counted from 0.
    fn of_layer(self, layer: usize) -> Activation;
}

/// Tansig in all hidden layers, known to the compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AllTansig;

impl Transfers for AllTansig {
    #[inline(always)]
    fn of_layer(self, _: usize) -> Activation {
        Activation::Tansig
    }
}

/// As listed; tansig beyond the end of the list.
impl Transfers for &[Activation] {
    #[inline(always)]
    fn of_layer(self, layer: usize) -> Activation {
        self.get(layer).copied().unwrap_or_default()
    }
}
