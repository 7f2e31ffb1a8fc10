//! What the strategies are made of.

use std::sync::{Arc, OnceLock};

use axis_sim::Axis;
use cfnn::{Network, Predictor};
use compensator::{
    DriveModel, FeedbackDesign, FrictionFeedforward, MotionEstimator, NetworkCompensation,
    ObserverGains, TransferFunction, TransferFunctionModel,
};
use lugre::LuGre;

use super::{Feedforward, Need};
use crate::{NoFeedback, PipelineError};

/// What the strategies are made of: the axis as its file has it, and what was found from it.
#[derive(Clone, Debug)]
pub struct Predictors {
    /// The axis that is controlled, as its model knows it.
    pub axis: Axis,
    /// One-cycle network.
    pub network: Option<Network>,
    /// Linear models of the tracking error.
    pub transfer: Option<TransferModels>,
    /// Friction as identified on the machine.
    pub identified: Option<LuGre>,
    /// What plans assume of the axis, where that is not what its file says.
    pub assumed_model: Option<DriveModel>,
    /// The feedback for the model, designed when it is first asked for.
    pub design: DesignOnce,
}

/// A feedback that is designed once, or found impossible once.
#[derive(Clone, Debug, Default)]
pub struct DesignOnce(Arc<OnceLock<Result<FeedbackDesign, NoFeedback>>>);

impl DesignOnce {
    /// The design, by `make` the first time.
    ///
    /// # Errors
    /// [`NoFeedback`] as it came the first time.
    pub fn get(
        &self,
        make: impl FnOnce() -> Result<FeedbackDesign, NoFeedback>,
    ) -> Result<FeedbackDesign, NoFeedback> {
        self.0.get_or_init(make).clone()
    }
}

/// Linear models of the tracking error, without and with friction feed-forward.
#[derive(Clone, Debug)]
pub struct TransferModels {
    /// Of the servo alone.
    pub alone: TransferFunctionModel,
    /// Of the servo with LuGre feed-forward.
    pub with_feedforward: TransferFunctionModel,
}

/// Compensation by the network.
pub type NetworkStrategy = NetworkCompensation<Predictor<4, 1>>;

/// Both error predictors at once.
pub(crate) struct BothPredictors {
    pub(crate) network: NetworkStrategy,
    pub(crate) transfer_function: TransferFunction,
}

impl Predictors {
    /// What the axis file alone tells: no network, transfer functions or identified friction.
    pub fn of(axis: &Axis) -> Self {
        Self {
            axis: axis.clone(),
            network: None,
            transfer: None,
            identified: None,
            assumed_model: None,
            design: DesignOnce::default(),
        }
    }

    /// All predictors for controlling `axis`; the transfer functions without
    /// and with friction feed-forward.
    pub fn new(
        axis: &Axis,
        network: Network,
        [alone, with_feedforward]: [TransferFunctionModel; 2],
        identified: LuGre,
    ) -> Self {
        Self {
            axis: axis.clone(),
            network: Some(network),
            transfer: Some(TransferModels {
                alone,
                with_feedforward,
            }),
            identified: Some(identified),
            assumed_model: None,
            design: DesignOnce::default(),
        }
    }

    /// Whether they have what a strategy may need.
    pub fn have(&self, need: Need) -> bool {
        match need {
            Need::Network => self.network.is_some(),
            Need::TransferFunctions => self.transfer.is_some(),
            Need::IdentifiedFriction => self.identified.is_some(),
        }
    }

    /// Refuses to go on without what `by` needs.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] names the first that is not there.
    pub fn require(&self, needs: &[Need], by: &str) -> Result<(), PipelineError> {
        match needs.iter().find(|need| !self.have(**need)) {
            None => Ok(()),
            Some(need) => Err(PipelineError::Missing {
                need: *need,
                by: by.to_owned(),
            }),
        }
    }

    /// What plans assume of the axis: if nothing else is given its file, with the friction
    /// identified on the machine where that is known.
    ///
    /// # Errors
    /// [`PipelineError::Compensator`] if no plan can be made from it.
    pub fn assumed_model(&self) -> Result<DriveModel, PipelineError> {
        if let Some(model) = self.assumed_model {
            return Ok(model);
        }
        let mut model = self.axis.drive_model()?;
        if let Some(law) = self.identified {
            model.friction = law;
        }
        Ok(model)
    }

    /// Compensation by the network.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] without one, [`PipelineError::Compensator`] for one of
    /// another shape.
    pub fn network(&self) -> Result<NetworkStrategy, PipelineError> {
        let network = self.network.clone();
        let network = network.ok_or_else(|| missing(Need::Network))?;
        let gains = ObserverGains::default();
        let (travel, period) = (self.axis.travel_per_radian(), self.axis.period);
        let estimator = MotionEstimator::new(travel, period, gains)?;
        Ok(NetworkCompensation::from_network(network, estimator)?)
    }

    /// The transfer functions.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] without them.
    pub fn transfer(&self) -> Result<&TransferModels, PipelineError> {
        let transfer = self.transfer.as_ref();
        transfer.ok_or_else(|| missing(Need::TransferFunctions))
    }

    /// The friction identified on the machine.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] without it.
    pub fn identified(&self) -> Result<LuGre, PipelineError> {
        self.identified
            .ok_or_else(|| missing(Need::IdentifiedFriction))
    }

    /// Compensation by a transfer function, ahead by the time constant 1/Kv of the closed
    /// position loop, through which a correction reaches the load.
    ///
    /// # Errors
    /// [`PipelineError::Compensator`] for a time constant outside its range.
    pub fn leading(&self, model: TransferFunctionModel) -> Result<TransferFunction, PipelineError> {
        let axis = &self.axis;
        let gain = axis.control.velocity_gain(axis.travel_per_radian());
        let lead_time = gain.map_or(0.0, |kv| 1.0 / kv);
        Ok(TransferFunction::with_lead(model, lead_time)?)
    }

    /// Feed-forward of a friction law in the coordinate of the axis' own.
    ///
    /// # Errors
    /// [`PipelineError::Compensator`] for values outside their ranges.
    pub fn friction(&self, law: LuGre) -> Result<FrictionFeedforward, PipelineError> {
        Feedforward::of(&self.axis).of_law(law, self.axis.period)
    }

    pub(crate) fn both(&self) -> Result<BothPredictors, PipelineError> {
        Ok(BothPredictors {
            network: self.network()?,
            transfer_function: TransferFunction::new(self.transfer()?.alone),
        })
    }
}

fn missing(need: Need) -> PipelineError {
    let by = "a strategy that does not say so".to_owned();
    PipelineError::Missing { need, by }
}
