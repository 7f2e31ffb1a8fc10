//! Checks of a log before anything is concluded from it.

use axis_log::Log;
use axis_log::intake::SHORT_GAP;
use axis_log::quality::{check_sampling, constant_channels, unit_slip};
use axis_sim::{Axis, Balance, ReplayError, needed_position, position_shown, reference_in};

use super::error::LogSetError;
use super::relations::agree;
use super::shared::shared;

/// Channels that are compared: a constant one is not connected.
const COMPARED: [&str; 11] = [
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

/// Checks a log against its axis; its sampling period, s.
///
/// # Errors
/// The first thing found that would make a verdict worthless.
pub fn check_log(file: &str, log: &Log, machine: &Axis) -> Result<f64, LogSetError> {
    let file = || file.to_owned();
    let sampling = check_sampling(log).map_err(|reason| LogSetError::Sampling {
        file: file(),
        reason,
    })?;
    if !machine.has_control() {
        return check_balanced(file(), log, sampling.period, machine);
    }
    let (reference, position) = match (reference_in(log), position_shown(log, machine)) {
        (Ok(reference), Ok(position)) => (reference, position),
        (_, Err(_)) if needed_position(machine).is_none() => {
            let channel = machine.position_channel();
            return Err(LogSetError::NoPosition {
                file: file(),
                channel,
            });
        }
        _ => return Ok(sampling.period),
    };
    if let Some(slip) = unit_slip(reference, &position) {
        return Err(LogSetError::Unit {
            file: file(),
            factor: slip.factor,
            guess: slip.guess,
            scale: 1.0 / slip.exact,
        });
    }
    if let Some(channel) = constant_channels(log)
        .into_iter()
        .find(|name| COMPARED.contains(&name.as_str()))
    {
        return Err(LogSetError::Constant {
            file: file(),
            channel,
        });
    }
    fast_enough(&file(), sampling.rate)?;
    no_holes(&file(), log)?;
    agree(&file(), log, machine)?;
    on_stroke(&file(), log, machine)?;
    follows(&file(), log, machine, reference, &position)?;
    moves_both_ways(&file(), reference)?;
    Ok(sampling.period)
}

/// Way of a reference below which it does not move, m or rad.
pub(super) const LEAST_WAY: f64 = 1e-4;

/// How far a reference goes forward and back in all, m or rad.
pub(super) fn moved(reference: &[f64]) -> [f64; 2] {
    let steps = reference.windows(2).map(|w| w[1] - w[0]);
    let way = |sign: f64| steps.clone().map(|d| (d * sign).max(0.0)).sum();
    [way(1.0), way(-1.0)]
}

/// Dry friction and a constant load look alike where the axis goes one way only.
fn moves_both_ways(file: &str, reference: &[f64]) -> Result<(), LogSetError> {
    let missing = match moved(reference).map(|way| way > LEAST_WAY).into() {
        (true, true) => return Ok(()),
        (false, false) => "the reference moves by less than 0.1 mm",
        _ => {
            "the axis moves in one direction only, so dry friction and a constant load look the same"
        }
    };
    Err(LogSetError::Poor {
        file: file.to_owned(),
        missing,
    })
}

/// Lowest rate of a log that is replayed, Hz: between slower samples a reference is not what its
/// controller was given.
const REPLAYED_HZ: f64 = 100.0;

fn fast_enough(file: &str, rate: f64) -> Result<(), LogSetError> {
    // Clocks may be a little off.
    match rate >= REPLAYED_HZ * (1.0 - 1e-3) {
        true => Ok(()),
        false => Err(LogSetError::TooSlow {
            file: file.to_owned(),
            rate,
            least: REPLAYED_HZ,
        }),
    }
}

/// Refuses what is not bridged, whatever a log was read of. A torque balance leaves out what lies
/// near a hole.
fn no_holes(file: &str, log: &Log) -> Result<(), LogSetError> {
    for channel in log.channels() {
        let long = log
            .missing(&channel.name)
            .iter()
            .find(|r| r.len() > SHORT_GAP);
        if let Some(run) = long {
            return Err(LogSetError::Hole {
                file: file.to_owned(),
                channel: channel.name.clone(),
                samples: run.len(),
                time: log.time()[run.start],
            });
        }
    }
    Ok(())
}

/// The same for a torque balance, which needs no reference: a motion in any direction, and
/// what made it.
fn check_balanced(
    file: String,
    log: &Log,
    period: f64,
    machine: &Axis,
) -> Result<f64, LogSetError> {
    let balance = match Balance::new(log, period, machine) {
        Ok(balance) => balance,
        Err(ReplayError::Balance(reason)) => return Err(LogSetError::Balance { file, reason }),
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
        return Err(LogSetError::Constant { file, channel });
    }
    on_stroke(&file, log, machine)?;
    Ok(period)
}

fn on_stroke(file: &str, log: &Log, machine: &Axis) -> Result<(), LogSetError> {
    let stroke = &machine.stroke;
    let position = position_shown(log, machine).unwrap_or_default();
    let channels: [(&'static str, _); 2] = [
        ("reference", reference_in(log).unwrap_or_default()),
        ("position", &position),
    ];
    for (channel, samples) in channels {
        let outside = |x: &f64| !(stroke.minimum - 1e-6..=stroke.maximum + 1e-6).contains(x);
        if let Some(k) = samples.iter().position(outside) {
            return Err(LogSetError::OffStroke {
                file: file.to_owned(),
                channel,
                position: samples[k],
                time: log.time()[k],
                minimum: stroke.minimum,
                maximum: stroke.maximum,
                unit: machine.freedom().unit(),
            });
        }
    }
    Ok(())
}

fn follows(
    file: &str,
    log: &Log,
    machine: &Axis,
    reference: &[f64],
    position: &[f64],
) -> Result<(), LogSetError> {
    let (low, high) = reference
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let travel = high - low;
    let error = |k: &usize| (reference[*k] - position[*k]).abs();
    let worst = (0..reference.len())
        .max_by(|a, b| error(a).total_cmp(&error(b)))
        .unwrap_or(0);
    if travel > 0.0 && error(&worst) > 0.1 * travel {
        return Err(LogSetError::NotFollowing {
            file: file.to_owned(),
            time: log.time()[worst],
            error: reference[worst] - position[worst],
            travel,
            unit: machine.freedom().unit(),
        });
    }
    Ok(())
}

/// Refuses a check log that is one of the fit logs, or holds a part of one.
///
/// # Errors
/// [`LogSetError::SameLog`], [`LogSetError::SharedPart`].
pub fn check_distinct(
    fit: &[(String, Log, f64)],
    check: &[(String, Log, f64)],
) -> Result<(), LogSetError> {
    for (fit_name, fit_log, _) in fit {
        for (check_name, check_log, _) in check {
            let Some(part) = shared(fit_log, check_log) else {
                continue;
            };
            let (fit, check) = (fit_name.clone(), check_name.clone());
            return Err(match part.len() == check_log.len() {
                true => LogSetError::SameLog { fit, check },
                false => LogSetError::SharedPart {
                    fit,
                    check,
                    samples: part.len(),
                    from: check_log.time()[part.start],
                    to: check_log.time()[part.end - 1],
                },
            });
        }
    }
    Ok(())
}
