//! The tables in docs/theory/axis-sim.md, made from the keys and the effects.

use super::key::{Key, Kind};
use super::keys::{BALL_SCREW, RIGID_MASS};
use crate::SixDigits;
use crate::axis::Range;
use crate::effects::EFFECTS;

const PAGE: &str = include_str!("../../../../docs/theory/axis-sim.md");

fn interval(limits: &Range) -> String {
    format!("{} to {}", SixDigits(limits.least), SixDigits(limits.most))
}

/// Rows of the keys below `path`.
fn rows(path: &str, keys: &[Key], rows: &mut Vec<String>) {
    for key in keys {
        let name = format!("{path}{}", key.name);
        let (units, valid) = match &key.kind {
            Kind::Quantity(dimension, limits) => {
                let units = dimension.units();
                let names: Vec<&str> = units.iter().map(|(unit, _)| *unit).collect();
                let si = units.iter().find(|(_, factor)| *factor == 1.0).unwrap().0;
                (names.join(", "), format!("{} {si}", interval(limits)))
            }
            Kind::Number(_, limits) => (String::new(), interval(limits)),
            Kind::Count(least, most) => (String::new(), format!("whole, {least} to {most}")),
            Kind::Text => (String::new(), "text".to_owned()),
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
        rows.push(format!("| `{name}` | {units} | {valid} |"));
    }
}

fn keys() -> String {
    let (mut ball_screw, mut rigid) = (Vec::new(), Vec::new());
    rows("", BALL_SCREW, &mut ball_screw);
    rows("", RIGID_MASS, &mut rigid);
    let only = |row: &&String| !ball_screw.contains(row);
    let own: Vec<&String> = rigid.iter().filter(only).collect();
    let head = "| key | units | valid |\n|---|---|---|\n";
    let join = |rows: Vec<&String>| {
        let lines: Vec<&str> = rows.iter().map(|row| row.as_str()).collect();
        lines.join("\n")
    };
    format!(
        "{head}{}\n\nOnly of a rigid mass:\n\n{head}{}\n",
        join(ball_screw.iter().collect()),
        join(own)
    )
}

fn effects() -> String {
    let mut text = "| effect | what | shows in | numbers, SI (size or shape) | rigid mass |\n|---|---|---|---|---|\n".to_owned();
    for effect in EFFECTS {
        let number = |p: &crate::effects::EffectParameter| {
            let [least, most] = p.bounds;
            let (kind, range) = (if p.size { "size" } else { "shape" }, Range { least, most });
            let text = format!("`{}` {} {}", p.name, interval(&range), p.unit);
            format!("{} ({kind})", text.trim_end())
        };
        let numbers: Vec<String> = effect.parameters.iter().map(number).collect();
        text += &format!(
            "| `{}` | {} | {} | {} | {} |\n",
            effect.name,
            effect.summary,
            effect.channel.name(),
            numbers.join("; "),
            if effect.on_rigid { "yes" } else { "" }
        );
    }
    text
}

fn check(mark: &str, expected: &str) {
    let from = PAGE.find(&format!("<!-- {mark}:")).unwrap();
    let page = &PAGE[from..];
    let (_, page) = page.split_once("-->\n").unwrap();
    let (page, _) = page.split_once("<!-- end -->").unwrap();
    assert!(
        page == expected,
        "docs/theory/axis-sim.md must have:\n{expected}"
    );
}

#[test]
fn the_page_has_the_keys_of_the_code() {
    check("keys", &keys());
}

#[test]
fn the_page_has_the_effects_of_the_registry() {
    check("effects", &effects());
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
                    for unit in dimension.units() {
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
    check(BALL_SCREW);
    check(RIGID_MASS);
}
