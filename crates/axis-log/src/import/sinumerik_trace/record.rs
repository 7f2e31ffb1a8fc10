//! Signals and their values, as the elements of a trace tell them.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::csv_text::MAX_COLUMNS;
use crate::error::clip;

/// From here on a number is no value: the bits of an infinity or a NaN, written as an integer
/// (0x7FF0000000000000 is the least of them).
pub(super) const NOT_MEASURED: f64 = 9_218_868_437_227_405_312.0;

/// Farthest of a `rec` from the grid of its signals, intervals.
const OFF: f64 = 0.25;

const TWICE: &str = "a rec has an attribute twice";

/// A signal, and the values that it took.
#[derive(Default)]
pub(super) struct Signal {
    pub name: String,
    pub description: String,
    /// Number of a `rec`, from 0, and the value from there on; NaN for none.
    changes: Vec<(usize, f64)>,
    /// The first value that is no number, and where it stands.
    pub other: Option<String>,
    /// Time from one value to the next, s.
    interval: Option<f64>,
    /// How many values were taken.
    count: Option<usize>,
}

impl Signal {
    /// A value for each `rec`.
    pub(super) fn held(&self, recs: usize) -> Vec<f64> {
        let mut values = vec![f64::NAN; recs];
        let ends = self.changes.iter().skip(1).map(|(rec, _)| *rec);
        for (&(start, value), end) in self.changes.iter().zip(ends.chain([recs])) {
            values[start..end].fill(value);
        }
        values
    }
}

/// What is known of a recording.
#[derive(Default)]
pub(super) struct Record {
    pub signals: Vec<Signal>,
    /// Time of each `rec`, s.
    pub times: Vec<f64>,
    /// Index of the signal that has a key.
    keys: HashMap<String, usize>,
    /// Whether the control says that it lost nothing.
    is_whole: bool,
}

/// The attributes of an element, or why they cannot be read.
pub(super) trait Attributes<'a>:
    Iterator<Item = Result<(&'a str, Cow<'a, str>), String>>
{
}
impl<'a, T: Iterator<Item = Result<(&'a str, Cow<'a, str>), String>>> Attributes<'a> for T {}

impl Record {
    /// A `dataSignal`.
    pub(super) fn signal<'a>(&mut self, attributes: impl Attributes<'a>) -> Result<(), String> {
        if !self.times.is_empty() {
            return Err("a dataSignal behind the first rec: all must stand before it".to_owned());
        }
        if self.signals.len() == MAX_COLUMNS {
            return Err(format!("more than {MAX_COLUMNS} signals: no more are read"));
        }
        let mut key = format!("f{}", self.signals.len() + 1);
        let mut signal = Signal::default();
        for attribute in attributes {
            let (name, value) = attribute?;
            match name {
                "id" => key = value.into_owned(),
                "name" => signal.name = value.into_owned(),
                "description" => signal.description = value.into_owned(),
                "interval" => signal.interval = positive(&value),
                "datapointCount" => signal.count = value.trim().parse().ok(),
                _ => {}
            }
        }
        let shown = clip(&key);
        if self.keys.insert(key, self.signals.len()).is_some() {
            return Err(format!("two dataSignals \"{shown}\": an id must be unique"));
        }
        self.signals.push(signal);
        Ok(())
    }

    /// The `frameHeader`.
    pub(super) fn header<'a>(&mut self, attributes: impl Attributes<'a>) -> Result<(), String> {
        for attribute in attributes {
            let (name, value) = attribute?;
            self.is_whole |= name == "dropOuts" && value.trim() == "0";
        }
        Ok(())
    }

    /// Puts back each `rec` that was left out because no signal changed: where the signals'
    /// `datapointCount` counts it, or where none has one and no `dropOuts` are told. At most so
    /// many are put back. How many were.
    pub(super) fn hold(&mut self, most: usize) -> usize {
        let Some((interval, places)) = self.places() else {
            return 0;
        };
        let (rows, seen) = (self.times.len(), places.last().map_or(0, |last| last + 1));
        let counted = self.signals.iter().filter_map(|signal| signal.count).max();
        // A signal whose value did not change at the end has no last `rec`.
        let whole = match counted {
            Some(counted) if counted >= seen => counted,
            None if self.is_whole => seen,
            _ => return 0,
        };
        if whole <= rows || whole - rows > most {
            return 0;
        }
        let mut times: Vec<f64> = (0..whole)
            .map(|place| self.times[0] + place as f64 * interval)
            .collect();
        places
            .iter()
            .zip(&self.times)
            .for_each(|(&place, &time)| times[place] = time);
        self.times = times;
        for signal in &mut self.signals {
            signal
                .changes
                .iter_mut()
                .for_each(|(rec, _)| *rec = places[*rec]);
        }
        whole - rows
    }

    /// The shortest interval of the signals, and where on it each `rec` lies; `None` if one
    /// lies beside it.
    fn places(&self) -> Option<(f64, Vec<usize>)> {
        let intervals = self.signals.iter().filter_map(|signal| signal.interval);
        let interval = intervals.min_by(f64::total_cmp)?;
        let start = *self.times.first()?;
        let mut places: Vec<usize> = Vec::with_capacity(self.times.len());
        for time in &self.times {
            let place = (time - start) / interval;
            let is_beside = (place - place.round()).abs() > OFF;
            let place = place.round() as usize;
            if is_beside || places.last().is_some_and(|last| place <= *last) {
                return None;
            }
            places.push(place);
        }
        Some((interval, places))
    }

    /// A `rec`.
    pub(super) fn rec<'a>(&mut self, attributes: impl Attributes<'a>) -> Result<(), String> {
        let (mut time, rec) = (None, self.times.len());
        for attribute in attributes {
            let (name, value) = attribute?;
            match (name, self.keys.get(name)) {
                ("time", _) if time.is_some() => return Err(TWICE.to_owned()),
                ("time", _) => time = Some(seconds(&value)?),
                (_, Some(&signal)) => self.value(signal, rec, &value)?,
                _ if is_key(name) => {
                    return Err(format!(
                        "a rec has \"{}\", which no dataSignal has as its id",
                        clip(name)
                    ));
                }
                _ => {}
            }
        }
        self.times
            .push(time.ok_or("a rec without time: each needs one")?);
        Ok(())
    }

    fn value(&mut self, signal: usize, rec: usize, text: &str) -> Result<(), String> {
        let signal = &mut self.signals[signal];
        if signal.changes.last().is_some_and(|(last, _)| *last == rec) {
            return Err(TWICE.to_owned());
        }
        let value = text.trim().parse().unwrap_or_else(|_| {
            let found = || format!("not numbers only (\"{}\" in rec {})", clip(text), rec + 1);
            signal.other.get_or_insert_with(found);
            f64::NAN
        });
        let measured = value < NOT_MEASURED;
        let value = if measured { value } else { f64::NAN };
        signal.changes.push((rec, value));
        Ok(())
    }
}

fn positive(text: &str) -> Option<f64> {
    let number: Option<f64> = text.trim().parse().ok();
    number.filter(|number| number.is_finite() && *number > 0.0)
}

fn seconds(text: &str) -> Result<f64, String> {
    let time: Option<f64> = text.trim().parse().ok();
    time.filter(|time| time.is_finite())
        .ok_or_else(|| format!("the time of a rec is \"{}\", not a number", clip(text)))
}

/// As ids of signals are: `f12`.
fn is_key(name: &str) -> bool {
    name.strip_prefix('f')
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}
