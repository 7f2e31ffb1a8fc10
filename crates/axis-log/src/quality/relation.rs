//! What one channel should be of another.

/// How a channel should follow from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RelationLaw {
    /// It is the other, but for what a loop leaves: factor 1, offset 0.
    Same,
    /// It is `factor` times the other, in their units; its zero may be anywhere.
    Scaled {
        /// Channel units per unit of the other; not 0.
        factor: f64,
    },
    /// It is `factor` times the integral of the other over time; its zero may be anywhere.
    Integral {
        /// Channel units per unit of the other and second; not 0.
        factor: f64,
    },
    /// It follows the other's command with a delay: factor 1, noise and ripple beside it.
    Follows,
    /// It is about `factor` times the other, as torque of current: within `within` of it
    /// (2 for half to twice), as friction and inertia lie between.
    About {
        /// Channel units per unit of the other; not 0.
        factor: f64,
        /// Greatest ratio that is trusted, above 1.
        within: f64,
    },
}

/// Two channels, and what one should be of the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Relation {
    /// The channel that is judged.
    pub channel: String,
    /// The one that it should follow from.
    pub from: String,
    /// How.
    pub law: RelationLaw,
}

impl Relation {
    /// A relation of channels by these names.
    pub fn new(channel: impl Into<String>, from: impl Into<String>, law: RelationLaw) -> Self {
        Self {
            channel: channel.into(),
            from: from.into(),
            law,
        }
    }

    pub(super) fn factor(&self) -> f64 {
        match self.law {
            RelationLaw::Same | RelationLaw::Follows => 1.0,
            RelationLaw::Scaled { factor }
            | RelationLaw::Integral { factor }
            | RelationLaw::About { factor, .. } => factor,
        }
    }
}
