//! Dry friction that falls with speed by another exponent.
//!
//! The law of the axis, and of `stribeck-friction`, falls from break-away as e^(−(v / v_s)²); others have
//! e^(−|v / v_s|^δ) with δ from 0.5 to 2, and 1 by Tustin (Armstrong-Hélouvry, Dupont, Canudas de Wit,
//! Automatica 30 (1994) 1083, doi:10.1016/0005-1098(94)90209-7).

use super::super::changes;
use super::{ActiveEffect, Family, HELD, Measure, OWN, begun, held};
use crate::effects::{Changes, Effect, EffectChannel, EffectVariable, Steepness, signed};
use crate::error::SetupError;
use crate::part::PartError;

/// The library's exponent.
const SQUARE: f64 = 2.0;

/// Most by which the exponent is smaller, or greater.
const LESS: f64 = 1.7;

static EXPONENT_FORM: Effect = Effect {
    name: "exponent-form",
    summary: "dry friction that falls with speed by another exponent",
    channel: EffectChannel::Torque,
    depends_on: "low speed",
    shown_over: EffectVariable::Speed,
    // Place of the effect and its values; level, fall and its speed; 2 − δ.
    parameters: &[
        HELD,
        HELD,
        HELD,
        HELD,
        HELD,
        HELD,
        HELD,
        held("level", Measure::Force),
        held("fall", Measure::Force),
        held("velocity", Measure::Speed),
        signed("less", Measure::Ratio, 0.5, LESS),
    ],
    needs: &[],
    install,
};

pub(super) const FAMILY: Family = Family {
    effect: &EXPONENT_FORM,
    differs_in: "fall with speed",
    begins: |of| {
        let form = of.fall.and_then(|[fall, velocity]| {
            let level = of.friction.values.first().copied()?;
            let mut values = begun(&of.friction)?;
            values.extend([level, fall, velocity, 0.0]);
            Some(ActiveEffect {
                effect: &EXPONENT_FORM,
                values,
            })
        });
        form.into_iter().collect()
    },
    at: |active, speed| {
        let law = Law::new(&active.values);
        1.0 + law.at(speed) / law.level
    },
    with_speed: |_| 0.0,
    whole: |_| None,
    speeds: |active| [0.01, 3.0].map(|by| by * Law::new(&active.values).velocity),
};

/// By how much the friction differs from that with the library's exponent, beside a full bristle.
#[derive(Clone, Copy)]
struct Law {
    level: f64,
    fall: f64,
    velocity: f64,
    exponent: f64,
}

impl Law {
    fn new(values: &[f64]) -> Self {
        let numbers: [f64; OWN + 4] = changes::array(values);
        Self {
            level: numbers[OWN],
            fall: numbers[OWN + 1],
            velocity: numbers[OWN + 2],
            exponent: SQUARE - numbers[OWN + 3],
        }
    }

    fn at(self, speed: f64) -> f64 {
        let ratio = (speed / self.velocity).abs();
        self.fall * ((-ratio.powf(self.exponent)).exp() - (-ratio * ratio).exp())
    }
}

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let law = Law::new(values);
    let is_above = |v: f64| v.is_finite() && v > 0.0;
    if !is_above(law.velocity) || !is_above(law.exponent) {
        let error = PartError::of("velocity or exponent", "is not above 0", "numbers above 0");
        return Err(error.into());
    }
    let steepness = Steepness {
        // Each of both falls is steepest by about 1/v_s; below an exponent of 1 the slope at rest has no
        // bound, but hardly any height.
        speed: 2.0 * (law.fall / law.velocity).abs(),
        bristle: law.fall.abs(),
        ..Steepness::default()
    };
    to.load_within(steepness, move |t| law.at(t.speed) * t.bristle);
    Ok(())
}
