//! What is exported: the parts of a compensator in one precision.

use axis_pipeline::strategies::NetworkStrategy;
use axis_scalar::Scalar;
use cfnn::{NetworkScalar, ScalingRange};
use compensator::{
    CompensatorError, DriveModel, Feedback, FrictionFeedforward, MotionEstimator, PlanSettings,
    Planner, TransferFunction,
};
use lugre::Exponential;

use crate::ExportError;

/// A compensator that a controller runs cycle by cycle: the sum of a predicted position error
/// and of what friction asks for, or a plan.
#[derive(Clone, Debug)]
pub struct ExportedLaw<T = f64> {
    /// What is added to the position.
    pub position: Position<T>,
    /// What is added to the command.
    pub friction: Option<FrictionFeedforward<T>>,
    /// A plan of the motion ahead, which stands alone.
    pub plan: Option<PlanLaw<T>>,
}

/// A plan of the motion ahead, and where there is one the feedback around it.
#[derive(Clone, Debug)]
pub struct PlanLaw<T = f64> {
    /// The planner, relaxed.
    pub planner: Box<Planner<T>>,
    /// The feedback, at the start of a motion.
    pub feedback: Option<Box<Feedback<T>>>,
}

impl<T: Exponential> PlanLaw<T> {
    /// For a model, with the settings by default.
    ///
    /// # Errors
    /// [`ExportError::Compensator`] names what no plan can be made from.
    pub fn new(model: &DriveModel<T>, feedback: Option<Feedback<T>>) -> Result<Self, ExportError> {
        let planner = Planner::new(model, &PlanSettings::default())?;
        Ok(Self {
            planner: Box::new(planner),
            feedback: feedback.map(Box::new),
        })
    }

    fn cast<U: Exponential>(&self) -> Result<PlanLaw<U>, ExportError> {
        let feedback = self.feedback.as_ref().map(|feedback| feedback.cast());
        PlanLaw::new(&self.planner.model().cast()?, feedback)
    }
}

/// The error of the position that is predicted for the end of a cycle.
#[derive(Clone, Debug)]
pub enum Position<T = f64> {
    /// None.
    Nothing,
    /// By the one-cycle network.
    Network(NetworkLaw<T>),
    /// By a linear model of the error.
    Transfer(Box<TransferFunction<T>>),
}

/// A one-cycle network and the estimator of its inputs.
#[derive(Clone, Debug)]
pub struct NetworkLaw<T = f64> {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Weights in the order that [`cfnn::FixedNetwork`] reads.
    pub packed: Vec<T>,
    /// Ranges of position (m), speed (m/s), acceleration (m/s²) and command (A).
    pub input: [ScalingRange<T>; 4],
    /// Range of the increment of the position, m.
    pub output: ScalingRange<T>,
    /// The estimator.
    pub estimator: MotionEstimator<T>,
}

impl<T: NetworkScalar + Exponential> ExportedLaw<T> {
    /// The same, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// [`ExportError`] if one leaves its range by that: a pole that becomes 1, say.
    pub fn cast<U: NetworkScalar + Exponential>(&self) -> Result<ExportedLaw<U>, ExportError> {
        let position = match &self.position {
            Position::Nothing => Position::Nothing,
            Position::Network(network) => Position::Network(network.cast()?),
            Position::Transfer(filter) => Position::Transfer(Box::new(filter.cast()?)),
        };
        let friction = self.friction.as_ref().map(FrictionFeedforward::cast);
        Ok(ExportedLaw {
            position,
            friction: friction.transpose()?,
            plan: self.plan.as_ref().map(PlanLaw::cast).transpose()?,
        })
    }
}

impl NetworkLaw {
    /// Of the network strategy.
    ///
    /// # Errors
    /// [`ExportError::Compensator`] for a network that does not take four inputs and give one
    /// output; [`ExportError::Network`] for one with layers that are not tansig.
    pub fn of(strategy: &NetworkStrategy) -> Result<Self, ExportError> {
        let network = strategy.model().network();
        network.architecture().require_tansig()?;
        let scaling = network.scaling();
        let input = <[ScalingRange<f64>; 4]>::try_from(scaling.input());
        let (Ok(input), [output]) = (input, scaling.output()) else {
            return Err(ExportError::Compensator(CompensatorError::NetworkShape {
                inputs: network.shape().inputs,
                outputs: network.shape().outputs,
            }));
        };
        Ok(Self {
            hidden: network.shape().hidden.clone(),
            packed: network.packed_weights().to_vec(),
            input,
            output: *output,
            estimator: *strategy.estimator(),
        })
    }
}

impl<T: NetworkScalar + Exponential> NetworkLaw<T> {
    fn cast<U: NetworkScalar>(&self) -> Result<NetworkLaw<U>, ExportError> {
        let [a, b, c, d] = &self.input;
        let input = |range| range_of("input", range);
        Ok(NetworkLaw {
            hidden: self.hidden.clone(),
            packed: self.packed.iter().map(|w| U::of(w.to_f64())).collect(),
            input: [input(a)?, input(b)?, input(c)?, input(d)?],
            output: range_of("output", &self.output)?,
            estimator: self.estimator.cast()?,
        })
    }
}

fn range_of<T: NetworkScalar, U: NetworkScalar>(
    what: &'static str,
    range: &ScalingRange<T>,
) -> Result<ScalingRange<U>, cfnn::Error> {
    let cast = |value: T| U::of(Scalar::to_f64(value));
    ScalingRange::new(what, cast(range.minimum()), cast(range.maximum()))
}
