//! Looking at logs before anything is concluded from them.

use axis_log::intake::SHORT_GAP;
use axis_log::quality::{
    Finding, Law, Relation, SamplingError, Verdict, check_sampling, constant_channels, cross_check,
    unit_slip,
};
use axis_log::{Log, unit_of};
use axis_sim::mechanism::Freedom;
use axis_sim::{
    Axis, Balance, BalanceError, ChannelPart, ReplayError, channels, position_in, reference_in,
};
use thiserror::Error;

/// Why a log cannot be used. The message names the file first.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IntakeError {
    /// Samples that are not uniform in time.
    #[error("{file}: {reason}")]
    Sampling {
        /// The log.
        file: String,
        /// What is wrong.
        reason: SamplingError,
    },
    /// No torque balance can be made of it.
    #[error("{file}: {reason}")]
    Balance {
        /// The log.
        file: String,
        /// What it lacks.
        reason: BalanceError,
    },
    /// A channel that never changes.
    #[error(
        "{file}: channel \"{channel}\" has the same value in every sample: it is not connected, or belongs to another axis; leave the column out, or map another one to it in [log]"
    )]
    Constant {
        /// The log.
        file: String,
        /// Its channel.
        channel: String,
    },
    /// Position and reference differ by the factor between two units.
    #[error(
        "{file}: \"position_m\" is {factor:.4e} times \"position_ref_m\" ({guess}): give the column a scale in the axis file, [[log.column]] source = …, channel = \"position_m\", scale = {scale}"
    )]
    Unit {
        /// The log.
        file: String,
        /// Measured by reference.
        factor: f64,
        /// In words.
        guess: &'static str,
        /// What would mend it.
        scale: f64,
    },
    /// Too long a time without measurement.
    #[error(
        "{file}: \"{channel}\" was not measured for {samples} samples from t = {time:.4} s on: at most {SHORT_GAP} in a row can be bridged; split the log there"
    )]
    Hole {
        /// The log.
        file: String,
        /// Its channel.
        channel: String,
        /// Samples in a row.
        samples: usize,
        /// When they begin, s.
        time: f64,
    },
    /// Channels that do not agree with each other, by a unit, a sign or a zero.
    #[error("{file}: {what}; if that is so, this in the axis file mends it:\n{lines}")]
    Mapping {
        /// The log.
        file: String,
        /// Which channels, and what they look like.
        what: String,
        /// Lines for the axis file.
        lines: String,
    },
    /// Positions that the axis cannot take.
    #[error(
        "{file}: the {channel} is {position:.6} at t = {time:.4} s, outside the axis' stroke of {minimum} to {maximum} (m or rad): the log belongs to another axis, is in another unit, or counts from another zero (offset in [log])"
    )]
    OffStroke {
        /// The log.
        file: String,
        /// Its channel.
        channel: &'static str,
        /// Where, m.
        position: f64,
        /// When, s.
        time: f64,
        /// Least position, m.
        minimum: f64,
        /// Greatest position, m.
        maximum: f64,
    },
    /// The table does not follow the reference at all.
    #[error(
        "{file}: at t = {time:.4} s the table is {error:.6} m from its reference, more than a tenth of the motion's {travel:.6} m: the two columns are not of one axis and one time"
    )]
    NotFollowing {
        /// The log.
        file: String,
        /// When, s.
        time: f64,
        /// Reference minus measured, m.
        error: f64,
        /// Range of the reference, m.
        travel: f64,
    },
    /// Nothing moves, or only one way.
    #[error(
        "{file}: the motion is too poor to tell effects apart: {missing}; record a move and the way back, with a rest between"
    )]
    Poor {
        /// The log.
        file: String,
        /// What it lacks.
        missing: &'static str,
    },
    /// It never stands still, so a simulation cannot begin like it.
    #[error(
        "{file}: starts in motion, at {speed:.4} m/s, and never rests for {REST_TIME} s: where the loop stands at its start is not in the log; record from rest"
    )]
    NeverRests {
        /// The log.
        file: String,
        /// At its start, m/s.
        speed: f64,
    },
    /// The same samples to fit and to check.
    #[error(
        "{check} holds the same samples as {fit}: a check must be motion that was not fitted to; give another log"
    )]
    SameLog {
        /// Given to fit.
        fit: String,
        /// Given to check.
        check: String,
    },
}

/// Checks a log against its axis; its sampling period, s.
///
/// # Errors
/// The first thing found that would make a verdict worthless.
pub fn check_log(file: &str, log: &Log, machine: &Axis) -> Result<f64, IntakeError> {
    let file = || file.to_owned();
    let sampling = check_sampling(log).map_err(|reason| IntakeError::Sampling {
        file: file(),
        reason,
    })?;
    if !machine.has_control() {
        return check_balanced(file(), log, sampling.period, machine);
    }
    let (Ok(reference), Ok(position)) = (reference_in(log), position_in(log)) else {
        return Ok(sampling.period);
    };
    if let Some(slip) = unit_slip(reference, position) {
        return Err(IntakeError::Unit {
            file: file(),
            factor: slip.factor,
            guess: slip.guess,
            scale: 1.0 / slip.exact,
        });
    }
    let used = [
        "position_ref_m",
        "position_ref_rad",
        "position_m",
        "position_rad",
        "motor_angle_rad",
        "iq_a",
        "iq_ref_a",
        "uq_v",
        "torque_ref_n_m",
        "force_ref_n",
        "drive_command_v",
    ];
    if let Some(channel) = constant_channels(log)
        .into_iter()
        .find(|name| used.contains(&name.as_str()))
    {
        return Err(IntakeError::Constant {
            file: file(),
            channel,
        });
    }
    no_holes(&file(), log)?;
    agree(&file(), log, machine)?;
    on_stroke(&file(), log, machine)?;
    follows(&file(), log, reference, position)?;
    let step = |w: &[f64]| w[1] - w[0];
    let moved = |sign: f64| {
        reference
            .windows(2)
            .map(step)
            .filter(|d| d * sign > 0.0)
            .sum::<f64>()
            .abs()
    };
    let (forward, back) = (moved(1.0), moved(-1.0));
    let missing = match (forward > 1e-4, back > 1e-4) {
        (true, true) => return Ok(sampling.period),
        (false, false) => "the reference moves by less than 0.1 mm",
        _ => "the axis moves in one direction only, so dry friction and a standing load look alike",
    };
    Err(IntakeError::Poor {
        file: file(),
        missing,
    })
}

fn no_holes(file: &str, log: &Log) -> Result<(), IntakeError> {
    for channel in log.channels() {
        let long = log
            .missing(&channel.name)
            .iter()
            .find(|r| r.len() > SHORT_GAP);
        if let Some(run) = long {
            return Err(IntakeError::Hole {
                file: file.to_owned(),
                channel: channel.name.clone(),
                samples: run.len(),
                time: log.time()[run.start],
            });
        }
    }
    Ok(())
}

/// Refuses a log whose channels say that one of them is in another unit, turned, or from
/// another zero.
fn agree(file: &str, log: &Log, machine: &Axis) -> Result<(), IntakeError> {
    let found = cross_checks(log, machine);
    let wrong = |f: &&Finding| f.verdict == Verdict::Contradicts;
    match found.iter().find(wrong) {
        None => Ok(()),
        Some(finding) => Err(IntakeError::Mapping {
            file: file.to_owned(),
            what: finding.to_string(),
            lines: finding.lines().unwrap_or_default(),
        }),
    }
}

/// Checks of a log's channels against each other, by what this axis has them be.
pub fn cross_checks(log: &Log, machine: &Axis) -> Vec<Finding> {
    cross_check(log, &machine.log, &relations(log, machine))
}

/// What channels of a log should be of each other on this axis.
pub fn relations(log: &Log, machine: &Axis) -> Vec<Relation> {
    let (position, reference) = (machine.position_channel(), machine.reference_channel());
    let speed = match machine.freedom() {
        Freedom::Linear => "velocity_m_s",
        Freedom::Rotary => "velocity_rad_s",
    };
    let travel = machine.travel_per_radian();
    let mut all = vec![
        Relation::new(position, reference, Law::Same),
        Relation::new(position, "motor_angle_rad", Law::Scaled { factor: travel }),
        Relation::new(
            "motor_angle_rad",
            "motor_speed_rad_s",
            Law::Integral { factor: 1.0 },
        ),
        Relation::new(
            position,
            "motor_speed_rad_s",
            Law::Integral { factor: travel },
        ),
        Relation::new(position, speed, Law::Integral { factor: 1.0 }),
        Relation::new("iq_a", "iq_ref_a", Law::Follows),
    ];
    // Whatever torque there is beside the current.
    let factor = machine.torque_constant();
    if factor.is_finite() && factor != 0.0 && log.has("iq_a") {
        let torque = |name: &str| name.contains("torque") && unit_of(name) == Some("N·m");
        let torques = log.channels().iter().filter(|c| torque(&c.name));
        let about = Law::About {
            factor,
            within: 2.0,
        };
        all.extend(torques.map(|c| Relation::new(&c.name, "iq_a", about)));
    }
    all
}

/// Channels of a log that are commands and not measured, on this axis.
pub fn exact_channels(machine: &Axis) -> Vec<&'static str> {
    let given = channels(machine).into_iter();
    let given = given.filter(|c| c.part == ChannelPart::Given);
    let added = "drive_command_added_v";
    given.map(|c| c.name(machine)).chain([added]).collect()
}

/// The same for a torque balance, which needs no reference: a motion in any direction, and
/// what made it.
fn check_balanced(
    file: String,
    log: &Log,
    period: f64,
    machine: &Axis,
) -> Result<f64, IntakeError> {
    let balance = match Balance::new(log, period, machine) {
        Ok(balance) => balance,
        Err(ReplayError::Balance(reason)) => return Err(IntakeError::Balance { file, reason }),
        // What else there may be is of the axis, and is said where that is set up.
        Err(_) => return Ok(period),
    };
    let quality = balance.quality();
    let used = quality.motion.iter().chain([&quality.channel]);
    let constant = constant_channels(log);
    if let Some(channel) = used
        .copied()
        .find(|name| constant.iter().any(|c| c == name))
    {
        let channel = channel.to_owned();
        return Err(IntakeError::Constant { file, channel });
    }
    on_stroke(&file, log, machine)?;
    Ok(period)
}

/// A log as a replay can begin it, and what was done for that, in words.
///
/// A ball-screw loop begins at rest: of a log that starts in motion, what lies
/// before its first rest is left out. A rigid machine begins with the position
/// and the speed of the log's first samples.
///
/// # Errors
/// [`IntakeError::NeverRests`].
pub fn from_rest(
    file: &str,
    log: Log,
    period: f64,
    machine: &Axis,
) -> Result<(Log, Option<String>), IntakeError> {
    // A torque balance begins with the measured motion.
    let reference = reference_in(&log).ok().filter(|_| machine.has_control());
    let Some(reference) = reference else {
        return Ok((log, None));
    };
    let few = ((START_TIME / period).round() as usize).clamp(1, reference.len().max(2) - 1);
    let speed = match reference.get(few) {
        Some(later) => (later - reference[0]) / (few as f64 * period),
        None => 0.0,
    };
    if speed.abs() <= AT_REST {
        return Ok((log, None));
    }
    if machine.control.starts_in_motion() {
        let words = format!(
            "{file} starts in motion; position and speed at its start ({speed:.4} m/s) are taken from its first samples"
        );
        return Ok((log, Some(words)));
    }
    let rest = (REST_TIME / period).round() as usize;
    let still = |window: &[f64]| {
        let ends = window
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        ends.1 - ends.0 <= AT_REST * REST_TIME
    };
    let first = reference.windows(rest + 1).position(still);
    // So late that nothing follows is as good as never.
    let left = first.and_then(|k| Some((k, log.skip(k + rest / 2).ok()?)));
    match left {
        Some((k, left)) => {
            let from = log.time()[k + rest / 2];
            let words = format!(
                "{file} starts in motion ({speed:.4} m/s); what lies before its first rest, at t = {from:.3} s, is left out"
            );
            Ok((left, Some(words)))
        }
        None => Err(IntakeError::NeverRests {
            file: file.to_owned(),
            speed,
        }),
    }
}

/// Reference speed below which a log is at rest, m/s.
const AT_REST: f64 = 1e-3;

/// Over what time a log's first speed is taken, s.
const START_TIME: f64 = 5e-3;

/// How long a rest must be for the loop to have come to rest in its half, s.
const REST_TIME: f64 = 0.2;

fn on_stroke(file: &str, log: &Log, machine: &Axis) -> Result<(), IntakeError> {
    let stroke = &machine.stroke;
    let channels: [(&'static str, _); 2] = [
        ("reference", reference_in(log)),
        ("position", position_in(log)),
    ];
    for (channel, samples) in channels {
        let samples = samples.unwrap_or_default();
        let outside = |x: &f64| !(stroke.minimum - 1e-6..=stroke.maximum + 1e-6).contains(x);
        if let Some(k) = samples.iter().position(outside) {
            return Err(IntakeError::OffStroke {
                file: file.to_owned(),
                channel,
                position: samples[k],
                time: log.time()[k],
                minimum: stroke.minimum,
                maximum: stroke.maximum,
            });
        }
    }
    Ok(())
}

fn follows(file: &str, log: &Log, reference: &[f64], position: &[f64]) -> Result<(), IntakeError> {
    let (low, high) = reference
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let travel = high - low;
    let error = |k: &usize| (reference[*k] - position[*k]).abs();
    let worst = (0..reference.len())
        .max_by(|a, b| error(a).total_cmp(&error(b)))
        .unwrap_or(0);
    if travel > 0.0 && error(&worst) > 0.1 * travel {
        return Err(IntakeError::NotFollowing {
            file: file.to_owned(),
            time: log.time()[worst],
            error: reference[worst] - position[worst],
            travel,
        });
    }
    Ok(())
}

/// Refuses a check log that is one of the fit logs.
///
/// # Errors
/// [`IntakeError::SameLog`].
pub fn check_distinct(
    fit: &[(String, Log, f64)],
    check: &[(String, Log, f64)],
) -> Result<(), IntakeError> {
    let same = |a: &Log, b: &Log| {
        a.len() == b.len()
            && position_in(a)
                .ok()
                .is_some_and(|x| Some(x) == position_in(b).ok())
    };
    for (fit_name, fit_log, _) in fit {
        for (check_name, check_log, _) in check {
            if same(fit_log, check_log) {
                return Err(IntakeError::SameLog {
                    fit: fit_name.clone(),
                    check: check_name.clone(),
                });
            }
        }
    }
    Ok(())
}
