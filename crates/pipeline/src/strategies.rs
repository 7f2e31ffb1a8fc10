//! The predictors of one axis, and the strategies made of them.

use axis_sim::Axis;
use cfnn::{Network, Predictor};
use compensator::{
    Combined, Compensator, FrictionFeedforward, MotionEstimator, NetworkCompensation,
    NoCompensation, ObserverGains, TransferFunction, TransferFunctionModel,
};
use lugre::LuGre;
use serde::{Deserialize, Serialize};

use crate::PipelineError;

/// A compensation strategy of the paper's Tables 15 and 16, and two more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// The servo alone.
    None,
    /// The network's predicted error.
    Network,
    /// The network and LuGre feed-forward with the identified parameters.
    NetworkLugre,
    /// The transfer function's predicted error.
    TransferFunction,
    /// The transfer function and LuGre feed-forward with the identified parameters.
    TransferFunctionLugre,
    /// LuGre feed-forward alone, identified parameters.
    Lugre,
    /// The network and LuGre feed-forward with the axis file's own parameters.
    NetworkLugrePrinted,
}

impl Strategy {
    /// All but [`Strategy::None`].
    pub const COMPENSATED: [Self; 6] = [
        Self::Network,
        Self::NetworkLugre,
        Self::TransferFunction,
        Self::TransferFunctionLugre,
        Self::Lugre,
        Self::NetworkLugrePrinted,
    ];

    /// What tables and messages call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Network => "network",
            Self::NetworkLugre => "network + LuGre",
            Self::TransferFunction => "transfer function",
            Self::TransferFunctionLugre => "transfer function + LuGre",
            Self::Lugre => "LuGre",
            Self::NetworkLugrePrinted => "network + LuGre as in the axis file",
        }
    }
}

/// What the strategies are made of.
#[derive(Clone, Debug)]
pub struct Predictors {
    /// One-cycle network.
    pub network: Network,
    /// Linear models of the tracking error.
    pub transfer: TransferModels,
    /// Friction as identified on the machine.
    pub identified: LuGre,
    /// Friction as the axis file gives it.
    pub printed: LuGre,
    /// Travel per radian, m/rad.
    pub travel_per_radian: f64,
    /// How friction comes into the actuator's command.
    pub feedforward: Feedforward,
    /// Control period, s.
    pub period: f64,
}

/// Linear models of the tracking error, without and with friction feed-forward.
#[derive(Clone, Debug)]
pub struct TransferModels {
    /// Of the servo alone.
    pub alone: TransferFunctionModel,
    /// Of the servo with LuGre feed-forward.
    pub with_feedforward: TransferFunctionModel,
    /// Time constant 1/Kv = 1/(P r) of the closed position loop, s, through which a
    /// correction reaches the load; compensation leads by it.
    pub lead_time: f64,
}

/// From a friction law in its own coordinate to the actuator's command.
#[derive(Clone, Copy, Debug)]
pub struct Feedforward {
    /// Load travel per unit of the law's coordinate.
    lever: f64,
    /// Friction of the law per unit of the command.
    per_effort: f64,
}

impl Feedforward {
    /// On an axis.
    pub fn of(axis: &Axis) -> Self {
        let r = axis.travel_per_radian();
        let lever = axis.friction.lever(r);
        Self {
            lever,
            per_effort: axis.torque_constant() * (lever / r),
        }
    }

    /// Feed-forward of a law, with a control period (s).
    ///
    /// # Errors
    /// [`PipelineError::Compensator`] for values outside their ranges.
    pub fn of_law(&self, law: LuGre, period: f64) -> Result<FrictionFeedforward, PipelineError> {
        let Self { lever, per_effort } = *self;
        Ok(FrictionFeedforward::new(law, lever, per_effort, period)?)
    }
}

type NetworkStrategy = NetworkCompensation<Predictor<4, 1>>;

/// Both error predictors at once.
pub(crate) struct BothPredictors {
    pub(crate) network: NetworkStrategy,
    pub(crate) transfer_function: TransferFunction,
}

impl Predictors {
    /// The predictors for controlling `axis`; the transfer functions without
    /// and with friction feed-forward.
    pub fn new(
        axis: &Axis,
        network: Network,
        [alone, with_feedforward]: [TransferFunctionModel; 2],
        identified: LuGre,
    ) -> Self {
        Self {
            network,
            transfer: TransferModels {
                alone,
                with_feedforward,
                lead_time: axis
                    .control
                    .velocity_gain(axis.travel_per_radian())
                    .map_or(0.0, |kv| 1.0 / kv),
            },
            identified,
            printed: axis.friction.law,
            travel_per_radian: axis.travel_per_radian(),
            feedforward: Feedforward::of(axis),
            period: axis.period,
        }
    }

    /// A compensator for one run.
    ///
    /// # Errors
    /// [`PipelineError`] where a part does not fit.
    pub fn compensator(&self, strategy: Strategy) -> Result<Box<dyn Compensator>, PipelineError> {
        Ok(match strategy {
            Strategy::None => Box::new(NoCompensation),
            Strategy::Network => Box::new(self.network()?),
            Strategy::NetworkLugre => Box::new(Combined::new(
                self.network()?,
                self.friction(self.identified)?,
            )),
            Strategy::TransferFunction => Box::new(self.leading(self.transfer.alone)?),
            Strategy::TransferFunctionLugre => Box::new(Combined::new(
                self.leading(self.transfer.with_feedforward)?,
                self.friction(self.identified)?,
            )),
            Strategy::Lugre => Box::new(self.friction(self.identified)?),
            Strategy::NetworkLugrePrinted => {
                Box::new(Combined::new(self.network()?, self.friction(self.printed)?))
            }
        })
    }

    pub(crate) fn both(&self) -> Result<BothPredictors, PipelineError> {
        Ok(BothPredictors {
            network: self.network()?,
            transfer_function: TransferFunction::new(self.transfer.alone),
        })
    }

    fn network(&self) -> Result<NetworkStrategy, PipelineError> {
        let gains = ObserverGains::default();
        let estimator = MotionEstimator::new(self.travel_per_radian, self.period, gains)?;
        Ok(NetworkCompensation::from_network(
            self.network.clone(),
            estimator,
        )?)
    }

    fn leading(&self, model: TransferFunctionModel) -> Result<TransferFunction, PipelineError> {
        Ok(TransferFunction::with_lead(model, self.transfer.lead_time)?)
    }

    fn friction(&self, law: LuGre) -> Result<FrictionFeedforward, PipelineError> {
        self.feedforward.of_law(law, self.period)
    }
}
