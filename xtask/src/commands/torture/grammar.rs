//! Files made anew from the grammar of their keys: tables, keys and steps in any
//! order and number, values near those of a good file or far from them.

use axis_sim::effects::EFFECTS;

use super::mutate::{NASTY, number, numbers};
use super::random::Source;

/// An axis file: the tables of `base` in another order, with other values, some
/// effects, tolerances, and now and then a table or key too few.
pub fn axis(base: &str, random: &mut Source) -> String {
    let mut tables = tables(base);
    // What stands before the first table must stay there.
    random.shuffle(&mut tables[1..]);
    let mut text = String::new();
    for table in &mut tables {
        let is_move = table[0].starts_with("[[trajectory]]");
        if random.chance(0.01) {
            continue;
        }
        if table.len() > 2 {
            random.shuffle(&mut table[1..]);
        }
        for _ in 0..if is_move { random.below(3) } else { 1 } {
            for line in table.iter() {
                let mut line = line.clone();
                vary(&mut line, random);
                if !random.chance(0.002) {
                    text += &format!("{line}\n");
                }
            }
        }
    }
    for _ in 0..random.below(4) {
        text += &effect(random);
    }
    if random.chance(0.2) {
        text += &format!(
            "[tolerances]\nknown_parameters_percent = {}\n",
            value(2.0, random)
        );
    }
    text
}

/// A text in its tables: what stands before the first one, then each with its heading.
fn tables(base: &str) -> Vec<Vec<String>> {
    let mut tables = vec![Vec::new()];
    for line in base.lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.starts_with('[') {
            tables.push(Vec::new());
        }
        if let (Some(table), false) = (tables.last_mut(), line.is_empty()) {
            table.push(line.to_owned());
        }
    }
    tables
}

/// Most values stay or move a little, a few become impossible.
fn vary(line: &mut String, random: &mut Source) {
    if line.starts_with("schema") || random.chance(0.8) {
        return;
    }
    if random.chance(0.02) {
        return number(line, random);
    }
    if let Some(range) = numbers(line).first().cloned()
        && let Ok(old) = line[range.clone()].parse::<f64>()
    {
        let whole = !line[range.clone()].contains(['.', 'e']) && old.abs() < 200.0;
        let new = old * 1.5f64.powf(2.0 * random.unit() - 1.0);
        let new = if whole { new.round() } else { new };
        line.replace_range(range, &format!("{new}"));
    }
}

/// An entry of `[[effects]]` with most of its parameters.
fn effect(random: &mut Source) -> String {
    let effect = random.pick(EFFECTS);
    let mut text = format!("[[effects]]\nname = \"{}\"\n", effect.name);
    for parameter in effect.parameters {
        if !random.chance(0.02) {
            let [least, most] = parameter.bounds;
            let near = parameter.typical * 10f64.powf(2.0 * random.unit() - 1.0);
            let near = if random.chance(0.05) {
                *random.pick(&[least, most])
            } else {
                near
            };
            text += &format!("{} = {}\n", parameter.name, value(near, random));
        }
    }
    text
}

fn value(near: f64, random: &mut Source) -> String {
    if random.chance(0.05) {
        return (*random.pick(&NASTY)).to_owned();
    }
    format!("{near:e}")
}

/// A motion program of up to eight steps of any kind.
pub fn program(random: &mut Source) -> String {
    let mut text = format!("start_mm = {}\n", value(600.0, random));
    for _ in 0..random.below(9) {
        let (kind, keys): (&str, &[(&str, f64)]) = *random.pick(&[
            (
                "move",
                &[
                    ("to_mm", 650.0),
                    ("velocity_mm_s", 100.0),
                    ("acceleration_mm_s2", 225.0),
                    ("jerk_mm_s3", 1200.0),
                ][..],
            ),
            (
                "move_by",
                &[
                    ("by_mm", -20.0),
                    ("velocity_mm_s", 100.0),
                    ("acceleration_mm_s2", 225.0),
                    ("jerk_mm_s3", 1200.0),
                ],
            ),
            ("dwell", &[("duration_s", 0.3)]),
            (
                "sine",
                &[
                    ("amplitude_mm", 1.0),
                    ("frequency_hz", 5.0),
                    ("cycles", 3.0),
                ],
            ),
            (
                "chirp",
                &[
                    ("amplitude_mm", 0.1),
                    ("from_frequency_hz", 1.0),
                    ("to_frequency_hz", 50.0),
                    ("duration_s", 2.0),
                    ("ramp_s", 0.2),
                ],
            ),
        ]);
        let one = |&(key, near): &(&str, f64)| {
            let near = near * 10f64.powf(2.0 * random.unit() - 1.0);
            let shown = if key == "cycles" && !random.chance(0.1) {
                format!("{}", near.round())
            } else {
                value(near, random)
            };
            format!("{key} = {shown}")
        };
        let mut keys: Vec<String> = keys.iter().map(one).collect();
        if kind == "chirp" && random.chance(0.5) {
            keys.push(format!(
                "sweep = \"{}\"",
                random.pick(&["linear", "logarithmic", "other"])
            ));
        }
        text += &format!("[[steps]]\n{kind} = {{ {} }}\n", keys.join(", "));
    }
    text
}
