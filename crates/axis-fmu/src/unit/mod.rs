//! One instance of a unit: its modes and its run.

mod bytes;
mod steps;
mod values;

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop};

use crate::correction::UnitCorrection;
use crate::error::UnitError;
use crate::history::History;
use crate::kind::UnitKind;
use crate::mode::FmiMode;
use crate::parameters;
use crate::run::Corrected;
use crate::simulated::Simulated;
use crate::variables::Variables;

/// One instance of a unit. A clone is its saved state.
#[derive(Clone, Debug)]
pub struct Unit {
    file: Arc<File>,
    mode: FmiMode,
    /// Of inputs and parameters, by value reference.
    values: Vec<f64>,
    run: Option<Simulated>,
    /// What the run was begun with, and what was done with it.
    begun: Vec<f64>,
    history: History,
    /// Start and end of the simulation, s.
    span: [f64; 2],
}

/// What all instances of a file have in common.
#[derive(Debug)]
struct File {
    kind: UnitKind,
    name: String,
    text: String,
    axis: Axis,
    correction: Option<UnitCorrection>,
    variables: Variables,
}

impl Unit {
    /// An instance of the axis in its closed loop, whose file has this text; `name` stands for it in
    /// messages.
    ///
    /// # Errors
    /// As [`Unit::of`].
    pub fn new(name: &str, text: &str) -> Result<Self, UnitError> {
        Self::of(UnitKind::ClosedLoop, name, text)
    }

    /// An instance of that kind; a compensated one is made by [`Unit::compensated`].
    ///
    /// # Errors
    /// [`UnitError::Axis`], [`UnitError::Setup`] if the axis cannot be simulated;
    /// [`UnitError::NoCorrection`].
    pub fn of(kind: UnitKind, name: &str, text: &str) -> Result<Self, UnitError> {
        match kind {
            UnitKind::ClosedLoop | UnitKind::Plant => Self::with(kind, name, text, |_| Ok(None)),
            UnitKind::Compensated => Err(UnitError::NoCorrection),
        }
    }

    /// An instance of the axis in its closed loop with the correction of this text
    /// ([`UnitCorrection::text`]).
    ///
    /// # Errors
    /// As [`Unit::of`] and [`UnitCorrection::parse`].
    pub fn compensated(name: &str, text: &str, correction: &str) -> Result<Self, UnitError> {
        let made = |axis: &Axis| UnitCorrection::parse(axis, correction).map(Some);
        Self::with(UnitKind::Compensated, name, text, made)
    }

    fn with(
        kind: UnitKind,
        name: &str,
        text: &str,
        correction: impl FnOnce(&Axis) -> Result<Option<UnitCorrection>, UnitError>,
    ) -> Result<Self, UnitError> {
        let axis = Axis::parse(name, text)?;
        ClosedLoop::new(&axis)?;
        let correction = correction(&axis)?;
        let variables = Variables::of(kind, &axis, name, text)?;
        Ok(Self {
            mode: FmiMode::Instantiated,
            values: variables.starts(),
            run: None,
            begun: variables.starts(),
            history: History::default(),
            span: [0.0, f64::INFINITY],
            file: Arc::new(File {
                kind,
                name: name.to_owned(),
                text: text.to_owned(),
                axis,
                correction,
                variables,
            }),
        })
    }

    /// The correction of a compensated one.
    pub fn correction(&self) -> Option<&UnitCorrection> {
        self.file.correction.as_ref()
    }

    /// Control periods by which the axis follows its references late: 0 without a correction.
    pub fn look_ahead(&self) -> usize {
        self.correction().map_or(0, UnitCorrection::look_ahead)
    }

    /// Its variables.
    pub fn variables(&self) -> &Variables {
        &self.file.variables
    }

    /// What of the axis it is.
    pub fn kind(&self) -> UnitKind {
        self.file.kind
    }

    /// The axis file's text.
    pub(crate) fn text(&self) -> &str {
        &self.file.text
    }

    /// The axis, as the file has it.
    pub fn axis(&self) -> &Axis {
        &self.file.axis
    }

    /// Where it is in the calling order.
    pub fn mode(&self) -> FmiMode {
        self.mode
    }

    /// The token that a description and its library must agree in: the axis, the program's version
    /// and the kind.
    pub fn token(&self) -> String {
        let correction = self.correction().map_or("", UnitCorrection::text);
        let digest = bytes::digest(correction.as_bytes());
        format!(
            "{}-{}{}",
            self.file.axis.fingerprint,
            env!("CARGO_PKG_VERSION"),
            self.file.kind.mark(digest)
        )
    }

    /// Time that it has reached, s.
    pub fn time(&self) -> f64 {
        let periods = self.run.as_ref().map_or(0.0, Simulated::periods);
        self.span[0] + periods * self.file.axis.period
    }

    /// Begins the initialisation at `start` (s); no step goes beyond `stop` (s), if there is one.
    ///
    /// # Errors
    /// As [`Unit::set_up`] and [`Unit::begin_initialization`].
    pub fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Result<(), UnitError> {
        self.once()?;
        self.set_up(start, stop)?;
        self.begin_initialization()
    }

    /// Says when the simulation begins, `start` (s), and that no step goes beyond `stop` (s), if there
    /// is one. Without it, it begins at 0 and has no end.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless instantiated; [`UnitError::Time`] for a time that is not finite,
    /// or an end before the start.
    pub fn set_up(&mut self, start: f64, stop: Option<f64>) -> Result<(), UnitError> {
        self.in_mode(
            "setting up the experiment",
            &[FmiMode::Instantiated],
            "before the initialization",
        )?;
        finite("start time", start)?;
        if let Some(stop) = stop.filter(|stop| !(*stop >= start && stop.is_finite())) {
            let valid = format!("a number from the start time {start} s on");
            return Err(UnitError::Time {
                what: "stop time",
                value: stop,
                valid,
            });
        }
        self.span = [start, stop.unwrap_or(f64::INFINITY)];
        Ok(())
    }

    /// Begins the initialisation.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless instantiated.
    pub fn begin_initialization(&mut self) -> Result<(), UnitError> {
        self.once()?;
        self.mode = FmiMode::Initialization;
        Ok(())
    }

    fn once(&self) -> Result<(), UnitError> {
        self.in_mode(
            "initialization",
            &[FmiMode::Instantiated],
            "once, after it is made or reset",
        )
    }

    /// Ends it: the axis is at rest at the position reference, under its own loads.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless in initialisation; [`UnitError::Axis`], [`UnitError::Setup`]
    /// if the parameters make no axis, or it cannot be there.
    pub fn exit_initialization(&mut self) -> Result<(), UnitError> {
        self.in_mode(
            "end of the initialization",
            &[FmiMode::Initialization],
            "after its beginning",
        )?;
        self.settled()?;
        self.mode = FmiMode::Step;
        Ok(())
    }

    /// Ends the simulation; what was computed last can still be read.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless in step mode or stopped by an error.
    pub fn terminate(&mut self) -> Result<(), UnitError> {
        self.in_mode(
            "termination",
            &[FmiMode::Step, FmiMode::Failed],
            "once, after the initialization",
        )?;
        self.mode = FmiMode::Terminated;
        Ok(())
    }

    /// As it was when it was made, in any mode.
    pub fn reset(&mut self) {
        self.mode = FmiMode::Instantiated;
        self.values = self.file.variables.starts();
        self.run = None;
        self.begun.clone_from(&self.values);
        self.history = History::default();
        self.span = [0.0, f64::INFINITY];
    }

    /// Marks the instance as failed: only a reset or a saved state brings it back.
    pub fn fail(&mut self) {
        self.mode = FmiMode::Failed;
    }

    /// The run, begun where it is not: at rest, with the parameters as they are.
    fn settled(&mut self) -> Result<(), UnitError> {
        if self.run.is_none() {
            let changed = self.changed();
            let changed_axis;
            let axis = if changed.is_empty() {
                &self.file.axis
            } else {
                let (name, text) = (&self.file.name, &self.file.text);
                changed_axis = parameters::with(name, text, changed.into_iter())?;
                &changed_axis
            };
            let correction = self.correction().filter(|_| self.is_compensated());
            let corrected = Corrected {
                law: correction.map(UnitCorrection::law),
                look_ahead: self.look_ahead(),
            };
            let run = Simulated::begin(self.file.kind, axis, &self.given(), corrected)?;
            self.run = Some(run);
            self.begun.clone_from(&self.values);
            self.history = History::default();
        }
        Ok(())
    }

    fn in_mode(
        &self,
        call: &'static str,
        modes: &[FmiMode],
        valid: &'static str,
    ) -> Result<(), UnitError> {
        match modes.contains(&self.mode) {
            true => Ok(()),
            false => Err(self.order(call, valid)),
        }
    }

    fn order(&self, call: &'static str, valid: &'static str) -> UnitError {
        let mode = self.mode;
        UnitError::Order { call, mode, valid }
    }
}

fn finite(what: &'static str, value: f64) -> Result<(), UnitError> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(UnitError::Time {
            what,
            value,
            valid: "a finite number".to_owned(),
        }),
    }
}
