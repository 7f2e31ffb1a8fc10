//! What both kinds of machine have: stroke, step, effects, tolerance, columns of logs.

use axis_log::{ColumnMap, Mapping};

use super::error::AxisFileError;
use super::fields::Fields;
use super::key::Key;
use crate::SixDigits;
use crate::axis::Stroke;
use crate::effects::{ActiveEffect, EFFECTS, Effect, EffectParameter};
use crate::work::{MOST_SUBSTEPS, substeps_of};

/// The entries of `[[effects]]`: `name`, and each parameter in SI units.
pub(super) fn effects(root: &Fields<'_>, rigid: bool) -> Result<Vec<ActiveEffect>, AxisFileError> {
    let all = || keys(EFFECTS.iter().flat_map(|effect| effect.parameters));
    let one = |entry: Fields<'_>| {
        // Without a name, it may stand there misspelt beside the parameters of any effect.
        let entry = if entry.has("name") {
            entry
        } else {
            entry.with_keys(all())?
        };
        let name = entry.word("name")?;
        let fits = |effect: &&&Effect| effect.fits(rigid).is_ok();
        let refuse = |what: &str| {
            let names: Vec<&str> = EFFECTS.iter().filter(fits).map(|e| e.name).collect();
            let what = format!("is \"{name}\": {what}");
            entry.refuse_value("name", what, names.join(", "))
        };
        let effect = Effect::named(name).ok_or_else(|| refuse("there is no such effect"))?;
        effect.fits(rigid).map_err(refuse)?;
        let entry = entry.with_keys(keys(effect.parameters.iter()))?;
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

/// The keys of an entry with these parameters.
fn keys<'a>(parameters: impl Iterator<Item = &'a EffectParameter>) -> Vec<Key> {
    let parameter = |p: &EffectParameter| Key::of_effect(p.name, p.unit, p.bounds);
    let names = EFFECTS.iter().map(|effect| effect.name).collect();
    std::iter::once(Key::of_words("name", names))
        .chain(parameters.map(parameter))
        .collect()
}

/// `[tolerances]`: how far known parameters may be off; 1 % unless it says more.
pub(super) fn tolerance(root: &Fields<'_>) -> Result<f64, AxisFileError> {
    match root.optional_table("tolerances")? {
        Some(f) => Ok(f.number("known_parameters_percent")? / 100.0),
        None => Ok(0.01),
    }
}

/// `[log]`: columns of the drive's own logs to channels.
pub(super) fn log(root: &Fields<'_>) -> Result<Mapping, AxisFileError> {
    let Some(f) = root.optional_table("log")? else {
        return Ok(Mapping::default());
    };
    let one = |c: Fields<'_>| {
        Ok(ColumnMap {
            source: c.text("source")?.to_owned(),
            channel: c.text("channel")?.to_owned(),
            scale: c.optional_number("scale")?.unwrap_or(1.0),
            offset: c.optional_number("offset")?.unwrap_or(0.0),
        })
    };
    let columns = f.tables("column")?;
    Ok(Mapping {
        columns: columns.into_iter().map(one).collect::<Result<_, _>>()?,
        sample_rate_hz: f.optional_number("sample_rate")?,
    })
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

/// `[stroke]`, on a screw of a length (m) where there is one.
pub(super) fn stroke(f: &Fields<'_>, screw_length: Option<f64>) -> Result<Stroke, AxisFileError> {
    let stroke = Stroke {
        minimum: f.number("minimum")?,
        maximum: f.number("maximum")?,
        start: f.number("start")?,
    };
    let reach = format!(
        "{} m to {} m",
        SixDigits(stroke.minimum),
        SixDigits(stroke.maximum)
    );
    let on_screw = screw_length.is_none_or(|l| stroke.minimum >= 0.0 && stroke.maximum <= l);
    if !(stroke.minimum < stroke.maximum && on_screw) {
        let screw = screw_length.map_or(String::new(), |l| {
            format!(" on a screw of {} m", SixDigits(l))
        });
        let valid = match screw_length {
            Some(_) => "0 <= minimum < maximum <= the screw's length",
            None => "minimum < maximum",
        };
        return Err(f.refuse_table(format!("reaches from {reach}{screw}"), valid));
    }
    if !(stroke.minimum..=stroke.maximum).contains(&stroke.start) {
        let what = format!("starts at {} m, outside {reach}", SixDigits(stroke.start));
        return Err(f.refuse_table(what, "a start inside the stroke"));
    }
    Ok(stroke)
}
