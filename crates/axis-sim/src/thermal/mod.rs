//! The axis' heat: its thermal model, and the losses of a motion that repeats itself.
//!
//! What a file's `[thermal]` leaves out is assumed (`axis_thermal::ThermalParameters`, docs/heat.md).
//! A screw gives heat and growth by place; of other mechanisms winding, carriage, bed and scale are
//! followed.

mod keys;
mod losses;
mod numbers;

pub use losses::LossModel;

pub(crate) use keys::{THERMAL_KEYS, is_of_screws};

use axis_thermal::{ScrewEnds, ThermalError, ThermalModel, ThermalParameters, ThermalScrew};

use numbers::NUMBERS;

use crate::axis::Axis;
use crate::mechanism::{Freedom, ScrewShape};
use crate::part::{Role, Values};

/// Heat capacity of a table for each kg of the load, J/(kg·K): half of that of steel and cast iron,
/// as half of a table takes part within an hour; assumed.
const TABLE_SPECIFIC_HEAT: f64 = 230.0;

impl Axis {
    /// The thermal model of this axis: the numbers of the file's `[thermal]`, the screw of its
    /// mechanism, the resistance of its motor; the rest is assumed.
    ///
    /// # Errors
    /// [`ThermalError::Invalid`] if numbers contradict each other.
    pub fn thermal_model(&self) -> Result<ThermalModel, ThermalError> {
        ThermalModel::new(self.thermal_parameters())
    }

    /// How many of the thermal model's numbers the file states.
    pub fn thermal_keys_stated(&self) -> usize {
        let stated = |name: &&str| {
            self.thermal.optional(name).is_some() || self.thermal.optional_count(name).is_some()
        };
        THERMAL_KEYS
            .iter()
            .map(|key| key.name)
            .filter(|name| stated(name))
            .count()
    }

    /// The keys of `[thermal]` under which other numbers than this axis' differ from its own, in the order of
    /// the file: each with its unit, and the value in that unit. Together they make an axis file of those numbers;
    /// what no key states (lengths, the number of segments, loss of the winding) is not among them.
    pub fn thermal_keys_of(&self, other: &ThermalParameters) -> Vec<(String, f64)> {
        let own = self.spelt(&self.thermal_parameters());
        let other = self.spelt(other).into_iter();
        other.filter(|number| !own.contains(number)).collect()
    }

    /// All numbers of this axis as [`Axis::thermal_keys_of`] has them.
    pub fn thermal_keys(&self) -> Vec<(String, f64)> {
        self.spelt(&self.thermal_parameters())
    }

    /// Numbers as keys of the file, in the units that it states them in.
    fn spelt(&self, numbers: &ThermalParameters) -> Vec<(String, f64)> {
        let mut numbers = numbers.clone();
        let one = |(name, number): &(&'static str, numbers::Number)| {
            let value = *number(&mut numbers)?;
            let key = THERMAL_KEYS.iter().find(|key| key.name == *name)?;
            let stated = self.thermal.unit(name);
            let units = key.units();
            let unit = units.iter().find(|(unit, _)| *unit == stated);
            Some(match unit.or(units.first()) {
                Some((unit, factor)) => (format!("{name}_{unit}"), value / factor),
                None => ((*name).to_owned(), value),
            })
        };
        NUMBERS.iter().filter_map(one).collect()
    }

    /// The numbers of [`Axis::thermal_model`].
    pub fn thermal_parameters(&self) -> ThermalParameters {
        let v = &self.thermal;
        let mut p = match (self.mechanism.screw(), self.mechanism.motor_freedom()) {
            (Some(shape), _) => ThermalParameters {
                screw: Some(screw(v, &shape)),
                ..ThermalParameters::default()
            },
            (None, Freedom::Linear) => ThermalParameters::linear_motor(),
            (None, Freedom::Rotary) => ThermalParameters::without_screw(),
        };
        if self.freedom() == Freedom::Linear {
            p.bodies.table.capacity = TABLE_SPECIFIC_HEAT * self.mechanism.load_inertia();
        }
        if let Some(resistance) = self.actuator.value(Role::Resistance) {
            // P = 1.5 R i_q², T = K_t i_q.
            let per_current = self.torque_constant();
            p.winding.per_torque_squared = 1.5 * resistance / (per_current * per_current);
        }
        if let Some(constant) = v.optional("motor_constant") {
            p.winding.per_torque_squared = 1.0 / (constant * constant);
        }
        for (name, number) in NUMBERS {
            // A law that no key states stays as it is.
            if let Some(value) = v.optional(name)
                && let Some(number) = number(&mut p)
            {
                *number = value;
            }
        }
        p
    }
}

fn screw(v: &Values, shape: &ScrewShape) -> ThermalScrew {
    let assumed = ThermalScrew::default();
    let segments = v.optional_count("screw_segments").map(|n| n as usize);
    ThermalScrew {
        length: shape.length,
        diameter: shape.diameter,
        density: shape.density,
        nut_length: assumed.nut_length.min(shape.length),
        segments: segments.unwrap_or(assumed.segments),
        ends: match shape.held_at_both_ends {
            None => ScrewEnds::OneFixed,
            Some(bearing_stiffness) => ScrewEnds::BothFixed {
                rigidity: shape.rigidity,
                bearing_stiffness,
                pretension: v.or("screw_pretension", 0.0),
            },
        },
        ..assumed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::Kind;

    const AXIS: &str = include_str!("../../../../data/axes/screw-datasheet.toml");
    const PAGE: &str = include_str!("../../../../docs/heat.md");

    /// A key that does nothing would be a slip of its name.
    #[test]
    fn every_key_changes_the_model_and_stands_in_the_page() {
        let text = AXIS.replace("fixed-free", "fixed-fixed");
        let axis = Axis::parse("axis.toml", &text).unwrap();
        let before = axis.thermal_parameters();
        for key in THERMAL_KEYS {
            let mut other = axis.clone();
            match key.kind {
                Kind::Count(..) => other.thermal.set_count(key.name, 7),
                _ => other.thermal.set(key.name, 0.0123),
            }
            assert_ne!(other.thermal_parameters(), before, "{}", key.name);
            assert!(PAGE.contains(&format!("`{}`", key.name)), "{}", key.name);
        }
    }

    /// Numbers of another model as keys, and the file with these keys as that model.
    #[test]
    fn keys_of_other_numbers_make_a_file_of_them() {
        let axis = Axis::parse("axis.toml", AXIS).unwrap();
        assert!(axis.thermal_keys_of(&axis.thermal_parameters()).is_empty());
        let mut other = axis.thermal_parameters();
        for (i, (_, number)) in NUMBERS.iter().enumerate() {
            if let Some(number) = number(&mut other) {
                *number *= 1.0 + 0.001 * i as f64;
            }
        }
        let keys = axis.thermal_keys_of(&other);
        assert!(keys.len() > 35, "{}", keys.len());
        // In the unit that the file states them in: no quantity stands there twice.
        let text = format!("{AXIS}\n[thermal]\ntable_capacity_kj_per_k = 100\n");
        let stated = Axis::parse("axis.toml", &text).unwrap();
        let spelt = stated.thermal_keys_of(&other);
        assert!(
            spelt
                .iter()
                .any(|(key, _)| key == "table_capacity_kj_per_k")
        );
        let lines: String = keys
            .iter()
            .map(|(key, v)| format!("{key} = {v:?}\n"))
            .collect();
        let again = Axis::parse("axis.toml", &format!("{AXIS}\n[thermal]\n{lines}")).unwrap();
        let mut found = again.thermal_parameters();
        for (name, number) in NUMBERS {
            let (a, b) = (
                number(&mut found).map(|v| *v),
                number(&mut other).map(|v| *v),
            );
            let (Some(a), Some(b)) = (a, b) else { continue };
            assert!((a - b).abs() <= 1e-12 * b.abs(), "{name}: {a} {b}");
        }
    }
}
