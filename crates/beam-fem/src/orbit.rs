//! The path of a node's centre in its lateral plane.

use nalgebra::Complex;

/// An elliptical orbit v + i w = f e^{iωt} + b e^{−iωt}, y the real axis and z the
/// imaginary one; ω > 0, spin about +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// f: the circle that turns from y to z, with a positive spin, m.
    pub forward: Complex<f64>,
    /// b: the circle that turns against it, m.
    pub backward: Complex<f64>,
}

impl Orbit {
    /// From the complex amplitudes of v and w (v(t) = Re(v e^{iωt})):
    /// f = (v + iw)/2, b = conj(v − iw)/2.
    pub fn new(v: Complex<f64>, w: Complex<f64>) -> Self {
        let i = Complex::new(0.0, 1.0);
        Self {
            forward: (v + i * w) * 0.5,
            backward: (v - i * w).conj() * 0.5,
        }
    }

    /// Half of the ellipse's long axis, m: the largest excursion.
    pub fn major(&self) -> f64 {
        self.forward.norm() + self.backward.norm()
    }

    /// Half of its short axis, m: above zero for motion with the spin, below against it.
    pub fn minor(&self) -> f64 {
        self.forward.norm() - self.backward.norm()
    }

    /// Angle of the long axis from y towards z, rad, in (−π/2, π/2].
    pub fn inclination(&self) -> f64 {
        let angle = 0.5 * (self.forward.arg() + self.backward.arg());
        let half = std::f64::consts::FRAC_PI_2;
        if angle > half {
            angle - 2.0 * half
        } else if angle <= -half {
            angle + 2.0 * half
        } else {
            angle
        }
    }
}
