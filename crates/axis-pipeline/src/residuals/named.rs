//! Effects that a search has named, as a residual: their laws, with sizes and shapes that are
//! set right from log to log.

use axis_sim::effects::{ActiveEffect, Nature};
use axis_sim::{Axis, EffectForces};
use compensator::{Residual, ResidualAt, ResidualBasis, ResidualRow, Unexplained, over_gaussian};
use nalgebra::{DMatrix, DVector};

use crate::PipelineError;

/// How far sizes and widths may be off, as a share of them; places, as a share of the width;
/// phases, rad.
const OFF: f64 = 0.3;
/// Change of a coefficient by which sensitivities are found, in deviations.
const CHANGE: f64 = 0.01;

/// A number of an effect that is learned.
#[derive(Clone, Copy, Debug)]
struct Free {
    effect: usize,
    parameter: usize,
    deviation: f64,
}

/// Named effects as a basis. Each coefficient is how far one of their numbers is off, in
/// deviations of what a name is held to be good for; linear about the last estimate.
#[derive(Clone, Debug)]
pub struct NamedEffects {
    axis: Axis,
    named: Vec<ActiveEffect>,
    free: Vec<Free>,
    here: Vec<f64>,
    /// At the coefficients `here`, and with each changed.
    forces: EffectForces,
    changed: Vec<EffectForces>,
}

impl NamedEffects {
    /// Of `named` effects on an axis. Only effects with a torque or force of their own count;
    /// one that changes a parameter of the model is the adaptation's.
    ///
    /// # Errors
    /// [`PipelineError::Setup`] if an effect does not fit the axis.
    pub fn new(axis: &Axis, named: &[ActiveEffect]) -> Result<Self, PipelineError> {
        let mut free = Vec::new();
        for (effect, active) in named.iter().enumerate() {
            for parameter in 0..active.values.len() {
                if let Some(deviation) = deviation(active, parameter) {
                    free.push(Free {
                        effect,
                        parameter,
                        deviation,
                    });
                }
            }
        }
        let forces = axis.effect_forces(named)?;
        let mut basis = Self {
            axis: axis.clone(),
            named: named.to_vec(),
            here: vec![0.0; free.len()],
            changed: vec![forces.clone(); free.len()],
            forces,
            free,
        };
        let here = basis.here.clone();
        basis.move_to(&here)?;
        Ok(basis)
    }

    /// The effects with what was learned of them.
    #[must_use]
    pub fn effects(&self, coefficients: &[f64]) -> Vec<ActiveEffect> {
        let mut effects = self.named.clone();
        for (free, coefficient) in self.free.iter().zip(coefficients) {
            effects[free.effect].values[free.parameter] += free.deviation * coefficient;
        }
        effects
    }

    fn move_to(&mut self, coefficients: &[f64]) -> Result<(), PipelineError> {
        let forces = self.axis.effect_forces(&self.effects(coefficients))?;
        let mut changed = Vec::with_capacity(self.free.len());
        for i in 0..self.free.len() {
            let mut off = coefficients.to_vec();
            off[i] += CHANGE;
            changed.push(self.axis.effect_forces(&self.effects(&off))?);
        }
        (self.forces, self.changed) = (forces, changed);
        self.here = coefficients.to_vec();
        Ok(())
    }

    /// Torque at the motor behind the Gaussian of a log.
    fn torque(&self, of: &EffectForces, at: &Unexplained, smoothing: f64) -> f64 {
        let travel = self.axis.travel_per_radian();
        let mut sum = 0.0;
        over_gaussian(at, travel, smoothing, |there, weight| {
            let u = there;
            let [torque, force] = of.at(u.motor_angle, u.motor_speed, u.position, u.direction);
            sum += weight * (torque + travel * force);
        });
        sum
    }
}

/// How far a number of a named effect may be off; none if it is held.
fn deviation(active: &ActiveEffect, parameter: usize) -> Option<f64> {
    let value = active.values[parameter];
    match active.effect.parameters.get(parameter)?.nature {
        Nature::Size { .. } | Nature::Width(_) => Some(OFF * value.abs()),
        Nature::Phase => Some(OFF),
        Nature::Place(_) => {
            let width = active.effect.place_of(|n| matches!(n, Nature::Width(_)))?;
            Some(OFF * active.values.get(width)?.abs())
        }
        _ => None,
    }
    .filter(|deviation| *deviation > 0.0)
}

impl ResidualBasis for NamedEffects {
    type Model = NamedResidual;

    fn size(&self) -> usize {
        self.free.len()
    }

    fn prior(&self) -> (DMatrix<f64>, DVector<f64>) {
        let size = self.size();
        (DMatrix::identity(size, size), DVector::zeros(size))
    }

    fn linearise(&mut self, coefficients: &[f64]) {
        // Where the effects take no such values it stays where it was.
        if let Err(refused) = self.move_to(coefficients) {
            tracing::warn!("named effects stay as they were: {refused}");
        }
    }

    fn row(&mut self, at: &Unexplained, smoothing: f64) -> ResidualRow {
        let own = self.torque(&self.forces, at, smoothing);
        let mut fixed = own;
        let changed = self.changed.iter().enumerate();
        let values = changed.map(|(i, changed)| {
            let slope = (self.torque(changed, at, smoothing) - own) / CHANGE;
            fixed -= slope * self.here[i];
            (i, slope)
        });
        let values = values.collect();
        ResidualRow { values, fixed }
    }

    fn model(&self, coefficients: &[f64]) -> NamedResidual {
        let effects = self.effects(coefficients);
        let forces = self.axis.effect_forces(&effects);
        NamedResidual(forces.unwrap_or_else(|_| self.forces.clone()))
    }
}

/// Torque and force of named effects.
#[derive(Clone, Debug)]
pub struct NamedResidual(EffectForces);

impl Residual for NamedResidual {
    fn besides(&mut self, at: &ResidualAt) -> [f64; 2] {
        self.0
            .at(at.motor_angle, at.motor_speed, at.position, at.direction)
    }
}
