//! `heat`: hours of a duty, what they warm, and how far the axis grows by that.

use std::path::PathBuf;

use axis_sim::mechanism::Freedom;
use axis_sim::thermal::LossModel;
use axis_sim::{Axis, ClosedLoop, SixDigits};
use axis_thermal::{Duty, ThermalModel};
use clap::{Args, ValueEnum};
use compensator::NoCompensation;
use miette::{IntoDiagnostic, Result, WrapErr};
use trajectories::{Motion, Program, Step};

use super::heat_program::repeated;
pub use super::heat_time::LONGEST;
use super::heat_time::time;
use super::heat_words::{Heated, HeatedNode, HeatedPlace};
use super::motions::listed;
use super::{heat_fit, heat_predict, heat_slow};
use crate::context::{DEFAULT_AXIS, axis_with};
use crate::exit::wrong_use;
use crate::out_file;
use crate::output::print;
use crate::page::heat as heat_page;
use crate::set_key::SetKey;

/// Options of `heat`.
#[derive(Args)]
pub struct Options {
    /// Axis file; its [thermal] has the known thermal values, the others are assumed
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Set a key of the axis file to another value for this run, such as
    /// thermal.nut_to_screw_w_per_k=20 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<SetKey>,
    /// Trajectory of the axis file, from 1, there and back without end [default: 1]
    #[arg(long, value_name = "N", conflicts_with = "program")]
    trajectory: Option<usize>,
    /// Standstill at both ends of the trajectory, s [default: 1]
    #[arg(
        long,
        value_name = "S",
        conflicts_with = "program",
        allow_negative_numbers = true
    )]
    dwell: Option<f64>,
    /// Motion program (TOML) that ends where it begins, without end
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// How long, such as 1h, 90min, 600s or 1d
    #[arg(long, value_name = "TIME", default_value = "1h", value_parser = time)]
    duration: f64,
    /// Temperature of the air, and of the whole axis at the start, °C
    #[arg(
        long,
        value_name = "DEG_C",
        default_value_t = 20.0,
        allow_negative_numbers = true
    )]
    air: f64,
    /// Positions of the table at which growth is shown, mm [default: five over the stroke]
    #[arg(long, value_name = "MM", num_args = 1.., allow_negative_numbers = true)]
    at: Vec<f64>,
    /// Where the losses come from
    #[arg(long, value_enum, default_value_t = LossesFrom::Reference)]
    losses: LossesFrom,
    #[command(flatten)]
    slow: heat_slow::Options,
    /// Where to write a page: temperatures, growth and losses over time
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// Where the losses come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum LossesFrom {
    /// Friction's steady curve and the torque for the reference: no loop is simulated
    Reference,
    /// The motion simulated once in closed loop
    Simulation,
}

/// Intervals of what is shown, however long the duration.
const INTERVALS: u32 = 240;

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = options.axis()?;
    if options.slow.is_asked() {
        return options.slow_logs(&axis);
    }
    let motion = options.motion(&axis)?;
    let run = HeatRun {
        motion: &motion,
        name: options.name(),
        duration: options.duration,
        air: options.air,
        places: options.places(&axis)?,
        is_simulated: options.losses == LossesFrom::Simulation,
    };
    let mut heated = run.on(&axis)?;
    heated.report = options.report.clone();
    if let Some(path) = &options.report {
        axis_report::write_atomic(path, &heat_page::page(&heated)).into_diagnostic()?;
    }
    print("heat", &heated)
}

impl Options {
    /// Fits or predicts logs of hours.
    fn slow_logs(&self, axis: &Axis) -> Result<()> {
        let own = match self.motion(axis) {
            // An axis file without a trajectory may have logs with a reference.
            Err(_) if !self.names_a_motion() => None,
            motion => Some(motion?),
        };
        let duties = self.slow.programs(axis, own)?;
        match &self.slow.predict {
            Some(file) => {
                let given = heat_predict::Given {
                    axis,
                    duties: &duties,
                    air: self.air,
                    places: self.places(axis)?,
                };
                heat_predict::command(&given, &self.slow, file)
            }
            None => {
                let given = heat_fit::Given {
                    axis,
                    file: &self.axis,
                    set: &self.set,
                    duties: &duties,
                    air: self.air,
                };
                heat_fit::command(&given, &self.slow)
            }
        }
    }

    fn axis(&self) -> Result<Axis> {
        axis_with(&self.axis, &self.set)
    }

    /// The motion that repeats itself.
    fn motion(&self, axis: &Axis) -> Result<Program> {
        if let Some(file) = &self.program {
            return repeated(file, axis);
        }
        let spec = self.trajectory().checked_sub(1);
        let spec = spec.and_then(|i| axis.trajectories.get(i)).ok_or_else(|| {
            wrong_use(format!(
                "--trajectory {}: there is no such trajectory; the axis file has {}",
                self.trajectory(),
                listed(axis)
            ))
        })?;
        let (start, limits) = (axis.stroke.start, spec.limits);
        let rest = Step::Dwell {
            duration: self.dwell(),
        };
        let to = |to: f64| Step::Move { to, limits };
        let steps = vec![to(start + spec.displacement), rest, to(start), rest];
        let program = Program::new(start, steps);
        program.into_diagnostic().wrap_err("--dwell")
    }

    fn trajectory(&self) -> usize {
        self.trajectory.unwrap_or(1)
    }

    /// s.
    fn dwell(&self) -> f64 {
        self.dwell.unwrap_or(1.0)
    }

    /// Whether a motion was asked for, rather than left to the default.
    fn names_a_motion(&self) -> bool {
        self.program.is_some() || self.trajectory.is_some() || self.dwell.is_some()
    }

    /// What the motion is called.
    fn name(&self) -> String {
        match &self.program {
            Some(file) => file.display().to_string(),
            None => format!(
                "trajectory {} there and back, standstills of {} s",
                self.trajectory(),
                SixDigits(self.dwell())
            ),
        }
    }

    fn places(&self, axis: &Axis) -> Result<Vec<f64>> {
        places(axis, &self.at, GivenAs::AT)
    }
}

/// How positions are given: what they are called, their unit, and what it is in metres.
#[derive(Clone, Copy)]
pub struct GivenAs {
    /// What the user calls them.
    pub name: &'static str,
    /// Their unit.
    pub unit: &'static str,
    /// That unit, m.
    pub metres: f64,
}

impl GivenAs {
    /// Of the command.
    pub const AT: Self = Self {
        name: "--at",
        unit: "mm",
        metres: 1e-3,
    };
}

/// Positions at which growth is shown, m: those that were asked for, or five over the stroke.
///
/// # Errors
/// Wrong use, if one is outside the stroke or the load turns.
pub fn places(axis: &Axis, at: &[f64], given: GivenAs) -> Result<Vec<f64>> {
    let stroke = &axis.stroke;
    let GivenAs { name, unit, metres } = given;
    if axis.freedom() == Freedom::Rotary {
        return match at.is_empty() {
            true => Ok(Vec::new()),
            false => Err(wrong_use(format!(
                "{name}: the load of this axis turns, and growth is along lines alone"
            ))),
        };
    }
    if at.is_empty() {
        let width = stroke.maximum - stroke.minimum;
        let at = |i: u32| stroke.minimum + 0.25 * f64::from(i) * width;
        return Ok((0..5).map(at).collect());
    }
    let slack = 1e-9;
    let inside = stroke.minimum - slack..=stroke.maximum + slack;
    let place = |given: &f64| {
        let at = metres * given;
        match inside.contains(&at) {
            true => Ok(at),
            false => Err(wrong_use(format!(
                "{name} {given}: the table is between {} and {} {unit}",
                SixDigits(stroke.minimum / metres),
                SixDigits(stroke.maximum / metres)
            ))),
        }
    };
    at.iter().map(place).collect()
}

/// Hours of a duty.
pub struct HeatRun<'a> {
    /// The motion that repeats itself.
    pub motion: &'a dyn Motion,
    /// What it is called.
    pub name: String,
    /// How long, s.
    pub duration: f64,
    /// Temperature of the air, and of all at the start, °C.
    pub air: f64,
    /// Positions at which growth is shown, m.
    pub places: Vec<f64>,
    /// Whether the losses are those of the motion simulated in closed loop.
    pub is_simulated: bool,
}

impl HeatRun<'_> {
    /// Runs the hours.
    ///
    /// # Errors
    /// If the axis has no thermal model, its loop does not come to the motion's end, or the heat does not settle.
    pub fn on(&self, axis: &Axis) -> Result<Heated> {
        let model = axis.thermal_model().into_diagnostic()?;
        let duty = self.duty(axis, &model)?;
        let at_work = model.under(&duty).into_diagnostic()?;
        let cold = model.at_rest(self.air);
        let mut state = cold.clone();
        let mut heated = self.begun(axis, &model, &duty);
        for k in 0..=INTERVALS {
            if k > 0 {
                let until = self.duration * f64::from(k) / f64::from(INTERVALS);
                let by = until - state.time;
                let work = at_work.run(&mut state, self.air, by).into_diagnostic();
                heated.steps += work
                    .wrap_err("the axis does not come to rest thermally")?
                    .steps;
            }
            heated.push(&model, &at_work, [&cold, &state]);
        }
        heated.screw_at_end_c = state.screw().to_vec();
        Ok(heated)
    }

    fn duty(&self, axis: &Axis, model: &ThermalModel) -> Result<Duty> {
        let losses = LossModel::of(axis).into_diagnostic()?;
        let mut duty = model.duty();
        if !self.is_simulated {
            losses.add_motion(&mut duty, axis, self.motion);
            return Ok(duty);
        }
        let closed_loop = ClosedLoop::new(axis).into_diagnostic()?;
        let add = |cycle: &axis_sim::Cycle| losses.add_cycle(&mut duty, axis.period, cycle);
        let outcome = closed_loop.run(self.motion, &mut NoCompensation, add);
        outcome.completed().into_diagnostic()?;
        Ok(duty)
    }

    fn begun(&self, axis: &Axis, model: &ThermalModel, duty: &Duty) -> Heated {
        let [dry, viscous] = duty.friction_power();
        let screw = model.parameters().screw;
        let nodes = model.nodes().into_iter().map(|node| HeatedNode {
            node,
            name: node.name(),
            temperature_c: Vec::new(),
        });
        let measures_at_motor = axis.drive_model().is_ok_and(|m| m.cascade.from_motor);
        Heated {
            axis: axis.name.clone(),
            axis_fingerprint: axis.fingerprint.clone(),
            motion: self.name.clone(),
            losses_from: match self.is_simulated {
                false => "reference",
                true => "simulation",
            },
            duty_s: duty.duration(),
            duration_s: self.duration,
            air_c: self.air,
            keys_of_the_file: axis.thermal_keys_stated(),
            cold_dry_friction_w: dry,
            cold_viscous_friction_w: viscous,
            measures_at: if measures_at_motor { "motor" } else { "load" },
            screw_segment_mm: screw.map(|screw| 1e3 * screw.segment()),
            steps: 0,
            time_min: Vec::new(),
            nodes: nodes.collect(),
            screw_mean_c: Vec::new(),
            loss_w: Vec::new(),
            dry_factor: Vec::new(),
            viscous_factor: Vec::new(),
            places: HeatedPlace::all(&self.places, screw.is_some()),
            force: None,
            screw_at_end_c: Vec::new(),
            report: None,
        }
    }
}
