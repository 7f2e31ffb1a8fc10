//! One file on its own clock, with holes.

use std::path::Path;

use super::done::Done;
use super::error::IntakeError;
use super::evened::{MOST_EMPTY, Stamps, even_out};
use super::unwrapped::unwrapped;
use crate::channel::Channel;
use crate::mapping::Mapping;
use crate::numeric::grid::Grid;
use crate::read::read;
use crate::read_error::ReadError;
use crate::table::{Holes, Note};

/// Channels on one clock; NaN if there is no value.
pub(super) struct Recording {
    pub name: String,
    pub time: Vec<f64>,
    /// Without the time.
    pub channels: Vec<Channel>,
    /// By how much each channel comes late, as the mapping says, s.
    pub delays: Vec<f64>,
    /// Sampling period, s, and greatest jitter in periods; of one row there is none.
    pub grid: Option<Even>,
    /// Rows that were missing, and in how many places.
    pub missing: [usize; 2],
    /// What was done on reading.
    pub done: Vec<Done>,
    /// What was done about uneven time stamps.
    pub evened: Option<Done>,
}

/// The even grid of a recording.
#[derive(Clone, Copy)]
pub(super) struct Even {
    pub start: f64,
    pub period: f64,
}

/// Greatest distance of an instant from the grid at which it can be taken to lie on it,
/// in periods.
const MOST_JITTER: f64 = 0.25;

impl Recording {
    pub(super) fn read(
        path: &Path,
        mapping: &Mapping,
        required: &[&str],
        is_alone: bool,
    ) -> Result<Self, IntakeError> {
        let name = path.display().to_string();
        let refused = |problem| ReadError {
            file: name.clone(),
            problem,
        };
        let read = read(path, mapping, required, Holes::Kept).map_err(refused)?;
        let map = |c: &Channel| read.maps.iter().find(|m| m.channel == c.name);
        let delay = |c: &Channel| map(c).map_or(0.0, |m| m.delay);
        let of_file = |note| Done::Read {
            file: name.clone(),
            note,
        };
        // Of several files each has some of the columns.
        let is_told = |note: &Note| is_alone || !matches!(note, Note::NoColumn { .. });
        let notes = read.notes.into_iter().filter(is_told);
        let mut done: Vec<Done> = notes.map(of_file).collect();
        let mut channels = read.channels;
        let scale = |c: &Channel| map(c).map_or(1.0, |m| m.scale);
        done.extend(unwrapped(&mut channels, scale));
        Ok(Self {
            done,
            ..Self::of(name, channels, delay)?
        })
    }

    /// Of channels with the time first, as long as each other, and the delay of each.
    pub(super) fn of(
        name: String,
        mut channels: Vec<Channel>,
        delay: impl Fn(&Channel) -> f64,
    ) -> Result<Self, IntakeError> {
        let time = channels.remove(0).samples;
        let mut recording = Self {
            delays: channels.iter().map(delay).collect(),
            name,
            time,
            channels,
            grid: None,
            missing: [0; 2],
            done: Vec::new(),
            evened: None,
        };
        recording.even_out();
        recording.fill_rows()?;
        Ok(recording)
    }

    fn even_out(&mut self) {
        let Some(evened) = even_out(&self.time, &mut self.channels) else {
            return;
        };
        self.time = evened.time;
        let (file, jitter) = (self.name.clone(), evened.jitter);
        let rate = 1.0 / evened.period;
        self.evened = Some(match evened.stamps {
            Stamps::Samples => Done::Interpolated { file, jitter, rate },
            Stamps::Row(rows) => Done::Shifted {
                file,
                rows,
                jitter,
                rate,
            },
            Stamps::Messages => Done::Evened { file, jitter, rate },
        });
    }

    /// Puts missing rows back, as NaN. Other rows keep their time stamps.
    fn fill_rows(&mut self) -> Result<(), IntakeError> {
        let Some(grid) = Grid::of(&self.time) else {
            return Ok(());
        };
        self.grid = Some(Even {
            start: grid.start,
            period: grid.period,
        });
        let (rows, length) = (self.time.len(), grid.length());
        if length == rows {
            return Ok(());
        }
        if length > MOST_EMPTY.saturating_mul(rows) {
            let file = self.name.clone();
            return Err(IntakeError::Sparse {
                file,
                rows,
                grid: length,
            });
        }
        let spread = |from: &[f64], empty: &dyn Fn(usize) -> f64| {
            let mut to: Vec<f64> = (0..length).map(empty).collect();
            grid.places.iter().zip(from).for_each(|(&p, &v)| to[p] = v);
            to
        };
        let gaps = grid.places.windows(2).filter(|w| w[1] > w[0] + 1).count();
        self.missing = [length - rows, gaps];
        let even = |k: usize| grid.start + k as f64 * grid.period;
        self.time = increasing(spread(&self.time, &even), &grid);
        for channel in &mut self.channels {
            channel.samples = spread(&channel.samples, &|_| f64::NAN);
        }
        Ok(())
    }

    /// Its even grid.
    pub(super) fn even(&self) -> Result<Even, IntakeError> {
        let file = || self.name.clone();
        let rows = self.time.len();
        let grid = self
            .grid
            .ok_or_else(|| IntakeError::TooShort { file: file(), rows })?;
        let off = |k: usize| {
            let at = grid.start + k as f64 * grid.period;
            (self.time[k] - at).abs() / grid.period
        };
        let worst = (0..rows)
            .max_by(|&a, &b| off(a).total_cmp(&off(b)))
            .unwrap_or(0);
        if off(worst) > MOST_JITTER {
            return Err(IntakeError::Jitter {
                file: file(),
                time: self.time[worst],
                jitter: off(worst),
                period: grid.period,
                most: MOST_JITTER,
            });
        }
        Ok(grid)
    }
}

/// Jitter beside a gap could turn an instant that was put there with one that was stamped;
/// the one that was put there gives way.
fn increasing(mut time: Vec<f64>, grid: &Grid) -> Vec<f64> {
    for w in grid.places.windows(2).filter(|w| w[1] > w[0] + 1) {
        let (from, to) = (time[w[0]], time[w[1]]);
        let steps = (w[1] - w[0]) as f64;
        for (i, t) in time[w[0] + 1..w[1]].iter_mut().enumerate() {
            *t = from + (to - from) * ((i + 1) as f64 / steps);
        }
    }
    time
}
