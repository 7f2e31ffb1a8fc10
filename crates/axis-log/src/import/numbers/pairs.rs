//! A position and its speed: what each says of the other's unit, and of the time's.

use std::f64::consts::TAU;

use super::super::Found;
use super::super::by_name::channel_of;
use super::column;
use crate::numeric::align::{Free, align, integral};
use crate::numeric::holes::{bridge, runs};
use crate::numeric::wrap::{unwrap, wrap};
use crate::table::Table;
use crate::unit_table::{known, size_of};

/// Positions and the speeds that are their derivatives.
const PAIRS: [(&str, &str); 6] = [
    ("position_m", "velocity_m_s"),
    ("position_rad", "velocity_rad_s"),
    ("motor_angle_rad", "motor_speed_rad_s"),
    ("position_ref_m", "velocity_ref_m_s"),
    ("position_ref_rad", "velocity_ref_rad_s"),
    ("motor_angle_rad", "velocity_rad_s"),
];

/// Units of a position and its speed that go together, the usual first.
const UNITS: [(&str, &str); 14] = [
    ("mm", "mm/s"),
    ("rad", "rad/s"),
    ("deg", "deg/s"),
    ("rev", "rev/s"),
    ("m", "m/s"),
    ("mm", "m/min"),
    ("mm", "mm/min"),
    ("mm", "m/s"),
    ("deg", "rpm"),
    ("rad", "rpm"),
    ("rev", "rpm"),
    ("deg", "rad/s"),
    ("rad", "deg/s"),
    ("deg", "rev/s"),
];

/// A turn in each unit of an angle.
const TURNS: [(f64, &str); 3] = [(TAU, "rad"), (360.0, "deg"), (1.0, "rev")];

/// Correlation above which a speed is the derivative of its position.
const SURE: f64 = 0.99;
/// Relative distance from a factor that counts as that factor.
const NEAR: f64 = 0.03;

/// The sampling period in s that pairs of one unit of length or angle tell.
pub(super) fn period(table: &mut dyn Table, found: &[Found]) -> Option<f64> {
    all(found).into_iter().find_map(|[x, v]| {
        let factor = factor(table, found, [x, v])?;
        let size = |k: usize| match found[k].is_said {
            true => size_of(found[k].column.unit),
            false => Some(1.0),
        };
        // Where only one is said, the other is not known to be of its kind.
        let both = found[x].is_said == found[v].is_said;
        both.then_some(factor * size(x)? / size(v)?)
    })
}

/// The units of positions and speeds that no name says, at this rate in Hz.
pub(super) fn checked(
    table: &mut dyn Table,
    found: &mut [Found],
    rate_hz: Option<f64>,
    remarks: &mut Vec<String>,
) {
    for k in 0..found.len() {
        if let Some(unit) = turned(table, &mut found[k], remarks) {
            turn_speeds(found, k, unit);
        }
    }
    let Some(rate) = rate_hz else {
        return;
    };
    for [x, v] in all(found) {
        if let Some(factor) = factor(table, found, [x, v]) {
            paired(found, [x, v], factor * rate, remarks);
        }
    }
}

/// Indices of each position and its speed, of one axis.
fn all(found: &[Found]) -> Vec<[usize; 2]> {
    let index = |channel: &str, axis: &str| {
        let is_it = |f: &Found| f.column.channel == channel && f.axis == axis;
        found.iter().position(is_it)
    };
    let mut pairs = Vec::new();
    for (x, position) in found.iter().enumerate() {
        let speeds = PAIRS
            .iter()
            .filter(|(of, _)| *of == position.column.channel);
        let mut speeds = speeds.filter_map(|(_, speed)| index(speed, &position.axis));
        // A position that turned out an angle still has its speed by another name.
        let other = |dimension: &str| {
            let channel = match position.column.channel.contains("_ref_") {
                true => "velocity_ref_m_s",
                false => "velocity_m_s",
            };
            index(channel_of(channel, dimension)?, &position.axis)
        };
        let speed = speeds
            .next()
            .or_else(|| other("speed"))
            .or_else(|| other("angular speed"));
        pairs.extend(speed.map(|speed| [x, speed]));
    }
    pairs
}

/// The unit of an angle that begins anew after a turn.
fn turned(
    table: &mut dyn Table,
    found: &mut Found,
    remarks: &mut Vec<String>,
) -> Option<&'static str> {
    let angle = channel_of(found.column.channel, "angle").filter(|_| !found.is_said)?;
    let values = column(table, &found.column.source)?;
    let (period, _) = wrap(&values, &TURNS.map(|(turn, _)| turn))?;
    let (_, unit) = TURNS.into_iter().find(|(turn, _)| *turn == period)?;
    (found.column.channel, found.column.unit, found.is_said) = (angle, unit, true);
    let source = &found.column.source;
    remarks.push(format!(
        "{source}: it wraps around after {period:.6}, so it is an angle in {unit}"
    ));
    Some(unit)
}

/// The speeds of an axis whose position turned out an angle in this unit are of one too, in its
/// unit a second unless another is said.
fn turn_speeds(found: &mut [Found], position: usize, unit: &str) {
    let axis = found[position].axis.clone();
    let per_second = match unit {
        "deg" => "deg/s",
        "rev" => "rev/s",
        _ => "rad/s",
    };
    let is_it = |f: &&mut Found| !f.is_said && f.axis == axis;
    for speed in found.iter_mut().filter(is_it) {
        let is_speed = known(speed.column.unit).is_some_and(|(_, of)| of == "speed");
        let channel = channel_of(speed.column.channel, "angular speed");
        if let Some(channel) = channel.filter(|_| is_speed) {
            (speed.column.channel, speed.column.unit) = (channel, per_second);
        }
    }
}

/// Position over summed speed, in their own numbers and per row, where they follow each other.
fn factor(table: &mut dyn Table, found: &[Found], [x, v]: [usize; 2]) -> Option<f64> {
    let whole = |mut values: Vec<f64>| {
        let holes = runs(&values);
        bridge(&mut values, &holes);
        values
    };
    let mut position = column(table, &found[x].column.source)?;
    if let Some((period, _)) = wrap(&position, &TURNS.map(|(turn, _)| turn)) {
        unwrap(&mut position, period);
    }
    let speed = integral(&whole(column(table, &found[v].column.source)?));
    let free = Free {
        delay: None,
        drift: true,
    };
    let fit = align(&speed, &whole(position), free)?;
    (fit.correlation > SURE && fit.factor > 0.0).then_some(fit.factor)
}

/// Puts the units right that no name says, so that speed is the derivative of position;
/// `factor` is position over the integral of speed in their numbers.
fn paired(found: &mut [Found], [x, v]: [usize; 2], factor: f64, remarks: &mut Vec<String>) {
    // Position in p over the integral of speed in q is q's size over p's.
    let fits = |(p, q): &(&'static str, &'static str)| {
        let ratio = size_of(q).zip(size_of(p)).map(|(q, p)| q / p);
        ratio.is_some_and(|ratio| (factor / ratio - 1.0).abs() < NEAR)
    };
    let as_said = |k: usize, unit: &str| {
        let own = known(found[k].column.unit).map(|(name, _)| name);
        !found[k].is_said || own == known(unit).map(|(name, _)| name)
    };
    let own = (found[x].column.unit, found[v].column.unit);
    let names = format!("{} and {}", found[x].column.source, found[v].column.source);
    if fits(&own) {
        return;
    }
    let mut all = UNITS.iter().filter(|(p, q)| as_said(x, p) && as_said(v, q));
    let Some((p, q)) = all.find(|units| fits(units)) else {
        remarks.push(format!(
            "{names}: position over the integral of speed is {factor:.5}, which {} and {} do not make: compare both with the drive",
            own.0, own.1
        ));
        return;
    };
    for (k, unit) in [(x, p), (v, q)] {
        let dimension = known(unit).map_or("", |(_, dimension)| dimension);
        if let Some(channel) = channel_of(found[k].column.channel, dimension) {
            (found[k].column.channel, found[k].column.unit) = (channel, unit);
        }
    }
    remarks.push(format!(
        "{names}: position over the integral of speed is {factor:.5}, as {p} and {q} make it"
    ));
}
