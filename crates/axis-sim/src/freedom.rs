//! How a load moves.

/// How the load moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Freedom {
    /// Along a line: m, N, kg.
    #[default]
    Linear,
    /// About an axis: rad, N·m, kg·m².
    Rotary,
}

impl Freedom {
    /// SI unit of its position.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Linear => "m",
            Self::Rotary => "rad",
        }
    }

    /// SI unit of its speed.
    pub fn speed_unit(self) -> &'static str {
        match self {
            Self::Linear => "m/s",
            Self::Rotary => "rad/s",
        }
    }

    /// What moves it, and the SI unit of that.
    pub fn force(self) -> [&'static str; 2] {
        match self {
            Self::Linear => ["force", "N"],
            Self::Rotary => ["torque", "N·m"],
        }
    }
}
