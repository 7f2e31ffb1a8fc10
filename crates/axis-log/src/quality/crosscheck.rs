//! Whether channels agree with each other, and what mapping would make them.

use std::f64::consts::{SQRT_2, TAU};
use std::fmt;

use super::clock;
use super::relation::{Relation, RelationLaw};
use crate::log::{Log, TIME_CHANNEL};
use crate::mapping::{ColumnMap, Mapping};
use crate::numeric::align::{Fit, Free, align, integral};
use crate::plus_minus::PlusMinus;
use crate::select::in_its_unit;
use crate::table::Head;
use crate::unit_table::slipped_unit;

/// What a cross-check says of a channel's mapping.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossCheckVerdict {
    /// The channels agree.
    Agrees,
    /// They do not agree, and no unit, sign or zero explains why; or it is not certain that they should.
    Unclear,
    /// They do not, and a unit, a sign or a zero says why: the mapping is wrong.
    Contradicts,
}

/// What was found about two channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What was checked.
    pub relation: Relation,
    /// The verdict.
    pub verdict: CrossCheckVerdict,
    /// What the channel looks like, in words.
    pub looks_like: String,
    /// Channel over what it should be, as found; 1 where they agree.
    pub factor: f64,
    /// Its standard error.
    pub factor_error: f64,
    /// Channel at 0 of what it should be, in the channel's unit.
    pub offset: f64,
    /// By how much it is late, s, and the standard error; where that was looked for.
    pub delay: Option<[f64; 2]>,
    /// Correlation of the channel with what it should be.
    pub correlation: f64,
    /// The column's mapping that would make them agree; never applied by itself.
    pub repair: Option<ColumnMap>,
}

/// Correlation above which two channels are surely related, and a factor means something.
const RELATED: f64 = 0.99;
/// The same of currents, with their ripple, and of torque and current.
const FOLLOWS: f64 = 0.9;
/// Relative distance from a factor that counts as that factor.
const NEAR: f64 = 0.03;
/// The same of channels that only follow.
const LOOSE: f64 = 0.15;
/// Longest delay that is looked for, s.
const LONGEST: f64 = 0.05;
/// Offset, as a share of the motion, above which zeros differ.
const OFFSET: f64 = 0.1;

/// Checks relations between channels of a log that was read by `mapping`. Relations of
/// channels that the log does not have, or that do not move, are passed over.
///
/// Each is a least-squares fit `y = factor · x(t − delay) + offset`; x is the other channel,
/// or its integral, times the factor that it should have. A factor within 3 % of 1 agrees; one
/// within 3 % of
/// a unit's (1000 for millimetres, 180/π for degrees, 60/2π for revolutions a minute,
/// encoder counts a turn), with either sign, contradicts where the correlation is above 0.99
/// (0.9 for currents, which must come within 15 %). The slip is laid to the channel of which a unit
/// explains it: its numbers are too large by what a smaller unit makes them, or too small by a
/// greater one.
pub fn cross_check(log: &Log, mapping: &Mapping, relations: &[Relation]) -> Vec<Finding> {
    let Some(clock) = clock(log) else {
        return Vec::new();
    };
    let one = |r: &Relation| check(log, mapping, r, clock.period);
    relations.iter().filter_map(one).collect()
}

fn check(log: &Log, mapping: &Mapping, relation: &Relation, period: f64) -> Option<Finding> {
    let y = log.channel(&relation.channel).ok()?;
    let x = log.channel(&relation.from).ok()?;
    let integrated = matches!(relation.law, RelationLaw::Integral { .. });
    let by = relation.factor() * if integrated { period } else { 1.0 };
    let x: Vec<f64> = if integrated { integral(x) } else { x.to_vec() };
    let x: Vec<f64> = x.iter().map(|v| v * by).collect();
    let delay = match relation.law {
        RelationLaw::Follows => Some(((LONGEST / period).round() as usize).max(2)),
        _ => None,
    };
    let fit = align(
        &x,
        y,
        Free {
            delay,
            drift: integrated,
        },
    )?;
    let (verdict, looks_like, repair) = judge(relation, &fit, &x, mapping);
    Some(Finding {
        relation: relation.clone(),
        verdict,
        looks_like,
        factor: fit.factor,
        factor_error: fit.factor_error,
        offset: fit.offset,
        delay: delay.map(|_| [fit.delay * period, fit.delay_error * period]),
        correlation: fit.correlation,
        repair,
    })
}

type Judged = (CrossCheckVerdict, String, Option<ColumnMap>);

fn judge(relation: &Relation, fit: &Fit, x: &[f64], mapping: &Mapping) -> Judged {
    let (related, near) = match relation.law {
        RelationLaw::Follows | RelationLaw::About { .. } => (FOLLOWS, LOOSE),
        _ => (RELATED, NEAR),
    };
    if fit.correlation < related {
        let words = format!(
            "not proportional to {} (correlation {:.3})",
            relation.from, fit.correlation
        );
        // A torque has friction and inertia beside current: no relation is no slip.
        return (CrossCheckVerdict::Unclear, words, None);
    }
    if let RelationLaw::About { within, .. } = relation.law
        && (1.0 / within..=within).contains(&fit.factor)
    {
        return (
            CrossCheckVerdict::Agrees,
            "as it should be".to_owned(),
            None,
        );
    }
    if (fit.factor - 1.0).abs() <= near {
        return zero(relation, fit, x, mapping);
    }
    slip(relation, fit.factor, near, mapping)
}

/// The factor is right; the zero may not be.
fn zero(relation: &Relation, fit: &Fit, x: &[f64], mapping: &Mapping) -> Judged {
    let agrees = (
        CrossCheckVerdict::Agrees,
        "as it should be".to_owned(),
        None,
    );
    if relation.law != RelationLaw::Same {
        return agrees;
    }
    let (low, high) = x
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    // At the middle of the motion, where the factor's error counts least.
    let middle = 0.5 * (low + high);
    let off = fit.offset + (fit.factor - 1.0) * middle;
    if off.abs() <= OFFSET * (high - low) + 5.0 * fit.offset_error {
        return agrees;
    }
    let map = of(mapping, &relation.channel);
    let repair = ColumnMap {
        offset: map.offset - off,
        ..map
    };
    let words = format!("{} measured from another zero, {off:.6} off", relation.from);
    (CrossCheckVerdict::Contradicts, words, Some(repair))
}

/// The factor is wrong: by which unit or sign.
fn slip(relation: &Relation, factor: f64, near: f64, mapping: &Mapping) -> Judged {
    let size = factor.abs();
    let turned = if factor < 0.0 {
        " with the sign reversed"
    } else {
        ""
    };
    let scaled = |channel: &str, by: f64| {
        let map = of(mapping, channel);
        ColumnMap {
            scale: map.scale * by,
            offset: map.offset * by,
            ..map
        }
    };
    if (size - 1.0).abs() <= near {
        // Which of two is turned they cannot tell; the one that is judged is named.
        return (
            CrossCheckVerdict::Contradicts,
            "right except for its sign".to_owned(),
            Some(scaled(&relation.channel, -1.0)),
        );
    }
    // Either the channel's numbers are so many times too large, or the other's too small.
    let either = [(&relation.channel, size), (&relation.from, 1.0 / size)];
    let unit = either.iter().filter_map(|(channel, times)| {
        let symbol = crate::unit_of(channel)?;
        let (unit, exact) = slipped_unit(symbol, *times, near)?;
        let words = format!("{channel} is in {unit} read as {symbol}{turned}");
        Some(((times / exact - 1.0).abs(), channel, words, exact))
    });
    let unit = unit.min_by(|a, b| a.0.total_cmp(&b.0));
    let mut counts = either.iter().filter_map(|(channel, times)| {
        let symbol = crate::unit_of(channel)?;
        let counts = counts_per_turn(symbol, *times)?;
        let words = format!("{channel} is in counts, {counts} a turn, read as {symbol}{turned}");
        Some((0.0, channel, words, counts / TAU))
    });
    match unit.or_else(|| counts.next()) {
        Some((_, channel, words, exact)) => (
            CrossCheckVerdict::Contradicts,
            words,
            Some(scaled(channel, factor.signum() / exact)),
        ),
        None if is_rms(relation, size) => (
            CrossCheckVerdict::Unclear,
            format!(
                "{factor:.5} times the expected value, which is near \u{221a}2: one of the two may be an RMS value, the other an amplitude"
            ),
            None,
        ),
        None => (
            CrossCheckVerdict::Unclear,
            format!("{factor:.5} times the expected value, which no unit explains"),
            // What one channel does to the other is as good a cause as a wrong scale.
            None,
        ),
    }
}

/// Whether of two currents one looks like the RMS value of the other's sine.
fn is_rms(relation: &Relation, size: f64) -> bool {
    let both = [&relation.channel, &relation.from];
    let are_currents = both.iter().all(|c| crate::unit_of(c) == Some("A"));
    let near = |value: f64| (size / value - 1.0).abs() <= NEAR;
    are_currents && (near(SQRT_2) || near(1.0 / SQRT_2))
}

/// Counts of an encoder in a turn: a power of two from 256 on, or 1, 1.2, 1.6, 2, 2.5, 3.6, 4,
/// 5 or 8 times a power of ten, to half a per cent.
fn counts_per_turn(symbol: &str, factor: f64) -> Option<f64> {
    if symbol != "rad" && symbol != "rad/s" {
        return None;
    }
    let counts = factor * TAU;
    let power = counts.log2().round().exp2();
    let ten = 10f64.powf(counts.log10().floor());
    let usual = [1.0, 1.2, 1.6, 2.0, 2.5, 3.6, 4.0, 5.0, 8.0, 10.0].map(|m| m * ten);
    let near = |c: &f64| *c >= 256.0 && (counts / c - 1.0).abs() < 5e-3;
    std::iter::once(power).chain(usual).find(near)
}

/// How a channel is read now.
fn of(mapping: &Mapping, channel: &str) -> ColumnMap {
    let found = mapping.columns.iter().find(|m| m.channel == channel);
    let as_named = |map: &ColumnMap| in_its_unit(map.clone(), &Head::new(map.source.as_str()));
    found.map(as_named).unwrap_or_else(|| ColumnMap {
        source: channel.to_owned(),
        channel: channel.to_owned(),
        scale: 1.0,
        is_scale_stated: false,
        offset: 0.0,
        delay: 0.0,
    })
}

impl Finding {
    /// The lines of an axis file that would repair the mapping.
    pub fn lines(&self) -> Option<String> {
        let map = self.repair.as_ref().filter(|m| m.channel != TIME_CHANNEL)?;
        let mut text = format!(
            "[[log.column]]\nsource = {:?}\nchannel = {:?}\nfactor = {}\n",
            map.source, map.channel, map.scale
        );
        if map.offset != 0.0 {
            text += &format!("offset = {}\n", map.offset);
        }
        if map.delay != 0.0 {
            text += &format!("delay_ms = {}\n", 1e3 * map.delay);
        }
        Some(text)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let r = &self.relation;
        let way = match r.law {
            RelationLaw::Integral { .. } => "the integral of ",
            _ => "",
        };
        write!(
            f,
            "{} against {way}{}: {} (factor {:.5} ± {:.1e}, correlation {:.4}",
            r.channel, r.from, self.looks_like, self.factor, self.factor_error, self.correlation
        )?;
        match self.delay {
            Some([delay, error]) => {
                let late = PlusMinus::new(1e3 * delay, 1e3 * error, 3);
                write!(f, ", late by {late} ms)")
            }
            None => f.write_str(")"),
        }
    }
}
