//! One learner, whatever it learns.

use compensator::{
    NetworkBasis, Residual, ResidualAt, ResidualLearner, ResidualModel, ResidualNetwork, Rest,
};

use super::named::{NamedEffects, NamedResidual};

/// Learns what no parameter of the model holds.
#[derive(Clone, Debug)]
pub enum AnyLearner {
    /// Harmonics of the motor's angle and curves along the stroke.
    Tables(ResidualLearner),
    /// The output layer of a network.
    Network(Box<ResidualLearner<NetworkBasis>>),
    /// Sizes and shapes of effects.
    Named(Box<ResidualLearner<NamedEffects>>),
}

/// What it has learned.
#[derive(Clone, Debug)]
pub enum AnyResidual {
    /// Harmonics and curves.
    Tables(Box<ResidualModel>),
    /// A network.
    Network(ResidualNetwork),
    /// Effects.
    Named(NamedResidual),
}

impl AnyLearner {
    /// Learns from what a move left unexplained; the share that was explained before.
    pub fn learn(&mut self, rest: &Rest) -> f64 {
        let (log, spacing, smoothing) = (&rest.instants, rest.spacing, rest.smoothing);
        match self {
            Self::Tables(learner) => learner.learn(log, spacing, smoothing),
            Self::Network(learner) => learner.learn(log, spacing, smoothing),
            Self::Named(learner) => learner.learn(log, spacing, smoothing),
        }
    }

    /// What was learned, where the gate lets it be used.
    #[must_use]
    pub fn model(&self) -> Option<AnyResidual> {
        match self {
            Self::Tables(learner) => learner.model().cloned().map(AnyResidual::Tables),
            Self::Network(learner) => {
                let network = learner.model().cloned().flatten();
                network.map(AnyResidual::Network)
            }
            Self::Named(learner) => learner.model().cloned().map(AnyResidual::Named),
        }
    }
}

impl Residual for AnyResidual {
    fn besides(&mut self, at: &ResidualAt) -> [f64; 2] {
        match self {
            Self::Tables(model) => model.besides(at),
            Self::Network(model) => model.besides(at),
            Self::Named(model) => model.besides(at),
        }
    }
}
