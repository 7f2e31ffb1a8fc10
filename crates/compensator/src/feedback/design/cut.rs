//! The loop cut at the plant's input: its frequency response and its eigenvalues.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::Design;
use super::linear::Linear;

/// Frequencies, evenly spread over the logarithm up to half the sampling rate.
const FREQUENCIES: usize = 300;
/// Lowest frequency, of half the sampling rate.
const LOWEST: f64 = 2e-5;

/// A plant under an observer and a state feedback.
pub(super) struct Loop<'a> {
    plant: &'a Linear,
    design: &'a Design,
    /// (I − L C)(A − B K): from an estimate to the next but for its measurement.
    kept: DMatrix<f64>,
}

impl<'a> Loop<'a> {
    pub fn new(plant: &'a Linear, design: &'a Design) -> Self {
        let m = &design.linear;
        let n = m.size();
        let without = DMatrix::identity(n, n) - &design.l * &m.c;
        let kept = without * (&m.a - &m.b * design.k.transpose());
        Self {
            plant,
            design,
            kept,
        }
    }

    /// Greatest eigenvalue of the closed loop, the disturbance of the plant left out.
    pub fn radius(&self, late: bool) -> f64 {
        let (p, n) = (self.plant.size() - 1, self.design.linear.size());
        let (a, b) = (self.plant.a.view((0, 0), (p, p)), self.plant.b.rows(0, p));
        let c = self.plant.c.columns(0, p);
        // States: plant, late command, estimate of the cycle before.
        let q = usize::from(late);
        let size = p + q + n;
        let lc = &self.design.l * c;
        let k = self.design.k.transpose();
        let mut m = DMatrix::zeros(size, size);
        // x̂ = M x̂₋ + L C x, u = −K x̂.
        let (from_plant, from_estimate) = (-&k * &lc, -&k * &self.kept);
        m.view_mut((0, 0), (p, p)).copy_from(&a);
        if late {
            m.view_mut((0, p), (p, 1)).copy_from(&b);
            m.view_mut((p, 0), (1, p)).copy_from(&from_plant);
            m.view_mut((p, p + q), (1, n)).copy_from(&from_estimate);
        } else {
            let closed = a + b * &from_plant;
            m.view_mut((0, 0), (p, p)).copy_from(&closed);
            m.view_mut((0, p), (p, n)).copy_from(&(b * &from_estimate));
        }
        m.view_mut((p + q, 0), (n, p)).copy_from(&lc);
        m.view_mut((p + q, p + q), (n, n)).copy_from(&self.kept);
        Schur::try_new(m, f64::EPSILON, 10_000).map_or(f64::INFINITY, |schur| {
            let eigenvalues = schur.complex_eigenvalues();
            eigenvalues
                .iter()
                .map(|z| libm::hypot(z.re, z.im))
                .fold(0.0, f64::max)
        })
    }

    /// Greatest |S|, and the delay margin in s.
    pub fn frequencies(&self, late: bool, period: f64) -> (f64, f64) {
        let (mut greatest, mut delay) = (0.0f64, f64::INFINITY);
        let mut before: Option<(f64, Complex<f64>)> = None;
        for i in 0..=FREQUENCIES {
            let share = libm::pow(LOWEST, 1.0 - i as f64 / FREQUENCIES as f64);
            let angle = std::f64::consts::PI * share;
            let Some(l) = self.loop_at(angle, late) else {
                return (f64::INFINITY, 0.0);
            };
            let one = l + Complex::new(1.0, 0.0);
            greatest = greatest.max(1.0 / libm::hypot(one.re, one.im));
            let size = |l: Complex<f64>| libm::hypot(l.re, l.im);
            if let Some((last, l0)) = before
                && (size(l0) - 1.0) * (size(l) - 1.0) <= 0.0
            {
                // Phase above −180°, by the angle at the crossing.
                let lead = libm::atan2(-l.im, -l.re);
                let lead = if lead < 0.0 {
                    lead + 2.0 * std::f64::consts::PI
                } else {
                    lead
                };
                delay = delay.min(lead / (0.5 * (last + angle)) * period);
            }
            before = Some((angle, l));
        }
        (greatest, delay)
    }

    /// L at z = e^{jφ}.
    fn loop_at(&self, angle: f64, late: bool) -> Option<Complex<f64>> {
        let (sine, cosine) = libm::sincos(angle);
        let z = Complex::new(cosine, sine);
        let complex = |m: &DMatrix<f64>| m.map(|v| Complex::new(v, 0.0));
        let p = self.plant.size() - 1;
        let (a, b) = (
            self.plant.a.view((0, 0), (p, p)).into_owned(),
            self.plant.b.rows(0, p).map(|v| Complex::new(v, 0.0)),
        );
        let x = (DMatrix::identity(p, p) * z - complex(&a)).lu().solve(&b)?;
        let lc = &self.design.l * self.plant.c.columns(0, p);
        let y: DVector<Complex<f64>> = complex(&lc) * x;
        let n = self.kept.nrows();
        let x = (DMatrix::identity(n, n) * z - complex(&self.kept))
            .lu()
            .solve(&(y * z))?;
        let u: Complex<f64> = self
            .design
            .k
            .iter()
            .zip(x.iter())
            .map(|(k, x)| x * *k)
            .sum();
        Some(if late { u / z } else { u })
    }
}
