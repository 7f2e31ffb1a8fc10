//! Growth as a slow log shows it: by a probe, or by the motor's encoder and a scale.
//!
//! Scale less encoder is growth, and the transmission's wind-up besides. At constant speed that is the same forward
//! and backward but for its sign, so that the mean of both directions at one place leaves it out; a constant load
//! and the screw's pitch errors stay, and readings count from the first at each place.

use axis_log::Log;
use axis_sim::Axis;

use super::HeatError;
use super::channels::{ANGLE, LENGTH, NUMBER, channel};

/// The end of a stretch: its row, and growth at some positions.
pub(super) struct Reading {
    pub row: usize,
    /// Position and growth, m.
    pub found: Vec<[f64; 2]>,
}

/// All ends of a log.
pub(super) struct Readings {
    pub ends: Vec<Reading>,
    /// Whether they are by encoder and scale.
    pub by_scale: bool,
}

/// The reference of a log.
pub(super) struct Reference<'a> {
    pub position: &'a [f64],
    pub velocity: &'a [f64],
    /// Rows at constant speed.
    pub constant: &'a [bool],
}

/// Of a log that names duties: each row is an end, and a reading if nothing says otherwise.
pub(super) fn of_rows(log: &Log, time: &[f64]) -> Result<Readings, HeatError> {
    let probed = probed(log)?;
    let all = (0..time.len()).map(|row| Reading {
        row,
        found: match probed.at(row) {
            Some(read) => vec![read],
            None => Vec::new(),
        },
    });
    Ok(Readings {
        ends: all.collect(),
        by_scale: false,
    })
}

/// Of a log with a reference: an end each window, and at each probing.
pub(super) fn of_reference(
    axis: &Axis,
    log: &Log,
    time: &[f64],
    reference: &Reference<'_>,
    window: f64,
) -> Result<Readings, HeatError> {
    if !(10.0..=3600.0).contains(&window) {
        return Err(HeatError::Option {
            name: "window",
            value: window,
            valid: "from 10 to 3600 s",
        });
    }
    let rows = windows(time, window);
    let probed = probed(log)?;
    if probed.is_any() {
        if probed.when.is_none() {
            return Err(HeatError::log(
                "has growth beside a reference, and does not say in which rows it was probed",
                "a channel probed_1, 1 in those rows and 0 in the others",
            ));
        }
        let is_window = |row: &usize| rows.binary_search(row).is_ok();
        let ends = (0..time.len()).filter(|row| is_window(row) || probed.at(*row).is_some());
        let ends = ends.map(|row| Reading {
            row,
            found: probed.at(row).into_iter().collect(),
        });
        return Ok(Readings {
            ends: ends.collect(),
            by_scale: false,
        });
    }
    let scale = channel(log, "position", LENGTH);
    let grown = scale
        .zip(channel(log, "motor_angle", ANGLE))
        .map(|(scale, angle)| {
            let r = axis.travel_per_radian();
            let both = scale.into_iter().zip(angle);
            both.map(|(scale, angle)| scale - r * angle)
                .collect::<Vec<f64>>()
        });
    let places = places(reference.position);
    let end = |row: usize| Reading {
        row,
        found: match &grown {
            Some(grown) => by_directions(time, reference, grown, row, &places),
            None => Vec::new(),
        },
    };
    Ok(Readings {
        ends: rows.into_iter().map(end).collect(),
        by_scale: grown.is_some(),
    })
}

/// Rows nearest behind each whole window, and the last row. What is left behind the last whole window is a window of
/// its own from half a window on; less is joined to the one before.
fn windows(time: &[f64], window: f64) -> Vec<usize> {
    let last = time.len() - 1;
    let count = (time[last] / window).floor() as usize;
    let at = |k: usize| {
        time.partition_point(|t| *t < k as f64 * window * (1.0 - 1e-12))
            .min(last)
    };
    let mut rows: Vec<usize> = (1..=count).map(at).collect();
    let left = time[last] - count as f64 * window;
    if left < 0.5 * window {
        rows.pop();
    }
    rows.push(last);
    rows.dedup();
    rows
}

/// What a probe found, by row.
struct Probed {
    place: Vec<f64>,
    growth: Vec<f64>,
    when: Option<Vec<f64>>,
}

impl Probed {
    fn is_any(&self) -> bool {
        !self.growth.is_empty()
    }

    fn at(&self, row: usize) -> Option<[f64; 2]> {
        let was = self.when.as_ref().is_none_or(|when| when[row] >= 0.5);
        let both = self.place.get(row).zip(self.growth.get(row));
        both.filter(|_| was)
            .map(|(place, growth)| [*place, *growth])
    }
}

fn probed(log: &Log) -> Result<Probed, HeatError> {
    let growth = channel(log, "growth", LENGTH).unwrap_or_default();
    let place = channel(log, "place", LENGTH).unwrap_or_default();
    if growth.len() != place.len() {
        return Err(HeatError::log(
            "has one of growth and place without the other",
            "both channels: place_m, where growth was probed, and growth_m (or in mm, µm)",
        ));
    }
    Ok(Probed {
        place,
        growth,
        when: channel(log, "probed", NUMBER),
    })
}

/// Places at which encoder and scale are compared.
const PLACES: u32 = 7;
/// Time over which they are, s: in it growth changes linearly.
const OVER: f64 = 60.0;
/// Half of the length over which they are, as a share of what is between two places.
const BESIDE: f64 = 1.0;
/// Change of speed from row to row that counts as constant, as a share of the speed.
const CONSTANT: f64 = 0.01;
/// Fewest rows of a direction.
const FEWEST: f64 = 4.0;

/// Evenly over the middle of where the reference goes.
fn places(position: &[f64]) -> Vec<f64> {
    let least = position.iter().copied().fold(f64::INFINITY, f64::min);
    let most = position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let at = |i: u32| least + (most - least) * (f64::from(i) + 0.5) / f64::from(PLACES);
    (0..PLACES).map(at).collect()
}

/// Sums of a straight line over the distance from a place.
#[derive(Clone, Copy, Default)]
struct Line {
    n: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
}

impl Line {
    fn add(&mut self, x: f64, y: f64) {
        self.n += 1.0;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
    }

    /// At the place.
    fn middle(&self) -> Option<f64> {
        let spread = self.n * self.xx - self.x * self.x;
        let slope = (self.n * self.xy - self.x * self.y) / spread;
        let fits = self.n >= FEWEST && spread > 0.0;
        fits.then(|| (self.y - slope * self.x) / self.n)
    }
}

/// Rows of a reference at constant speed: it is that of the rows beside.
pub(super) fn constant(velocity: &[f64]) -> Vec<bool> {
    let v = velocity;
    let is_constant = |k: usize| {
        let beside = [k.saturating_sub(1), (k + 1).min(v.len() - 1)];
        let change = beside.map(|other| (v[other] - v[k]).abs());
        v[k] != 0.0 && change[0].max(change[1]) <= CONSTANT * v[k].abs()
    };
    (0..v.len()).map(is_constant).collect()
}

/// Width of a class of speeds, as a share, and the places, of 0.1 mm, from which a class is a constant speed: an axis
/// that accelerates has a speed at few places only.
const CLASS: f64 = 0.005;
const PLACES_OF_A_SPEED: usize = 8;

/// The same of a reference that is not seen between its rows: a speed that is found at many places is a constant one.
pub(super) fn recurring(position: &[f64], velocity: &[f64]) -> Vec<bool> {
    let class = |v: &f64| (v.abs().ln() / CLASS).round() as i64;
    let mut found: Vec<(i64, i64)> = position
        .iter()
        .zip(velocity)
        .filter(|(_, v)| **v != 0.0)
        .map(|(x, v)| (class(v), (1e4 * x).round() as i64))
        .collect();
    found.sort_unstable();
    found.dedup();
    let recurs = |v: &f64| {
        let of = class(v);
        let until = |class: i64| found.partition_point(|(c, _)| *c < class);
        *v != 0.0 && until(of + 1) - until(of) >= PLACES_OF_A_SPEED
    };
    velocity.iter().map(recurs).collect()
}

/// Growth about the time of a row, the mean of both directions at each place.
fn by_directions(
    time: &[f64],
    reference: &Reference<'_>,
    grown: &[f64],
    row: usize,
    places: &[f64],
) -> Vec<[f64; 2]> {
    let at = |t: f64| time.partition_point(|s| *s < t);
    let rows = at(time[row] - 0.5 * OVER).max(1)..at(time[row] + 0.5 * OVER).min(time.len() - 1);
    let half = match places {
        [a, b, ..] => BESIDE * (b - a),
        _ => 0.0,
    };
    let mut lines = vec![[Line::default(); 2]; places.len()];
    for k in rows {
        if !reference.constant[k] {
            continue;
        }
        let v = reference.velocity;
        for (place, both) in places.iter().zip(&mut lines) {
            let beside = reference.position[k] - place;
            if beside.abs() <= half {
                both[usize::from(v[k] > 0.0)].add(beside, grown[k]);
            }
        }
    }
    let read = places
        .iter()
        .zip(&lines)
        .filter_map(|(place, [back, forth])| {
            Some([*place, 0.5 * (back.middle()? + forth.middle()?)])
        });
    read.collect()
}
