//! What the numbers of a table say of the units that its names say, or do not.
//!
//! A time must rise by a step that makes a rate at which logs are read. A speed is the derivative
//! of its position: the factor between them tells the unit of either, or of the time, where the
//! others are known. An angle that begins anew after 360, 2π or 1 is in that turn's unit.

mod pairs;

use super::Found;
use crate::log::TIME_CHANNEL;
use crate::numeric::grid::Grid;
use crate::numeric::order::median;
use crate::quality::{MAX_RATE_HZ, MIN_RATE_HZ, rate_of};
use crate::table::{Holes, Table};
use crate::unit_table::size_of;

/// What was found beside the units.
#[derive(Default)]
pub(super) struct Numbers {
    pub remarks: Vec<String>,
    pub rate_hz: Option<f64>,
}

/// Units of time, as messages call them.
const TIMES: [&str; 4] = ["s", "ms", "us", "ns"];

/// Checks the units of what was found, and puts right, or takes out, what cannot be.
pub(super) fn checked(table: &mut dyn Table, found: &mut Vec<Found>) -> Numbers {
    let mut numbers = Numbers::default();
    let time = found
        .iter()
        .position(|found| found.column.channel == TIME_CHANNEL);
    let own = table.heads().iter().any(|head| head.name == TIME_CHANNEL);
    if own {
        numbers.rate_hz = step(table, TIME_CHANNEL).map(|step| 1.0 / step);
        pairs::checked(table, found, numbers.rate_hz, &mut numbers.remarks);
        return numbers;
    }
    let time = time.or_else(|| {
        found.extend(rising(table, found));
        found
            .iter()
            .position(|found| found.column.channel == TIME_CHANNEL)
    });
    let Some(time) = time else {
        pairs::checked(table, found, None, &mut numbers.remarks);
        return numbers;
    };
    let source = found[time].column.source.clone();
    if let Some(step) = step(table, &source) {
        let neighbours = pairs::period(table, found).and_then(|period| named(period / step));
        let said = found[time].is_said.then_some(found[time].column.unit);
        match unit(step, said, neighbours) {
            Ok((unit, remark)) => {
                found[time].column.unit = unit;
                numbers.rate_hz = size_of(unit).map(|size| 1.0 / (step * size));
                numbers
                    .remarks
                    .extend(remark.map(|why| format!("{source}: {why}")));
            }
            Err(why) => {
                numbers.remarks.push(format!("{source}: {why}"));
                found.remove(time);
            }
        }
    }
    pairs::checked(table, found, numbers.rate_hz, &mut numbers.remarks);
    numbers
}

/// The numbers of a column; none if it cannot be read.
fn column(table: &mut dyn Table, name: &str) -> Option<Vec<f64>> {
    let index = table.heads().iter().position(|head| head.name == name)?;
    table.read(&[index], Holes::Kept).ok()?.pop()
}

/// The first column, where its name says nothing and it rises evenly, by another step than 1: that
/// would be a counter.
fn rising(table: &mut dyn Table, found: &[Found]) -> Option<Found> {
    let first = table.heads().first().filter(|head| head.fault.is_none())?;
    let (time, name) = (Found::of("", first, TIME_CHANNEL, "s"), first.name.clone());
    let is_free = found.iter().all(|found| found.column.source != name);
    let values = column(table, &name).filter(|values| is_free && values.len() > 2)?;
    let step = step(table, &name).filter(|step| *step != 1.0)?;
    let is_even = |w: &[f64]| ((w[1] - w[0]) / step - 1.0).abs() < 0.5;
    values.windows(2).all(is_even).then_some(time)
}

/// The usual step of a column that rises: that of its grid, where it always does, as rounded steps
/// have a median that is off.
fn step(table: &mut dyn Table, name: &str) -> Option<f64> {
    let values = column(table, name)?;
    let steps = values.windows(2).map(|w| w[1] - w[0]);
    let mut rising: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    if rising.len() + 1 == values.len() {
        return Grid::of(&values).map(|grid| grid.period);
    }
    (2 * rising.len() > values.len()).then(|| median(&mut rising))
}

/// Six digits of a number, without what rounding left behind.
fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The unit of time with that size, within a fifth: the others are a thousand times away.
fn named(size: f64) -> Option<&'static str> {
    let near = |unit: &&str| size_of(unit).is_some_and(|own| (size / own).ln().abs() < 0.2);
    TIMES.into_iter().find(near)
}

/// The unit of a time whose numbers rise by `step`, and what is to be said of it.
fn unit(
    step: f64,
    said: Option<&'static str>,
    neighbours: Option<&'static str>,
) -> Result<(&'static str, Option<String>), String> {
    let fits = |unit: &str| size_of(unit).is_some_and(|size| rate_of(step * size).is_ok());
    let rate = |unit: &str| size_of(unit).map_or(f64::NAN, |size| 1.0 / (step * size));
    let shown = digits(step);
    let by_numbers = neighbours
        .filter(|unit| fits(unit))
        .or_else(|| TIMES.into_iter().find(|unit| fits(unit)));
    match (said, by_numbers) {
        (Some(said), _) if fits(said) => {
            let other = neighbours.filter(|unit| *unit != said && fits(unit));
            let remark = other.map(|unit| {
                format!("its name says {said}, and so do its steps of {shown}; a speed beside its position says {unit}")
            });
            Ok((said, remark))
        }
        (Some(said), Some(unit)) => Ok((
            unit,
            Some(format!(
                "its name says {said}, which would be {:.4e} Hz; steps of {shown} are taken for {unit}, {:.4} Hz",
                rate(said),
                rate(unit)
            )),
        )),
        (None, Some(unit)) => {
            let by = match neighbours == Some(unit) {
                true => "and a speed beside its position say",
                false => "say",
            };
            Ok((
                unit,
                Some(format!(
                    "no name says its unit; steps of {shown} {by} {unit}, {:.4} Hz",
                    rate(unit)
                )),
            ))
        }
        (_, None) => Err(format!(
            "steps of {shown} are no time between {MIN_RATE_HZ} and {MAX_RATE_HZ} Hz in s, ms, us or ns; give its factor to s yourself, or sample_rate_hz"
        )),
    }
}
