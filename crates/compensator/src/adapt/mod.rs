//! Adaptation between moves: what the log of a move says of the parameters of a
//! [`DriveModel`], and the model for the next move.
//!
//! A log is judged along the motion that was measured, not through the closed loop: what
//! controllers and compensators did does not matter, and nothing need be known of them.
//! With a zero-phase Gaussian (σ = 4 ms) over all signals, torque and motion must balance,
//!
//! ```text
//! T = (J − J_w) θ̈ + J_w a/r + r (m a + T_f(v)/lever + load(x))
//! θ − x/r = const + C (T − (J − J_w) θ̈)
//! ```
//!
//! θ being the motor's angle, x, v, a the load's position and its rates, T_f LuGre stepped
//! along v. Gauss–Newton finds the relative errors of friction, inertia and compliance for
//! which they do, weighing log, prior and what earlier moves said. Residuals count as many
//! values as their correlation leaves independent, so that structure which the model does
//! not have makes estimates uncertain, not wrong and sure.

mod assumed;
mod balance;
mod check;
mod coordinates;
mod error;
mod fit;
mod information;
mod kernel;
mod known;
mod parameter;
mod record;
mod report;
mod residual;
mod smooth;
mod torque;
mod unexplained;
mod weight;

use std::vec::Vec;

use libm::{exp, expm1};

use crate::error::{require, within};
use crate::{DriveModel, Residual, Sample};
use assumed::AssumedModel;
pub use error::AdaptError;
use known::{Information, Known};
pub use parameter::{AdaptParameter, AdaptPrior, PriorSpread};
use parameter::{COUNT, Theta};
use record::Record;
pub use report::{Estimated, Learned};
pub use unexplained::UnexplainedTorque;

/// If a fit leaves more than this share of the torque unexplained, the log is of another machine.
const MOST_LEFT: f64 = 0.3;
/// A fit is refused if its residual is greater than this times the one before, plus [`FINEST`] of the torque: earlier
/// moves and the prior pull as well.
const WORSE: f64 = 1.1;
/// Share of the torque within which residuals are alike.
const FINEST: f64 = 1e-3;
/// Share of the wind-up under the Coulomb level that half a free travel is uncertain by
/// whatever a log says.
const NOT_LINEAR: f64 = 0.02;
/// Standard errors of a free travel that a plan takes up.
const CLEAR: f64 = 3.0;

/// The parameters of a model, adapted from move to move.
#[derive(Clone, Debug)]
pub struct Adaptation {
    assumed: AssumedModel,
    states: Vec<State>,
}

/// What is known after a move.
#[derive(Clone, Debug)]
struct State {
    estimate: Theta,
    information: Information,
    variances: Theta,
    /// Half the free travel and its variance, rad at the motor; infinite before any estimate.
    gap: [f64; 2],
}

impl Adaptation {
    /// Of a model that may be off by what `prior` says.
    ///
    /// # Errors
    /// [`AdaptError::Setting`] for a model that no plan can be made from, a prior out of
    /// its range or a control period above 2 ms; [`AdaptError::Nothing`] if nothing is
    /// free.
    pub fn new(model: &DriveModel, prior: &AdaptPrior) -> Result<Self, AdaptError> {
        model.check()?;
        prior.check()?;
        let inside = within(model.period, 1e-6, 2e-3);
        require(
            inside,
            "period",
            model.period,
            "from 1e-6 to 2e-3 s to adapt",
        )?;
        let assumed = AssumedModel {
            model: *model,
            prior: *prior,
        };
        let state = State {
            estimate: [0.0; COUNT],
            information: Information::zeros(),
            variances: prior.spreads.map(|s| s.deviation * s.deviation),
            gap: [assumed.half_gap(), f64::INFINITY],
        };
        if !AdaptParameter::ALL.iter().any(|&p| assumed.adapts(p)) {
            return Err(AdaptError::Nothing);
        }
        Ok(Self {
            assumed,
            states: Vec::from([state]),
        })
    }

    /// Learns from the log of a move, one sample a control cycle; the move may begin with
    /// loaded bristles, and be a program of several moves. After an error everything is as
    /// it was.
    ///
    /// # Errors
    /// [`AdaptError`] says what the log lacks.
    pub fn learn(&mut self, log: &[Sample]) -> Result<Learned, AdaptError> {
        self.learn_from(log, &[])
    }

    /// The same where `residual` acts beside the model: what it takes of the torque says
    /// nothing of the parameters.
    ///
    /// # Errors
    /// As [`Adaptation::learn`].
    pub fn learn_beside(
        &mut self,
        log: &[Sample],
        residual: &mut impl Residual,
    ) -> Result<Learned, AdaptError> {
        let besides = self.besides(log, residual)?;
        self.learn_from(log, &besides)
    }

    fn learn_from(&mut self, log: &[Sample], besides: &[[f64; 2]]) -> Result<Learned, AdaptError> {
        let state = self.state();
        let record = Record::new(&self.assumed, log, self.assumed.smoothing(), besides)?;
        let known = Known {
            assumed: &self.assumed,
            estimate: state.estimate,
            information: state.information * self.assumed.prior.retention,
            gap: [state.gap[0], state.gap[1] / self.assumed.prior.retention],
        };
        let fit = known.fit(&record);
        let (torque, [before, after]) = (record.torque, fit.weighed);
        // Written so that NaN is refused too.
        let explained = fit.left <= MOST_LEFT * torque;
        if !explained {
            return Err(AdaptError::Unexplained {
                residual: fit.left,
                torque,
            });
        }
        let agrees = after <= WORSE * before + FINEST * torque;
        if !agrees {
            return Err(AdaptError::NoBetter { before, after });
        }
        self.states.push(State {
            estimate: fit.estimate,
            information: fit.information,
            variances: fit.variances,
            gap: match fit.gap {
                Some([gap, error]) => {
                    // A transmission is not as linear as its model.
                    let blunt = NOT_LINEAR * self.assumed.wound();
                    [0.5 * gap, 0.25 * error * error + blunt * blunt]
                }
                None => state.gap,
            },
        });
        Ok(Learned {
            moves: self.moves(),
            parameters: self.estimates(),
            torque_before: before,
            torque_after: after,
            torque,
            free_travel: fit
                .gap
                .map(|gap| gap.map(|by| by * self.assumed.model.travel)),
        })
    }

    /// The model with the present estimates.
    pub fn model(&self) -> DriveModel {
        let mut model = self.assumed.at(&self.state().estimate);
        let [half, variance] = self.state().gap;
        // Less than three standard errors is none; and none is negative.
        if half > CLEAR * variance.sqrt() {
            model.kinematics.free_travel = 2.0 * half * model.travel;
        } else if variance.is_finite() {
            model.kinematics.free_travel = 0.0;
        }
        model
    }

    /// Moves learned and not taken back.
    pub fn moves(&self) -> usize {
        self.states.len() - 1
    }

    /// Takes the last move back; false if there is none.
    pub fn step_back(&mut self) -> bool {
        let some = self.moves() > 0;
        if some {
            self.states.pop();
        }
        some
    }

    /// Takes all moves back: the model is the first one again.
    pub fn forget(&mut self) {
        self.states.truncate(1);
    }

    /// The parameters that are adapted on this axis, as they are known now.
    pub fn estimates(&self) -> Vec<Estimated> {
        let state = self.state();
        let adapted = AdaptParameter::ALL.into_iter();
        let adapted = adapted.filter(|&parameter| self.assumed.adapts(parameter));
        let estimated = adapted.map(|parameter| {
            let i = parameter.index();
            let (theta, deviation) = (state.estimate[i], state.variances[i].sqrt());
            let assumed_model = self.assumed.value(parameter);
            let (relative, standard_error, value) = match parameter.is_ratio() {
                true => (
                    expm1(theta),
                    exp(theta) * deviation,
                    assumed_model * exp(theta),
                ),
                false => (theta, deviation, assumed_model * theta),
            };
            let [least, most] = self.assumed.bounds(parameter);
            Estimated {
                parameter,
                relative,
                standard_error,
                value,
                value_error: assumed_model * standard_error,
                at_bound: theta <= least || theta >= most,
            }
        });
        estimated.collect()
    }

    fn state(&self) -> &State {
        // There is always the assumed model at the bottom.
        &self.states[self.states.len() - 1]
    }
}
