//! The log: channels over one time axis.

use crate::channel::Channel;
use crate::error::LogError;

/// Name of the first channel of every log: the time in seconds.
pub const TIME_CHANNEL: &str = "t_s";

/// Channels over one time axis.
///
/// Holds from construction on: the first channel is [`TIME_CHANNEL`], strictly
/// increasing; all channels are equally long (at least one sample), finite,
/// uniquely named, and their units agree with the suffixes of their names.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    channels: Vec<Channel>,
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
        };
        for channel in channels {
            log.push_channel(channel)?;
        }
        Ok(log)
    }

    /// A log of channels that the caller has checked.
    pub(crate) fn from_checked(channels: Vec<Channel>) -> Self {
        Self { channels }
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
    /// [`LogError::Empty`] where nothing is left.
    pub fn skip(&self, instants: usize) -> Result<Self, LogError> {
        if instants >= self.len() {
            return Err(LogError::Empty);
        }
        let rest = |c: &Channel| Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples: c.samples[instants..].to_vec(),
        };
        Ok(Self {
            channels: self.channels.iter().map(rest).collect(),
        })
    }

    /// The log with every `every`th instant only, from the first one on.
    ///
    /// The samples in between are dropped, not averaged: what lies above half
    /// the new sampling rate folds down. The last instant stays only where the
    /// factor meets it.
    ///
    /// # Errors
    /// [`LogError::Decimation`] where `every` is 0.
    pub fn decimate(&self, every: usize) -> Result<Self, LogError> {
        if every == 0 {
            return Err(LogError::Decimation { every });
        }
        let thin = |c: &Channel| Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples: c.samples.iter().copied().step_by(every).collect(),
        };
        Ok(Self {
            channels: self.channels.iter().map(thin).collect(),
        })
    }
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
