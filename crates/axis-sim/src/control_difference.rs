//! What two axes have otherwise in their controllers: a model and the machine that stands for the real one should have the same,
//! as a correction is made for the controller of the model.

use std::fmt;

use crate::axis::Axis;
use crate::control::units_of_gain;
use crate::part::{Key, Values};
use crate::six_digits::SixDigits;

/// Share by which two numbers may differ and be the same: rounding of their units.
const ROUNDING: f64 = 1e-9;

/// Keys of which a file has one or the other for the same gain: that of the position, and of the speed's integral.
const SPELT_TWICE: [[&str; 2]; 2] = [
    ["position_gain", "kv"],
    ["speed_integral", "speed_integral_time"],
];

/// A key of the controller that two axis files have otherwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ControlDifference {
    /// Its name, with the unit of both values.
    pub key: String,
    /// As the model has it, in words; `left out` if it has not.
    pub model: String,
    /// As the machine has it.
    pub machine: String,
}

impl fmt::Display for ControlDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            key,
            model,
            machine,
        } = self;
        write!(
            f,
            "{key} is {model} in the axis file and {machine} in the machine's"
        )
    }
}

/// All keys of the controller that `machine` has otherwise than `model`: its kind, its sampling, gains and filters, the gains
/// of current controllers. Gains that two files spell by other keys are compared as the loop has them.
#[must_use]
pub fn control_differences(model: &Axis, machine: &Axis) -> Vec<ControlDifference> {
    let kinds = [model, machine].map(|axis| axis.control.kind().name);
    let words = |key: &str, [model, machine]: [String; 2]| ControlDifference {
        key: key.to_owned(),
        model,
        machine,
    };
    if kinds[0] != kinds[1] {
        return vec![words(
            "control.kind",
            kinds.map(|kind| format!("\"{kind}\"")),
        )];
    }
    let mut all = Vec::new();
    let rates = [model, machine].map(|axis| 1.0 / axis.period);
    if !is_same(rates[0], rates[1]) {
        all.push(words(
            "control.frequency_hz",
            rates.map(|rate| SixDigits(rate).to_string()),
        ));
    }
    let has_same = has_same_gains(model, machine);
    let is_same_gain = |name: &str| {
        let mut spelt = SPELT_TWICE.iter().zip(has_same);
        spelt.any(|(keys, is_same)| is_same && keys.contains(&name))
    };
    let effort = model.actuator.effort();
    for key in model.control.kind().keys {
        let values = [model, machine].map(|axis| axis.control.values());
        let units = units_of_gain(&*model.control, key, effort, &*model.mechanism);
        if !is_same_gain(key.name()) {
            let found = differing(key, values, &units);
            all.extend(found.map(|found| ControlDifference {
                key: format!("control.{}", found.key),
                ..found
            }));
        }
    }
    let currents = model.actuator.kind().keys.iter();
    for key in currents.filter(|key| key.name().starts_with("current_")) {
        let values = [model, machine].map(|axis| axis.actuator.values());
        all.extend(differing(key, values, key.units()));
    }
    all
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}

/// Whether the loops have the same gain of the position, and of the speed's integral, however the files spell them.
fn has_same_gains(model: &Axis, machine: &Axis) -> [bool; 2] {
    let gains = |axis: &Axis| {
        let found = axis
            .control
            .cascade(axis.travel_per_radian(), axis.period)?;
        Some([found.position, found.speed_integral])
    };
    let both = gains(model).zip(gains(machine));
    both.map_or([false; 2], |(a, b)| {
        std::array::from_fn(|k| is_same(a[k], b[k]))
    })
}

/// A key that two parts have otherwise, in the unit of the first.
fn differing(
    key: &Key,
    values: [&Values; 2],
    units: &[(&'static str, f64)],
) -> Option<ControlDifference> {
    let numbers = values.map(|values| values.optional(key.name()).or(key.default()));
    let same = match numbers {
        [Some(a), Some(b)] => is_same(a, b),
        _ => values
            .map(|values| shown(values, key, 1.0))
            .windows(2)
            .all(|w| w[0] == w[1]),
    };
    if same {
        return None;
    }
    let own = values.map(|values| values.unit(key.name()));
    let unit = units.iter().find(|(unit, _)| own.contains(unit));
    let (name, factor) = match unit.or(units.first()) {
        Some((unit, factor)) if !unit.is_empty() => (format!("{}_{unit}", key.name()), *factor),
        _ => (key.name().to_owned(), 1.0),
    };
    let [model, machine] =
        values.map(|values| shown(values, key, factor).unwrap_or_else(|| "left out".to_owned()));
    Some(ControlDifference {
        key: name,
        model,
        machine,
    })
}

/// What stands under a key, a number in units of `factor`.
fn shown(values: &Values, key: &Key, factor: f64) -> Option<String> {
    let name = key.name();
    let number = values.optional(name).or(key.default());
    let number = number.map(|number| SixDigits(number / factor).to_string());
    let count = || values.optional_count(name).map(|count| count.to_string());
    let word = || values.word(name).map(|word| format!("\"{word}\""));
    number.or_else(count).or_else(word)
}
