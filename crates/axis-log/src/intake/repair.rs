//! Outliers out, holes bridged and marked.

use std::ops::Range;

use super::done::Done;
use super::recording::Recording;
use crate::channel::Channel;
use crate::numeric::holes::{bridge, runs};
use crate::quality::outliers;

/// Most missing samples in a row over which a search may go on; longer holes it refuses.
pub const SHORT_GAP: usize = 5;

/// Samples from a command's pulse within which what is measured may answer it with a pulse of its own: a current
/// loop's rise, a drive's dead time and a cycle of skew.
const ANSWER: usize = 10;

/// Makes isolated outliers holes, but of the channels that are exact, and but of what answers a pulse in one of those.
pub(super) fn take_out(recording: &mut Recording, exact: &[&str], done: &mut Vec<Done>) {
    let time = &recording.time;
    let is_exact = |c: &Channel| exact.contains(&c.name.as_str());
    let commands = recording.channels.iter().filter(|c| is_exact(c));
    let mut pulses: Vec<usize> = commands
        .flat_map(|c| outliers(&c.samples))
        .map(|o| o.index)
        .collect();
    pulses.sort_unstable();
    let answers = |k: usize| {
        let before = pulses.partition_point(|&p| p < k);
        before > 0 && k - pulses[before - 1] <= ANSWER
    };
    for channel in recording.channels.iter_mut().filter(|c| !is_exact(c)) {
        let mut found = outliers(&channel.samples);
        found.retain(|o| !answers(o.index));
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
