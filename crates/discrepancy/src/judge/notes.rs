//! Notes on the logs to read a result.

use axis_log::quality::sample_jitter;
use axis_sim::effects::Measure;
use axis_sim::{Axis, ReplayError, Trace};

use super::compared::Compared;
use super::remainder::Remainder;
use super::units::{ReadUnit, channel_unit};
use crate::answers::{IMMATERIAL, LogSet, Prepared, State};
use crate::name::gap::Gap;
use crate::name::search::{Found, LAW_ERROR};
use crate::noise::Excess;

/// All notes to a result.
///
/// # Errors
/// [`ReplayError`] if the machine as its file says does not run the logs.
pub(super) fn all_notes(
    compared: &Compared<'_>,
    remainder: &Remainder<'_>,
) -> Result<Vec<String>, ReplayError> {
    let (machine, found, set) = (compared.machine, compared.found, compared.set);
    let mut all = notes(machine, found)?;
    all.extend(faster_notes(machine, found, set, &compared.traces));
    all.extend(compared.slow.notes(set));
    all.extend(found.hum.notes());
    let of_loop = compared.left.loop_noise.as_ref();
    all.extend(of_loop.and_then(|noise| noise.note(machine)));
    let above = remainder.more_than_noise;
    all.extend(above.map(|(log, times)| above_noise_note(&found.fit_logs, log, times)));
    all.extend(remainder.coloured.as_ref().map(Excess::note));
    all.extend(found.within_error.iter().map(law_error_note));
    if remainder.is_immaterial && !remainder.gap.is_at_floor() {
        all.push(immaterial_note(compared));
    }
    if remainder.is_slow_of_loop {
        all.push(slow_of_loop_note(&remainder.gap));
    }
    Ok(all)
}

/// Notes on the logs.
fn notes(machine: &Axis, found: &Found) -> Result<Vec<String>, ReplayError> {
    let mut notes: Vec<String> = sets(found).flat_map(|set| set.notes()).collect();
    if !notes.is_empty() {
        notes.push(FLOOR.to_owned());
    }
    notes.extend(balance_notes(machine, found)?);
    notes.extend(slack_notes(machine, found));
    notes.extend(sets(found).flat_map(jitter_notes));
    notes.extend(sets(found).flat_map(|set| set.notes_of_ticks(machine)));
    Ok(notes)
}

/// What a torque balance does not show of this axis, and a torque that is not that of this axis file.
fn balance_notes(machine: &Axis, found: &Found) -> Result<Vec<String>, ReplayError> {
    let set = &found.fit_logs;
    let mut notes = Vec::new();
    let has_transmission = machine.mechanism.stiffness().is_some();
    let is_torque_alone = set.channels.len() == 1 && !set.balances().is_empty();
    if is_torque_alone && has_transmission {
        notes.push("backlash, lead errors, thermal growth and wind-up lie between motor and load, and do not show in this balance: log both the motor's angle and the load's position to see them".to_owned());
    }
    if let Some(times) = times_the_model(machine, set)? {
        let times = match times.abs() < 0.01 {
            true => format!("{times:.2e}"),
            false => format!("{times:.3}"),
        };
        notes.push(format!(
            "{} is {times} times what the axis file makes of the motion: check the column's unit, factor and sign, and the torque constant, before anything else that stands here",
            set.channels[0]
        ));
    }
    Ok(notes)
}

/// Multiple of the model's torque beyond which, one way or the other, a unit is more likely than a machine.
const ANOTHER_UNIT: f64 = 30.0;

/// Correlation from which on a log shows the model's torque in another unit or with another sign.
const SAME_COURSE: f64 = 0.8;

/// By how much the measured torque of a balance is a multiple of that of the axis file, if it has its course and
/// another sign, or another unit's size.
fn times_the_model(machine: &Axis, set: &LogSet) -> Result<Option<f64>, ReplayError> {
    if set.balances().is_empty() {
        return Ok(None);
    }
    let traces = set.simulate(machine, &State::initial(machine))?;
    let [mut both, mut model, mut logged] = [0.0; 3];
    for (log, simulated) in set.logs.iter().zip(set.simulated_all(&traces)) {
        let mean = |series: &[f64]| series.iter().sum::<f64>() / series.len().max(1) as f64;
        let (m, s) = (&log.measured[0], &simulated[0]);
        let [m_mean, s_mean] = [mean(m), mean(s)];
        for (m, s) in m.iter().zip(s) {
            let [m, s] = [m - m_mean, s - s_mean];
            both += m * s;
            model += s * s;
            logged += m * m;
        }
    }
    let times = both / model;
    let has_its_course = both.abs() >= SAME_COURSE * (model * logged).sqrt();
    let is_of_its_size = (ANOTHER_UNIT.recip()..=ANOTHER_UNIT).contains(&times);
    Ok((model > 0.0 && has_its_course && !is_of_its_size).then_some(times))
}

/// Of logs whose samples are off their even time stamps: what that adds to a channel is noise that
/// grows with its speed, and the noise that the residual is compared with holds it.
fn jitter_notes(set: &LogSet) -> impl Iterator<Item = String> {
    let of_log = |log: &Prepared| {
        // Only what has a mass behind it moves smoothly from sample to sample.
        let is_motion = |name: &&&str| ["m", "rad"].contains(&channel_unit(name));
        let channels = set.channels.iter().filter(is_motion);
        let jitter = channels.filter_map(|name| Some((*name, sample_jitter(&log.log, name)?)));
        let largest = jitter.max_by(|(_, a), (_, b)| a.rms.total_cmp(&b.rms));
        largest.map(|(channel, jitter)| {
            format!(
                "{}: the samples of {channel} jitter by {:.1} % of a period ({:.1} µs) although their time stamps are even. Their error grows with the speed and counts as noise, which hides small effects: log the true instants to see these",
                log.name,
                100.0 * jitter.share,
                1e6 * jitter.rms
            )
        })
    };
    let replayed = set.logs.iter().filter(|log| log.answer.replay().is_some());
    replayed.filter_map(of_log).collect::<Vec<_>>().into_iter()
}

/// How the noise of a torque balance is to be read.
const FLOOR: &str = "the noise stated for a torque balance is a lower bound from the spectra of torque and motion, as no controller is known: a residual above it may still be noise";

/// What must be known of a balance's rest that is taken for noise though it is above its floor.
fn slow_of_loop_note(check: &Gap) -> String {
    let above = check.channels.iter().filter(|c| c.floor_is_least);
    let times = above.map(|c| c.after / c.floor);
    let times = times.fold(0.0, f64::max);
    format!(
        "the residual is {times:.1} times that lower bound, and no curve over the motion that is fitted on some logs predicts others: it is taken for sensor noise that passed through the controller; a replay with the controller's gains would show more"
    )
}

/// What stood beside a larger effect.
fn law_error_note((name, share): &(&'static str, f64)) -> String {
    match *share > 0.0 {
        true => format!(
            "{name} would explain more, but is not named: it does {:.1} % of what the other effects do at the same frequencies, and their laws may be off by {:.0} %",
            100.0 * share,
            100.0 * LAW_ERROR
        ),
        false => format!(
            "{name} would explain more of the fitted logs, but is not named: it does nothing on check motion, which cannot confirm it"
        ),
    }
}

/// What must be known of a residual that is above its noise, and too small to be a lack of the model.
fn immaterial_note(compared: &Compared<'_>) -> String {
    let channels = compared.left.gap.channels.iter();
    let above = channels.max_by(|a, b| (a.after / a.floor).total_cmp(&(b.after / b.floor)));
    let (channel, times) = above.map_or(("", 0.0), |c| (c.channel.as_str(), c.after / c.floor));
    format!(
        "{channel}: the residual is {times:.1} times its noise, but within {} % of what each channel shows (of a position: of the tracking error); no current sensor is more linear, so it counts as agreement",
        100.0 * IMMATERIAL
    )
}

/// Which log the model does not agree with, where others are at their noise.
fn above_noise_note(set: &LogSet, log: usize, times: f64) -> String {
    let name = set.logs.get(log).map_or("a log", |log| log.name.as_str());
    format!(
        "{name}: the residual is {times:.1} times its noise and no effect explains it, so \"nothing is missing\" is ruled out"
    )
}

/// Where a gap is so large that the logs do not say where the screw lay in it at their
/// start.
fn slack_notes(machine: &Axis, found: &Found) -> Vec<String> {
    let effects = [&machine.effects[..], &found.fit.state.effects].concat();
    let left = sets(found).map(|set| set.slack_left(&effects));
    let unit = machine.freedom().unit();
    let note = |(gap, log): (f64, &Prepared)| {
        format!(
            "{} is compared only after its reference has moved by {:.3e} {unit}, which takes up a part of a gap of {gap:.3e} {unit}; where the motor stood in the remainder is not known: record a longer first move",
            log.name, log.taken_up
        )
    };
    left.flatten().map(note).collect()
}

/// Where a log goes faster than those that were fitted to, one way: what is said of that is a
/// law drawn further than it was seen.
fn faster_notes(machine: &Axis, found: &Found, set: &LogSet, traces: &[Trace]) -> Vec<String> {
    let fastest = |traces: &[Trace], way: f64| {
        let speeds = traces.iter().flat_map(|trace| &trace.speed);
        speeds.fold(0.0_f64, |most, v| most.max(way * v))
    };
    let si = Measure::Speed.unit(machine.freedom());
    let one = |(log, trace): (&Prepared, &Trace), way: f64, words: &str| {
        let seen = fastest(&found.fit.traces, way);
        let own = fastest(std::slice::from_ref(trace), way);
        let unit = ReadUnit::of(si, own);
        (own > FASTER * seen).then(|| {
            format!(
                "{} goes {words} at up to {}, the fitted logs at up to {}: effects that depend on speed are extrapolated there; fit to motion as fast",
                log.name,
                unit.said(own),
                unit.said(seen)
            )
        })
    };
    let logs = set.logs.iter().zip(traces);
    logs.flat_map(|log| [one(log, 1.0, "ahead"), one(log, -1.0, "back")])
        .flatten()
        .collect()
}

/// How much faster than the fitted motion is worth saying.
const FASTER: f64 = 1.2;

/// All logs that a result was made from.
fn sets(found: &Found) -> impl Iterator<Item = &LogSet> {
    let test = found.test.as_ref().map(|test| &test.fitted);
    [&found.fit_logs, &found.check_logs].into_iter().chain(test)
}
