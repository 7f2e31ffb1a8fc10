//! The tables in docs/axis-file.md and docs/effects.md, made from the kinds, their keys and the effects.

use super::keys::keys;
use super::layout::Layout;
use super::registry::Registry;
use crate::SixDigits;
use crate::actuator::Effort;
use crate::effects::{EFFECTS, EffectParameter};
use crate::freedom::Freedom;
use crate::part::{Key, Kind, PartKind, named};
use crate::value_range::ValueRange;

const KEYS: (&str, &str) = (
    "docs/axis-file.md",
    include_str!("../../../../docs/axis-file.md"),
);
const EFFECT_NUMBERS: (&str, &str) = (
    "docs/effects.md",
    include_str!("../../../../docs/effects.md"),
);

fn interval(limits: &ValueRange) -> String {
    format!("{} to {}", SixDigits(limits.least), SixDigits(limits.most))
}

/// Rows of the keys below `path`.
fn rows(path: &str, keys: &[Key], rows: &mut Vec<String>) {
    for key in keys {
        let name = format!("{path}{}", key.name);
        let (units, valid) = match &key.kind {
            Kind::Quantity(dimension, limits) => {
                let names: Vec<&str> = dimension.units.iter().map(|(unit, _)| *unit).collect();
                let si = dimension.units.iter().find(|(_, factor)| *factor == 1.0);
                (
                    names.join(", "),
                    format!("{} {}", interval(limits), si.unwrap().0),
                )
            }
            Kind::Number(_, limits) => (String::new(), interval(limits)),
            Kind::Count(least, most) => (String::new(), format!("whole, {least} to {most}")),
            Kind::Text(_) => (String::new(), "text".to_owned()),
            Kind::Word(words) => (String::new(), words.join(" or ")),
            Kind::Table(keys) => {
                self::rows(&format!("{path}{}.", key.name), keys, rows);
                continue;
            }
            Kind::Tables(keys) => {
                self::rows(&format!("{path}{}[].", key.name), keys, rows);
                continue;
            }
        };
        let left_out = key.left_out(1.0);
        rows.push(format!("| `{name}` | {units} | {valid}{left_out} |"));
    }
}

const HEAD: &str = "| key | units | valid |\n|---|---|---|\n";

fn kinds<P: ?Sized>(sections: &str, kinds: &[&'static PartKind<P>], text: &mut String) {
    *text += &format!("## {sections}\n\n");
    for kind in kinds {
        let mut lines = Vec::new();
        rows("", kind.keys, &mut lines);
        *text += &format!(
            "### `{}`\n{}.\n\n{HEAD}{}\n\n",
            kind.name,
            kind.summary,
            lines.join("\n")
        );
    }
}

/// What belongs to no part, of the kinds that a file's sections may name first.
fn own() -> String {
    let registry = Registry::default();
    let layout = Layout {
        mechanism: named(&registry.mechanisms, "rack").unwrap(),
        actuator: named(&registry.actuators, "pmsm-foc").unwrap(),
        control: named(&registry.controls, "p-pi").unwrap(),
        friction: named(&registry.frictions, "lugre").unwrap(),
        loads: Vec::new(),
    };
    let mut lines = Vec::new();
    let parts = ["mechanism", "actuator", "friction", "tolerances"];
    for key in keys(&layout, Freedom::Linear, Effort::Current) {
        if parts.contains(&key.name) {
            continue;
        }
        let key = match key.kind {
            // The controller's own are in its kind's table.
            Kind::Table(keys) if key.name == "control" => {
                let own =
                    |k: &Key| ["frequency", "following_error_limit", "gains"].contains(&k.name);
                Key::of_table("control", keys.iter().filter(|k| own(k)).cloned().collect())
            }
            _ => key,
        };
        rows("", &[key], &mut lines);
    }
    format!("{HEAD}{}\n\n", lines.join("\n"))
}

fn all_keys() -> String {
    let registry = Registry::default();
    let mut text = own();
    kinds("`[mechanism]`", &registry.mechanisms, &mut text);
    kinds("`[actuator]`", &registry.actuators, &mut text);
    kinds("`[control]`", &registry.controls, &mut text);
    kinds("`[friction]`", &registry.frictions, &mut text);
    kinds("`[[load]]`", &registry.loads, &mut text);
    kinds(
        "`[sensors.load]`, `[sensors.motor]`",
        &registry.sensors,
        &mut text,
    );
    text.truncate(text.trim_end().len());
    text + "\n"
}

fn effects() -> String {
    let mut text = "| effect | what | shows in | numbers, SI (size or shape) | needs |\n|---|---|---|---|---|\n".to_owned();
    for effect in EFFECTS {
        let number = |p: &EffectParameter| {
            let [least, most] = p.bounds;
            let (kind, range) = (
                if p.is_size() { "size" } else { "shape" },
                ValueRange { least, most },
            );
            let unit = p.measure.unit(Freedom::Linear);
            let text = format!("`{}` {} {unit}", p.name, interval(&range));
            format!("{} ({kind})", text.trim_end())
        };
        let numbers: Vec<String> = effect.parameters.iter().map(number).collect();
        let needs: Vec<&str> = effect.needs.iter().map(|need| need.name()).collect();
        text += &format!(
            "| `{}` | {} | {} | {} | {} |\n",
            effect.name,
            effect.summary,
            effect.channel.name(),
            numbers.join("; "),
            needs.join("; ")
        );
    }
    text
}

fn check((name, page): (&str, &str), mark: &str, expected: &str) {
    let from = page.find(&format!("<!-- {mark}:")).unwrap();
    let (_, page) = page[from..].split_once("-->\n").unwrap();
    let (page, _) = page.split_once("<!-- end -->").unwrap();
    assert!(page == expected, "{name} must have:\n{expected}");
}

#[test]
fn the_page_has_the_keys_of_the_code() {
    check(KEYS, "keys", &all_keys());
}

#[test]
fn the_page_has_the_effects_of_the_registry() {
    check(EFFECT_NUMBERS, "effects", &effects());
}

/// The limits that a message shows in a unit are accepted in that unit, and
/// what is a hundredth beyond them is not.
#[test]
fn limits_hold_in_every_unit() {
    fn check(keys: &[Key]) {
        for key in keys {
            match &key.kind {
                Kind::Table(keys) | Kind::Tables(keys) => check(keys),
                Kind::Quantity(dimension, limits) => {
                    for unit in dimension.units {
                        let valid = key.valid(Some(*unit));
                        let mut words = valid.split([' ', ',']);
                        let mut next = |after: &str| -> f64 {
                            words.find(|word| *word == after).unwrap();
                            words.next().unwrap().parse().unwrap()
                        };
                        let (least, most) = (next("from") * unit.1, next("to") * unit.1);
                        // Six digits are shown, and unit factors such as rpm have more.
                        let near = |a: f64, b: f64| (a - b).abs() <= 5e-6 * b.abs();
                        assert!(
                            near(least, limits.least) && near(most, limits.most),
                            "{valid}"
                        );
                        assert!(!limits.takes(most + 0.01 * most.abs()), "{valid}");
                        assert!(
                            !limits.takes(least - 0.01 * least.abs().max(1e-12)),
                            "{valid}"
                        );
                    }
                }
                _ => {}
            }
        }
    }
    fn of<P: ?Sized>(kinds: &[&'static PartKind<P>]) {
        kinds.iter().for_each(|kind| check(kind.keys));
    }
    let registry = Registry::default();
    of(&registry.mechanisms);
    of(&registry.actuators);
    of(&registry.controls);
    of(&registry.frictions);
    of(&registry.loads);
    of(&registry.sensors);
}
