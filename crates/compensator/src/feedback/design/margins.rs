//! Margins of a designed feedback, on the believed axis or on another one.
//!
//! The loop is cut at the plant's input, the command: one signal, whatever is measured. With
//! L(z) = −(command that comes back)/(command that goes in), S = 1/(1 + L).

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::linear::{Linear, Situation};
use super::{Design, DesignError, FeedbackDesign, FeedbackSettings, STICKING};
use crate::model::Mode;

/// Frequencies, evenly spread over the logarithm up to half the sampling rate.
const FREQUENCIES: usize = 300;
/// Lowest frequency, of half the sampling rate.
const LOWEST: f64 = 2e-5;

/// An axis that is not the believed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation<'a> {
    /// Its modes: those of another position. As many as it has; none: those of the design.
    pub modes: &'a [Mode],
    /// Its load's inertia as a share of the believed one; the modes are those without it.
    pub mass: f64,
    /// Its bristles' stiffness and damping and its viscous friction, as shares.
    pub friction: f64,
    /// Its χ as a share of the one that the feedback goes by, at most 1 in all.
    pub sticking: f64,
    /// Share of the least damping of slow sliding, which is negative; 1 where the load slides
    /// at about half the Stribeck speed and more, 0 where it slides fast.
    pub stribeck: f64,
}

impl Default for Variation<'_> {
    fn default() -> Self {
        Self {
            modes: &[],
            mass: 1.0,
            friction: 1.0,
            sticking: 1.0,
            stribeck: 0.0,
        }
    }
}

/// How far a loop is from instability; the worst over χ of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Greatest sensitivity at the plant's input; infinite where the loop is not stable.
    pub sensitivity: f64,
    /// χ where that is.
    pub sticking: f64,
    /// The same with one more cycle of delay.
    pub sensitivity_late: f64,
    /// χ where that is.
    pub sticking_late: f64,
    /// Delay that the loop takes before it is unstable, s.
    pub delay: f64,
    /// Greatest eigenvalue of the closed loop, 1/cycle; below 1.
    pub radius: f64,
}

impl FeedbackDesign {
    /// Margins on the axis that `on` says.
    ///
    /// # Errors
    /// [`DesignError`] where that has more states than there is room for.
    pub fn margins(&self, on: &Variation<'_>) -> Result<Margins, DesignError> {
        let mut all = Margins {
            sensitivity: 0.0,
            sticking: 0.0,
            sensitivity_late: 0.0,
            sticking_late: 0.0,
            delay: f64::INFINITY,
            radius: 0.0,
        };
        for (design, sticking) in self.designs.iter().zip(STICKING) {
            let plant = self.plant(on, sticking)?;
            let at = Loop::new(&plant, design);
            for late in [false, true] {
                let radius = at.radius(late);
                let (mut sensitivity, delay) = at.frequencies(late, self.model.period);
                if radius.is_nan() || radius >= 1.0 {
                    sensitivity = f64::INFINITY;
                }
                let (worst, place) = if late {
                    (&mut all.sensitivity_late, &mut all.sticking_late)
                } else {
                    all.radius = all.radius.max(radius);
                    all.delay = all.delay.min(delay);
                    (&mut all.sensitivity, &mut all.sticking)
                };
                if sensitivity > *worst {
                    (*worst, *place) = (sensitivity, sticking);
                }
            }
        }
        Ok(all)
    }

    fn plant(&self, on: &Variation<'_>, sticking: f64) -> Result<Linear, DesignError> {
        let modes = match on.modes {
            [] => &self.modes,
            modes => &self.settings.used(modes)?,
        };
        let situation = Situation {
            sticking: (sticking * on.sticking).clamp(0.0, 1.0),
            mass: on.mass,
            friction: on.friction,
            bristles: 1.0,
            sliding: on.stribeck * self.stribeck,
        };
        Linear::new(&self.model, modes, &self.settings, &situation)
    }

    /// Refuses a design whose margins are not those that its settings ask for, with the load
    /// where it was designed for and `elsewhere`.
    pub(super) fn require_margins(&self, elsewhere: &[&[Mode]]) -> Result<(), DesignError> {
        let s = &self.settings;
        if s.sensitivity.is_infinite() && s.sensitivity_late.is_infinite() {
            return Ok(());
        }
        let here: &[Mode] = &self.modes;
        // Everything in one place first: most of what fails does so there.
        for modes in core::iter::once(&here).chain(elsewhere) {
            for stribeck in [0.0, 1.0] {
                for mass in [1.0, s.mass[0], s.mass[1]] {
                    for friction in [1.0, s.friction[0], s.friction[1]] {
                        let on = Variation {
                            modes,
                            mass,
                            friction,
                            stribeck,
                            ..Variation::default()
                        };
                        self.margins(&on)?.within(s, &on)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Margins {
    fn within(&self, s: &FeedbackSettings, on: &Variation<'_>) -> Result<(), DesignError> {
        // Slow sliding is unstable by itself: a loop around it cannot have the same margins.
        let slow = |most: f64| {
            if on.stribeck > 0.0 {
                most.max(s.sensitivity_slow)
            } else {
                most
            }
        };
        let late = "the sensitivity with one more cycle of delay";
        let asked = [
            (
                "the sensitivity",
                self.sensitivity,
                slow(s.sensitivity),
                self.sticking,
            ),
            (
                late,
                self.sensitivity_late,
                slow(s.sensitivity_late),
                self.sticking_late,
            ),
        ];
        for (what, value, most, sticking) in asked {
            if value > most {
                return Err(DesignError::Margin {
                    what,
                    value,
                    most,
                    mass: on.mass,
                    friction: on.friction,
                    sticking,
                    stribeck: on.stribeck,
                    frequency: on.modes.get(1).map_or(0.0, |mode| mode.frequency),
                });
            }
        }
        Ok(())
    }
}

/// A plant under an observer and a state feedback.
struct Loop<'a> {
    plant: &'a Linear,
    design: &'a Design,
    /// (I − L C)(A − B K): from an estimate to the next but for its measurement.
    kept: DMatrix<f64>,
}

impl<'a> Loop<'a> {
    fn new(plant: &'a Linear, design: &'a Design) -> Self {
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
    fn radius(&self, late: bool) -> f64 {
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
    fn frequencies(&self, late: bool, period: f64) -> (f64, f64) {
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
