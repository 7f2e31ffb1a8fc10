//! Kinds of units.

/// What of an axis a unit is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnitKind {
    /// The axis in its closed loop: references in, motion out.
    #[default]
    ClosedLoop,
    /// The machine alone, without sensors, control and current loops: the motor's torque, force or
    /// current in, motion out.
    Plant,
}

impl UnitKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::ClosedLoop => "closed loop",
            Self::Plant => "plant alone",
        }
    }

    /// How the tokens of such units end.
    pub(crate) fn mark(self) -> &'static str {
        match self {
            Self::ClosedLoop => "",
            Self::Plant => "-plant",
        }
    }

    /// The kind of the unit that has this token.
    pub fn of_token(token: &str) -> Self {
        match token.ends_with(Self::Plant.mark()) {
            true => Self::Plant,
            false => Self::ClosedLoop,
        }
    }
}
