//! The axis file with the friction that was identified.

use std::path::Path;

use axis_sim::friction::{FRICTIONS, Friction as AxisFriction, FrictionPlace};
use axis_sim::mechanism::Freedom;
use axis_sim::part::{Key, PartKind};
use axis_sim::{Axis, SixDigits};
use miette::{IntoDiagnostic, Result};
use toml_edit::{DocumentMut, Item, Table, Value};

use super::friction::{Found, Friction};
use crate::commands::control_table::{digits, table};
use crate::commands::moved_file::moved;
use crate::context::Context;

/// Its name among the results.
pub(super) const NAME: &str = "axis.toml";

/// Keys of a LuGre friction, in the order of [`Friction::law`] and [`Friction::parameters`].
const KEYS: [(&str, &str); 6] = [
    ("coulomb", "T_C"),
    ("stiction", "T_S"),
    ("stribeck_speed", "Ω_S"),
    ("bristle_stiffness", "σ0"),
    ("bristle_damping", "σ1"),
    ("viscous", "σ2"),
];

/// The text of the axis file with `found` as its `[friction]`, in SI units, for a file in `folder`; its comments say how sure each number is.
pub(super) fn with_friction(context: &Context, folder: &Path, found: &Friction) -> Result<String> {
    let old = &context.axis.friction;
    let kind = lugre_at(old.at);
    let text = moved(&context.axis_text, &context.axis_file, folder)?;
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    let friction = table(&mut document, "friction")?;
    let mut decor = friction.decor().clone();
    // What stood beside the old numbers is about them.
    decor.set_suffix("   # found by `identify`, with 95 % intervals");
    *friction = Table::new();
    *friction.decor_mut() = decor;
    friction.insert("kind", Item::Value(kind.name.into()));
    for ((name, symbol), &value) in KEYS.iter().zip(&found.law) {
        let key = kind.keys.iter().find(|key| key.name() == *name);
        let Some((spelling, limits)) = key.map(spelled) else {
            continue;
        };
        let [least, most] = limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let mut value = Value::from(digits(value).clamp(least, most));
        if let Some(found) = found.parameters.iter().find(|found| found.name == *symbol) {
            value
                .decor_mut()
                .set_suffix(format!("   # {}", how_sure(found)));
        }
        friction.insert(&spelling, Item::Value(value));
    }
    // Tolerances of numbers that this friction does not have.
    if let Some(tolerances) = document.get_mut("tolerances").and_then(Item::as_table_mut) {
        let has = |name: &str| kind.known.iter().any(|known| known.name == name);
        for known in old.kind().known.iter().filter(|known| !has(known.name)) {
            tolerances.remove(known.name);
        }
    }
    let text = document.to_string();
    Axis::parse(&folder.join(NAME).display().to_string(), &text)?;
    Ok(text)
}

/// The kind of LuGre friction in that coordinate.
fn lugre_at(at: FrictionPlace) -> &'static PartKind<AxisFriction> {
    let name = match at {
        FrictionPlace::Motor => "lugre-at-motor",
        FrictionPlace::Load(Freedom::Linear) => "lugre",
        FrictionPlace::Load(Freedom::Rotary) => "lugre-rotary",
    };
    let named = FRICTIONS.iter().find(|kind| kind.name == name);
    named.expect("the kinds of friction have these names")
}

/// A key with its SI unit, and its limits.
fn spelled(key: &Key) -> (String, Option<[f64; 2]>) {
    let si = key.units().iter().find(|(_, factor)| *factor == 1.0);
    let unit = si.map_or(String::new(), |(unit, _)| format!("_{unit}"));
    (format!("{}{unit}", key.name()), key.limits())
}

fn how_sure(found: &Found) -> String {
    match found.interval_95 {
        Some([low, high]) => format!("95 %: {} to {}", SixDigits(low), SixDigits(high)),
        None => match found.source.as_str() {
            "axis file" => "as it was: the logs do not tell".to_owned(),
            source => source.to_owned(),
        },
    }
}
