//! The three frames of a three-phase quantity (voltage, current or flux) and
//! the transforms between them, amplitude-invariant: a balanced set of peak
//! value X is a vector of length X in each frame.

use axis_scalar::Scalar;
use core::ops::{Add, Mul, Neg, Sub};

/// 1/√3.
pub(crate) const FRAC_1_SQRT_3: f64 = 0.577_350_269_189_625_8;
const SQRT_3_HALF: f64 = 0.866_025_403_784_438_6;

/// The three phase quantities, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Phases<T = f64> {
    /// Phase a.
    pub a: T,
    /// Phase b, 120° behind a.
    pub b: T,
    /// Phase c, 240° behind a.
    pub c: T,
}

/// A space vector in the stator's frame, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct AlphaBeta<T = f64> {
    /// Along the axis of phase a.
    pub alpha: T,
    /// 90° (electrical) ahead of α.
    pub beta: T,
}

/// A space vector in the rotor's frame, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Dq<T = f64> {
    /// Direct axis, along the magnets' flux.
    pub d: T,
    /// Quadrature axis, 90° (electrical) ahead of d.
    pub q: T,
}

impl<T: Scalar> Phases<T> {
    /// Clarke transform: α = (2a − b − c)/3, β = (b − c)/√3. What the three
    /// phases have in common ([`Phases::zero_sequence`]) is dropped.
    #[inline]
    pub fn clarke(self) -> AlphaBeta<T> {
        AlphaBeta {
            alpha: (T::TWO * self.a - self.b - self.c) / T::of(3.0),
            beta: (self.b - self.c) * T::of(FRAC_1_SQRT_3),
        }
    }

    /// The mean of the three phases, which drives no current in a star
    /// winding whose neutral is not connected.
    #[inline]
    pub fn zero_sequence(self) -> T {
        (self.a + self.b + self.c) / T::of(3.0)
    }
}

impl<T: Scalar> AlphaBeta<T> {
    /// Inverse Clarke transform, without zero sequence:
    /// a = α, b = −α/2 + √3/2 β, c = −α/2 − √3/2 β.
    #[inline]
    pub fn inverse_clarke(self) -> Phases<T> {
        let half = T::of(-0.5) * self.alpha;
        let side = T::of(SQRT_3_HALF) * self.beta;
        Phases {
            a: self.alpha,
            b: half + side,
            c: half - side,
        }
    }

    /// Park transform for a d axis at the electrical `angle` (rad, from
    /// phase a): d = α cos θ + β sin θ, q = −α sin θ + β cos θ
    /// (R. H. Park, Trans. AIEE 48 (1929) 716–727, with the axes and scale
    /// usual today).
    #[inline]
    pub fn park(self, angle: T) -> Dq<T> {
        let (sin, cos) = angle.sin_cos();
        self.park_sin_cos(sin, cos)
    }

    /// [`AlphaBeta::park`] with the angle's sine and cosine at hand, for
    /// several transforms at one angle.
    #[inline]
    pub fn park_sin_cos(self, sin: T, cos: T) -> Dq<T> {
        Dq {
            d: self.alpha * cos + self.beta * sin,
            q: self.beta * cos - self.alpha * sin,
        }
    }
}

impl<T: Scalar> Dq<T> {
    /// The zero vector.
    pub const ZERO: Self = Self {
        d: T::ZERO,
        q: T::ZERO,
    };

    /// Inverse Park transform for a d axis at the electrical `angle` (rad).
    #[inline]
    pub fn inverse_park(self, angle: T) -> AlphaBeta<T> {
        let (sin, cos) = angle.sin_cos();
        self.inverse_park_sin_cos(sin, cos)
    }

    /// [`Dq::inverse_park`] with the angle's sine and cosine at hand.
    #[inline]
    pub fn inverse_park_sin_cos(self, sin: T, cos: T) -> AlphaBeta<T> {
        AlphaBeta {
            alpha: self.d * cos - self.q * sin,
            beta: self.d * sin + self.q * cos,
        }
    }

    /// Scalar product; for a voltage (V) and a current (A), 3/2 of it is the
    /// electrical power (W) in this amplitude-invariant frame.
    #[inline]
    pub fn dot(self, other: Self) -> T {
        self.d * other.d + self.q * other.q
    }
}

impl<T: Scalar> Add for Dq<T> {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Dq<T> {
        Dq {
            d: self.d + o.d,
            q: self.q + o.q,
        }
    }
}

impl<T: Scalar> Sub for Dq<T> {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Dq<T> {
        Dq {
            d: self.d - o.d,
            q: self.q - o.q,
        }
    }
}

impl<T: Scalar> Mul<T> for Dq<T> {
    type Output = Self;
    #[inline]
    fn mul(self, k: T) -> Dq<T> {
        Dq {
            d: self.d * k,
            q: self.q * k,
        }
    }
}

impl<T: Scalar> Neg for Dq<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Dq<T> {
        Dq {
            d: -self.d,
            q: -self.q,
        }
    }
}
