//! One instance of a unit: its modes and its run.

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop};
use trajectories::Setpoint;

use crate::error::UnitError;
use crate::mode::FmiMode;
use crate::parameters;
use crate::run::{Given, Run};
use crate::variables::{Input, VariableKind, Variables};

/// Share of the control period by which a communication point may be off: what rounding makes
/// of a time that is added up.
const POINT_TOLERANCE: f64 = 1e-2;

/// Share of the stop time by which a step may end behind it: importers compare times to about
/// nine digits.
const STOP_TOLERANCE: f64 = 1e-9;

/// Most control cycles in one communication step.
const MOST_CYCLES: f64 = 1e9;

/// One instance of a unit. A clone is its saved state.
#[derive(Clone, Debug)]
pub struct Unit {
    file: Arc<File>,
    mode: FmiMode,
    /// Of inputs and parameters, by value reference.
    values: Vec<f64>,
    run: Option<Run>,
    /// Start and end of the simulation, s.
    span: [f64; 2],
}

/// What all instances of a file have in common.
#[derive(Debug)]
struct File {
    name: String,
    text: String,
    axis: Axis,
    variables: Variables,
}

impl Unit {
    /// An instance of the axis whose file has this text; `name` stands for it in messages.
    ///
    /// # Errors
    /// [`UnitError::Axis`], [`UnitError::Setup`] if it cannot be simulated.
    pub fn new(name: &str, text: &str) -> Result<Self, UnitError> {
        let axis = Axis::parse(name, text)?;
        ClosedLoop::new(&axis)?;
        let variables = Variables::of(&axis, name, text)?;
        Ok(Self {
            mode: FmiMode::Instantiated,
            values: variables.starts(),
            run: None,
            span: [0.0, f64::INFINITY],
            file: Arc::new(File {
                name: name.to_owned(),
                text: text.to_owned(),
                axis,
                variables,
            }),
        })
    }

    /// Its variables.
    pub fn variables(&self) -> &Variables {
        &self.file.variables
    }

    /// The axis, as the file has it.
    pub fn axis(&self) -> &Axis {
        &self.file.axis
    }

    /// Where it is in the calling order.
    pub fn mode(&self) -> FmiMode {
        self.mode
    }

    /// The token that a description and its library must agree in: the axis and the program's
    /// version.
    pub fn token(&self) -> String {
        token(&self.file.axis)
    }

    /// Time that it has reached, s.
    pub fn time(&self) -> f64 {
        let periods = self
            .run
            .as_ref()
            .map_or(0.0, |run| run.cycles as f64 + run.past);
        self.span[0] + periods * self.file.axis.period
    }

    /// Begins the initialisation at `start` (s); no step goes beyond `stop` (s), if there is one.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless instantiated; [`UnitError::Time`] for a time that is not finite,
    /// or an end before the start.
    pub fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Result<(), UnitError> {
        self.in_mode(
            "initialization",
            &[FmiMode::Instantiated],
            "once, after it is made or reset",
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
        self.mode = FmiMode::Initialization;
        Ok(())
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
        self.span = [0.0, f64::INFINITY];
    }

    /// Gives the instance up: what is left is to reset it, or to set it to a saved state.
    pub fn fail(&mut self) {
        self.mode = FmiMode::Failed;
    }

    /// The value of a variable, in its unit. In initialisation mode outputs are those of the axis
    /// at rest under what has been set so far.
    ///
    /// # Errors
    /// [`UnitError::Reference`]; [`UnitError::Order`] for an output before the initialisation; in
    /// it also as [`Unit::exit_initialization`].
    pub fn get(&mut self, reference: u32) -> Result<f64, UnitError> {
        let output = match &self.file.variables.get(reference)?.kind {
            VariableKind::Time => return Ok(self.time()),
            VariableKind::Output(output) => output.0,
            VariableKind::Input(_)
            | VariableKind::Parameter { .. }
            | VariableKind::ExactBetween => {
                return Ok(self
                    .values
                    .get(reference as usize)
                    .copied()
                    .unwrap_or(f64::NAN));
            }
        };
        if self.mode == FmiMode::Initialization {
            self.settled()?;
        }
        match &self.run {
            Some(run) => Ok(output.read(run.shown(), &run.cycle)),
            None => Err(self.order("reading an output", "from the initialization on")),
        }
    }

    /// Sets an input or, before the end of the initialisation, a parameter, in its unit.
    ///
    /// # Errors
    /// [`UnitError::Reference`]; [`UnitError::Set`] for what cannot be set, or not any more, and
    /// for what is not finite; [`UnitError::Order`] after the end.
    pub fn set(&mut self, reference: u32, value: f64) -> Result<(), UnitError> {
        let (set, is_before) = (
            self.file.variables.get(reference)?,
            self.mode != FmiMode::Step,
        );
        let refused = |why: &str| UnitError::Set {
            name: set.name.clone(),
            why: why.to_owned(),
        };
        let valid = [
            FmiMode::Instantiated,
            FmiMode::Initialization,
            FmiMode::Step,
        ];
        self.in_mode(
            "setting a variable",
            &valid,
            "before the end of the simulation",
        )?;
        match &set.kind {
            VariableKind::Time => return Err(refused("the steps make it")),
            VariableKind::Output(_) => return Err(refused("it is an output")),
            VariableKind::Parameter { .. } | VariableKind::ExactBetween if !is_before => {
                return Err(refused(
                    "it is fixed; valid: before the initialization ends",
                ));
            }
            VariableKind::ExactBetween if value != 0.0 && value != 1.0 => {
                return Err(refused(&format!("{value} is neither; valid: 0 or 1")));
            }
            VariableKind::Parameter { .. }
            | VariableKind::ExactBetween
            | VariableKind::Input(_) => {}
        }
        if !value.is_finite() {
            return Err(refused(&format!("{value} is no finite number")));
        }
        if let Some(place) = self.values.get_mut(reference as usize) {
            *place = value;
        }
        if is_before {
            self.run = None;
        }
        Ok(())
    }

    /// Goes from `point` (s), where the unit is, over `step` (s), of any length; the inputs are
    /// held. A control cycle takes those of the point where it begins. Where the step ends between
    /// two samples, outputs show the machine as of the last one, or, with the parameter
    /// `unit.exact_between_samples`, as it is. Gives the time reached, s.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless in step mode; [`UnitError::Time`] for another point, a step that
    /// is not above 0 or ends behind the stop time, and then nothing has been done;
    /// [`UnitError::Stopped`] if the run had to be given up.
    pub fn step(&mut self, point: f64, step: f64) -> Result<f64, UnitError> {
        self.in_mode("a step", &[FmiMode::Step], "after the initialization")?;
        let periods = self.periods(point, step)?;
        let (given, exact) = (self.given(), self.is_exact());
        let Some(run) = &mut self.run else {
            return Err(self.order("a step", "after the initialization"));
        };
        if let Err(stopped) = run.run_on(periods, &given, exact) {
            self.mode = FmiMode::Failed;
            return Err(stopped);
        }
        Ok(self.time())
    }

    /// Control periods of a communication step.
    fn periods(&self, point: f64, step: f64) -> Result<f64, UnitError> {
        let (now, period) = (self.time(), self.file.axis.period);
        let refused = |what, value, valid| Err(UnitError::Time { what, value, valid });
        let is_here = (point - now).abs() <= POINT_TOLERANCE * period;
        if !is_here {
            return refused(
                "communication point",
                point,
                format!("where the unit is, {now} s"),
            );
        }
        let most = MOST_CYCLES * period;
        if !(step > 0.0 && step <= most) {
            let valid = format!("above 0 and at most {most} s");
            return refused("communication step", step, valid);
        }
        let (left, stop) = (self.span[1] - now, self.span[1]);
        if step > left + (POINT_TOLERANCE * period).max(STOP_TOLERANCE * stop.abs()) {
            let valid = format!("up to the stop time, {stop} s");
            return refused("communication step", step, valid);
        }
        Ok(step / period)
    }

    /// Whether outputs show the machine between two samples as it is there.
    fn is_exact(&self) -> bool {
        let mut all = self.file.variables.iter().zip(&self.values);
        all.any(|(variable, value)| {
            matches!(variable.kind, VariableKind::ExactBetween) && *value != 0.0
        })
    }

    /// The inputs as the loop takes them.
    fn given(&self) -> Given {
        let of = |input: Input| {
            let is_it = |kind: &VariableKind| matches!(kind, VariableKind::Input(i) if *i == input);
            let mut all = self.file.variables.iter().zip(&self.values);
            all.find(|(variable, _)| is_it(&variable.kind))
                .map_or(0.0, |(_, value)| *value)
        };
        Given {
            reference: Setpoint {
                position: of(Input::Position),
                velocity: of(Input::Velocity),
                acceleration: of(Input::Acceleration),
                jerk: 0.0,
            },
            motor: of(Input::Motor),
            load: of(Input::Load),
        }
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
            self.run = Some(Run::begin(axis, &self.given())?);
        }
        Ok(())
    }

    /// The parameters that are not as the file has them: table, key, number.
    fn changed(&self) -> Vec<(&str, &str, f64)> {
        let all = self.file.variables.iter().zip(&self.values);
        let changed = all.filter_map(|(variable, value)| match &variable.kind {
            VariableKind::Parameter { table, key } if variable.start != Some(*value) => {
                Some((table.as_str(), key.as_str(), *value))
            }
            _ => None,
        });
        changed.collect()
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

/// The token of an axis, under this version of the program.
pub(crate) fn token(axis: &Axis) -> String {
    format!("{}-{}", axis.fingerprint, env!("CARGO_PKG_VERSION"))
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
