//! Keys of the axis file that a tuned axis has otherwise.

use axis_sim::Axis;
use axis_sim::control::units_of_gain;
use axis_sim::part::{Key, Values};
use schemars::JsonSchema;
use serde::Serialize;

use crate::tune::Tuned;

/// A key of the axis file that was set.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TunedKey {
    /// Section that it stands in: `control` or `actuator`.
    #[serde(skip)]
    pub section: &'static str,
    /// With its unit, as in the file.
    pub key: String,
    /// Before; none where the file had none.
    pub before: Option<f64>,
    /// Now.
    pub value: f64,
    /// The least and the greatest that the key takes, in that unit.
    #[serde(skip)]
    pub limits: Option<[f64; 2]>,
}

impl Tuned {
    /// Keys of control and actuator that are others than those of the axis before, in the units of
    /// its file.
    pub fn keys(&self, before: &Axis) -> Vec<TunedKey> {
        let effort = before.actuator.effort();
        let gain = |key: &Key| units_of_gain(&*before.control, key, effort, &*before.mechanism);
        let mut all = changed(
            "control",
            self.axis.control.kind().keys,
            [before.control.values(), self.axis.control.values()],
            gain,
        );
        all.extend(changed(
            "actuator",
            self.axis.actuator.kind().keys,
            [before.actuator.values(), self.axis.actuator.values()],
            |key| key.units().to_vec(),
        ));
        all
    }
}

/// What the second values have otherwise than the first.
fn changed(
    section: &'static str,
    keys: &[Key],
    values: [&Values; 2],
    units: impl Fn(&Key) -> Vec<(&'static str, f64)>,
) -> Vec<TunedKey> {
    let one = |key: &Key| {
        let [before, after] = values.map(|values| values.optional(key.name()));
        let after = after.filter(|_| before != after)?;
        let (units, own) = (units(key), values[0].unit(key.name()));
        let unit = units.iter().find(|(unit, _)| *unit == own);
        let (name, factor) = match unit.or(units.first()) {
            Some((unit, factor)) => (format!("{}_{unit}", key.name()), *factor),
            None => (key.name().to_owned(), 1.0),
        };
        Some(TunedKey {
            section,
            key: name,
            before: before.map(|before| before / factor),
            value: after / factor,
            limits: key.limits().map(|limits| limits.map(|edge| edge / factor)),
        })
    };
    keys.iter().filter_map(one).collect()
}
