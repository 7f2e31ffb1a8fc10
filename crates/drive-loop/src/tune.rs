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

use crate::error::LoopError;
use crate::gains::Limits;
use crate::law::LoopGains;
use crate::moves::{MoveFigures, moves};
use crate::quick_current::with_quick_current;
use crate::report::{Accepted, Found, report};
use crate::set::{AxisLoops, LoopSet};
use crate::tune_settings::TuneSettings;
use crate::tuning::{MoveCheck, Tuning};

/// Shares of the limits' distance to 1 to which they are lowered where the simulated axis rings or
/// saturates.
const LOWERED: [f64; 6] = [1.0, 0.85, 0.7, 0.55, 0.4, 0.25];
/// A notch that is tried: damping, and share that is left at its middle.
const NOTCH: [f64; 2] = [0.3, 0.5];
/// Gain of the objective (a share) for which a notch is worth its parameters.
const WORTH: f64 = 0.05;
/// Ringing that counts as none: a thousandth of the greatest command.
const QUIET: f64 = 1e-3;

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
                    let accepted = Accepted {
                        file: &file,
                        found: &found,
                        limits: &limits,
                        tuned: &tuned,
                        moves: moves.collect(),
                    };
                    let report = report(axis, settings, accepted)?;
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
    let has_notch = found.loops.model.signal_path().command[1].is_some();
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
    Ok(after.is_some_and(|after| after.signal_path.command[1].is_some()))
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
