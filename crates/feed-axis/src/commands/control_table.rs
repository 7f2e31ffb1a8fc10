//! The tables `[control]` and `[tolerances]` of an axis file, with an estimated controller.

use std::path::Path;

use axis_sim::Axis;
use axis_sim::control::{CONTROLS, Control, units_of_gain};
use axis_sim::part::{Key, Part};
use discrepancy::controller::{ControllerEstimate, Gain};
use drive_loop::TunedKey;
use miette::{IntoDiagnostic, Result, miette};
use toml_edit::{DocumentMut, Item, Table, Value};

/// Half width of an interval, as a share, up to which a gain is written as exact.
const EXACT: f64 = 1e-3;
/// Greatest tolerance that an axis file takes.
const WIDEST: f64 = 0.9;

/// Key with unit, as the file has or takes it, and the unit's factor to SI.
pub fn spelling(machine: &Axis, control: &Part<dyn Control>, key: &str) -> (String, f64) {
    let Some(known) = control.kind().keys.iter().find(|k| k.name() == key) else {
        return (key.to_owned(), 1.0);
    };
    let own = control.values().unit(key);
    let effort = machine.actuator.effort();
    let units = units_of_gain(&**control, known, effort, &*machine.mechanism);
    let unit = units.iter().find(|(unit, _)| *unit == own);
    match unit.or(units.first()) {
        Some((unit, factor)) => (format!("{key}_{unit}"), *factor),
        None => (key.to_owned(), 1.0),
    }
}

/// The tolerance of a gain, by its interval, as `[tolerances]` has it; none if it is exact.
pub fn tolerance(gain: &Gain) -> Option<String> {
    let half = 0.5 * (gain.ci95[1] - gain.ci95[0]);
    let share = half / gain.value.abs();
    (gain.value != 0.0 && share > EXACT).then(|| match share < WIDEST {
        // Rounded up.
        true => format!("{} %", (1e4 * share).ceil() / 100.0),
        false => "unknown".to_owned(),
    })
}

/// The axis file's text with the controller in its `[control]` and the gains' intervals in
/// `[tolerances]`; all else as it was. The control runs at `frequency` (Hz), or as the file says
/// if there is none.
pub fn with_control(
    text: &str,
    machine: &Axis,
    found: &ControllerEstimate,
    frequency: Option<f64>,
) -> Result<String> {
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    let kind = found.control.kind().name;
    let is_new = kind != machine.control.kind().name;
    let control = table(&mut document, "control")?;
    if is_new {
        let old = CONTROLS.iter().flat_map(|control| control.keys);
        for key in old.flat_map(spellings) {
            control.remove(&key);
        }
        set(control, "kind", kind.into());
    }
    if let Some(hz) = frequency {
        control.remove("frequency_khz");
        set(control, "frequency_hz", hz.into());
    }
    for (key, word) in &found.words {
        set(control, key, (*word).into());
    }
    for gain in &found.gains {
        let (name, factor) = spelling(machine, &found.control, gain.key);
        let limits = limits(&found.control, gain.key);
        set(control, &name, written(gain.value, factor, limits).into());
    }
    set(control, "gains", "estimated".into());
    write_tolerances(&mut document, found)?;
    if !document.contains_key("simulation") {
        let step = digits(1e6 * machine.period.min(machine.simulation.step));
        set(table(&mut document, "simulation")?, "step_us", step.into());
    }
    Ok(document.to_string())
}

/// How a file of tuned gains begins.
const TUNED: &str = "# Gains set by `feed-axis tune`, from ";

/// The axis file's text with the keys of a tuned axis, to seven digits, and the keys as they stand
/// there. Its first line says so, with the name of the file that they are from; comments behind the
/// keys' old values are gone.
pub fn with_tuned(text: &str, from: &Path, keys: Vec<TunedKey>) -> Result<(String, Vec<TunedKey>)> {
    let from = from.file_name().unwrap_or_default().display();
    let first = text.split_inclusive('\n').next();
    let text = match first.filter(|line| line.starts_with(TUNED)) {
        Some(line) => &text[line.len()..],
        None => text,
    };
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    let mut all = Vec::new();
    for key in keys {
        let value = written(key.value, 1.0, key.limits);
        let table = table(&mut document, key.section)?;
        let old = table.get(&key.key).and_then(Item::as_float);
        if old != Some(value) {
            // A comment behind the old value is about that value.
            table.insert(&key.key, Item::Value(value.into()));
        }
        all.push(TunedKey {
            before: key.before.map(digits),
            value,
            ..key
        });
    }
    let text = format!(
        "{TUNED}{from}; comments below on gains and margins are about that file.\n{document}"
    );
    Ok((text, all))
}

/// The gains' own lines in `[tolerances]`; those of the controller that was there are gone.
fn write_tolerances(document: &mut DocumentMut, found: &ControllerEstimate) -> Result<()> {
    let known = found.control.kind().known.iter().map(|known| known.name);
    let known: Vec<&str> = known.collect();
    if let Some(old) = document.get_mut("tolerances").and_then(Item::as_table_mut) {
        for known in CONTROLS.iter().flat_map(|control| control.known) {
            old.remove(known.name);
        }
    }
    for gain in found.gains.iter().filter(|gain| known.contains(&gain.key)) {
        if let Some(share) = tolerance(gain) {
            set(table(document, "tolerances")?, gain.key, share.into());
        }
    }
    Ok(())
}

/// The table of that name, new at the end if there is none.
pub(super) fn table<'a>(document: &'a mut DocumentMut, name: &str) -> Result<&'a mut Table> {
    let entry = document
        .entry(name)
        .or_insert_with(|| Item::Table(Table::new()));
    let found = entry.as_table_mut();
    found.ok_or_else(|| miette!("{name} is no table; valid: [{name}] on a line of its own"))
}

/// All ways to write a key.
fn spellings(key: &Key) -> Vec<String> {
    let units = key
        .units()
        .iter()
        .map(|(unit, _)| format!("{}_{unit}", key.name()));
    units.chain([key.name().to_owned()]).collect()
}

/// Sets a value, a comment behind it kept.
fn set(table: &mut Table, key: &str, mut value: Value) {
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
}

/// The least and the greatest value of a key, in SI units.
pub fn limits(control: &Part<dyn Control>, key: &str) -> Option<[f64; 2]> {
    let known = control.kind().keys.iter().find(|k| k.name() == key);
    known.and_then(Key::limits)
}

/// Seven digits of a value in a unit of this factor; all of them where seven would leave the limits.
fn written(value: f64, factor: f64, limits: Option<[f64; 2]>) -> f64 {
    let rounded = digits(value / factor);
    let holds = |[least, most]: [f64; 2]| (least..=most).contains(&(rounded * factor));
    match limits.is_none_or(holds) {
        true => rounded,
        false => value / factor,
    }
}

/// Seven digits of a number.
pub(super) fn digits(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gain(value: f64, half: f64) -> Gain {
        Gain {
            key: "kv",
            value,
            ci95: [value - half, value + half],
        }
    }

    #[test]
    fn a_tolerance_holds_the_interval() {
        assert_eq!(tolerance(&gain(20.0, 0.01)), None);
        assert_eq!(tolerance(&gain(20.0, 0.5)).unwrap(), "2.5 %");
        assert_eq!(tolerance(&gain(3.0, 0.1)).unwrap(), "3.34 %");
        assert_eq!(tolerance(&gain(3.0, 30.0)).unwrap(), "unknown");
        assert_eq!(tolerance(&gain(0.0, 30.0)), None);
    }

    /// 1e9 rad/s per m is 9549296.585513721 rpm/mm, and 9549297 is more.
    #[test]
    fn a_value_at_its_limit_is_not_rounded_beyond_it() {
        let rpm_per_mm = std::f64::consts::TAU / 60.0 * 1e3;
        let limits = Some([0.0, 1e9]);
        assert_eq!(digits(1e9 / rpm_per_mm), 9_549_297.0);
        let most = written(1e9, rpm_per_mm, limits);
        assert!((most * rpm_per_mm / 1e9 - 1.0).abs() < 1e-15 && most < 9_549_297.0);
        assert_eq!(written(1.0 / 3.0, 1.0, limits), 0.333_333_3);
        assert_eq!(written(17.59, 1.0, None), 17.59);
    }

    #[test]
    fn a_tuned_value_loses_the_comment_on_the_old_one() {
        let key = |value| TunedKey {
            section: "control",
            key: "kv_per_s".to_owned(),
            before: Some(20.0),
            value,
            limits: None,
        };
        let text = "# An axis.\n[control]\nkv_per_s = 20.0 # 1.2 m/min per mm\n";
        let same = with_tuned(text, Path::new("a/x.toml"), vec![key(20.0)]).unwrap();
        let first = "# Gains set by `feed-axis tune`, from x.toml; comments below on gains and margins are about that file.\n";
        assert_eq!(same.0, format!("{first}{text}"));
        // Tuned again: one such line.
        let again = with_tuned(&same.0, Path::new("x.toml"), vec![key(30.0)]).unwrap();
        assert_eq!(
            again.0,
            format!("{first}# An axis.\n[control]\nkv_per_s = 30.0\n")
        );
    }

    #[test]
    fn a_value_keeps_its_comment() {
        let mut document: DocumentMut = "[control]\nkv_per_s = 20 # as ordered\n".parse().unwrap();
        set(
            table(&mut document, "control").unwrap(),
            "kv_per_s",
            16.7.into(),
        );
        assert_eq!(
            document.to_string(),
            "[control]\nkv_per_s = 16.7 # as ordered\n"
        );
    }
}
