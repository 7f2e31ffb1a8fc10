//! Cycles to a log with named channels.

use std::io::{self, Write};
use std::mem;

use axis_log::{Channel, CsvSink, Log, LogError, LogSink};

use crate::axis::Axis;
use crate::channels::{LogChannel, channels};
use crate::cycle::{Cycle, RunStopped};
use crate::error::SetupError;
use crate::freedom::Freedom;
use crate::late_clock::{LateClocks, Lateness};

/// Collects the cycles of a run, in memory.
#[derive(Clone, Debug)]
pub struct Recorder {
    channels: Vec<LogChannel>,
    freedom: Freedom,
    late: Lateness,
    cycles: Vec<Cycle>,
}

impl Recorder {
    /// For runs of this axis: the channels of [`CHANNELS`](crate::CHANNELS) that it has, all on
    /// one clock.
    pub fn new(axis: &Axis) -> Self {
        Self {
            channels: channels(axis),
            freedom: axis.freedom(),
            late: Lateness::default(),
            cycles: Vec::new(),
        }
    }

    /// The same as this axis' log shows them: the load's channel and the reference's late by what
    /// its effects say (`clock-offset`, `reference-delay`). `period` is that of the cycles it is
    /// given, s.
    ///
    /// # Errors
    /// [`SetupError`] where an effect does not fit the axis.
    pub fn as_logged(axis: &Axis, period: f64) -> Result<Self, SetupError> {
        let (_, hooks) = axis.with_effects()?;
        Ok(Self {
            late: Lateness {
                load: hooks.clock_offset / period,
                reference: hooks.reference_delay / period,
            },
            ..Self::new(axis)
        })
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

    /// The cycles so far, as they were.
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles
    }

    /// The log: one channel a signal, one sample a cycle.
    ///
    /// # Errors
    /// [`LogError`] if there is no cycle, or one that is not finite.
    pub fn log(&self) -> Result<Log, LogError> {
        if self.late == Lateness::default() {
            return self.log_of(&self.cycles);
        }
        let mut shown = Vec::with_capacity(self.cycles.len());
        let mut clock = LateClocks::new(self.late);
        for cycle in &self.cycles {
            clock.push(cycle, |c| shown.push(c));
        }
        clock.finish(|c| shown.push(c));
        self.log_of(&shown)
    }

    /// The log of cycles as they are shown.
    fn log_of(&self, cycles: &[Cycle]) -> Result<Log, LogError> {
        let one = |channel: &LogChannel| {
            let [name, unit] = channel.of_freedom(self.freedom);
            Channel {
                name: name.to_owned(),
                unit: unit.to_owned(),
                samples: cycles.iter().map(channel.read).collect(),
            }
        };
        Log::new(self.channels.iter().map(one).collect())
    }
}

/// Cycles that are held before they are written.
const BLOCK: usize = 4096;

/// Writes the cycles of a run to a [`LogSink`], such as a [`LogFile`](axis_log::LogFile), while
/// it goes on: what it holds itself does not grow with the run.
///
/// What comes out is [`Recorder::log`] as the sink writes it.
#[derive(Debug)]
pub struct FlowRecorder<S> {
    sink: Box<S>,
    clock: LateClocks,
    block: Recorder,
    is_begun: bool,
    failed: Option<io::Error>,
}

/// Cycles to CSV text, that of [`axis_log::write_csv_to`].
pub type CsvRecorder<W> = FlowRecorder<CsvSink<W>>;

impl<W: Write> CsvRecorder<W> {
    /// Writes what `recorder` would collect to `writer`, in large pieces.
    pub fn new(writer: W, recorder: Recorder) -> Self {
        Self::to(CsvSink::new(writer), recorder)
    }
}

impl<S: LogSink> FlowRecorder<S> {
    /// Writes what `recorder` would collect to `sink`.
    pub fn to(sink: S, recorder: Recorder) -> Self {
        Self {
            sink: Box::new(sink),
            clock: LateClocks::new(recorder.late),
            block: recorder,
            is_begun: false,
            failed: None,
        }
    }

    /// Adds a cycle. After an error nothing more is written;
    /// [`FlowRecorder::finish`] tells it.
    pub fn push(&mut self, cycle: &Cycle) {
        if self.failed.is_some() {
            return;
        }
        let block = &mut self.block.cycles;
        self.clock.push(cycle, |shown| block.push(shown));
        if self.block.cycles.len() >= BLOCK {
            self.failed = self.write_block().err();
        }
    }

    /// Writes what is left, and ends the sink: CSV text gives its writer back.
    ///
    /// # Errors
    /// The sink's; [`io::ErrorKind::InvalidData`] if there was no cycle,
    /// or one that is not finite.
    pub fn finish(mut self) -> io::Result<S::End> {
        self.write_rest()?;
        self.sink.finish()
    }

    /// The same, of a run that did not come to its end: the log says so, and why, in a
    /// [note](LogSink::note) `stopped`.
    ///
    /// # Errors
    /// As [`FlowRecorder::finish`].
    pub fn finish_stopped(mut self, why: &RunStopped) -> io::Result<S::End> {
        self.write_rest()?;
        self.sink.note("stopped", &why.to_string())?;
        self.sink.finish()
    }

    fn write_rest(&mut self) -> io::Result<()> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        let block = &mut self.block.cycles;
        mem::replace(&mut self.clock, LateClocks::new(Lateness::default()))
            .finish(|shown| block.push(shown));
        if !self.is_begun || !self.block.cycles.is_empty() {
            self.write_block()?;
        }
        Ok(())
    }

    fn write_block(&mut self) -> io::Result<()> {
        let invalid = |error| io::Error::new(io::ErrorKind::InvalidData, error);
        self.sink
            .write(&self.block.log_of(&self.block.cycles).map_err(invalid)?)?;
        self.is_begun = true;
        self.block.cycles.clear();
        Ok(())
    }
}
