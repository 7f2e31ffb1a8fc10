//! What makes a measured response wrong without looking so.

use axis_sim::{Axis, SixDigits};
use frequency_response::FrequencyResponse;
use schemars::JsonSchema;
use serde::Serialize;

use super::model_at::ModelAt;
use super::record::Recorded;
use super::{MeasureSettings, MeasuredMargins};
use crate::error::LoopError;
use crate::loops::hertz;
use crate::plant::modes_at;

/// Share of Stribeck's speed below which the load stands, and travel, in displacements of the bristles, below
/// which it has not begun to slide.
const STANDS: f64 = 0.2;
const SLID: f64 = 20.0;
/// Multiple of Stribeck's speed from which on friction is a damper.
const SLIDES: f64 = 3.0;
/// Share of the samples in which the motor may turn back, and in which the command may be at its limit.
const TURNED: f64 = 1e-3;
const LIMITED: f64 = 0.01;
/// Frequency to which moves without excitation are good, Hz.
const MOVES: f64 = 10.0;
/// Distance of two values of the maximum sensitivity that counts.
const APART: f64 = 0.08;
/// Lines below the first antiresonance that are needed.
const LINES: f64 = 40.0;
/// Modes that are looked at, and the change of one over the stretch that counts, as a share.
const MODES: usize = 3;
const MOVED: f64 = 0.02;
/// Lines (Hz) that a loop needs, and the share of them that must have the coherence.
const NEEDED: [f64; 2] = [4.0, 100.0];
const TRUSTED: f64 = 0.5;

/// Something that is wrong with a measurement.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Trap {
    /// What, and what would be right.
    pub what: String,
    /// Whether gains must not be tuned on such a response.
    pub refused: bool,
}

/// A response with what it was measured on, at the model's place.
pub(crate) struct Response<'a> {
    pub recorded: &'a Recorded<'a>,
    pub shown: &'a FrequencyResponse,
    pub at: &'a ModelAt,
}

pub(crate) fn traps(
    axis: &Axis,
    response: &Response<'_>,
    margins: Option<&MeasuredMargins>,
    settings: &MeasureSettings,
) -> Result<Vec<Trap>, LoopError> {
    let Response { recorded, at, .. } = *response;
    let mut all = Vec::new();
    let mut add = |refused: bool, what: String| all.push(Trap { what, refused });
    if !recorded.is_excited() {
        add(
            true,
            format!(
                "the log has no excitation (channel {}): the response of ordinary moves is good to about {MOVES} Hz and useless from 20 Hz on; valid: a motion program with [excitation]",
                axis_sim::excitation_channel(axis).name(axis)
            ),
        );
    }
    if let Some([command, instead]) = recorded.instead {
        add(
            true,
            format!(
                "the log has no command (channel {command}), and {instead}, which follows it, stands in its place: the drive's own lag is not in the response, so neither margins nor a comparison with the model follow from it; valid: a log with {command}"
            ),
        );
    }
    friction(axis, recorded, at, &mut add);
    limits(axis, recorded, &mut add);
    differing(margins, &mut add);
    lines(axis, response, settings, &mut add);
    moving(axis, recorded, &mut add)?;
    Ok(all)
}

/// Two ways to the maximum sensitivity that differ.
fn differing(margins: Option<&MeasuredMargins>, add: &mut impl FnMut(bool, String)) {
    let Some(m) = margins else {
        return;
    };
    let apart = (m.sensitivity.value - m.by_response.value).abs();
    let deviation = m.sensitivity.deviation.hypot(m.by_response.deviation);
    if apart > APART.max(4.0 * deviation) {
        add(
            false,
            format!(
                "the maximum sensitivity is {:.2} from the command and {:.2} from the responses: lines too coarse, something at a limit, or a controller on the machine that is not that of the axis file",
                m.sensitivity.value, m.by_response.value
            ),
        );
    }
}

/// A log that is too slow, lines that are too coarse, or too few that count.
fn lines(
    axis: &Axis,
    response: &Response<'_>,
    settings: &MeasureSettings,
    add: &mut impl FnMut(bool, String),
) {
    let Response {
        recorded,
        shown,
        at,
    } = *response;
    if (recorded.period / axis.period - 1.0).abs() > 1e-3 {
        add(
            true,
            format!(
                "the log has a sample each {} s and the controller runs each {} s: what lies between is folded into the response; valid: a log of every control cycle",
                SixDigits(recorded.period),
                SixDigits(axis.period)
            ),
        );
    }
    if let Some(antiresonance) = at.antiresonance_hz()
        && shown.step_hz > antiresonance / LINES
    {
        add(
            false,
            format!(
                "the lines are {:.2} Hz apart, coarser than a fortieth of the first antiresonance ({:.1} Hz): peaks come out too low, and the sensitivity with them; valid: a longer segment (a longer slide), at most {:.2} Hz",
                shown.step_hz,
                antiresonance,
                antiresonance / LINES
            ),
        );
    }
    let [low, high] = NEEDED;
    let needed = shown.trusted(NEEDED, 0.0).count();
    let trusted = shown.trusted(NEEDED, settings.coherence).count();
    if recorded.is_excited() && (trusted as f64) < TRUSTED * needed.max(1) as f64 {
        add(
            true,
            format!(
                "{trusted} of {needed} lines from {low} to {high} Hz have a coherence of {}; valid: a longer slide, or a greater amplitude",
                settings.coherence
            ),
        );
    }
}

/// Modes that are not where they were at the end of the slide.
fn moving(
    axis: &Axis,
    recorded: &Recorded<'_>,
    add: &mut impl FnMut(bool, String),
) -> Result<(), LoopError> {
    let modes = |position: f64| -> Result<Vec<f64>, LoopError> {
        let modes = modes_at(axis, position)?;
        let all = modes.iter().map(|mode| hertz(mode.frequency));
        Ok(all.filter(|f| *f > 1e-3).take(MODES).collect())
    };
    let [first, last] = recorded.stretch;
    let (first, last) = (modes(first)?, modes(last)?);
    for (i, (from, to)) in first.iter().zip(&last).enumerate() {
        if (to / from - 1.0).abs() > MOVED {
            add(
                false,
                format!(
                    "over the stretch of the log the model's mode {} moves from {from:.1} to {to:.1} Hz: what is measured is a mean; valid: a shorter stretch (40 mm), and several places",
                    i + 1
                ),
            );
        }
    }
    Ok(())
}

/// Friction that sticks follows the excitation with a coherence of 1, and with another response.
fn friction(
    axis: &Axis,
    recorded: &Recorded<'_>,
    at: &ModelAt,
    add: &mut impl FnMut(bool, String),
) {
    let friction = at.model.model.friction.parameters();
    let lever = at.model.model.lever;
    // Dry friction without a stiction has no falling part, whatever its speed is.
    let stribeck = match friction.stiction > friction.coulomb {
        true => friction.stribeck_speed * lever,
        false => 0.0,
    };
    let bristles = friction.stiction / friction.stiffness * lever;
    let unit = axis.freedom().speed_unit();
    let speed = recorded.mean_speed;
    let travelled = recorded.stretch[1] - recorded.stretch[0];
    let is_short = bristles.is_finite() && travelled < SLID * bristles;
    if speed <= STANDS * stribeck || is_short || speed == 0.0 {
        add(
            true,
            format!(
                "the load stands ({} {unit}): friction holds it like a spring, and the response, at whatever coherence, is not that of the sliding load (120 % off below 40 Hz in simulation); valid: a slide at constant speed, above three times the Stribeck speed",
                SixDigits(speed)
            ),
        );
        return;
    }
    let travel = at.model.model.travel;
    let turning = recorded.windows.iter().map(|[from, to]| {
        let sign = (recorded.load[*to - 1] - recorded.load[*from]).signum() * travel.signum();
        match (recorded.speed, recorded.angle) {
            (Some(speed), _) => speed[*from..*to]
                .iter()
                .filter(|v| **v * sign < 0.0)
                .count(),
            (None, Some(angle)) => angle[*from..*to]
                .windows(2)
                .filter(|w| (w[1] - w[0]) * sign < 0.0)
                .count(),
            (None, None) => 0,
        }
    });
    let samples = recorded.seconds() / recorded.period;
    let share = turning.sum::<usize>() as f64 / samples;
    if share > TURNED && recorded.is_excited() {
        add(
            share > 10.0 * TURNED,
            format!(
                "the excitation turns the motor back in {:.1} % of the samples, and friction with it; valid: a quicker slide, or a smaller amplitude",
                100.0 * share
            ),
        );
    }
    if speed < SLIDES * stribeck {
        add(
            false,
            format!(
                "the load slides at {} {unit}, below three times the Stribeck speed ({} {unit}): friction falls with the speed there, and the response is several per cent off (70 % at worst in simulation); valid: {} {unit} or more",
                SixDigits(speed),
                SixDigits(stribeck),
                SixDigits(SLIDES * stribeck)
            ),
        );
    }
}

/// A command at its limit, or voltages at theirs, pass no more of the excitation.
fn limits(axis: &Axis, recorded: &Recorded<'_>, add: &mut impl FnMut(bool, String)) {
    let limit = axis.actuator.limit();
    let samples = recorded.seconds() / recorded.period;
    let inside = || recorded.windows.iter().flat_map(|[from, to]| *from..*to);
    let mut said = |count: usize, what: String| {
        let share = count as f64 / samples;
        if count > 0 {
            add(
                share > LIMITED,
                format!(
                    "{what} in {:.2} % of the samples: the excitation is saturated, and the loop is not linear; valid: a smaller amplitude",
                    100.0 * share
                ),
            );
        }
    };
    let at_limit = |k: &usize| recorded.command[*k].abs() >= (1.0 - 1e-6) * limit;
    said(
        inside().filter(at_limit).count(),
        format!(
            "the command is at its limit of {} {}",
            SixDigits(limit),
            recorded.command_unit
        ),
    );
    // Space vectors reach the DC link over √3.
    let most = axis
        .actuator
        .values()
        .optional("dc_link")
        .map(|u| u / 3f64.sqrt());
    if let (Some(most), Some([d, q])) = (most, recorded.voltages) {
        let at_limit = |k: &usize| d[*k].hypot(q[*k]) >= (1.0 - 1e-3) * most;
        said(
            inside().filter(at_limit).count(),
            format!("the voltage is at its limit of {} V", SixDigits(most)),
        );
    }
}
