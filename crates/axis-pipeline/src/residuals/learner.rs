//! One learner, whatever it learns.

use compensator::{
    NetworkBasis, Residual, ResidualAt, ResidualLearner, ResidualModel, ResidualNetwork,
    UnexplainedTorque,
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
    Named(Box<NamedResidual>),
}

impl AnyLearner {
    /// Judges it by what is left of a move that nothing has learned from, by parameters beside
    /// it and by parameters `alone`: the share of the latter that it explains.
    pub fn judge(&mut self, beside: &UnexplainedTorque, alone: &UnexplainedTorque) -> f64 {
        let (spacing, smoothing) = (beside.spacing, beside.smoothing);
        let (beside, alone) = (&beside.instants, &alone.instants);
        match self {
            Self::Tables(learner) => learner.judge(beside, alone, spacing, smoothing),
            Self::Network(learner) => learner.judge(beside, alone, spacing, smoothing),
            Self::Named(learner) => learner.judge(beside, alone, spacing, smoothing),
        }
    }

    /// Fits it to what the parameters beside it leave of a move.
    pub fn fit(&mut self, rest: &UnexplainedTorque) {
        let (log, spacing, smoothing) = (&rest.instants, rest.spacing, rest.smoothing);
        match self {
            Self::Tables(learner) => learner.fit(log, spacing, smoothing),
            Self::Network(learner) => learner.fit(log, spacing, smoothing),
            Self::Named(learner) => learner.fit(log, spacing, smoothing),
        }
    }

    /// What is learned, whether or not the gate lets it be used.
    #[must_use]
    pub fn latest(&self) -> Option<AnyResidual> {
        match self {
            Self::Tables(learner) => Some(AnyResidual::Tables(learner.latest().clone())),
            Self::Network(learner) => learner.latest().clone().map(AnyResidual::Network),
            Self::Named(learner) => Some(AnyResidual::Named(Box::new(learner.latest().clone()))),
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
            Self::Named(learner) => learner
                .model()
                .cloned()
                .map(Box::new)
                .map(AnyResidual::Named),
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
