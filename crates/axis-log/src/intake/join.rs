//! Several recordings on one even grid.

use super::delay::between;
use super::done::Done;
use super::error::IntakeError;
use super::recording::{Even, Recording};
use crate::channel::Channel;
use crate::log::TIME_CHANNEL;
use crate::numeric::holes::{bridge, runs};
use crate::numeric::resample::{Resampler, SAME};

/// Channels on one grid, the time first; NaN if there is no value.
pub(super) fn join(
    mut parts: Vec<Recording>,
    rate: Option<f64>,
    done: &mut Vec<Done>,
) -> Result<Vec<Channel>, IntakeError> {
    let mut grids = Vec::with_capacity(parts.len());
    for part in &parts {
        grids.push(part.even()?);
    }
    let period = period(&grids, rate)?;
    drop_doubles(&mut parts, done, period);
    let sources = sources(&parts, &grids);
    let start = sources
        .iter()
        .map(|s| s.grid.start)
        .fold(f64::MIN, f64::max);
    let end = sources.iter().map(Source::end).fold(f64::MAX, f64::min);
    let files: Vec<String> = parts.iter().map(|p| p.name.clone()).collect();
    // Rounding must not cost the last row.
    let count = ((end - start) / period + SAME).floor() + 1.0;
    if count.is_nan() || count < 3.0 {
        let (files, overlap) = (files.join(" + "), end - start);
        return Err(IntakeError::NoOverlap {
            files,
            overlap,
            period,
        });
    }
    let count = count as usize;
    let time: Vec<f64> = (0..count).map(|k| start + k as f64 * period).collect();
    if parts.len() > 1 {
        let span = [start, time[count - 1]];
        done.push(Done::Joined {
            files,
            period,
            span,
        });
    }
    for source in sources.iter().filter(|s| s.given != 0.0) {
        let (channel, delay) = (source.channel.name.clone(), source.given);
        done.push(Done::Delayed { channel, delay });
    }
    let mut channels = vec![Channel {
        name: TIME_CHANNEL.to_owned(),
        unit: "s".to_owned(),
        samples: time,
    }];
    channels.extend(sources.iter().map(|s| s.on(start, period, count)));
    Ok(channels)
}

fn period(grids: &[Even], rate: Option<f64>) -> Result<f64, IntakeError> {
    let slowest = grids.iter().map(|g| g.period).fold(0.0, f64::max);
    let fastest = grids.iter().map(|g| g.period).fold(f64::MAX, f64::min);
    match rate {
        None => Ok(slowest),
        Some(rate) if rate > 0.0 && rate <= (1.0 + 1e-6) / fastest => Ok(1.0 / rate),
        Some(rate) => Err(IntakeError::Rate {
            rate,
            most: 1.0 / fastest,
        }),
    }
}

/// Takes the delay of each further file out, as far as it can be known, and then the
/// channels that an earlier file has too.
fn drop_doubles(parts: &mut [Recording], done: &mut Vec<Done>, period: f64) {
    let (Some((first, others)), mut names) = (parts.split_first_mut(), Vec::new()) else {
        return;
    };
    names.extend(first.channels.iter().map(|c| c.name.clone()));
    for part in others {
        let file = part.name.clone();
        let given = part.delays.iter().any(|&d| d != 0.0) || first.delays.iter().any(|&d| d != 0.0);
        match between(first, part, period) {
            Some(found) if given => {
                let surely = 3.0 * found.standard_error + 0.5 * period;
                let differs = found.delay.abs() > surely;
                let file = file.clone();
                done.extend(differs.then_some(Done::DelayDiffers { file, found }));
            }
            Some(found) => {
                let grid = part.grid.as_mut();
                grid.into_iter().for_each(|g| g.start -= found.delay);
                done.push(Done::Aligned {
                    file: file.clone(),
                    found,
                });
            }
            None if !given => {
                let against = first.name.clone();
                done.push(Done::DelayUnknown {
                    file: file.clone(),
                    against,
                });
            }
            None => {}
        }
        let mut keep = Vec::new();
        for channel in &part.channels {
            let twice = names.contains(&channel.name);
            keep.push(!twice);
            if twice {
                let (file, channel) = (file.clone(), channel.name.clone());
                done.push(Done::Twice { file, channel });
            } else {
                names.push(channel.name.clone());
            }
        }
        let mut which = keep.iter();
        part.channels.retain(|_| which.next() == Some(&true));
        let mut which = keep.iter();
        part.delays.retain(|_| which.next() == Some(&true));
    }
}

/// A channel and when it was: its delays taken out.
struct Source<'a> {
    channel: &'a Channel,
    grid: Even,
    given: f64,
}

fn sources<'a>(parts: &'a [Recording], grids: &[Even]) -> Vec<Source<'a>> {
    let mut all = Vec::new();
    for (part, grid) in parts.iter().zip(grids) {
        // An estimated delay stands in the recording's own grid.
        let grid = part.grid.unwrap_or(*grid);
        for (channel, &given) in part.channels.iter().zip(&part.delays) {
            let start = grid.start - given;
            let grid = Even { start, ..grid };
            all.push(Source {
                channel,
                grid,
                given,
            });
        }
    }
    all
}

impl Source<'_> {
    fn end(&self) -> f64 {
        self.grid.start + (self.channel.samples.len() - 1) as f64 * self.grid.period
    }

    fn on(&self, start: f64, period: f64, count: usize) -> Channel {
        let mut samples = self.channel.samples.clone();
        let holes = runs(&samples);
        bridge(&mut samples, &holes);
        let resampler = Resampler::new(period / self.grid.period);
        let one = |k: usize| {
            let u = (start - self.grid.start + k as f64 * period) / self.grid.period;
            let hole = |at: i64| usize::try_from(at).is_ok_and(|at| in_any(&holes, at));
            if !holes.is_empty() && resampler.rests_on(u).any(hole) {
                return f64::NAN;
            }
            resampler.at(&samples, u)
        };
        Channel {
            samples: (0..count).map(one).collect(),
            name: self.channel.name.clone(),
            unit: self.channel.unit.clone(),
        }
    }
}

fn in_any(ranges: &[std::ops::Range<usize>], at: usize) -> bool {
    let next = ranges.partition_point(|r| r.end <= at);
    ranges.get(next).is_some_and(|r| r.contains(&at))
}
