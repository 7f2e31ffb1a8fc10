//! An assumed model, and what it is at other parameters.

use libm::{exp, log, sqrt};
use lugre::{LuGre, Parameters};

use super::parameter::{AdaptParameter, AdaptPrior, Theta};
use crate::DriveModel;

/// Slowest natural motion of a transmission that is waited for, s.
const SLOWEST: f64 = 2e-2;

/// An assumed model with the parameters that it has.
#[derive(Clone, Debug)]
pub(super) struct AssumedModel {
    pub model: DriveModel,
    pub prior: AdaptPrior,
}

impl AssumedModel {
    /// Deviation of the Gaussian over all signals, s.
    pub fn smoothing(&self) -> f64 {
        let m = &self.model;
        let own = m.travel * sqrt(m.along.most_compliance() * m.load_inertia);
        self.prior.smoothing.max(own.min(SLOWEST))
    }

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

    /// The parameter as assumed, in its unit; of a constant load, the Coulomb force.
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

    /// Half the assumed free travel, rad at the motor.
    pub fn half_gap(&self) -> f64 {
        0.5 * self.model.kinematics.free_travel / self.model.travel
    }

    /// Greatest wind-up under the Coulomb level, rad at the motor.
    pub fn wound(&self) -> f64 {
        let level = self.model.travel * self.value(AdaptParameter::StandingLoad);
        self.value(AdaptParameter::Compliance) * level
    }

    /// Force of the constant load at `theta`, N or N·m.
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
