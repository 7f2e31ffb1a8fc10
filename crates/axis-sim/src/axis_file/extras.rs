//! What both kinds of machine have: effects, tolerance, columns of logs.

use axis_log::{ColumnMap, Mapping};

use super::error::AxisFileError;
use super::fields::Fields;
use super::units::{FREQUENCY, Valid};
use crate::effects::{ActiveEffect, EFFECTS, Effect};

/// The entries of `[[effects]]`: `name`, and each parameter in SI units.
pub(super) fn effects(root: &Fields<'_>, rigid: bool) -> Result<Vec<ActiveEffect>, AxisFileError> {
    let known: Vec<(&str, &'static Effect)> = EFFECTS
        .iter()
        .filter(|effect| effect.on_rigid || !rigid)
        .map(|effect| (effect.name, *effect))
        .collect();
    let one = |f: Fields<'_>| {
        let effect = f.word("name", &known)?;
        let value = |p: &crate::effects::EffectParameter| {
            let value = f.number(p.name, Valid::Finite)?;
            let [least, most] = p.bounds;
            if (least..=most).contains(&value) {
                return Ok(value);
            }
            let what = format!("has {} = {value}", p.name);
            let valid = format!("{} from {least} to {most} {}", p.name, p.unit);
            Err(f.refuse_table(what, valid.trim_end()))
        };
        let values = effect
            .parameters
            .iter()
            .map(value)
            .collect::<Result<_, _>>()?;
        f.finish()?;
        Ok(ActiveEffect { effect, values })
    };
    root.tables("effects")?.into_iter().map(one).collect()
}

/// `[tolerances]`: how far known parameters may be off; 1 % unless it says more.
pub(super) fn tolerance(root: &Fields<'_>) -> Result<f64, AxisFileError> {
    let Some(f) = root.optional_table("tolerances")? else {
        return Ok(0.01);
    };
    let percent = f.number("known_parameters_percent", Valid::Positive)?;
    f.finish()?;
    Ok(percent / 100.0)
}

/// `[log]`: columns of the drive's own logs to channels.
pub(super) fn log(root: &Fields<'_>) -> Result<Mapping, AxisFileError> {
    let Some(f) = root.optional_table("log")? else {
        return Ok(Mapping::default());
    };
    let rate = f.optional_quantity("sample_rate", &FREQUENCY, Valid::Positive)?;
    let one = |c: Fields<'_>| {
        let map = ColumnMap {
            source: c.text("source")?.to_owned(),
            channel: c.text("channel")?.to_owned(),
            scale: c.optional_number("scale", 1.0)?,
            offset: c.optional_number("offset", 0.0)?,
        };
        c.finish()?;
        Ok(map)
    };
    let columns = f
        .tables("column")?
        .into_iter()
        .map(one)
        .collect::<Result<_, _>>()?;
    f.finish()?;
    Ok(Mapping {
        columns,
        sample_rate_hz: rate,
    })
}
