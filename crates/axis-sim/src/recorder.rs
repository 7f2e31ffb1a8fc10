//! Cycles to a log with named channels.

use std::io::{self, Write};

use axis_log::{Channel, Log, LogError, write_csv_to};

use crate::axis::Axis;
use crate::channels::{LogChannel, channels};
use crate::cycle::Cycle;
use crate::mechanism::Freedom;

/// Collects the cycles of a run, in memory.
#[derive(Clone, Debug)]
pub struct Recorder {
    channels: Vec<LogChannel>,
    freedom: Freedom,
    cycles: Vec<Cycle>,
}

impl Recorder {
    /// For runs of this axis: the channels of [`CHANNELS`](crate::CHANNELS) that it has.
    pub fn new(axis: &Axis) -> Self {
        Self {
            channels: channels(axis),
            freedom: axis.freedom(),
            cycles: Vec::new(),
        }
    }

    /// With a channel more.
    #[must_use]
    pub fn with(mut self, channel: LogChannel) -> Self {
        self.channels.push(channel);
        self
    }

    /// Adds a cycle; pass this to [`crate::ClosedLoop::run`].
    pub fn push(&mut self, cycle: &Cycle) {
        self.cycles.push(*cycle);
    }

    /// The cycles so far.
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles
    }

    /// The log: one channel a signal, one sample a cycle.
    ///
    /// # Errors
    /// [`LogError`] where there is no cycle, or one that is not finite.
    pub fn log(&self) -> Result<Log, LogError> {
        let one = |channel: &LogChannel| {
            let [name, unit] = channel.of_freedom(self.freedom);
            Channel {
                name: name.to_owned(),
                unit: unit.to_owned(),
                samples: self.cycles.iter().map(channel.read).collect(),
            }
        };
        Log::new(self.channels.iter().map(one).collect())
    }
}

/// Cycles that are held before they are written.
const BLOCK: usize = 4096;

/// Writes the cycles of a run as the CSV text of their log while it goes on:
/// what it holds does not grow with the run.
///
/// The text is that of [`Recorder::log`] written by [`axis_log::write_csv_to`].
#[derive(Debug)]
pub struct CsvRecorder<W> {
    writer: W,
    block: Recorder,
    rows: u64,
    failed: Option<io::Error>,
}

impl<W: Write> CsvRecorder<W> {
    /// Writes what `recorder` would collect to `writer`, in large pieces.
    pub fn new(writer: W, recorder: Recorder) -> Self {
        Self {
            writer,
            block: recorder,
            rows: 0,
            failed: None,
        }
    }

    /// Adds a cycle. After an error nothing more is written;
    /// [`CsvRecorder::finish`] tells it.
    pub fn push(&mut self, cycle: &Cycle) {
        if self.failed.is_some() {
            return;
        }
        self.block.push(cycle);
        if self.block.cycles.len() == BLOCK {
            self.failed = self.write_block().err();
        }
    }

    /// Writes what is left, and gives the writer back.
    ///
    /// # Errors
    /// The writer's; [`io::ErrorKind::InvalidData`] where there was no cycle,
    /// or one that is not finite.
    pub fn finish(mut self) -> io::Result<W> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        if self.rows == 0 || !self.block.cycles.is_empty() {
            self.write_block()?;
        }
        self.writer.flush()?;
        Ok(self.writer)
    }

    fn write_block(&mut self) -> io::Result<()> {
        let invalid = |error| io::Error::new(io::ErrorKind::InvalidData, error);
        let mut text = Vec::new();
        write_csv_to(&mut text, &self.block.log().map_err(invalid)?)?;
        // The names stand once, at the top.
        let header = text.iter().position(|&byte| byte == b'\n');
        let from = match header {
            Some(end) if self.rows > 0 => end + 1,
            _ => 0,
        };
        self.writer.write_all(&text[from..])?;
        self.rows += self.block.cycles.len() as u64;
        self.block.cycles.clear();
        Ok(())
    }
}
