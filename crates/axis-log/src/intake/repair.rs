//! Outliers out, holes bridged and marked.

use std::ops::Range;

use super::done::Done;
use super::recording::Recording;
use crate::channel::Channel;
use crate::numeric::holes::{bridge, runs};
use crate::quality::outliers;

/// Longest run of missing samples that is taken for a short one.
pub const SHORT_GAP: usize = 5;

/// Makes isolated outliers holes, but of the channels that are exact.
pub(super) fn take_out(recording: &mut Recording, exact: &[&str], done: &mut Vec<Done>) {
    let time = &recording.time;
    let inexact = |c: &&mut Channel| !exact.contains(&c.name.as_str());
    for channel in recording.channels.iter_mut().filter(inexact) {
        let found = outliers(&channel.samples);
        let Some(first) = found.first() else {
            continue;
        };
        done.push(Done::Outliers {
            channel: channel.name.clone(),
            samples: found.len(),
            first: time[first.index],
            farthest: found.iter().map(|o| o.distance.abs()).fold(0.0, f64::max),
            unit: channel.unit.clone(),
        });
        found
            .iter()
            .for_each(|o| channel.samples[o.index] = f64::NAN);
    }
}

/// Bridges the holes of a channel; where they were.
pub(super) fn bridged(
    channel: &mut Channel,
    time: &[f64],
    done: &mut Vec<Done>,
) -> Vec<Range<usize>> {
    let holes = runs(&channel.samples);
    bridge(&mut channel.samples, &holes);
    if let Some(longest) = holes.iter().max_by_key(|r| r.len()) {
        done.push(Done::Bridged {
            channel: channel.name.clone(),
            samples: holes.iter().map(Range::len).sum(),
            longest: longest.len(),
            at: time[longest.start],
        });
    }
    holes
}
