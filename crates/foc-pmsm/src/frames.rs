//! The three frames of a three-phase quantity (voltage, current or flux) and
//! the transforms between them, amplitude-invariant: a balanced set of peak
//! value X is a vector of length X in each frame.

use crate::math::sin_cos;
use core::ops::{Add, Mul, Neg, Sub};

/// 1/√3.
pub(crate) const FRAC_1_SQRT_3: f64 = 0.577_350_269_189_625_8;
const SQRT_3_HALF: f64 = 0.866_025_403_784_438_6;

/// The three phase quantities, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Phases {
    /// Phase a.
    pub a: f64,
    /// Phase b, 120° behind a.
    pub b: f64,
    /// Phase c, 240° behind a.
    pub c: f64,
}

/// A space vector in the stator's frame, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AlphaBeta {
    /// Along the axis of phase a.
    pub alpha: f64,
    /// 90° (electrical) ahead of α.
    pub beta: f64,
}

/// A space vector in the rotor's frame, in V or A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dq {
    /// Direct axis, along the magnets' flux.
    pub d: f64,
    /// Quadrature axis, 90° (electrical) ahead of d.
    pub q: f64,
}

impl Phases {
    /// Clarke transform: α = (2a − b − c)/3, β = (b − c)/√3. What the three
    /// phases have in common ([`Phases::zero_sequence`]) is dropped.
    #[inline]
    pub fn clarke(self) -> AlphaBeta {
        AlphaBeta {
            alpha: (2.0 * self.a - self.b - self.c) / 3.0,
            beta: (self.b - self.c) * FRAC_1_SQRT_3,
        }
    }

    /// The mean of the three phases, which drives no current in a star
    /// winding whose neutral is not connected.
    #[inline]
    pub fn zero_sequence(self) -> f64 {
        (self.a + self.b + self.c) / 3.0
    }
}

impl AlphaBeta {
    /// Inverse Clarke transform, without zero sequence:
    /// a = α, b = −α/2 + √3/2 β, c = −α/2 − √3/2 β.
    #[inline]
    pub fn inverse_clarke(self) -> Phases {
        let half = -0.5 * self.alpha;
        let side = SQRT_3_HALF * self.beta;
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
    pub fn park(self, angle: f64) -> Dq {
        let (sin, cos) = sin_cos(angle);
        self.park_sin_cos(sin, cos)
    }

    /// [`AlphaBeta::park`] with the angle's sine and cosine at hand, for
    /// several transforms at one angle.
    #[inline]
    pub fn park_sin_cos(self, sin: f64, cos: f64) -> Dq {
        Dq {
            d: self.alpha * cos + self.beta * sin,
            q: self.beta * cos - self.alpha * sin,
        }
    }
}

impl Dq {
    /// The zero vector.
    pub const ZERO: Dq = Dq { d: 0.0, q: 0.0 };

    /// Inverse Park transform for a d axis at the electrical `angle` (rad).
    #[inline]
    pub fn inverse_park(self, angle: f64) -> AlphaBeta {
        let (sin, cos) = sin_cos(angle);
        self.inverse_park_sin_cos(sin, cos)
    }

    /// [`Dq::inverse_park`] with the angle's sine and cosine at hand.
    #[inline]
    pub fn inverse_park_sin_cos(self, sin: f64, cos: f64) -> AlphaBeta {
        AlphaBeta {
            alpha: self.d * cos - self.q * sin,
            beta: self.d * sin + self.q * cos,
        }
    }

    /// Scalar product; for a voltage (V) and a current (A), 3/2 of it is the
    /// electrical power (W) in this amplitude-invariant frame.
    #[inline]
    pub fn dot(self, other: Dq) -> f64 {
        self.d * other.d + self.q * other.q
    }
}

impl Add for Dq {
    type Output = Dq;
    #[inline]
    fn add(self, o: Dq) -> Dq {
        Dq {
            d: self.d + o.d,
            q: self.q + o.q,
        }
    }
}

impl Sub for Dq {
    type Output = Dq;
    #[inline]
    fn sub(self, o: Dq) -> Dq {
        Dq {
            d: self.d - o.d,
            q: self.q - o.q,
        }
    }
}

impl Mul<f64> for Dq {
    type Output = Dq;
    #[inline]
    fn mul(self, k: f64) -> Dq {
        Dq {
            d: self.d * k,
            q: self.q * k,
        }
    }
}

impl Neg for Dq {
    type Output = Dq;
    #[inline]
    fn neg(self) -> Dq {
        Dq {
            d: -self.d,
            q: -self.q,
        }
    }
}
