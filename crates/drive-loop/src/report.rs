//! What is reported of gains that were found: figures, what limits them, what would help.

use axis_sim::Axis;
use rayon::prelude::*;

use crate::error::LoopError;
use crate::gains::Limits;
use crate::helps::helps;
use crate::law::LoopGains;
use crate::margins::CutMargins;
use crate::set::AxisLoops;
use crate::tune_settings::TuneSettings;
use crate::tuned_gains::LoopFigures;
use crate::tuning::{Limiting, MoveCheck, Tuning};

/// An axis with gains that keep all limits.
pub(crate) struct Accepted<'a> {
    /// Loops of the axis as its file says.
    pub file: &'a AxisLoops,
    pub found: &'a Found,
    pub limits: &'a Limits,
    /// The axis with these gains.
    pub tuned: &'a Axis,
    /// Its simulated moves.
    pub moves: Vec<MoveCheck>,
}

/// Of an axis as its file says, and of what was accepted for it.
pub(crate) fn report(
    axis: &Axis,
    settings: &TuneSettings,
    accepted: Accepted<'_>,
) -> Result<Tuning, LoopError> {
    let Accepted {
        file,
        found,
        limits,
        tuned,
        moves,
    } = accepted;
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
    let before = file.figures(&file.gains());
    let after = loops.figures(gains);
    let exceeds = |peak: Option<f64>, limit: f64| peak.is_none_or(|peak| peak > limit);
    let [limit, limit_late] = limits.sensitivity;
    if exceeds(before.sensitivity, limit) || exceeds(before.sensitivity_late, limit_late) {
        let said =
            |peak: Option<f64>| peak.map_or("not stable".to_owned(), |peak| format!("{peak:.3}"));
        notes.push(format!(
            "the gains of the file do not keep these limits (sensitivity {}, with one more cycle of delay {}){}",
            said(before.sensitivity),
            said(before.sensitivity_late),
            match is_softer(&before, &after) {
                true => ": the tuned loop holds the load less firmly than they do",
                false => "",
            }
        ));
    }
    if !settings.set.measured.is_empty() {
        notes.push(format!(
            "limits hold for {} measured responses too, and the model's loops have {:.2} cycles of delay more than the file's, as these show; the simulated moves have not",
            settings.set.measured.len(),
            settings.set.delay
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
        file: before,
        tuned: after,
        proven_stable: radii.iter().all(|radius| *radius < 1.0),
        limiting: limiting(loops, gains, limits),
        helps: helps(&found.axis, settings, loops, gains, limits)?,
        moves,
        evaluations: found.evaluations,
        notes,
    })
}

/// Whether a compliance that is reported rose, to the three decimals of its ratio.
fn is_softer(before: &LoopFigures, after: &LoopFigures) -> bool {
    let rose = |before: f64, after: f64| after / before > 1.0005;
    let slopes = before.compliance_slope.zip(after.compliance_slope);
    rose(before.compliance_rms, after.compliance_rms)
        || slopes.is_some_and(|(before, after)| rose(before, after))
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
    let places = if loops.model.is_pid { 1 } else { 2 };
    let kinds = kinds.into_iter().filter(|(_, place, ..)| *place < places);
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

/// Loops with the best gains that were found for them.
pub(crate) struct Found {
    pub axis: Axis,
    pub loops: AxisLoops,
    pub gains: LoopGains,
    pub notch: Option<f64>,
    pub evaluations: usize,
}
