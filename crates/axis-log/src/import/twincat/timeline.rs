//! Which channels were sampled together.

use std::ops::Range;

use super::clock::Clock;
use super::number::decimal;
use super::rows::{Row, Rows};
use crate::read_error::ReadProblem;
use crate::table::Fault;

/// What messages call a column of times.
const TIME: &str = "time";

/// A timeline, as its texts tell it: the same instant is always the same text.
#[derive(Default)]
struct Timeline<'a> {
    /// Instants that are another than the one before.
    instants: usize,
    /// The first two of them.
    first: Vec<&'a str>,
    last: &'a str,
    /// Rows in which it has a time.
    rows: usize,
    /// Line in which it first has another time than the main one, as long as it goes.
    differs: Option<u64>,
}

impl<'a> Timeline<'a> {
    fn add(&mut self, time: &'a str) {
        self.rows += 1;
        if time != self.last {
            self.instants += 1;
            self.last = time;
            if self.first.len() < 2 {
                self.first.push(time);
            }
        }
    }
}

/// The timelines of an export.
pub(super) struct Timelines<'a> {
    all: Vec<Timeline<'a>>,
    main: usize,
}

impl<'a> Timelines<'a> {
    /// Refuses times that are no numbers, and values without a time.
    pub(super) fn of(groups: &[Range<usize>], rows: &Rows<'a>) -> Result<Self, ReadProblem> {
        let mut all: Vec<Timeline<'a>> = groups.iter().map(|_| Timeline::default()).collect();
        for row in rows.iter() {
            let all = all.iter_mut().zip(groups);
            for (timeline, group) in all.take_while(|(_, group)| group.start < row.fields.len()) {
                match row.field(group.start) {
                    "" => check_blank(&row, group)?,
                    time => {
                        check_number(&row, group.start, time)?;
                        timeline.add(time);
                    }
                }
            }
        }
        let most = all.iter().map(|timeline| timeline.instants).max();
        let main = all
            .iter()
            .position(|timeline| Some(timeline.instants) == most);
        let mut timelines = Self {
            all,
            main: main.unwrap_or_default(),
        };
        timelines.compare(groups, rows);
        Ok(timelines)
    }

    /// Each is compared to its last sample, or to where it differs: then it costs no more, so
    /// that the work is no more than the fields.
    fn compare(&mut self, groups: &[Range<usize>], rows: &Rows<'a>) {
        let mut left: Vec<usize> = self.all.iter().map(|timeline| timeline.rows).collect();
        let mut compared: Vec<usize> = (0..groups.len()).filter(|&k| left[k] > 0).collect();
        for row in rows.iter() {
            let main = row.field(groups[self.main].start);
            compared.retain(|&k| {
                let time = row.field(groups[k].start);
                if time != main {
                    self.all[k].differs = Some(row.line);
                }
                left[k] -= usize::from(!time.is_empty());
                time == main && left[k] > 0
            });
        }
    }

    /// Number of the one with the most instants, the first of several.
    pub(super) fn main(&self) -> usize {
        self.main
    }

    pub(super) fn clock(&self) -> Clock {
        Clock::of(self.all[self.main].first.first().unwrap_or(&""))
    }

    /// Rows that have a time of the main one.
    pub(super) fn samples(&self) -> usize {
        self.all[self.main].rows
    }

    /// Why the channels of a timeline have no values at the times of the main one.
    pub(super) fn fault(&self, timeline: usize) -> Option<Fault> {
        let [of, main] = [timeline, self.main].map(|k| &self.all[k]);
        let found = match of.differs {
            _ if of.rows == 0 => "without a sample".to_owned(),
            None => return None,
            Some(line) => format!(
                "sampled at other times from line {line} on ({}; the time {})",
                self.pace(of),
                self.pace(main)
            ),
        };
        Some(Fault {
            found,
            valid: "an export of channels with one sample time",
        })
    }

    fn pace(&self, of: &Timeline<'_>) -> String {
        // Rounded to what is left of a difference of such times.
        let ms = |text: &&str| self.clock().seconds(text).map(|s| (s * 1e9).round() / 1e6);
        let times: Vec<f64> = of.first.iter().filter_map(ms).collect();
        match times[..] {
            [first, second] => {
                let every = ((second - first) * 1e6).round() / 1e6;
                format!("every {every} ms from {first} ms on")
            }
            _ => format!("{} times", of.instants),
        }
    }
}

fn check_blank(row: &Row<'_>, group: &Range<usize>) -> Result<(), ReadProblem> {
    match group.clone().all(|field| row.field(field).is_empty()) {
        true => Ok(()),
        false => Err(ReadProblem::MissingValue {
            place: row.place(group.start),
            name: TIME.to_owned(),
        }),
    }
}

fn check_number(row: &Row<'_>, field: usize, time: &str) -> Result<(), ReadProblem> {
    match decimal(time) {
        Some(_) => Ok(()),
        None => Err(ReadProblem::NotANumber {
            place: row.place(field),
            name: TIME.to_owned(),
            text: time.to_owned(),
        }),
    }
}
