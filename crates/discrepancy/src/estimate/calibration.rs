//! Known parameters brought to where they explain the most.

use nalgebra::DVector;

use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::gauss_newton::Descent;
use crate::spectrum::Amplitudes;

/// Change of a known parameter, as a share of it, over which its derivatives are the same to
/// far better than a hundredth.
const SAME: f64 = 1e-3;

/// Times that they are made anew at most.
const CALIBRATIONS: usize = 4;

/// Fall of D, or of a sum of squares, that is not worth another round of derivatives.
const SETTLED: f64 = 2.0;

/// Share of a sum of squares by which another round of derivatives must bring it down: that is where a
/// descent of D begins, which goes on from there by itself.
const LITTLE: f64 = 1e-4;

/// The largest of the changes from one state to another.
fn farthest(from: &[f64], to: &[f64]) -> f64 {
    let changes = from.iter().zip(to).map(|(a, b)| (a - b).abs());
    changes.fold(0.0, f64::max)
}

impl Fitter<'_> {
    /// The known parameters fitted, and their derivatives where that ends. `known` are those
    /// where it begins, and are made anew where it has left their range: where tolerances are
    /// wide, D is lowest along a narrow curve (all that scales a torque together), along which
    /// old derivatives lead in ever smaller steps.
    pub fn calibrated(&self, mut fit: Fit, mut known: Columns) -> (Fit, Columns) {
        for _ in 0..CALIBRATIONS {
            let (before, from) = (fit.deviance, fit.state.shares.clone());
            fit = self.refine(fit, &known, 4);
            let moved = farthest(&from, &fit.state.shares);
            tracing::debug!(before, after = fit.deviance, moved, "calibrated");
            if moved > SAME {
                known = self.known_columns(&fit);
            }
            if moved <= SAME || before - fit.deviance < SETTLED {
                break;
            }
        }
        (fit, known)
    }

    /// The sum of squares of a fit's residual, weighed by the spectral matrices of this `noise`, with
    /// the departures of known parameters.
    pub fn squares(&self, noise: &Amplitudes) -> impl Fn(&Fit) -> f64 {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(noise));
        move |fit: &Fit| {
            layout.whiten(&whitener, &fit.rest).norm_squared() + self.departure(&fit.state)
        }
    }

    /// Fitted by least squares, the residual weighed by the spectral matrices of this `noise`,
    /// which do not change: D is flat where a residual is large, as the residual is then its own
    /// weight,
    /// and has minima of its own there; a sum of squares has not. `known` are the derivatives
    /// with respect to the known parameters where it begins; they are made anew `anew` times at
    /// most.
    pub fn by_least_squares(
        &self,
        mut fit: Fit,
        mut known: Columns,
        noise: &Amplitudes,
        anew: usize,
    ) -> Fit {
        let squares = self.squares(noise);
        let descent = Descent {
            rounds: 4,
            lengths: 4,
            shorter: 0.35,
        };
        for round in 0..=anew {
            let (before, from) = (squares(&fit), fit.state.shares.clone());
            let step = |fit: &Fit| {
                let effects = self.effect_slopes(fit, 0);
                let columns = known.iter().cloned().chain(effects).collect();
                Some(self.solve_beside(noise, fit, &columns, None).step)
            };
            let better = |fit: &Fit, step: &DVector<f64>, length: f64| {
                let trial = self.at(self.moved(&fit.state, step, length)).ok()?;
                (squares(&trial) < squares(fit)).then_some(trial)
            };
            fit = descent.from(fit, step, better, |before, after| {
                squares(before) - squares(after) >= SETTLED
            });
            let after = squares(&fit);
            let moved = farthest(&from, &fit.state.shares);
            tracing::debug!(
                before,
                after,
                moved,
                deviance = fit.deviance,
                "least squares"
            );
            let little = SETTLED.max(LITTLE * after);
            if round == anew || moved <= SAME || before - after < little {
                break;
            }
            known = self.known_columns(&fit);
        }
        fit
    }
}
