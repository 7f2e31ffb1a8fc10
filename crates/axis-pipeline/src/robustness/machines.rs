//! Machines that differ from their model.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, EFFECTS};
use axis_sim::mechanism::Freedom;

use crate::ErrorUnit;

/// A machine that differs from the axis.
#[derive(Clone, Debug)]
pub struct Machine {
    /// In words.
    pub name: String,
    /// The machine.
    pub axis: Axis,
}

/// What the table asks of: a heavier load, backlash, a softer nut, another Stribeck curve,
/// and what repeats with angle and position. Parameters that the axis' file does not have
/// are passed over.
pub fn machines(axis: &Axis) -> Vec<Machine> {
    let known = |changes: &[(&str, f64)]| {
        let shares: Vec<f64> = axis
            .known()
            .iter()
            .map(|name| {
                let change = changes.iter().find(|(changed, _)| changed == name);
                change.map_or(0.0, |(_, share)| *share)
            })
            .collect();
        axis.with_known(&shares)
    };
    let with = |effects: &[(&str, &[f64])]| {
        let mut machine = axis.clone();
        for (name, values) in effects {
            if let Some(effect) = EFFECTS.iter().find(|effect| effect.name == *name) {
                machine.effects.push(ActiveEffect {
                    effect,
                    values: values.to_vec(),
                });
            }
        }
        machine
    };
    let unit = ErrorUnit::of(axis);
    let mass = match axis.freedom() {
        Freedom::Linear => "kg",
        Freedom::Rotary => "kg·m²",
    };
    vec![
        Machine {
            name: format!("200 {mass} more"),
            axis: known(&[("table_mass", 200.0 / axis.mechanism.load_inertia())]),
        },
        Machine {
            name: format!("3 {unit} backlash"),
            axis: with(&[("backlash", &[3e-6])]),
        },
        Machine {
            name: "nut stiffness -20 %".to_owned(),
            axis: known(&[("nut_stiffness", -0.2)]),
        },
        Machine {
            name: "Stribeck speed +20 %, break-away +5 %".to_owned(),
            axis: known(&[("stribeck_speed", 0.2), ("break_away", 0.05)]),
        },
        Machine {
            name: "cogging, local and asymmetric friction".to_owned(),
            axis: with(&[
                ("cogging-torque", &[0.05, 11.0, 0.6]),
                ("position-dependent-friction", &[40.0, 0.75, 0.06]),
                ("asymmetric-friction", &[20.0, -10.0]),
            ]),
        },
    ]
}
