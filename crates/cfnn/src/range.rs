use crate::{Error, Real};

/// One row of the min-max scaling (MATLAB's `mapminmax`): the affine map of
/// `[minimum, maximum]`, in the caller's unit, onto `[-1, 1]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range<T> {
    minimum: T,
    maximum: T,
    gain: T,
    half_width: T,
}

impl<T: Real> Range<T> {
    /// The range from `minimum` to `maximum`; `what` names it in the error.
    ///
    /// # Errors
    /// [`Error::Range`] unless both ends, their distance and its inverse are
    /// finite and the minimum lies below the maximum.
    pub fn new(what: &'static str, minimum: T, maximum: T) -> Result<Self, Error> {
        let width = maximum - minimum;
        let gain = T::TWO / width;
        let usable = width.is_finite() && gain.is_finite() && minimum.is_finite();
        if minimum < maximum && usable {
            Ok(Self {
                minimum,
                maximum,
                gain,
                half_width: width / T::TWO,
            })
        } else {
            Err(Error::Range {
                what,
                minimum: minimum.to_f64(),
                maximum: maximum.to_f64(),
            })
        }
    }

    /// Lower end, mapped to -1.
    pub fn minimum(&self) -> T {
        self.minimum
    }

    /// Upper end, mapped to 1.
    pub fn maximum(&self) -> T {
        self.maximum
    }

    /// Half of the width: one scaled unit in the caller's unit.
    pub fn half_width(&self) -> T {
        self.half_width
    }

    /// Scaled units per unit of the caller: the inverse of the half width, rounded by itself.
    pub fn gain(&self) -> T {
        self.gain
    }

    /// From the caller's unit to the scaled one; values outside the range are
    /// extrapolated, not clipped.
    #[inline(always)]
    pub fn to_unit(&self, value: T) -> T {
        (value - self.minimum) * self.gain - T::ONE
    }

    /// From the scaled unit to the caller's.
    #[inline(always)]
    pub fn from_unit(&self, scaled: T) -> T {
        (scaled + T::ONE) * self.half_width + self.minimum
    }
}
