//! Tables that name a kind: what else they have follows from it.

use serde_json::{Map, Value, json};

use super::super::keys::SHARE;
use super::super::layout::kinds_key;
use super::super::loop_keys::loop_keys;
use super::super::registry::Registry;
use super::key::{closed, properties};
use super::reference;
use crate::effects::Effect;
use crate::freedom::Freedom;
use crate::part::{Key, Known, PartKind, number, text_of};

/// Definitions of the parts' tables, by kind.
pub(super) fn part_tables(registry: &Registry, defs: &mut Map<String, Value>) {
    by_kind("mechanism", &registry.mechanisms, &[], defs);
    by_kind("actuator", &registry.actuators, &[], defs);
    let both = [Freedom::Linear, Freedom::Rotary].map(loop_keys).concat();
    by_kind("control", &registry.controls, &both, defs);
    by_kind("friction", &registry.frictions, &[], defs);
    by_kind("load", &registry.loads, &[], defs);
    by_kind("sensor", &registry.sensors, &[], defs);
    let effect = effects(&registry.effects, defs);
    defs.insert("effect".to_owned(), effect);
    defs.insert("tolerances".to_owned(), closed(&tolerances(registry)));
    let sensor = || reference("sensor");
    defs.insert(
        "sensors".to_owned(),
        json!({
            "type": "object",
            "properties": { "load": sensor(), "motor": sensor() },
            "additionalProperties": false,
        }),
    );
}

/// Tables of this item.
pub(super) fn list(item: Value) -> Value {
    json!({ "type": "array", "items": item })
}

/// `section`, a table that names its kind, and one definition a kind, with `own` keys beside.
fn by_kind<P: ?Sized>(
    section: &str,
    kinds: &[&'static PartKind<P>],
    own: &[Key],
    defs: &mut Map<String, Value>,
) {
    let key = kinds_key(kinds);
    let tables = kinds.iter().map(|kind| {
        let mut keys = vec![key.clone()];
        keys.extend(kind.keys.iter().cloned());
        let mut table = closed(&keys);
        beside(&mut table, own);
        (kind.name, kind.summary, table)
    });
    let tables = tables.collect();
    let of = chosen("kind", &key, section, tables, defs);
    defs.insert(section.to_owned(), of);
}

/// Keys that several kinds have besides; the same name may stand in several units.
fn beside(table: &mut Value, own: &[Key]) {
    if own.is_empty() {
        return;
    }
    let mut extra = closed(own);
    if let Some(all) = table["properties"].as_object_mut() {
        all.extend(own.iter().flat_map(properties));
    }
    for list in ["required", "allOf"] {
        let mut all = table[list].as_array().cloned().unwrap_or_default();
        let more = extra[list].as_array_mut().map(std::mem::take);
        all.extend(more.unwrap_or_default());
        all.dedup();
        if !all.is_empty() {
            table[list] = Value::Array(all);
        }
    }
}

/// A table of which `word` chooses one of several.
fn chosen(
    word: &str,
    key: &Key,
    section: &str,
    tables: Vec<(&'static str, &'static str, Value)>,
    defs: &mut Map<String, Value>,
) -> Value {
    let rules: Vec<Value> = tables
        .into_iter()
        .map(|(name, summary, mut table)| {
            table["properties"][word] = json!({ "const": name });
            table["title"] = json!(name);
            table["description"] = json!(summary);
            let definition = format!("{section}.{name}");
            let is_it = json!({ "properties": { word: { "const": name } }, "required": [word] });
            let rule = json!({ "if": is_it, "then": reference(&definition) });
            defs.insert(definition, table);
            rule
        })
        .collect();
    let words: Map<String, Value> = properties(key).into_iter().collect();
    json!({ "type": "object", "properties": words, "required": [word], "allOf": rules })
}

/// `[[effects]]`: limits of their numbers follow the axis, so that none stands here.
fn effects(all: &[&'static Effect], defs: &mut Map<String, Value>) -> Value {
    let key = Key::of_words("name", all.iter().map(|effect| effect.name).collect());
    let tables = all.iter().map(|effect| {
        let number = |p: &crate::effects::EffectParameter| {
            let unit = p.measure.unit(Freedom::Linear);
            let what = format!("a number in SI units, {unit} if the load moves along a line");
            let what = match unit {
                "" => "a number".to_owned(),
                _ => what,
            };
            (
                p.name.to_owned(),
                json!({ "type": "number", "description": what }),
            )
        };
        let numbers: Map<String, Value> = effect.parameters.iter().map(number).collect();
        let mut required: Vec<&str> = effect.parameters.iter().map(|p| p.name).collect();
        required.push("name");
        let table = json!({
            "type": "object",
            "properties": numbers,
            "required": required,
            "additionalProperties": false,
        });
        (effect.name, effect.summary, table)
    });
    let tables = tables.collect();
    chosen("name", &key, "effect", tables, defs)
}

/// `[tolerances]`, of the known parameters of any kind.
fn tolerances(registry: &Registry) -> Vec<Key> {
    fn of<P: ?Sized>(kinds: &[&'static PartKind<P>]) -> impl Iterator<Item = &'static Known> {
        kinds.iter().flat_map(|kind| kind.known)
    }
    let known = of(&registry.mechanisms)
        .chain(of(&registry.actuators))
        .chain(of(&registry.controls))
        .chain(of(&registry.frictions))
        .chain(of(&registry.loads));
    let known = known.map(|known| text_of(known.name, SHARE).optional());
    let default = number("known_parameters_percent", 1e-3, 100.0).optional();
    std::iter::once(default).chain(known).collect()
}
