//! What belongs to no part: stroke, step, effects, tolerances, columns of logs.

use std::collections::BTreeMap;

use axis_log::{ColumnMap, ColumnUnit, Mapping};

use super::error::AxisFileError;
use super::fields::Fields;
use super::keys::SHARE;
use crate::SixDigits;
use crate::axis::{Axis, BalanceSettings, Stroke, Tolerances};
use crate::effects::{ActiveEffect, Effect, EffectParameter, Scales};
use crate::freedom::Freedom;
use crate::part::units::{MOTOR_SPEED, MOTOR_TORQUE};
use crate::part::{Key, Known, Values};
use crate::rating::{
    AxisDuty, DataSheets, MOTOR_CURVE, MotorPoint, RATING_KEYS, about, is_linear_unit,
};
use crate::thermal::{THERMAL_KEYS, is_of_screws};
use crate::value_range::ValueRange;
use crate::work::{MOST_SUBSTEPS, substeps_of};

/// The entries of `[[effects]]`: `name`, and each parameter in SI units.
pub(super) fn effects(
    root: &Fields<'_>,
    axis: &Axis,
    effects: &[&'static Effect],
) -> Result<Vec<ActiveEffect>, AxisFileError> {
    let scales = Scales::of(axis);
    // A search of logs takes the speed that these show (`Axis::fastest`), which may be far from what acceleration and stroke let expect.
    let speeds: &[f64] = match axis.trajectories.is_empty() {
        true => &[0.01, 1.0, 100.0],
        false => &[1.0],
    };
    let bounds = |p: &EffectParameter| {
        let all = speeds.iter().map(|by| p.bounds(&scales.faster(*by)));
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [low, high]| {
            [a.min(low), b.max(high)]
        })
    };
    let names = || effects.iter().map(|effect| effect.name);
    let keys = |parameters: &mut dyn Iterator<Item = &EffectParameter>| -> Vec<Key> {
        let parameter = |p: &EffectParameter| Key::of_effect(p.name, p.unit(&scales), bounds(p));
        std::iter::once(Key::of_words("name", names().collect()))
            .chain(parameters.map(parameter))
            .collect()
    };
    let all = || keys(&mut effects.iter().flat_map(|effect| effect.parameters));
    let one = |entry: Fields<'_>| {
        // Without a name, it may stand there misspelt beside the parameters of any effect.
        let entry = if entry.has("name") {
            entry
        } else {
            entry.with_keys(all())?
        };
        let name = entry.word("name")?;
        let fits = |effect: &&&Effect| effect.applies_to(axis).is_ok();
        let refuse = |what: &str| {
            let names: Vec<&str> = effects.iter().filter(fits).map(|e| e.name).collect();
            let what = format!("is \"{name}\": {what}");
            entry.refuse_value("name", what, names.join(", "))
        };
        let effect = effects.iter().copied().find(|effect| effect.name == name);
        let effect = effect.ok_or_else(|| refuse("there is no such effect"))?;
        effect.applies_to(axis).map_err(|why| refuse(&why))?;
        let entry = entry.with_keys(keys(&mut effect.parameters.iter()))?;
        let value = |p: &EffectParameter| entry.number(p.name);
        let values = effect.parameters.iter().map(value);
        Ok(ActiveEffect {
            effect,
            values: values.collect::<Result<_, _>>()?,
        })
    };
    let entries = root.unchecked("effects", all())?;
    entries.into_iter().map(one).collect()
}

/// `[tolerances]`: how far known parameters may be off; 1 % unless it says more.
pub(super) fn tolerances(
    root: &Fields<'_>,
    known: &[&'static Known],
) -> Result<Tolerances, AxisFileError> {
    let Some(f) = root.optional_table("tolerances")? else {
        return Ok(Tolerances::all(0.01));
    };
    let default = f.optional_number("known_parameters_percent")?;
    let mut by_name = BTreeMap::new();
    for known in known {
        if f.has(known.name) {
            let share = share(&f, known.name)?;
            f.keep(known.name, share);
            by_name.insert(known.name, share);
        }
    }
    Ok(Tolerances {
        default: default.map_or(0.01, |percent| percent / 100.0),
        by_name,
    })
}

/// `"20 %"`, or `"unknown"`.
fn share(f: &Fields<'_>, name: &str) -> Result<f64, AxisFileError> {
    let text = f.text(name)?;
    if text.trim() == "unknown" {
        return Ok(Tolerances::UNKNOWN);
    }
    let percent = text.trim().strip_suffix('%').map(str::trim);
    let percent = percent.and_then(|p| p.strip_prefix('±').unwrap_or(p).trim().parse::<f64>().ok());
    let share = percent.map(|percent| percent / 100.0);
    let valid = |share: &f64| (1e-5..=Tolerances::UNKNOWN).contains(share);
    share.filter(valid).ok_or_else(|| {
        let what = format!("is \"{text}\"");
        f.refuse_value(name, what, SHARE.to_owned())
    })
}

/// `[log]`: columns of the drive's own logs to channels.
pub(super) fn log(root: &Fields<'_>) -> Result<Mapping, AxisFileError> {
    let Some(f) = root.optional_table("log")? else {
        return Ok(Mapping::default());
    };
    let columns = f.tables("column")?;
    Ok(Mapping {
        columns: columns.iter().map(column).collect::<Result<_, _>>()?,
        sample_rate_hz: f.optional_number("sample_rate")?,
    })
}

/// One column: `unit`, `counts_per_turn` and `factor` (once called `scale`) make its scale.
fn column(c: &Fields<'_>) -> Result<ColumnMap, AxisFileError> {
    let factor = c.optional_number("factor")?;
    let scale = c.optional_number("scale")?;
    if factor.is_some() && scale.is_some() {
        let valid = "one of them: scale is another name of factor";
        return Err(c.refuse_value("scale", "stands beside factor".to_owned(), valid.to_owned()));
    }
    let unit = ColumnUnit {
        unit: c.optional_text("unit")?,
        counts_per_turn: c.optional_number("counts_per_turn")?,
        factor: factor.or(scale),
    };
    let map = ColumnMap::in_unit(c.text("source")?, c.text("channel")?, unit);
    let map = map.map_err(|why| {
        c.refuse_table(
            format!("cannot be read: {why}"),
            "a column that makes its channel",
        )
    })?;
    Ok(ColumnMap {
        offset: c.optional_number("offset")?.unwrap_or(0.0),
        delay: 1e-3 * c.optional_number("delay_ms")?.unwrap_or(0.0),
        ..map
    })
}

/// `[balance]`: settings of the torque balance; what is left out is taken from the log.
pub(super) fn balance(root: &Fields<'_>) -> Result<BalanceSettings, AxisFileError> {
    let Some(f) = root.optional_table("balance")? else {
        return Ok(BalanceSettings::default());
    };
    Ok(BalanceSettings {
        cutoff: f.optional_number("cutoff")?,
        slowest: f.optional_number("slowest")?,
    })
}

/// `[thermal]`: what is known of the axis' heat. Nothing is accepted that an axis without a screw
/// would not use.
pub(super) fn thermal(root: &Fields<'_>, has_screw: bool) -> Result<Values, AxisFileError> {
    let mut values = Values::default();
    let Some(f) = root.optional_table("thermal")? else {
        return Ok(values);
    };
    let of_screws = THERMAL_KEYS.iter().filter(|key| is_of_screws(key.name));
    let given = |key: &Key| key.spellings().into_iter().find(|spelling| f.has(spelling));
    if !has_screw && let Some(spelling) = of_screws.clone().find_map(given) {
        let what = "is about a screw, and the mechanism has none".to_owned();
        let others = THERMAL_KEYS.iter().filter(|key| !is_of_screws(key.name));
        let others: Vec<&str> = others.map(|key| key.name).collect();
        let valid = format!("{} (each with its unit)", others.join(", "));
        return Err(f.refuse_value(&spelling, what, valid));
    }
    f.part(THERMAL_KEYS, &mut values)?;
    Ok(values)
}

/// `[rating]`: what the data sheets of the axis' parts allow. Nothing is accepted that the axis cannot have.
pub(super) fn rating(root: &Fields<'_>, axis: &Axis) -> Result<DataSheets, AxisFileError> {
    let mut sheets = DataSheets::default();
    let Some(f) = root.optional_table("rating")? else {
        return Ok(sheets);
    };
    let linear = axis.mechanism.motor_freedom() == Freedom::Linear;
    let is_had = |key: &Key| about(key.name).is_none_or(|of| axis.is_about(of));
    for key in RATING_KEYS {
        let Some(spelling) = key.spellings().into_iter().find(|s| f.has(s)) else {
            continue;
        };
        sheets.stated += 1;
        if let Some(of) = about(key.name).filter(|of| !axis.is_about(*of)) {
            let what = format!("is about {}, and the axis has none", of.name());
            let others = RATING_KEYS.iter().filter(|key| is_had(key));
            let others: Vec<&str> = others.map(|key| key.name).collect();
            let valid = format!("{} (each with its unit)", others.join(", "));
            return Err(f.refuse_value(&spelling, what, valid));
        }
    }
    f.part(RATING_KEYS, &mut sheets.values)?;
    unit_of_motor(
        &f,
        &["continuous_torque", "peak_torque", "max_speed"],
        linear,
    )?;
    for point in f.tables(MOTOR_CURVE)? {
        unit_of_motor(
            &point,
            &["speed", "continuous_torque", "peak_torque"],
            linear,
        )?;
        sheets.motor_curve.push(MotorPoint {
            speed: point.number("speed")?,
            continuous: point.optional_number("continuous_torque")?,
            peak: point.optional_number("peak_torque")?,
        });
    }
    Ok(sheets)
}

/// A motor that moves along a line has a force, and a speed in m/s.
fn unit_of_motor(f: &Fields<'_>, keys: &[&str], linear: bool) -> Result<(), AxisFileError> {
    let units = [MOTOR_TORQUE.units, MOTOR_SPEED.units].concat();
    for (unit, _) in units {
        let spellings = keys.iter().map(|key| (key, format!("{key}_{unit}")));
        let wrong = |spelling: &String| f.has(spelling) && is_linear_unit(unit) != linear;
        if let Some((key, spelling)) = spellings.into_iter().find(|(_, s)| wrong(s)) {
            let (what, units) = match (linear, key.ends_with("speed")) {
                (true, true) => ("moves along a line", "m_per_s, mm_per_s or m_per_min"),
                (true, false) => ("moves along a line", "n"),
                (false, true) => ("turns", "rpm or rad_per_s"),
                (false, false) => ("turns", "n_m"),
            };
            let what = format!("has the unit {unit}, and the motor {what}");
            return Err(f.refuse_value(&spelling, what, format!("{key} in {units}")));
        }
    }
    Ok(())
}

/// Whether the numbers of `[rating]` go together.
pub(super) fn check_rating(root: &Fields<'_>, axis: &Axis) -> Result<(), AxisFileError> {
    let Some(f) = root.optional_table("rating")? else {
        return Ok(());
    };
    let checked = AxisDuty::of(axis).and_then(|duty| axis.checked(&duty));
    match checked {
        Ok(_) => Ok(()),
        Err(error) => Err(f.refuse_table(error.to_string(), "other values")),
    }
}

/// A control period has only so many internal steps.
pub(super) fn check_step(f: &Fields<'_>, period: f64, step: f64) -> Result<(), AxisFileError> {
    if substeps_of(period, step) <= f64::from(MOST_SUBSTEPS) {
        return Ok(());
    }
    let what = format!(
        "has a step of {} s, of which the control period of {} s has more than {}",
        SixDigits(step),
        SixDigits(period),
        MOST_SUBSTEPS
    );
    let least = period / f64::from(MOST_SUBSTEPS);
    Err(f.refuse_table(what, &format!("a step of {} s or longer", SixDigits(least))))
}

/// `[stroke]`, inside a mechanism's reach where it has one.
pub(super) fn stroke(
    f: &Fields<'_>,
    reach: Option<ValueRange>,
    freedom: Freedom,
) -> Result<Stroke, AxisFileError> {
    let unit = freedom.unit();
    let stroke = Stroke {
        minimum: f.number("minimum")?,
        maximum: f.number("maximum")?,
        start: f.number("start")?,
    };
    let between =
        |least, most| format!("{} {unit} to {} {unit}", SixDigits(least), SixDigits(most));
    let own = between(stroke.minimum, stroke.maximum);
    let inside = |r: &ValueRange| {
        let slack = |end: f64| 1e-12 * end.abs();
        stroke.minimum >= r.least - slack(r.least) && stroke.maximum <= r.most + slack(r.most)
    };
    if stroke.minimum >= stroke.maximum || !reach.as_ref().is_none_or(inside) {
        let (beside, valid) = match &reach {
            None => (String::new(), "minimum < maximum".to_owned()),
            Some(r) => (
                format!(
                    ", on a mechanism that reaches from {}",
                    between(r.least, r.most)
                ),
                format!(
                    "{} {unit} <= minimum < maximum <= {} {unit}",
                    SixDigits(r.least),
                    SixDigits(r.most)
                ),
            ),
        };
        return Err(f.refuse_table(format!("reaches from {own}{beside}"), &valid));
    }
    if !(stroke.minimum..=stroke.maximum).contains(&stroke.start) {
        let what = format!(
            "starts at {} {unit}, outside {own}",
            SixDigits(stroke.start)
        );
        return Err(f.refuse_table(what, "a start inside the stroke"));
    }
    Ok(stroke)
}
