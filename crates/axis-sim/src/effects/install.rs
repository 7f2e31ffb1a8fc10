//! Puts effects into an axis.

use super::changes::{Changeable, Changes};
use super::hooks::Hooks;
use super::{ActiveEffect, EffectParameter};
use crate::axis::Axis;
use crate::error::SetupError;
use crate::part::{PartError, Role};

/// Makes the effects' changes to the axis, and gives their hooks.
///
/// # Errors
/// [`SetupError`] if a value is not a number, the axis has no part for an effect to
/// act on, or a parameter leaves its range.
fn install(effects: &[ActiveEffect], axis: &mut Axis) -> Result<Hooks, SetupError> {
    let mut hooks = Hooks::default();
    if let Some(error) = axis.mechanism.kinematic_error() {
        hooks.offset(move |screw| error(screw));
    }
    for active in summed(effects) {
        let effect = active.effect;
        effect.applies_to(axis).map_err(|why| SetupError::Effect {
            effect: effect.name,
            why,
        })?;
        check(&active)?;
        let mut changes = Changes {
            axis,
            hooks: &mut hooks,
        };
        (effect.install)(&active.values, &mut changes)?;
    }
    Ok(hooks)
}

/// The effects, those that agree in name and shape as one with the sum of their sizes.
fn summed(effects: &[ActiveEffect]) -> Vec<ActiveEffect> {
    let mut sums: Vec<ActiveEffect> = Vec::with_capacity(effects.len());
    for active in effects {
        match sums.iter_mut().find(|sum| alike(sum, active)) {
            Some(sum) => {
                for ((p, a), b) in numbers(active.effect.parameters, &mut sum.values, active) {
                    if p.is_size() {
                        *a += b;
                    }
                }
            }
            None => sums.push(active.clone()),
        }
    }
    sums
}

fn numbers<'a>(
    parameters: &'a [EffectParameter],
    sum: &'a mut [f64],
    added: &'a ActiveEffect,
) -> impl Iterator<Item = ((&'a EffectParameter, &'a mut f64), f64)> {
    parameters.iter().zip(sum).zip(added.values.iter().copied())
}

/// Whether two are of one effect and of the same shape.
fn alike(a: &ActiveEffect, b: &ActiveEffect) -> bool {
    let shapes = |active: &ActiveEffect| -> Vec<f64> {
        let numbers = active.effect.parameters.iter().zip(&active.values);
        numbers
            .filter(|(p, _)| !p.is_size())
            .map(|(_, v)| *v)
            .collect()
    };
    a.effect.name == b.effect.name && a.values.len() == b.values.len() && shapes(a) == shapes(b)
}

fn check(active: &ActiveEffect) -> Result<(), SetupError> {
    let numbers = active.effect.parameters.iter().zip(&active.values);
    match numbers.into_iter().find(|(_, v)| !v.is_finite()) {
        None => Ok(()),
        Some((p, value)) => Err(PartError::of(
            p.name,
            format!("of the effect \"{}\" is {value}", active.effect.name),
            "a finite number",
        )
        .into()),
    }
}

impl Axis {
    /// The axis with its effects' changes made, and their hooks.
    pub(crate) fn with_effects(&self) -> Result<(Self, Hooks), SetupError> {
        let mut axis = self.clone();
        let hooks = install(&self.effects, &mut axis)?;
        Ok((axis, hooks))
    }
}

impl Changeable for Axis {
    fn change(&mut self, role: Role, to: &dyn Fn(f64) -> f64) -> Result<(), SetupError> {
        Axis::change(self, role, to)
    }

    fn copy(&self) -> Box<dyn Changeable> {
        Box::new(self.clone())
    }

    fn travel_per_radian(&self) -> f64 {
        Axis::travel_per_radian(self)
    }

    fn friction_lever(&self) -> f64 {
        self.friction.lever(Axis::travel_per_radian(self))
    }

    fn stroke_start(&self) -> f64 {
        self.stroke.start
    }

    fn stiffness(&self) -> f64 {
        self.mechanism.stiffness().unwrap_or(f64::INFINITY)
    }

    fn greatest_force(&self) -> f64 {
        let torque = self.torque_constant() * self.actuator.limit();
        torque / Axis::travel_per_radian(self)
    }

    fn pole_pairs(&self) -> Option<f64> {
        self.actuator.pole_pairs()
    }
}
