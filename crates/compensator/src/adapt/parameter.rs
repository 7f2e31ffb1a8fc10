//! What is adapted, and what is held possible of each parameter.

use crate::CompensatorError;
use crate::error::{require, within};

/// Number of parameters.
pub(super) const COUNT: usize = 9;
/// One number for each parameter.
pub(super) type Theta = [f64; COUNT];

/// A parameter that is adapted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum AdaptParameter {
    /// Coulomb level and break-away together.
    FrictionLevel,
    /// Viscous coefficient σ2.
    Viscosity,
    /// Bristle stiffness σ0.
    BristleStiffness,
    /// Bristle damping σ1.
    BristleDamping,
    /// Inertia of the load m.
    LoadInertia,
    /// Compliance C from motor to load, all of it by one factor.
    Compliance,
    /// Stribeck speed.
    StribeckSpeed,
    /// Break-away level over Coulomb level, T_S/T_C.
    BreakAway,
    /// Force against the load that always acts, in units of the Coulomb level.
    StandingLoad,
}

impl AdaptParameter {
    /// All of them, in the order of every list here.
    pub const ALL: [Self; COUNT] = [
        Self::FrictionLevel,
        Self::Viscosity,
        Self::BristleStiffness,
        Self::BristleDamping,
        Self::LoadInertia,
        Self::Compliance,
        Self::StribeckSpeed,
        Self::BreakAway,
        Self::StandingLoad,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::FrictionLevel => "friction level",
            Self::Viscosity => "viscosity",
            Self::BristleStiffness => "bristle stiffness",
            Self::BristleDamping => "bristle damping",
            Self::LoadInertia => "load inertia",
            Self::Compliance => "compliance",
            Self::StribeckSpeed => "Stribeck speed",
            Self::BreakAway => "break-away ratio",
            Self::StandingLoad => "standing load",
        }
    }

    pub(super) const fn index(self) -> usize {
        self as usize
    }

    /// Whether it is estimated as the logarithm of its ratio to the assumed model, which keeps
    /// its sign; a constant load is a share of the Coulomb level instead.
    pub(super) const fn is_ratio(self) -> bool {
        !matches!(self, Self::StandingLoad)
    }
}

/// What is held possible of one parameter before anything is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PriorSpread {
    /// Standard deviation of its relative error; 0 holds it fixed. Larger errors are
    /// accepted if the data insist: beyond two deviations the prior gives way.
    pub deviation: f64,
    /// Bound: the estimate stays from 1/bound to bound times the assumed model (a constant load
    /// within ± (bound − 1) Coulomb levels). At least 1.
    pub bound: f64,
}

/// What is held possible of all parameters, and how fast it may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptPrior {
    /// In the order of [`AdaptParameter::ALL`].
    pub spreads: [PriorSpread; COUNT],
    /// Share of what was known that is kept from move to move, from 0 (each move anew)
    /// to 1 (the machine never changes).
    pub retention: f64,
    /// Deviation of the Gaussian over all signals, s; 1 to 20 ms. An axis whose load
    /// follows its motor more slowly takes that time instead: r √(C m), one over its
    /// natural frequency.
    pub smoothing: f64,
}

impl Default for AdaptPrior {
    /// Settings of friction and compliance known to 20 %, inertia and break-away ratio to
    /// 10 %, viscosity to a half and within a factor of 100. A constant load of 1 % of the Coulomb
    /// level: in moves of one direction it looks
    /// like friction, which is likelier; a reversal separates the two.
    fn default() -> Self {
        let spread = |parameter| {
            let (deviation, bound) = match parameter {
                // Any move of some speed shows it, and axis files state it far too small.
                AdaptParameter::Viscosity => (0.5, 100.0),
                AdaptParameter::LoadInertia => (0.1, 3.0),
                AdaptParameter::BreakAway => (0.1, 2.0),
                AdaptParameter::StandingLoad => (0.01, 2.0),
                _ => (0.2, 3.0),
            };
            PriorSpread { deviation, bound }
        };
        Self {
            spreads: AdaptParameter::ALL.map(spread),
            retention: 0.2,
            smoothing: 4e-3,
        }
    }
}

impl AdaptPrior {
    /// The spread of a parameter.
    pub fn of(&self, parameter: AdaptParameter) -> PriorSpread {
        self.spreads[parameter.index()]
    }

    /// The same with another spread of one parameter.
    #[must_use]
    pub fn with(mut self, parameter: AdaptParameter, spread: PriorSpread) -> Self {
        self.spreads[parameter.index()] = spread;
        self
    }

    pub(super) fn check(&self) -> Result<(), CompensatorError> {
        for spread in &self.spreads {
            let inside = within(spread.deviation, 0.0, 10.0);
            require(inside, "deviation", spread.deviation, "from 0 to 10")?;
            let inside = within(spread.bound, 1.0, 1e3);
            require(inside, "bound", spread.bound, "from 1 to 1000")?;
        }
        let inside = within(self.retention, 0.0, 1.0);
        require(inside, "retention", self.retention, "from 0 to 1")?;
        let inside = within(self.smoothing, 1e-3, 2e-2);
        require(inside, "smoothing", self.smoothing, "from 1 to 20 ms")?;
        Ok(())
    }
}
