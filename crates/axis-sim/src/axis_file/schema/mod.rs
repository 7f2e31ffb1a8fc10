//! The JSON Schema of the axis file, made from the registry of kinds.
//!
//! It says what a table of keys can say: names, units, limits, words, what must be there, what
//! else may not. What takes several values together (a start inside the stroke, gains in units
//! of the actuator, effects that the axis has no part for, limits of an effect's numbers in
//! proportion to the axis) the reader alone refuses.

mod key;
mod parts;
#[cfg(test)]
mod tests;

use serde_json::{Map, Value, json};

use super::keys::keys;
use super::layout::{Layout, Section};
use super::loop_keys::loop_keys;
use super::registry::Registry;
use crate::actuator::Effort;
use crate::freedom::Freedom;
use crate::part::PartKind;
use crate::rating::rating_keys;
use crate::thermal::THERMAL_KEYS;
use key::{closed, without};
use parts::{list, part_tables};

/// Tables that follow how the load moves.
const BY_FREEDOM: [&str; 3] = ["stroke", "balance", "trajectory"];

impl Registry {
    /// The JSON Schema (draft 2020-12, <https://json-schema.org/draft/2020-12>) of the axis
    /// files that [`Axis::read_with`](crate::Axis::read_with) takes with this registry. A file that it refuses is refused by the reader; the reader refuses more,
    /// where values contradict each other.
    pub fn json_schema(&self) -> Value {
        let mut defs = Map::new();
        part_tables(self, &mut defs);
        defs.insert("thermal".to_owned(), closed(THERMAL_KEYS));
        defs.insert("rating".to_owned(), closed(&rating_keys()));
        for freedom in FREEDOMS {
            for effort in EFFORTS {
                self.by_movement(freedom, effort, &mut defs);
            }
        }
        let mut file = self.file();
        file["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
        file["title"] = json!("Axis file");
        file["description"] = json!(
            "A feed axis and its controller. The last part of a key is its unit. Made from the program's registry: `feed-axis schema axis`."
        );
        file["$defs"] = Value::Object(defs);
        file
    }

    /// The tables and keys of the file.
    fn file(&self) -> Value {
        let layout = self.any_layout();
        let keys = layout.map_or(Vec::new(), |layout| {
            keys(&layout, Freedom::Linear, Effort::Current)
        });
        let mut file = closed(&keys);
        for section in Section::ALL.map(Section::name) {
            file["properties"][section] = reference(section);
        }
        file["properties"]["load"] = list(reference("load"));
        file["properties"]["effects"] = list(reference("effect"));
        file["properties"]["tolerances"] = reference("tolerances");
        file["properties"]["sensors"] = reference("sensors");
        file["properties"]["thermal"] = reference("thermal");
        file["properties"]["rating"] = reference("rating");
        // Which of them, the movement tells.
        for name in BY_FREEDOM.iter().chain(&["samples"]) {
            file["properties"][name] = json!({});
        }
        let mut rules = Vec::new();
        for freedom in FREEDOMS {
            let mechanisms = self.mechanisms_that(freedom);
            let other = match freedom {
                Freedom::Linear => Freedom::Rotary,
                Freedom::Rotary => Freedom::Linear,
            };
            rules.push(json!({
                "if": kinds_are(&[("mechanism", &mechanisms)]),
                "then": { "properties": {
                    "stroke": reference(&of_freedom("stroke", freedom)),
                    "balance": reference(&of_freedom("balance", freedom)),
                    "trajectory": list(reference(&of_freedom("trajectory", freedom))),
                    "control": without(&loop_keys(other), &loop_keys(freedom)),
                } },
            }));
            for effort in EFFORTS {
                let actuators = self.actuators_that(effort);
                rules.push(json!({
                    "if": kinds_are(&[("mechanism", &mechanisms), ("actuator", &actuators)]),
                    "then": { "properties": { "samples": reference(&samples(freedom, effort)) } },
                }));
            }
        }
        // Only what is controlled is simulated.
        rules.push(
            json!({ "if": { "required": ["control"] }, "then": { "required": ["simulation"] } }),
        );
        file["allOf"] = Value::Array(rules);
        file
    }

    /// The tables that follow how the load moves and what the actuator takes.
    fn by_movement(&self, freedom: Freedom, effort: Effort, defs: &mut Map<String, Value>) {
        let Some(layout) = self.any_layout() else {
            return;
        };
        for key in keys(&layout, freedom, effort) {
            let name = match key.name() {
                "samples" => samples(freedom, effort),
                name if BY_FREEDOM.contains(&name) => of_freedom(name, freedom),
                _ => continue,
            };
            defs.insert(name, closed(key.keys()));
        }
    }

    /// The first kind of each section.
    fn any_layout(&self) -> Option<Layout> {
        Some(Layout {
            mechanism: self.mechanisms.first()?,
            actuator: self.actuators.first()?,
            control: self.controls.first()?,
            friction: self.frictions.first()?,
            loads: Vec::new(),
        })
    }

    fn mechanisms_that(&self, freedom: Freedom) -> Vec<&'static str> {
        names(&self.mechanisms, |part| part.freedom() == freedom)
    }

    fn actuators_that(&self, effort: Effort) -> Vec<&'static str> {
        names(&self.actuators, |part| part.effort() == effort)
    }
}

const FREEDOMS: [Freedom; 2] = [Freedom::Linear, Freedom::Rotary];
const EFFORTS: [Effort; 4] = [
    Effort::Current,
    Effort::Torque,
    Effort::Force,
    Effort::Voltage,
];

/// Kinds of whose parts it is seen that they are such.
fn names<P: ?Sized>(
    kinds: &[&'static PartKind<P>],
    such: impl Fn(&P) -> bool,
) -> Vec<&'static str> {
    let such = |kind: &&&'static PartKind<P>| kind.example().is_some_and(|part| such(&part));
    kinds.iter().filter(such).map(|kind| kind.name).collect()
}

/// The condition that the kinds of these sections are among those.
fn kinds_are(sections: &[(&str, &[&str])]) -> Value {
    let one = |(name, kinds): &(&str, &[&str])| {
        let kind = json!({ "properties": { "kind": { "enum": kinds } }, "required": ["kind"] });
        ((*name).to_owned(), kind)
    };
    let required: Vec<&str> = sections.iter().map(|(name, _)| *name).collect();
    json!({ "properties": sections.iter().map(one).collect::<Map<_, _>>(), "required": required })
}

fn of_freedom(table: &str, freedom: Freedom) -> String {
    let word = match freedom {
        Freedom::Linear => "linear",
        Freedom::Rotary => "rotary",
    };
    format!("{table}.{word}")
}

fn samples(freedom: Freedom, effort: Effort) -> String {
    let word = match effort {
        Effort::Current => "current",
        Effort::Torque => "torque",
        Effort::Force => "force",
        Effort::Voltage => "voltage",
    };
    format!("{}.{word}", of_freedom("samples", freedom))
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}
