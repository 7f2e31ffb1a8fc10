//! What is adapted: parameters of a [`DriveModel`] as relative errors, and what is held
//! possible of each.

use libm::{exp, log};
use lugre::{LuGre, Parameters};

use crate::error::{require, within};
use crate::{CompensatorError, DriveModel};

/// Number of parameters.
pub(super) const COUNT: usize = 9;
/// One number for each parameter.
pub(super) type Theta = [f64; COUNT];

/// A parameter that is adapted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

    /// Whether it is estimated as the logarithm of its ratio to the belief, which keeps
    /// its sign; a standing load is a share of the Coulomb level instead.
    pub(super) const fn is_ratio(self) -> bool {
        !matches!(self, Self::StandingLoad)
    }
}

/// What is held possible of one parameter before anything is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Standard deviation of its relative error; 0 holds it fixed. Larger errors are
    /// believed where the data insist: beyond two deviations the prior gives way.
    pub deviation: f64,
    /// Bound: the estimate stays from 1/bound to bound times the belief (a standing load
    /// within ± (bound − 1) Coulomb levels). At least 1.
    pub bound: f64,
}

/// What is held possible of all parameters, and how fast it may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptPrior {
    /// In the order of [`AdaptParameter::ALL`].
    pub spreads: [Spread; COUNT],
    /// Share of what was known that is kept from move to move, from 0 (each move anew)
    /// to 1 (the machine never changes).
    pub retention: f64,
}

impl Default for AdaptPrior {
    /// Settings of friction and compliance known to 20 %, inertia and break-away ratio to
    /// 10 %. A standing load of 1 % of the Coulomb level: in moves of one direction it looks
    /// like friction, which is the likelier of the two; a reversal tells them apart.
    fn default() -> Self {
        let spread = |parameter| {
            let (deviation, bound) = match parameter {
                AdaptParameter::LoadInertia => (0.1, 3.0),
                AdaptParameter::BreakAway => (0.1, 2.0),
                AdaptParameter::StandingLoad => (0.01, 2.0),
                _ => (0.2, 3.0),
            };
            Spread { deviation, bound }
        };
        Self {
            spreads: AdaptParameter::ALL.map(spread),
            retention: 0.2,
        }
    }
}

impl AdaptPrior {
    /// The spread of a parameter.
    pub fn of(&self, parameter: AdaptParameter) -> Spread {
        self.spreads[parameter.index()]
    }

    /// The same with another spread of one parameter.
    #[must_use]
    pub fn with(mut self, parameter: AdaptParameter, spread: Spread) -> Self {
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
        Ok(())
    }
}

/// A believed model with the parameters that it has.
#[derive(Clone, Debug)]
pub(super) struct Belief {
    pub model: DriveModel,
    pub prior: AdaptPrior,
}

impl Belief {
    /// Whether the model has the parameter, and the prior lets it change.
    pub fn adapts(&self, parameter: AdaptParameter) -> bool {
        let p = self.model.friction.parameters();
        let has = match parameter {
            AdaptParameter::FrictionLevel
            | AdaptParameter::BristleStiffness
            | AdaptParameter::StandingLoad => p.coulomb > 0.0,
            AdaptParameter::Viscosity => p.viscous > 0.0,
            AdaptParameter::BristleDamping => p.coulomb > 0.0 && p.damping > 0.0,
            AdaptParameter::LoadInertia => true,
            AdaptParameter::Compliance => self.model.along.most_compliance() > 0.0,
            // Without a rise towards rest neither has any meaning.
            AdaptParameter::StribeckSpeed | AdaptParameter::BreakAway => p.stiction > p.coulomb,
        };
        has && self.prior.of(parameter).deviation > 0.0
    }

    /// Least and greatest value of its coordinate.
    pub fn bounds(&self, parameter: AdaptParameter) -> [f64; 2] {
        let most = self.prior.of(parameter).bound;
        match parameter {
            AdaptParameter::StandingLoad => [1.0 - most, most - 1.0],
            // Break-away below the Coulomb level is no law.
            AdaptParameter::BreakAway => {
                let p = self.model.friction.parameters();
                let least = (p.coulomb / p.stiction).max(1.0 / most);
                [log(least), log(most)]
            }
            _ => [-log(most), log(most)],
        }
    }

    /// The parameter as believed, in its unit; of a standing load, the Coulomb force.
    pub fn value(&self, parameter: AdaptParameter) -> f64 {
        let (m, p) = (&self.model, self.model.friction.parameters());
        match parameter {
            AdaptParameter::FrictionLevel => p.coulomb,
            AdaptParameter::Viscosity => p.viscous,
            AdaptParameter::BristleStiffness => p.stiffness,
            AdaptParameter::BristleDamping => p.damping,
            AdaptParameter::LoadInertia => m.load_inertia,
            AdaptParameter::Compliance => m.along.most_compliance(),
            AdaptParameter::StribeckSpeed => p.stribeck_speed,
            AdaptParameter::BreakAway => p.stiction / p.coulomb,
            AdaptParameter::StandingLoad => p.coulomb / m.lever,
        }
    }

    /// The friction law at `theta`.
    pub fn friction(&self, theta: &Theta) -> LuGre {
        let p = self.model.friction.parameters();
        let factor = |parameter: AdaptParameter| exp(theta[parameter.index()]);
        let level = factor(AdaptParameter::FrictionLevel);
        let coulomb = p.coulomb * level;
        let changed = Parameters {
            coulomb,
            stiction: (p.stiction * level * factor(AdaptParameter::BreakAway)).max(coulomb),
            stribeck_speed: p.stribeck_speed * factor(AdaptParameter::StribeckSpeed),
            stiffness: p.stiffness * factor(AdaptParameter::BristleStiffness),
            damping: p.damping * factor(AdaptParameter::BristleDamping),
            viscous: p.viscous * factor(AdaptParameter::Viscosity),
        };
        // Within the bounds every law stays one, but for numbers at the edge of f64.
        LuGre::new(changed).unwrap_or(self.model.friction)
    }

    /// Force of the standing load at `theta`, N or N·m.
    pub fn standing_load(&self, theta: &Theta) -> f64 {
        let share = theta[AdaptParameter::StandingLoad.index()];
        match share {
            0.0 => 0.0,
            _ => share * self.value(AdaptParameter::StandingLoad),
        }
    }

    /// The whole model at `theta`.
    pub fn at(&self, theta: &Theta) -> DriveModel {
        let factor = |parameter: AdaptParameter| exp(theta[parameter.index()]);
        let mut model = self.model;
        model.friction = self.friction(theta);
        model.load_inertia *= factor(AdaptParameter::LoadInertia);
        model.along = model
            .along
            .with_compliance(factor(AdaptParameter::Compliance))
            .with_load(self.standing_load(theta));
        model
    }
}
