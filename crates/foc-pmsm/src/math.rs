//! The functions that [`Scalar`] lacks.

use axis_scalar::Scalar;

/// `x` between two bounds; what is not a number passes, which `min` and `max`
/// would hide.
#[inline]
pub(crate) fn clamp<T: Scalar>(x: T, low: T, high: T) -> T {
    let above = if x < low { low } else { x };
    if above > high { high } else { above }
}

/// The angle (rad) without whole turns, from −π to π.
#[inline]
pub(crate) fn wrapped<T: Scalar>(angle: T) -> T {
    if angle.abs() <= T::PI {
        return angle;
    }
    let turn = T::TWO * T::PI;
    let rest = angle - turn * (angle / turn + T::HALF).floor();
    // Of an angle that large that its last place is more than a turn anything is left.
    clamp(rest, -T::PI, T::PI)
}

/// √(x² + y²), without squares that overflow or vanish.
#[inline]
pub(crate) fn length<T: Scalar>(x: T, y: T) -> T {
    let (x, y) = (x.abs(), y.abs());
    let most = x.max(y);
    if most > T::ZERO && most.is_finite() {
        let (x, y) = (x / most, y / most);
        return most * (x * x + y * y).sqrt();
    }
    // 0, infinite, or not a number.
    x + y
}
