//! The log: channels over one time axis.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use crate::channel::Channel;
use crate::error::LogError;

/// Name of the first channel of every log: the time in seconds.
pub const TIME_CHANNEL: &str = "t_s";

/// Channels over one time axis.
///
/// Holds from construction on: the first channel is [`TIME_CHANNEL`], strictly
/// increasing; all channels are equally long (at least one sample), finite,
/// uniquely named, and their units agree with the suffixes of their names.
///
/// Samples that were not measured, or not trusted, may be marked as
/// [missing](Self::missing): their values are interpolated, for display, and must be
/// given no weight. Files have NaN in their place.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    channels: Vec<Channel>,
    /// Of each channel that has any: sorted, apart, not empty, within the log.
    missing: BTreeMap<String, Vec<Range<usize>>>,
}

impl Log {
    /// A log of these channels, the time first.
    ///
    /// # Errors
    /// The [`LogError`] that names the first channel, sample and value to break
    /// what a log promises.
    pub fn new(channels: Vec<Channel>) -> Result<Self, LogError> {
        let mut channels = channels.into_iter();
        let time = channels.next().ok_or(LogError::Empty)?;
        check_time(&time)?;
        let mut log = Self {
            channels: vec![time],
            missing: BTreeMap::new(),
        };
        for channel in channels {
            log.push_channel(channel)?;
        }
        Ok(log)
    }

    /// A log of channels that the caller has checked.
    pub(crate) fn from_checked(channels: Vec<Channel>) -> Self {
        let missing = BTreeMap::new();
        Self { channels, missing }
    }

    /// Adds a channel behind the others.
    ///
    /// # Errors
    /// [`LogError::Duplicate`], [`LogError::Length`], [`LogError::NotFinite`],
    /// [`LogError::UnitSuffix`] or [`LogError::UnitMismatch`]; the log is then
    /// unchanged.
    pub fn push_channel(&mut self, channel: Channel) -> Result<(), LogError> {
        channel.check()?;
        if self.has(&channel.name) {
            return Err(LogError::Duplicate { name: channel.name });
        }
        if channel.samples.len() != self.len() {
            return Err(LogError::Length {
                name: channel.name,
                found: channel.samples.len(),
                expected: self.len(),
            });
        }
        self.channels.push(channel);
        Ok(())
    }

    /// The samples of the channel of that full name (`position_m`), in its unit,
    /// one for each instant of [`time`](Self::time).
    ///
    /// # Errors
    /// [`LogError::MissingChannel`], which lists the channels that exist.
    pub fn channel(&self, name: &str) -> Result<&[f64], LogError> {
        self.channels
            .iter()
            .find(|c| c.name == name)
            .map(|c| c.samples.as_slice())
            .ok_or_else(|| LogError::MissingChannel {
                name: name.to_owned(),
                available: self.channels.iter().map(|c| c.name.clone()).collect(),
            })
    }

    /// Whether the log has a channel of that full name.
    pub fn has(&self, name: &str) -> bool {
        self.channels.iter().any(|c| c.name == name)
    }

    /// The instants, as ranges of their indices, at which the channel of that name was not
    /// measured and its value is interpolated: sorted and apart. None for a channel that
    /// is not there.
    pub fn missing(&self, name: &str) -> &[Range<usize>] {
        self.missing.get(name).map_or(&[], Vec::as_slice)
    }

    /// Marks instants of a channel as not measured, beside those marked before. What lies
    /// outside the log is left out.
    ///
    /// # Errors
    /// [`LogError::MissingChannel`].
    pub fn mark_missing(
        &mut self,
        name: &str,
        instants: impl IntoIterator<Item = Range<usize>>,
    ) -> Result<(), LogError> {
        self.channel(name)?;
        let length = self.len();
        let mut all: Vec<Range<usize>> = self.missing.remove(name).unwrap_or_default();
        all.extend(instants);
        let merged = merged(all, length);
        if !merged.is_empty() {
            self.missing.insert(name.to_owned(), merged);
        }
        Ok(())
    }

    /// The samples of a channel of the log as files have them: NaN where they are missing.
    pub(crate) fn with_holes<'a>(&self, channel: &'a Channel) -> Cow<'a, [f64]> {
        let missing = self.missing(&channel.name);
        if missing.is_empty() {
            return Cow::Borrowed(&channel.samples);
        }
        let mut samples = channel.samples.clone();
        for run in missing {
            samples[run.clone()].fill(f64::NAN);
        }
        Cow::Owned(samples)
    }

    /// All channels in their order, the time first.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The instants in seconds, strictly increasing.
    pub fn time(&self) -> &[f64] {
        &self.channels[0].samples
    }

    /// Number of instants, at least 1.
    #[allow(clippy::len_without_is_empty)] // a log is never empty
    pub fn len(&self) -> usize {
        self.time().len()
    }

    /// The log without its first `instants`; its times stay as they are.
    ///
    /// # Errors
    /// [`LogError::Empty`] if nothing is left.
    pub fn skip(&self, instants: usize) -> Result<Self, LogError> {
        if instants >= self.len() {
            return Err(LogError::Empty);
        }
        let rest = |c: &Channel| Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples: c.samples[instants..].to_vec(),
        };
        let moved =
            |r: &Range<usize>| r.start.saturating_sub(instants)..r.end.saturating_sub(instants);
        Ok(Self {
            channels: self.channels.iter().map(rest).collect(),
            missing: self.moved(self.len() - instants, moved),
        })
    }

    /// The first `instants` of the log, or all of it where it has no more.
    ///
    /// # Errors
    /// [`LogError::Empty`] if none is asked for.
    pub fn first(&self, instants: usize) -> Result<Self, LogError> {
        let length = instants.min(self.len());
        if length == 0 {
            return Err(LogError::Empty);
        }
        let begin = |c: &Channel| Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples: c.samples[..length].to_vec(),
        };
        Ok(Self {
            channels: self.channels.iter().map(begin).collect(),
            missing: self.moved(length, Clone::clone),
        })
    }

    /// The log with every `every`th instant only, from the first one on.
    ///
    /// The samples in between are dropped, not averaged: what lies above half
    /// the new sampling rate folds down. The last instant stays only where the
    /// factor meets it.
    ///
    /// # Errors
    /// [`LogError::Decimation`] if `every` is 0.
    pub fn decimate(&self, every: usize) -> Result<Self, LogError> {
        if every == 0 {
            return Err(LogError::Decimation { every });
        }
        let thin = |c: &Channel| Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples: c.samples.iter().copied().step_by(every).collect(),
        };
        // The first of the kept instants at or behind an index.
        let moved = |r: &Range<usize>| r.start.div_ceil(every)..r.end.div_ceil(every);
        Ok(Self {
            channels: self.channels.iter().map(thin).collect(),
            missing: self.moved(self.len().div_ceil(every), moved),
        })
    }

    fn moved(
        &self,
        length: usize,
        to: impl Fn(&Range<usize>) -> Range<usize>,
    ) -> BTreeMap<String, Vec<Range<usize>>> {
        let of = |(name, ranges): (&String, &Vec<Range<usize>>)| {
            let ranges = merged(ranges.iter().map(&to).collect(), length);
            (!ranges.is_empty()).then(|| (name.clone(), ranges))
        };
        self.missing.iter().filter_map(of).collect()
    }
}

/// The same instants as ranges that are sorted, apart and within the length.
fn merged(mut ranges: Vec<Range<usize>>, length: usize) -> Vec<Range<usize>> {
    ranges.iter_mut().for_each(|r| r.end = r.end.min(length));
    ranges.retain(|r| r.start < r.end);
    ranges.sort_by_key(|r| r.start);
    let mut apart: Vec<Range<usize>> = Vec::with_capacity(ranges.len());
    for range in ranges {
        match apart.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => apart.push(range),
        }
    }
    apart
}

fn check_time(time: &Channel) -> Result<(), LogError> {
    if time.name != TIME_CHANNEL {
        return Err(LogError::TimeNotFirst {
            found: time.name.clone(),
        });
    }
    if time.samples.is_empty() {
        return Err(LogError::Empty);
    }
    time.check()?;
    match time.samples.windows(2).position(|w| w[1] <= w[0]) {
        Some(k) => Err(LogError::TimeNotIncreasing {
            index: k + 1,
            previous: time.samples[k],
            value: time.samples[k + 1],
        }),
        None => Ok(()),
    }
}
