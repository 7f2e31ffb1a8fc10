use axis_scalar::Scalar;

use crate::tansig::{tansig_f32, tansig_f64};

/// The scalar of an evaluation: `f64` or `f32`.
///
/// Training is in `f64` only; `f32` exists for controllers.
pub trait NetworkScalar: Scalar {
    /// The transfer function of the hidden layers,
    /// `2 / (1 + e^{-2x}) - 1 = tanh x`, within 8 units in the last place.
    /// NaN gives NaN.
    #[must_use]
    #[inline(always)]
    fn tansig(self) -> Self {
        let [value] = Self::tansig_of([self]);
        value
    }

    /// [`NetworkScalar::tansig`] of each element, with the same bits; several at once
    /// keep the processor's vectors full.
    #[must_use]
    fn tansig_of<const C: usize>(values: [Self; C]) -> [Self; C];
}

impl NetworkScalar for f64 {
    #[inline(always)]
    fn tansig_of<const C: usize>(values: [Self; C]) -> [Self; C] {
        tansig_f64(values)
    }
}

impl NetworkScalar for f32 {
    #[inline(always)]
    fn tansig_of<const C: usize>(values: [Self; C]) -> [Self; C] {
        tansig_f32(values)
    }
}
