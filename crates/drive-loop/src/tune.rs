//! Gains under limits of the sensitivity.
//!
//! ```text
//! least  ½ ln(r²/(K k_i k_v)) + mean ln RMS|y/F|      over sliding and stuck, all positions, the file's mass
//! with   max 1/|1 + L| ≤ 1.6, and ≤ 2 with one more cycle of delay      at both cuts, in all corners
//! ```
//!
//! The first term is the compliance of a sliding load at low frequencies per frequency, the second that
//! from 1 to 300 Hz. Either alone has a fault: the first makes k_p large and k_v small, the second
//! gives the integral up. The search starts from the symmetric optimum (C. Kessler, Regelungstechnik 6
//! (1958) 395–400 and 432–436) at several widths and from the file's own gains.

use axis_sim::control::CascadeGains;
use axis_sim::{Axis, SetupError};
use compensator::Drive;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::LoopError;
use crate::helps::{Help, helps};
use crate::law::LoopGains;
use crate::loops::Sensitivities;
use crate::margins::CutMargins;
use crate::moves::{MoveFigures, moves};
use crate::plant::Corner;
use crate::search::least;
use crate::set::{AxisLoops, LoopSet};

/// Widths of the symmetric optimum from which the search starts.
const WIDTHS: [f64; 3] = [2.5, 4.0, 7.0];
/// Evaluations of each start, and of the best after that.
const COARSE: usize = 120;
const FINE: usize = 260;
/// Cost of a constraint, per logarithm of how far it is exceeded: more than any gain is worth.
const EXCESS: f64 = 30.0;
/// Cost of a loop that is not stable.
const UNSTABLE: f64 = 1e3;
/// Share by which limits are kept in the search, for the peaks between two frequencies of the grid.
const KEPT: f64 = 0.998;
/// Shares of the limits' distance to 1 to which they are lowered where the simulated axis rings or
/// saturates.
const LOWERED: [f64; 6] = [1.0, 0.85, 0.7, 0.55, 0.4, 0.25];
/// A notch that is tried: damping, and share that is left at its middle.
const NOTCH: [f64; 2] = [0.3, 0.5];
/// Gain of the objective (a share) for which a notch is worth its parameters.
const WORTH: f64 = 0.05;
/// Ringing that counts as none: a thousandth of the greatest command.
const QUIET: f64 = 1e-3;

/// What is asked of gains.
#[derive(Clone, Debug, PartialEq)]
pub struct TuneSettings {
    /// Greatest sensitivity at either cut, in all corners.
    pub sensitivity: f64,
    /// The same with one more cycle of delay.
    pub sensitivity_late: f64,
    /// Greatest ripple of the command by the step of the sensor that the speed is derived from, as a
    /// share of the greatest command (RMS); infinite for none.
    pub ripple: f64,
    /// The corners.
    pub set: LoopSet,
    /// Whether the acceleration is fed forward.
    pub acceleration: bool,
    /// Whether a notch may be set where the file has none.
    pub notch: bool,
    /// Whether the current controllers are set to the magnitude optimum first.
    pub current: bool,
    /// Whether the limits are lowered until no simulated move rings or saturates more than with the
    /// gains of the file.
    pub simulated: bool,
}

impl Default for TuneSettings {
    fn default() -> Self {
        Self {
            sensitivity: 1.6,
            sensitivity_late: 2.0,
            ripple: 0.02,
            set: LoopSet::default(),
            acceleration: true,
            notch: true,
            current: false,
            simulated: true,
        }
    }
}

impl TuneSettings {
    fn check(&self) -> Result<(), LoopError> {
        let refused = |name, value, valid| Err(LoopError::Setting { name, value, valid });
        if !(1.1..=10.0).contains(&self.sensitivity) {
            return refused(
                "the limit of the sensitivity",
                self.sensitivity,
                "from 1.1 to 10",
            );
        }
        if self.sensitivity_late.is_nan() || self.sensitivity_late < self.sensitivity {
            let valid = "at least the limit without the cycle of delay";
            return refused(
                "the limit with one more cycle",
                self.sensitivity_late,
                valid,
            );
        }
        if self.ripple.is_nan() || self.ripple <= 0.0 {
            return refused("the limit of the ripple", self.ripple, "above 0");
        }
        Ok(())
    }
}

/// Gains in SI, of the motor's and the load's coordinates as the axis file has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TunedGains {
    /// k_v, 1/s.
    pub kv_per_s: f64,
    /// k_p: command (A, N·m, N or V) per speed of the motor (rad/s, m/s).
    pub speed_proportional: f64,
    /// T_n = k_p/k_i, s; none without an integral.
    pub integral_time_s: Option<f64>,
    /// Command per acceleration of the load; 0 where it is not fed forward.
    pub acceleration_feedforward: f64,
    /// Frequency of the notch that was set, Hz; none where it is as the file has it.
    pub notch_hz: Option<f64>,
}

/// How good a loop holds the load, and its margins over the set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LoopFigures {
    /// Greatest sensitivity over the set at either cut; none where a corner is unstable.
    pub sensitivity: Option<f64>,
    /// The same with one more cycle of delay.
    pub sensitivity_late: Option<f64>,
    /// Compliance of the sliding load per frequency, at low ones: 2π r²/(K k_i k_v), m/N per Hz or
    /// rad/(N·m) per Hz; none without an integral.
    pub compliance_slope: Option<f64>,
    /// Geometric mean over the file's mass at all positions, sliding and stuck, of the root mean
    /// square compliance from 1 to 300 Hz, m/N or rad/(N·m).
    pub compliance_rms: f64,
    /// Greatest compliance of the sliding load at the first position.
    pub compliance_peak: f64,
    /// Ripple of the command by the sensor's step, a share of the greatest command (RMS).
    pub ripple: f64,
    /// Objective: the lower, the better the load is held.
    pub objective: f64,
}

/// A constraint, and how near the gains are to it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Limiting {
    /// What it limits: `sensitivity at the command`, ….
    pub what: String,
    /// Its value.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Where: the corner with the greatest value; none of a constraint that has no corner.
    pub corner: Option<Corner>,
    /// Frequency of the peak there, Hz.
    pub frequency_hz: Option<f64>,
    /// Number, from 1, of the natural mode within a quarter of that frequency.
    pub mode: Option<usize>,
}

/// A move before and after.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MoveCheck {
    /// Number of the trajectory, from 1.
    pub trajectory: usize,
    /// With the gains of the file.
    pub file: MoveFigures,
    /// With the tuned ones.
    pub tuned: MoveFigures,
}

/// What `tune` found.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Tuning {
    /// Of this form.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Fingerprint of the file's axis.
    pub axis_fingerprint: String,
    /// Version of the program.
    pub version: String,
    /// Unit of the load's position: "m" or "rad".
    pub position_unit: String,
    /// Limits of the sensitivity that were kept: as asked for, or lower where the simulated axis rang.
    pub limits: [f64; 2],
    /// Gains of the file.
    pub file_gains: TunedGains,
    /// Gains that were found.
    pub tuned_gains: TunedGains,
    /// The file's loops.
    pub file: LoopFigures,
    /// The tuned loops.
    pub tuned: LoopFigures,
    /// Whether the greatest eigenvalue is below 1 in every corner, loops at their own rates.
    pub proven_stable: bool,
    /// Constraints, the nearest first; those within 2 % limit the gains.
    pub limiting: Vec<Limiting>,
    /// What would help, the most first: each by tuning again with that change.
    pub helps: Vec<Help>,
    /// The file's moves, simulated with the noise of the sensors.
    pub moves: Vec<MoveCheck>,
    /// Evaluations of the objective.
    pub evaluations: usize,
    /// What else is to be known, in words.
    pub notes: Vec<String>,
}

/// A tuned axis.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The axis with its new gains.
    pub axis: Axis,
    /// What was found.
    pub report: Tuning,
}

impl Tuning {
    /// Number of this form.
    pub const SCHEMA: u32 = 1;

    /// Tunes an axis. The same axis and settings give the same bits.
    ///
    /// # Errors
    /// [`LoopError`] where the axis has no such loops, no gains keep the limits, or the simulated axis
    /// rings or saturates with all that do.
    pub fn of(axis: &Axis, settings: &TuneSettings) -> Result<Tuned, LoopError> {
        settings.check()?;
        let mut own = axis.clone();
        if settings.current {
            with_quick_current(&mut own)?;
        }
        let file = AxisLoops::new(axis, &settings.set)?;
        let before = moves(axis)?;
        let mut what = String::new();
        for by in LOWERED {
            let limits = Limits::of(settings, by);
            let found = best(&own, settings, &limits)?;
            let tuned = with_gains(&found.axis, settings, &found.gains)?;
            let after = moves(&tuned)?;
            let ripple = found.loops.figures(&found.gains).ripple;
            let worse = worse(&before, &after, ripple).filter(|_| settings.simulated);
            match worse {
                None => {
                    let checks = before.iter().zip(&after).enumerate();
                    let moves = checks.map(|(i, (file, tuned))| MoveCheck {
                        trajectory: i + 1,
                        file: *file,
                        tuned: *tuned,
                    });
                    let moves = moves.collect();
                    let report = report(axis, settings, &file, &found, &limits, &tuned, moves)?;
                    return Ok(Tuned {
                        axis: tuned,
                        report,
                    });
                }
                Some(said) => what = said,
            }
        }
        Err(LoopError::Simulation {
            what,
            most: Limits::of(settings, LOWERED[LOWERED.len() - 1]).sensitivity[0],
        })
    }
}

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub sensitivity: [f64; 2],
    pub ripple: f64,
}

impl Limits {
    fn of(settings: &TuneSettings, by: f64) -> Self {
        // Lowered towards 1, which no loop is below.
        let lower = |most: f64| 1.0 + (most - 1.0) * by;
        Self {
            sensitivity: [
                lower(settings.sensitivity),
                lower(settings.sensitivity_late),
            ],
            ripple: settings.ripple,
        }
    }
}

/// Loops with the best gains that were found for them.
pub(crate) struct Found {
    pub axis: Axis,
    pub loops: AxisLoops,
    pub gains: LoopGains,
    pub notch: Option<f64>,
    pub evaluations: usize,
}

/// The best gains, and with them a notch where that is worth it.
fn best(axis: &Axis, settings: &TuneSettings, limits: &Limits) -> Result<Found, LoopError> {
    let loops = AxisLoops::new(axis, &settings.set)?;
    let (gains, mut evaluations) = loops.tuned(limits, None)?;
    let mut found = Found {
        axis: axis.clone(),
        loops,
        gains,
        notch: None,
        evaluations: 0,
    };
    let has_notch = found.loops.model.passage().command[1].is_some();
    if settings.notch && !has_notch {
        let mut least = found.loops.figures(&gains).objective - WORTH;
        // The first mode is what the speed loop damps; a notch there takes that from it.
        let top = 0.4 / axis.period * std::f64::consts::TAU;
        let modes: Vec<f64> = found.loops.modes.iter().skip(1).take(2).copied().collect();
        for mode in modes.into_iter().filter(|w| *w < top) {
            let frequency = mode / std::f64::consts::TAU;
            let mut notched = axis.clone();
            if !set_notch(&mut notched, frequency)? {
                continue;
            }
            let loops = AxisLoops::new(&notched, &settings.set)?;
            let Ok((gains, used)) = loops.tuned(limits, Some(&found.gains)) else {
                continue;
            };
            evaluations += used;
            let objective = loops.figures(&gains).objective;
            if objective < least {
                least = objective;
                found = Found {
                    axis: notched,
                    loops,
                    gains,
                    notch: Some(frequency),
                    evaluations: 0,
                };
            }
        }
    }
    found.evaluations = evaluations;
    Ok(found)
}

fn set_notch(axis: &mut Axis, frequency: f64) -> Result<bool, LoopError> {
    let travel = axis.travel_per_radian();
    let Some(cascade) = axis.control.cascade(travel, axis.period) else {
        return Ok(false);
    };
    let gains = CascadeGains {
        position: cascade.position * travel,
        speed: cascade.speed,
        speed_integral: cascade.speed_integral,
        acceleration_feedforward: None,
        notch: Some([frequency, NOTCH[0], NOTCH[1]]),
    };
    retune(axis, &gains)?;
    let after = axis.control.cascade(travel, axis.period);
    Ok(after.is_some_and(|after| after.passage.command[1].is_some()))
}

fn retune(axis: &mut Axis, gains: &CascadeGains) -> Result<(), LoopError> {
    let travel = axis.travel_per_radian();
    let Some(values) = axis.control.retuned(axis.control.values(), gains, travel) else {
        return Err(LoopError::Control {
            kind: axis.control.kind().name,
        });
    };
    axis.control
        .change(|own| *own = values)
        .map_err(|error| SetupError::from(error).into())
}

/// Sets the current controllers to the magnitude optimum; whether there are any.
pub(crate) fn with_quick_current(axis: &mut Axis) -> Result<bool, LoopError> {
    let values = axis.actuator.values();
    let Some(values) = axis.actuator.with_magnitude_optimum(values, axis.period) else {
        return Ok(false);
    };
    let changed = axis.actuator.change(|own| *own = values);
    changed.map_err(SetupError::from)?;
    axis.actuator
        .runs_at(axis.period)
        .map_err(SetupError::from)?;
    Ok(true)
}

/// The axis with these gains.
fn with_gains(axis: &Axis, settings: &TuneSettings, gains: &LoopGains) -> Result<Axis, LoopError> {
    let mut tuned = axis.clone();
    let travel = axis.travel_per_radian();
    let fed = acceleration(axis)?;
    let gains = CascadeGains {
        position: gains.position * travel,
        speed: gains.speed,
        speed_integral: gains.integral,
        acceleration_feedforward: settings.acceleration.then_some(fed),
        notch: None,
    };
    retune(&mut tuned, &gains)?;
    Ok(tuned)
}

/// The same axis with its acceleration fed forward by `share` of J/(r K), the command that moves all
/// that moves.
///
/// # Errors
/// [`LoopError`] where the axis has no such loops.
pub fn with_acceleration(axis: &Axis, share: f64) -> Result<Axis, LoopError> {
    let loops = AxisLoops::new(axis, &LoopSet::nominal())?;
    let gains = loops.gains();
    let mut fed = axis.clone();
    let travel = axis.travel_per_radian();
    let command = share * acceleration(axis)?;
    retune(
        &mut fed,
        &CascadeGains {
            position: gains.position * travel,
            speed: gains.speed,
            speed_integral: gains.integral,
            acceleration_feedforward: Some(command),
            notch: None,
        },
    )?;
    Ok(fed)
}

/// Command per acceleration of the load: J/(r K).
fn acceleration(axis: &Axis) -> Result<f64, LoopError> {
    let inertia = axis.planned_mechanism()?.total_inertia();
    Ok(inertia / (axis.travel_per_radian() * axis.torque_constant()))
}

impl AxisLoops {
    /// The best gains within the limits, and how many evaluations that took: from several starts, or
    /// from `near` alone.
    pub fn tuned(
        &self,
        limits: &Limits,
        near: Option<&LoopGains>,
    ) -> Result<(LoopGains, usize), LoopError> {
        let starts = match near {
            Some(gains) => vec![*gains],
            None => {
                let own = self.gains();
                let optimum = WIDTHS.map(|a| self.symmetric_optimum(a));
                optimum.into_iter().chain([own]).collect()
            }
        };
        let mut evaluations = 0;
        let mut cost = |x: &[f64]| {
            evaluations += 1;
            self.cost(&self.gains_of(x), limits)
        };
        let found = starts.iter().map(|gains| {
            let x = numbers(gains);
            least(&mut cost, &x, 0.35, 1e-4, COARSE)
        });
        let mut best = found
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or_else(|| (numbers(&self.gains()), f64::INFINITY));
        for size in [0.12, 0.03] {
            let next = least(&mut cost, &best.0, size, 1e-7, FINE);
            if next.1 < best.1 {
                best = next;
            }
        }
        let mut gains = self.gains_of(&best.0);
        // What little of a limit the cost leaves.
        for _ in 0..40 {
            if self.excess(&gains, limits) <= 0.0 {
                return Ok((gains, evaluations));
            }
            gains.speed *= 0.99;
            gains.integral *= 0.99 * 0.99;
            gains.position *= 0.99;
        }
        let figures = self.figures(&gains);
        Err(LoopError::NoGains {
            most: limits.sensitivity[0],
            most_late: limits.sensitivity[1],
            found: figures.sensitivity.unwrap_or(f64::INFINITY),
            found_late: figures.sensitivity_late.unwrap_or(f64::INFINITY),
        })
    }

    fn gains_of(&self, x: &[f64]) -> LoopGains {
        let speed = x[0].exp();
        LoopGains {
            speed,
            position: x[1].exp(),
            integral: match (self.model.integrates(), x.get(2)) {
                (true, Some(time)) => speed / time.exp(),
                _ => 0.0,
            },
        }
    }

    /// k_p = J/(a T_Σ K), T_n = a² T_Σ, k_v = 1/(8 a T_Σ).
    fn symmetric_optimum(&self, a: f64) -> LoopGains {
        let (model, passage) = (&self.model.model, self.model.passage());
        let period = model.period;
        let inner = match &model.drive {
            Drive::Lag { bandwidth, .. } => 1.0 / bandwidth,
            Drive::FieldOriented { motor, q, late, .. } => {
                motor.parameters().inductance_q / q[0] + (late + 0.5) * period
            }
        };
        let speed_period = f64::from(passage.speed_every.max(1)) * period;
        let mut small = inner + model.delay + 0.5 * speed_period;
        if self.model.sensing.by_differences {
            small += 0.5 * speed_period;
        }
        let speed = self.inertia / (a * small * model.torque_constant());
        LoopGains {
            speed,
            integral: match self.model.integrates() {
                true => speed / (a * a * small),
                false => 0.0,
            },
            position: 1.0 / (8.0 * a * small) / model.travel,
        }
    }

    /// What the search makes least.
    fn cost(&self, gains: &LoopGains, limits: &Limits) -> f64 {
        let excess = self.excess(gains, limits);
        if excess.is_infinite() {
            return UNSTABLE;
        }
        self.objective(gains) + EXCESS * excess.max(0.0)
    }

    /// Logarithm by which the worst constraint is exceeded; infinite where a corner is unstable.
    fn excess(&self, gains: &LoopGains, limits: &Limits) -> f64 {
        let of = |s: Sensitivities| {
            let most = |pair: [f64; 2]| pair[0].max(pair[1]);
            let [now, late] = limits.sensitivity;
            (most(s.now) / now).max(most(s.late) / late)
        };
        let all: Vec<f64> = self
            .corners
            .par_iter()
            .map(|corner| of(corner.sensitivities(gains)))
            .collect();
        let mut worst = all.into_iter().fold(0.0, f64::max) / KEPT;
        if limits.ripple.is_finite() {
            worst = worst.max(self.corners[0].ripple(&self.model, gains) / limits.ripple);
        }
        worst.ln()
    }

    /// Mean over the file's mass of the logarithm of the compliance.
    fn compliance(&self, gains: &LoopGains) -> f64 {
        let own = |at: &Corner| at.mass == self.corners[0].at.mass;
        let corners: Vec<_> = self.corners.iter().filter(|c| own(&c.at)).collect();
        let all: Vec<f64> = corners
            .par_iter()
            .map(|corner| corner.compliance_rms(gains).ln())
            .collect();
        all.iter().sum::<f64>() / all.len() as f64
    }

    fn slope(&self, gains: &LoopGains) -> Option<f64> {
        let model = &self.model.model;
        let integral = gains.integral * gains.position * model.travel * model.torque_constant();
        let slope = std::f64::consts::TAU * model.travel * model.travel / integral;
        (gains.integral > 0.0).then_some(slope)
    }

    fn objective(&self, gains: &LoopGains) -> f64 {
        let slope = self.slope(gains).map_or(0.0, f64::ln);
        0.5 * slope + self.compliance(gains)
    }

    /// Figures of these gains.
    pub fn figures(&self, gains: &LoopGains) -> LoopFigures {
        let all = self.corners.iter().map(|c| c.sensitivities(gains));
        let most = all.fold([0.0_f64; 2], |most, s| {
            [
                most[0].max(s.now[0]).max(s.now[1]),
                most[1].max(s.late[0]).max(s.late[1]),
            ]
        });
        let [now, late] = most.map(|s| s.is_finite().then_some(s));
        let own = &self.corners[0];
        let peak = own.points.iter().map(|p| p.compliance(gains).norm());
        LoopFigures {
            sensitivity: now,
            sensitivity_late: late,
            compliance_slope: self.slope(gains),
            compliance_rms: self.compliance(gains).exp(),
            compliance_peak: peak.fold(0.0, f64::max),
            ripple: own.ripple(&self.model, gains),
            objective: self.objective(gains),
        }
    }

    fn shown(&self, gains: &LoopGains, fed: f64, notch: Option<f64>) -> TunedGains {
        TunedGains {
            kv_per_s: gains.position * self.model.model.travel,
            speed_proportional: gains.speed,
            integral_time_s: (gains.integral > 0.0).then(|| gains.speed / gains.integral),
            acceleration_feedforward: fed,
            notch_hz: notch,
        }
    }
}

/// The numbers that are searched for: logarithms of k_p, of k_v/r and, where there is an integral, of
/// T_n.
fn numbers(gains: &LoopGains) -> Vec<f64> {
    let mut all = vec![gains.speed.ln(), gains.position.ln()];
    if gains.integral > 0.0 {
        all.push((gains.speed / gains.integral).ln());
    }
    all
}

/// What the tuned axis does worse in its moves than with the gains of the file, if anything.
fn worse(before: &[MoveFigures], after: &[MoveFigures], ripple: f64) -> Option<String> {
    // What the sensor's steps make of the command by themselves; in a band of friction two of them
    // may come together.
    let quiet = QUIET.max(2.0 * ripple);
    before.iter().zip(after).enumerate().find_map(|(i, (file, tuned))| {
        let place = i + 1;
        if tuned.peak_error.is_none() && file.peak_error.is_some() {
            return Some(format!("does not come to the end of trajectory {place}"));
        }
        if tuned.saturated_cycles > file.saturated_cycles {
            return Some(format!(
                "saturates in {} cycles of trajectory {place}",
                tuned.saturated_cycles
            ));
        }
        (tuned.ringing > file.ringing.max(quiet)).then(|| {
            format!(
                "rings in the standstill after trajectory {place}: its command deviates by {:.2} % of the greatest",
                100.0 * tuned.ringing
            )
        })
    })
}

fn report(
    axis: &Axis,
    settings: &TuneSettings,
    file: &AxisLoops,
    found: &Found,
    limits: &Limits,
    tuned: &Axis,
    moves: Vec<MoveCheck>,
) -> Result<Tuning, LoopError> {
    let (loops, gains) = (&found.loops, &found.gains);
    let fed = |axis: &Axis| {
        let cascade = axis.control.cascade(axis.travel_per_radian(), axis.period);
        cascade.map_or(0.0, |cascade| cascade.acceleration_feedforward)
    };
    let radii: Vec<f64> = loops
        .corners
        .par_iter()
        .map(|corner| crate::turn::radius(&loops.model, corner, gains))
        .collect();
    let mut notes = Vec::new();
    if limits.sensitivity[0] < settings.sensitivity {
        notes.push(format!(
            "the limit of the sensitivity was lowered from {} to {:.3}, as the simulated axis rang or saturated above",
            settings.sensitivity, limits.sensitivity[0]
        ));
    }
    if axis.trajectories.is_empty() {
        notes.push("the axis file has no [[trajectory]], so no move was simulated".to_owned());
    }
    if !axis.effects.is_empty() {
        notes.push("bodies that swing, waves and errors of sensors among the file's effects count in the simulated moves only".to_owned());
    }
    Ok(Tuning {
        schema: Tuning::SCHEMA,
        axis: axis.name.clone(),
        axis_fingerprint: axis.fingerprint.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        position_unit: axis.freedom().unit().to_owned(),
        limits: limits.sensitivity,
        file_gains: file.shown(&file.gains(), fed(axis), None),
        tuned_gains: loops.shown(gains, fed(tuned), found.notch),
        file: file.figures(&file.gains()),
        tuned: loops.figures(gains),
        proven_stable: radii.iter().all(|radius| *radius < 1.0),
        limiting: limiting(loops, gains, limits),
        helps: helps(&found.axis, settings, loops, gains, limits)?,
        moves,
        evaluations: found.evaluations,
        notes,
    })
}

/// The constraints, the nearest first.
fn limiting(loops: &AxisLoops, gains: &LoopGains, limits: &Limits) -> Vec<Limiting> {
    let margins: Vec<_> = loops
        .corners
        .par_iter()
        .map(|corner| corner.margins(&loops.model, gains))
        .collect();
    let late = "with one more cycle of delay";
    // Height and frequency of a peak.
    type Of = fn(&CutMargins) -> (Option<f64>, f64);
    let now: Of = |cut| (cut.sensitivity, cut.sensitivity_at_hz);
    let later: Of = |cut| (cut.sensitivity_late, cut.sensitivity_late_at_hz);
    let kinds = [
        (
            "sensitivity at the command".to_owned(),
            0,
            now,
            limits.sensitivity[0],
        ),
        (
            "sensitivity at the position".to_owned(),
            1,
            now,
            limits.sensitivity[0],
        ),
        (
            format!("sensitivity at the command {late}"),
            0,
            later,
            limits.sensitivity[1],
        ),
        (
            format!("sensitivity at the position {late}"),
            1,
            later,
            limits.sensitivity[1],
        ),
    ];
    let mut all = Vec::new();
    for (what, place, of, limit) in kinds {
        let worst = margins
            .iter()
            .map(|m| (m, of([&m.command, &m.position][place])))
            .map(|(m, (height, at))| (m, height.unwrap_or(f64::MAX), at))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((corner, value, at)) = worst else {
            continue;
        };
        let near = |w: &f64| {
            let ratio = at / crate::loops::hertz(*w);
            (0.8..=1.25).contains(&ratio)
        };
        all.push(Limiting {
            what,
            value,
            limit,
            corner: Some(corner.at),
            frequency_hz: Some(at),
            mode: loops.modes.iter().position(near).map(|i| i + 1),
        });
    }
    let ripple = loops.corners[0].ripple(&loops.model, gains);
    if ripple > 0.0 && limits.ripple.is_finite() {
        all.push(Limiting {
            what: "ripple of the command by the steps of the sensor that the speed is derived from"
                .to_owned(),
            value: ripple,
            limit: limits.ripple,
            corner: None,
            frequency_hz: None,
            mode: None,
        });
    }
    all.sort_by(|a, b| (b.value / b.limit).total_cmp(&(a.value / a.limit)));
    all
}
