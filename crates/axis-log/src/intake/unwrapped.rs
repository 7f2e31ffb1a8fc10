//! Angles and counters that begin anew after a turn.

use std::f64::consts::TAU;

use super::done::Done;
use crate::channel::Channel;
use crate::numeric::order::median;
use crate::numeric::wrap::{unwrap, wrap};

/// Bits of a counter that may run over.
const BITS: std::ops::RangeInclusive<i32> = 8..=32;

/// Makes channels go on that plainly begin anew: angles after a turn, in whatever unit their
/// column was, and counters after all their bits. `scale` is what a channel's column was
/// multiplied by. What is commanded and what is measured then count from one turn.
pub(super) fn unwrapped(channels: &mut [Channel], scale: impl Fn(&Channel) -> f64) -> Vec<Done> {
    let mut done = Vec::new();
    for channel in channels.iter_mut() {
        let periods = periods(&channel.unit, scale(channel));
        let Some((period, jumps)) = wrap(&channel.samples, &periods) else {
            continue;
        };
        unwrap(&mut channel.samples, period);
        done.push(Done::Unwrapped {
            channel: channel.name.clone(),
            period,
            jumps,
            unit: channel.unit.clone(),
        });
    }
    for one in &done {
        if let Done::Unwrapped {
            channel, period, ..
        } = one
        {
            to_one_turn(channels, channel, *period);
        }
    }
    done
}

/// After how much a channel of that unit may begin anew, a turn first.
fn periods(unit: &str, scale: f64) -> Vec<f64> {
    let turn = match unit {
        "rad" => TAU,
        "°" => 360.0,
        "rev" => 1.0,
        "m" | "mm" | "µm" => f64::NAN,
        _ => return Vec::new(),
    };
    // A column in degrees or turns that is read as radians as it stands is found out later.
    let unread = [360.0, 1.0].map(|turn| turn * scale.abs());
    let counts = BITS.map(|bits| f64::from(bits).exp2() * scale.abs());
    let turns = std::iter::once(turn).chain(unread.into_iter().filter(|_| !turn.is_nan()));
    let all = turns.chain(counts);
    all.filter(|period| period.is_finite() && *period > 0.0)
        .collect()
}

/// A command and what is measured of it may have begun in different turns: moves what was
/// unwrapped to where it is nearest to the other.
fn to_one_turn(channels: &mut [Channel], name: &str, period: f64) {
    let other = match name.contains("_ref_") {
        // The command stays where it is.
        true => return,
        false => name
            .rsplit_once("_rad")
            .map(|(stem, _)| format!("{stem}_ref_rad")),
    };
    let Some(reference) = channels.iter().find(|c| Some(&c.name) == other.as_ref()) else {
        return;
    };
    let reference = reference.samples.clone();
    let Some(channel) = channels.iter_mut().find(|c| c.name == name) else {
        return;
    };
    let apart = reference.iter().zip(&channel.samples).map(|(r, x)| r - x);
    let mut apart: Vec<f64> = apart.filter(|d| d.is_finite()).collect();
    let turns = (median(&mut apart) / period).round();
    channel
        .samples
        .iter_mut()
        .for_each(|x| *x += turns * period);
}
