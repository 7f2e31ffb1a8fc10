//! One instance of a unit: its modes and its run.

mod bytes;
mod steps;
mod values;

use std::path::Path;
use std::sync::Arc;

use axis_sim::Axis;

use crate::correction::UnitCorrection;
use crate::error::UnitError;
use crate::history::History;
use crate::kind::UnitKind;
use crate::machine::Machine;
use crate::mode::FmiMode;
use crate::one_axis::OneAxis;
use crate::simulated::Simulated;
use crate::subject::{Resource, Subject};
use crate::variables::{VariableKind, Variables};

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
    subject: Box<dyn Subject>,
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
            UnitKind::ClosedLoop | UnitKind::Plant => {
                let axis = OneAxis::of(kind, name, text, |_| Ok(None))?;
                Self::with(kind, Box::new(axis))
            }
            UnitKind::Compensated => Err(UnitError::NoCorrection),
            UnitKind::Machine => Err(UnitError::NoMachine),
        }
    }

    /// An instance of the axis in its closed loop with the correction of this text
    /// ([`UnitCorrection::text`]).
    ///
    /// # Errors
    /// As [`Unit::of`] and [`UnitCorrection::parse`].
    pub fn compensated(name: &str, text: &str, correction: &str) -> Result<Self, UnitError> {
        let kind = UnitKind::Compensated;
        let made = |axis: &Axis| UnitCorrection::parse(axis, correction).map(Some);
        Self::with(kind, Box::new(OneAxis::of(kind, name, text, made)?))
    }

    /// An instance of the machine of this machine file; the axis files that it names are read, too.
    ///
    /// # Errors
    /// [`UnitError::MachineFile`], [`UnitError::Axis`] for a file that cannot be read or makes no
    /// machine.
    pub fn machine(file: &Path) -> Result<Self, UnitError> {
        Self::with(UnitKind::Machine, Box::new(Machine::read(file)?))
    }

    fn with(kind: UnitKind, subject: Box<dyn Subject>) -> Result<Self, UnitError> {
        let variables = subject.variables()?;
        let inputs = variables.iter();
        let inputs = inputs.filter(|variable| matches!(variable.kind, VariableKind::Input(_)));
        Ok(Self {
            mode: FmiMode::Instantiated,
            values: variables.starts(),
            run: None,
            begun: variables.starts(),
            // The inputs, and the length.
            history: History::new(inputs.count() + 1),
            span: [0.0, f64::INFINITY],
            file: Arc::new(File {
                kind,
                subject,
                variables,
            }),
        })
    }

    /// The correction of a compensated one.
    pub fn correction(&self) -> Option<&UnitCorrection> {
        self.file.subject.correction()
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

    /// The files that it is made of again, as they lie among its resources.
    pub(crate) fn resources(&self) -> Vec<Resource<'_>> {
        self.file.subject.resources()
    }

    /// Short name of the axis or machine.
    pub fn name(&self) -> &str {
        self.file.subject.name()
    }

    /// What it is, for people.
    pub fn description(&self) -> String {
        self.file.subject.description()
    }

    /// Fingerprint of the axis, or of the files of a machine.
    pub fn fingerprint(&self) -> String {
        self.file.subject.fingerprint()
    }

    /// The axis of each drive, as its file has it: one, but for a machine.
    pub fn axes(&self) -> &[Axis] {
        self.file.subject.axes()
    }

    /// Control period, s; of a machine the shortest time of which those of all its drives are whole
    /// parts.
    pub fn period(&self) -> f64 {
        self.file.subject.period()
    }

    /// Where it is in the calling order.
    pub fn mode(&self) -> FmiMode {
        self.mode
    }

    /// The token that a description and its library must agree in: the axis, the program's version
    /// and the kind.
    pub fn token(&self) -> String {
        let (subject, version) = (&self.file.subject, env!("CARGO_PKG_VERSION"));
        format!("{}-{version}{}", subject.fingerprint(), subject.mark())
    }

    /// Time that it has reached, s.
    pub fn time(&self) -> f64 {
        let periods = self.run.as_ref().map_or(0.0, |run| run.0.periods());
        self.span[0] + periods * self.period()
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
        self.history = History::new(self.history.words());
        self.span = [0.0, f64::INFINITY];
    }

    /// Marks the instance as failed: only a reset or a saved state brings it back.
    pub fn fail(&mut self) {
        self.mode = FmiMode::Failed;
    }

    /// The run, begun where it is not: at rest, with the parameters as they are.
    fn settled(&mut self) -> Result<(), UnitError> {
        if self.run.is_none() {
            let (changed, inputs) = (self.changed(), self.inputs());
            let run = (self.file.subject).begin(&changed, &inputs, self.is_compensated())?;
            self.run = Some(run);
            self.begun.clone_from(&self.values);
            self.history = History::new(self.history.words());
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
