//! Kinds of units.

/// What of an axis or a machine a unit is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnitKind {
    /// The axis in its closed loop: references in, motion out.
    #[default]
    ClosedLoop,
    /// The machine alone, without sensors, control and current loops: the motor's torque, force or
    /// current in, motion out.
    Plant,
    /// The closed loop with a correction in it: the axis follows its references as many control
    /// periods late as the correction looks ahead.
    Compensated,
    /// Two or three axes on one path, each in its closed loop, and what lies between them: references
    /// of all axes in, their motion and that of the tool out.
    Machine,
}

/// What stands in the token of a compensated unit before the digest of its correction.
const COMPENSATED: &str = "-compensated-";

impl UnitKind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::ClosedLoop => "closed loop",
            Self::Plant => "plant alone",
            Self::Compensated => "compensated closed loop",
            Self::Machine => "machine of several axes in closed loops",
        }
    }

    /// How the tokens of such units end; `digest` is that of the correction.
    pub(crate) fn mark(self, digest: u64) -> String {
        match self {
            Self::ClosedLoop => String::new(),
            Self::Plant => "-plant".to_owned(),
            Self::Machine => "-machine".to_owned(),
            Self::Compensated => format!("{COMPENSATED}{digest:016x}"),
        }
    }

    /// The kind of the unit that has this token.
    pub fn of_token(token: &str) -> Self {
        match () {
            () if token.ends_with(&Self::Plant.mark(0)) => Self::Plant,
            () if token.ends_with(&Self::Machine.mark(0)) => Self::Machine,
            () if token.contains(COMPENSATED) => Self::Compensated,
            () => Self::ClosedLoop,
        }
    }
}
