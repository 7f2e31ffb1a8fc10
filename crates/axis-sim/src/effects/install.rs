//! Puts effects into a machine.

use feed_dynamics::DriveError;

use super::changes::{Changes, Hooks, MachineMut};
use super::{ActiveEffect, EffectParameter};

/// Most control periods by which the current reference may come late.
const MOST_DELAY: f64 = 1e5;

/// Makes the effects' changes to the machine, and gives their hooks.
///
/// # Errors
/// [`DriveError`] where a value is not a number, an effect does not exist on
/// that kind of machine, or a parameter leaves its range.
pub(crate) fn install(
    effects: &[ActiveEffect],
    machine: MachineMut<'_>,
) -> Result<Hooks, DriveError> {
    let rigid = matches!(machine, MachineMut::Rigid(_));
    let period = machine.period();
    let mut hooks = Hooks::default();
    let mut changes = Changes {
        machine,
        hooks: &mut hooks,
    };
    for active in summed(effects) {
        let effect = active.effect;
        effect.fits(rigid).map_err(|_| DriveError::Parameter {
            name: effect.name,
            value: active.values.first().copied().unwrap_or(0.0),
            valid: "left out on a rigid mass, which has no part for it to act on",
        })?;
        check(&active)?;
        (effect.install)(&active.values, &mut changes)?;
    }
    if hooks.delay > MOST_DELAY * period {
        return Err(DriveError::Parameter {
            name: "control-delay",
            value: hooks.delay,
            valid: "at most 100000 control periods",
        });
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
                    if p.size {
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
        numbers.filter(|(p, _)| !p.size).map(|(_, v)| *v).collect()
    };
    a.effect.name == b.effect.name && a.values.len() == b.values.len() && shapes(a) == shapes(b)
}

fn check(active: &ActiveEffect) -> Result<(), DriveError> {
    let numbers = active.effect.parameters.iter().zip(&active.values);
    match numbers.into_iter().find(|(_, v)| !v.is_finite()) {
        None => Ok(()),
        Some((p, value)) => Err(DriveError::Parameter {
            name: p.name,
            value: *value,
            valid: "a finite number",
        }),
    }
}
