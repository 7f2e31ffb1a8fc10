//! What strategies are made of.

/// What is found from simulation or measurement, and a strategy may be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// The trained one-cycle network.
    Network,
    /// The transfer functions of the tracking error.
    TransferFunctions,
    /// The friction parameters identified on the machine.
    IdentifiedFriction,
}

impl Need {
    /// All of them.
    pub const ALL: [Self; 3] = [
        Self::Network,
        Self::TransferFunctions,
        Self::IdentifiedFriction,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Network => "the trained network",
            Self::TransferFunctions => "the transfer functions of the tracking error",
            Self::IdentifiedFriction => "the identified friction parameters",
        }
    }
}
