//! Items of screw, nut, bearings, guides and belt.

use std::f64::consts::{FRAC_PI_4, PI};

use axis_rating::screw::{BUCKLING_SHARE, CRITICAL_SPEED_SHARE, dn_value};
use axis_rating::{
    BASE_REVOLUTIONS, BeltTeeth, GuideBase, Rating, RollingElement, ScrewMounting, ScrewStrength,
    belt, life,
};

use super::duty::Contacts;
use super::item::CheckedItem;
use super::keys::About;
use super::sheets::element;
use super::{AxisDuty, CheckError};
use crate::axis::Axis;
use crate::mechanism::ScrewShape;
use crate::part::Values;

/// The items, those left out that the mechanism cannot have.
pub(super) fn items(axis: &Axis, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let v = &axis.rating.values;
    let mut items = Vec::new();
    if let Some(shape) = axis.mechanism.screw() {
        items.extend(shaft(v, &shape, duty)?);
        items.extend(nut(v, duty)?);
        items.extend(bearing(v, duty)?);
    }
    if axis.is_about(About::Belt) {
        items.extend(teeth(v, duty)?);
    }
    if axis.is_about(About::Guide) {
        items.extend(guides(v, duty)?);
    }
    Ok(items)
}

/// Of keys, those that the file does not state.
fn lacks<'a>(v: &Values, keys: &[&'a str]) -> Vec<&'a str> {
    let missing = |key: &&'a str| !v.has(key);
    keys.iter().copied().filter(missing).collect()
}

fn mounting(v: &Values, shape: &ScrewShape) -> Option<ScrewMounting> {
    match v.word("screw_mounting") {
        Some("fixed-fixed") => Some(ScrewMounting::FixedFixed),
        Some("fixed-supported") => Some(ScrewMounting::FixedSupported),
        Some("supported-supported") => Some(ScrewMounting::SupportedSupported),
        Some(_) => Some(ScrewMounting::FixedFree),
        // Of the other, the mechanism says nothing about bending.
        None => shape.held_at_both_ends.map(|_| ScrewMounting::FixedFixed),
    }
}

fn shaft(v: &Values, shape: &ScrewShape, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let rpm = 30.0 / PI;
    let fastest = duty.motor.fastest_rad_per_s();
    let force = duty.greatest_force;
    let (speed, speed_title) = (
        "screw_critical_speed",
        "speed of the screw against its critical speed",
    );
    let (press, press_title) = ("screw_buckling", "axial force against the buckling load");
    let length = v.or("screw_length", shape.length);
    let mut items = match mounting(v, shape) {
        Some(mounting) => {
            let area = FRAC_PI_4 * shape.diameter * shape.diameter;
            let strength = ScrewStrength {
                root_diameter_m: v.or("screw_root_diameter", shape.diameter),
                youngs_modulus_pa: shape.rigidity / area,
                density_kg_per_m3: shape.density,
                mounting,
            };
            let share = v.or("screw_speed_share", CRITICAL_SPEED_SHARE);
            let found = strength.critical_speed(fastest, length, share)?;
            let found = Rating::at_most(rpm * found.value, rpm * found.limit, "rpm");
            let share = v.or("screw_buckling_share", BUCKLING_SHARE);
            let pressed = v.or("screw_buckling_length", length);
            let load = strength.buckling(force, pressed, share)?;
            vec![
                CheckedItem::rated(speed, speed_title, found),
                CheckedItem::rated(press, press_title, load),
            ]
        }
        None => {
            let key = ["screw_mounting"];
            vec![
                CheckedItem::missing(speed, speed_title, Some((rpm * fastest, "rpm")), &key),
                CheckedItem::missing(press, press_title, Some((force, "N")), &key),
            ]
        }
    };
    let (name, title) = ("screw_dn_value", "DN value");
    let keys = lacks(v, &["screw_ball_circle", "screw_dn_limit"]);
    let diameter = v.optional("screw_ball_circle");
    items.push(match (diameter, v.optional("screw_dn_limit")) {
        (Some(diameter), Some(limit)) => {
            CheckedItem::rated(name, title, dn_value(diameter, fastest, limit)?)
        }
        (Some(diameter), None) => {
            let known = dn_value(diameter, fastest, 1.0)?.value;
            CheckedItem::missing(name, title, Some((known, "mm/min")), &keys)
        }
        _ => CheckedItem::missing(name, title, None, &keys),
    });
    Ok(items)
}

/// What of a rolling contact is asked.
struct Rolling {
    life: [&'static str; 2],
    safety: [&'static str; 2],
    dynamic: &'static str,
    fixed: &'static str,
    element: RollingElement,
}

/// Life in hours of both contacts together, or of the one that carries a load.
fn contact_life(
    contacts: &Contacts,
    rating: f64,
    element: RollingElement,
    load: impl Fn(f64) -> Result<f64, CheckError>,
    duration: f64,
) -> Result<f64, CheckError> {
    let mut lives = [0.0; 2];
    for (into, side) in lives.iter_mut().zip(&contacts.sides) {
        if side.load_n() == 0.0 && contacts.sides[0].load_n() > 0.0 {
            *into = f64::INFINITY;
            continue;
        }
        let load = load(side.load_n())?;
        *into = life::nominal_life(BASE_REVOLUTIONS, rating, load, element)?;
    }
    let joint = life::joint_life(lives, element)?;
    let turns = contacts.sides[0].travel();
    let per_s = if duration > 0.0 {
        turns / duration
    } else {
        0.0
    };
    Ok(life::life_h(joint, per_s)?)
}

fn rolling(
    v: &Values,
    duty: &AxisDuty,
    contacts: &Contacts,
    of: &Rolling,
    load: impl Fn(f64) -> Result<f64, CheckError>,
) -> Result<Vec<CheckedItem>, CheckError> {
    let [name, title] = of.life;
    let keys = lacks(v, &[of.dynamic, "required_life"]);
    let hours = match v.optional(of.dynamic) {
        Some(rating) => Some(contact_life(
            contacts,
            rating,
            of.element,
            &load,
            duty.duration(),
        )?),
        None => None,
    };
    let first = match (hours, v.optional("required_life")) {
        (Some(hours), Some(required)) => {
            CheckedItem::rated(name, title, life::life(hours, required)?)
        }
        (hours, _) => CheckedItem::missing(name, title, hours.map(|hours| (hours, "h")), &keys),
    };
    let [name, title] = of.safety;
    let second = match v.optional(of.fixed) {
        Some(rating) => {
            let safety =
                life::static_safety(rating, load(contacts.greatest)?, v.or("static_safety", 1.0))?;
            CheckedItem::rated(name, title, safety)
        }
        None => CheckedItem::missing(name, title, None, &[of.fixed]),
    };
    Ok(vec![first, second])
}

fn nut(v: &Values, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let of = Rolling {
        life: ["nut_life", "nominal life of the nut (ISO 3408-5)"],
        safety: ["nut_static_safety", "static safety of the nut"],
        dynamic: "nut_dynamic_load_rating",
        fixed: "nut_static_load_rating",
        element: RollingElement::Ball,
    };
    let factor = v.or("load_factor", 1.0);
    rolling(v, duty, &duty.nut, &of, |load| Ok(factor * load))
}

fn bearing(v: &Values, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let of = Rolling {
        life: [
            "bearing_life",
            "nominal life of the fixed bearing (ISO 281)",
        ],
        safety: [
            "bearing_static_safety",
            "static safety of the fixed bearing",
        ],
        dynamic: "bearing_dynamic_load_rating",
        fixed: "bearing_static_load_rating",
        element: duty.sheets.bearing_element,
    };
    let factor = v.or("load_factor", 1.0);
    let radial = v.or("bearing_radial_load", 0.0);
    let factors = [
        v.or("bearing_radial_factor", 1.0),
        v.or("bearing_axial_factor", 1.0),
    ];
    rolling(v, duty, &duty.bearing, &of, |load| {
        Ok(life::equivalent_load_n(radial, factor * load, factors)?)
    })
}

fn guides(v: &Values, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let (name, title) = ("guide_life", "nominal life of the guides (ISO 14728-1)");
    let needed = [
        "guide_load",
        "guide_dynamic_load_rating",
        "guide_base",
        "required_life",
    ];
    let keys = lacks(v, &needed);
    let base = v.word("guide_base").map(|word| match word {
        "50-km" => GuideBase::Km50,
        _ => GuideBase::Km100,
    });
    let load = v.optional("guide_load");
    let known = load.zip(v.optional("guide_dynamic_load_rating")).zip(base);
    let hours = match known {
        Some(((load, rating), base)) => {
            let element = element(v, "guide_element");
            let load = v.or("load_factor", 1.0) * load;
            let metres = life::nominal_life(base.travel_m(), rating, load, element)?;
            let per_s = match duty.duration() > 0.0 {
                true => duty.travel / duty.duration(),
                false => 0.0,
            };
            Some(life::life_h(metres, per_s)?)
        }
        None => None,
    };
    let first = match (hours, v.optional("required_life")) {
        (Some(hours), Some(required)) => {
            CheckedItem::rated(name, title, life::life(hours, required)?)
        }
        (hours, _) => CheckedItem::missing(name, title, hours.map(|hours| (hours, "h")), &keys),
    };
    let (name, title) = ("guide_static_safety", "static safety of the guides");
    let second = match load.zip(v.optional("guide_static_load_rating")) {
        Some((load, rating)) => {
            let load = v.or("load_factor", 1.0) * load;
            let safety = life::static_safety(rating, load, v.or("static_safety", 1.0))?;
            CheckedItem::rated(name, title, safety)
        }
        None => {
            let keys = lacks(v, &["guide_load", "guide_static_load_rating"]);
            CheckedItem::missing(name, title, None, &keys)
        }
    };
    Ok(vec![first, second])
}

fn teeth(v: &Values, duty: &AxisDuty) -> Result<Vec<CheckedItem>, CheckError> {
    let (name, title) = ("belt_tooth_load", "pull on the teeth in mesh");
    let pull = duty.greatest_force;
    let needed = ["belt_tooth_force", "belt_width", "belt_teeth_in_mesh"];
    let first = match needed.map(|key| v.optional(key)) {
        [Some(force), Some(width_m), Some(in_mesh)] => {
            let teeth = BeltTeeth {
                force_per_width_n_per_m: force,
                width_m,
                in_mesh,
            };
            CheckedItem::rated(name, title, teeth.tooth_load(pull)?)
        }
        _ => CheckedItem::missing(name, title, Some((pull, "N")), &lacks(v, &needed)),
    };
    let (name, title) = ("belt_cord_load", "pretension and pull in the cords");
    let pretension = v.or("belt_pretension", 0.0);
    let second = match v.optional("belt_cord_limit") {
        Some(limit) => CheckedItem::rated(name, title, belt::cord_load(pull, pretension, limit)?),
        None => CheckedItem::missing(
            name,
            title,
            Some((pull + pretension, "N")),
            &["belt_cord_limit"],
        ),
    };
    Ok(vec![first, second])
}
