//! Times.

use super::number::decimal;

/// From here on a whole number is a time in ticks, not in ms: the year 1604, or 31 700 years.
const LEAST_TICKS: i64 = 1_000_000_000_000_000;
const TICKS_PER_SECOND: f64 = 1e7;

/// How times are written.
#[derive(Clone, Copy)]
pub(super) enum Clock {
    /// Milliseconds since the export's start.
    Milliseconds,
    /// Ticks of 100 ns since 1601; a double would round them to 16, so the first is taken off.
    Ticks(i64),
}

impl Clock {
    pub(super) fn of(first: &str) -> Self {
        match first.parse() {
            Ok(ticks) if ticks >= LEAST_TICKS => Self::Ticks(ticks),
            _ => Self::Milliseconds,
        }
    }

    /// Since the export's start, or since the first sample, s.
    pub(super) fn seconds(self, text: &str) -> Option<f64> {
        match self {
            Self::Milliseconds => decimal(text).map(|ms| ms / 1e3),
            Self::Ticks(first) => {
                let since = text.parse::<i64>().ok()?.checked_sub(first)?;
                Some(since as f64 / TICKS_PER_SECOND)
            }
        }
    }
}
