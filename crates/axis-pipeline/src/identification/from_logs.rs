//! Logs to friction.

use axis_log::Log;
use axis_log::quality::check_sampling;
use axis_sim::Axis;
use axis_sim::balance::ObservedMotion;
use lugre::identify::{ParameterEstimate, PreslidingFit, StaticFit};

use super::curve::{self, Fitted, LEAST_SPEEDS};
use super::error::IdentifyLogsError;
use super::found::{FoundParameter, Identified, Open, ParameterSource, SmallMotion, SpeedRun};
use super::steady::{self, Record};
use super::{presliding, varying};

/// Identifies an axis' friction from logs, each with its name for messages.
///
/// Of each log the motion is read (position or speed of load or motor) and the motor's torque (its
/// current, its command, or a measured torque); `axis` gives inertia, transmission, torque
/// constant, loads, and the coordinate of the friction law. Its friction is not read,
/// except for the bristles if the logs show no small motion, which is reported.
///
/// 1. Stretches of constant speed, both directions, give the steady-state curve. If they show
///    fewer than six different speeds, short stretches of slowly changing speed are taken as well.
/// 2. Small motions about a standstill give the bristles' stiffness and damping.
///
/// # Errors
/// [`IdentifyLogsError`] names the log and what it lacks.
pub fn identify_from_logs(
    axis: &Axis,
    logs: &[(String, Log)],
) -> Result<Identified, IdentifyLogsError> {
    if logs.is_empty() {
        return Err(IdentifyLogsError::NoLogs);
    }
    let records: Result<Vec<Record<'_>>, _> = logs
        .iter()
        .enumerate()
        .map(|(index, (name, log))| record(axis, index, name, log))
        .collect();
    let mut records = records?;
    let mut found = speeds(&mut records)?;
    let mut small = small_motions(&records, &found.fitted.statics);
    if found.drop_unslid(&records, &small)? {
        small = small_motions(&records, &found.fitted.statics);
    }
    gathered(axis, found, small)
}

/// Way since the last turn, in pre-sliding distances T_C/σ0, after which a contact slides: its
/// bristles are
/// bent to 1 − e⁻⁵, 0.7 % short of their limit.
const SLIDES: f64 = 5.0;

/// Friction against speed.
struct Speeds {
    runs: Vec<SpeedRun>,
    notes: Vec<String>,
    fitted: Fitted,
}

impl Speeds {
    /// Leaves out the runs of which small motions say that nothing slid yet, and fits the curve
    /// anew; whether there were any.
    fn drop_unslid(
        &mut self,
        records: &[Record<'_>],
        small: &[SmallMotion],
    ) -> Result<bool, IdentifyLogsError> {
        let Some([stiffness, _]) = stiffness(small) else {
            return Ok(false);
        };
        let least = SLIDES * self.fitted.statics.coulomb.value / stiffness;
        let (slid, unslid): (Vec<_>, Vec<_>) = self
            .runs
            .iter()
            .cloned()
            .partition(|run| run.distance >= least);
        if unslid.is_empty() || different(&slid) < LEAST_SPEEDS {
            return Ok(false);
        }
        let (fitted, mut runs) = fitted(slid, records)?;
        let told = unslid.into_iter().map(|run| SpeedRun {
            left_out: Some(format!(
                "its bristles still bend: {:.2e} since the last turn, sliding begins after {least:.2e}",
                run.distance
            )),
            ..run
        });
        runs.extend(told);
        (self.fitted, self.runs) = (fitted, runs);
        Ok(true)
    }
}

fn small_motions(records: &[Record<'_>], statics: &StaticFit) -> Vec<SmallMotion> {
    let of = |record| presliding::small_motions(record, statics);
    records.iter().flat_map(of).collect()
}

/// The steady-state curve alone, of logs in the making.
pub(super) fn curve_of(axis: &Axis, log: &Log) -> Result<StaticFit, IdentifyLogsError> {
    let mut records = vec![record(axis, 0, "the runs so far", log)?];
    Ok(speeds(&mut records)?.fitted.statics)
}

fn record<'a>(
    axis: &'a Axis,
    index: usize,
    name: &str,
    log: &Log,
) -> Result<Record<'a>, IdentifyLogsError> {
    let sampling = check_sampling(log).map_err(|reason| IdentifyLogsError::Sampling {
        log: name.to_owned(),
        reason,
    })?;
    let shown = ObservedMotion::of(log, sampling.period, axis);
    let shown = shown.map_err(|reason| IdentifyLogsError::Channels {
        log: name.to_owned(),
        reason,
    })?;
    let start = log.time().first().copied().unwrap_or(0.0);
    Ok(Record::of(axis, index, start, shown))
}

/// The runs, what is worth telling, the curve.
fn speeds(records: &mut [Record<'_>]) -> Result<Speeds, IdentifyLogsError> {
    let mut runs: Vec<SpeedRun> = records.iter_mut().flat_map(steady::runs).collect();
    let stretches = runs.len();
    let (mut notes, mut windows) = (Vec::new(), 0);
    if different(&runs) < ENOUGH_SPEEDS {
        let more = varying::runs(records);
        windows = more.windows;
        if !more.runs.is_empty() {
            notes.extend(more.note);
            runs.extend(more.runs);
        }
    }
    let speeds = different(&runs);
    if speeds < LEAST_SPEEDS {
        return Err(IdentifyLogsError::TooFewSpeeds {
            speeds,
            stretches,
            windows,
            vibrating: runs.iter().filter(|run| is_left_out(run)).count(),
            needed: LEAST_SPEEDS,
        });
    }
    let (fitted, runs) = fitted(runs, records)?;
    Ok(Speeds {
        runs,
        notes,
        fitted,
    })
}

/// The curve of runs, and these with the reasons for which some were left out.
fn fitted(
    mut runs: Vec<SpeedRun>,
    records: &[Record<'_>],
) -> Result<(Fitted, Vec<SpeedRun>), IdentifyLogsError> {
    let unit = records.first();
    let unit = unit.map_or("", |record| record.axis.friction.at.units().speed);
    let fitted = curve::fit(&runs, unit)?;
    for left in &fitted.statics.left_out {
        runs[left.run].left_out = Some(left.reason.to_string());
    }
    Ok((fitted, runs))
}

/// Different speeds that show the whole curve ([`lugre::identify::identify_static`]).
const ENOUGH_SPEEDS: usize = 6;

fn is_left_out(run: &SpeedRun) -> bool {
    run.run.is_at_rest() || run.run.vibration > lugre::identify::VIBRATION_LIMIT
}

/// Different |speeds| of runs that will be used; those within 1 % of the one before are repeats.
fn different(runs: &[SpeedRun]) -> usize {
    let used = runs.iter().filter(|run| !is_left_out(run));
    let mut speeds: Vec<f64> = used.map(|run| run.run.speed.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup_by(|next, kept| *next <= 1.01 * *kept);
    speeds.len()
}

/// Everything that was found, as one result.
fn gathered(
    axis: &Axis,
    found: Speeds,
    small_motions: Vec<SmallMotion>,
) -> Result<Identified, IdentifyLogsError> {
    let Speeds {
        runs,
        mut notes,
        fitted: Fitted { statics, open },
    } = found;
    let mut open: Vec<Open> = open.into_iter().collect();
    let freedom = statics.degrees_of_freedom;
    let of = |name, estimate: ParameterEstimate| {
        FoundParameter::of(name, estimate.value, estimate.standard_error, freedom)
    };
    let no_fall = |name, value| FoundParameter::open(name, value, ParameterSource::NoFall);
    let [stiction, stribeck_speed] = match open.is_empty() {
        true => [
            of("T_S", statics.stiction),
            of("Ω_S", statics.stribeck_speed),
        ],
        false => [
            no_fall("T_S", statics.coulomb.value),
            no_fall("Ω_S", statics.stribeck_speed.value),
        ],
    };
    let viscous = match statics.viscous.value > 0.0 {
        true => of("σ2", statics.viscous),
        false => FoundParameter::open("σ2", 0.0, ParameterSource::NotSeen),
    };
    if viscous.source == ParameterSource::NotSeen {
        open.push(Open {
            parameters: vec!["σ2"],
            why: "friction does not rise with speed in these runs".to_owned(),
            run: "run faster, and at more speeds, both ways".to_owned(),
        });
    }
    let (bristles, more) = bristles(axis, &small_motions, &statics);
    open.extend(more);
    let [stiffness, damping] = bristles;
    notes.extend(one_way(&runs, &statics));
    let parameters = [
        of("T_C", statics.coulomb),
        stiction,
        stribeck_speed,
        viscous,
        stiffness,
        damping,
    ];
    let levels = statics.parameters();
    let law = levels.with_bristles(stiffness.value, damping.value);
    lugre::LuGre::new(law)?;
    Ok(Identified {
        runs,
        small_motions,
        statics,
        parameters,
        law,
        open,
        notes,
    })
}

/// What one direction alone hides.
fn one_way(runs: &[SpeedRun], statics: &StaticFit) -> Option<String> {
    let used = statics.used.iter().map(|&i| runs[i].run.speed);
    let forward = used.clone().filter(|v| *v > 0.0).count();
    let back = used.count() - forward;
    (forward.min(back) < 2).then(|| {
        "fewer than two runs go in one of the two directions: a constant load or an offset of the torque sensor adds to T_C and cannot be separated from it; run every speed in both directions".to_owned()
    })
}

/// σ0 and σ1: the mean over all small motions that tell them, each with the weight of its own
/// standard error; where they scatter more than these, the scatter counts.
fn bristles(
    axis: &Axis,
    motions: &[SmallMotion],
    statics: &StaticFit,
) -> ([FoundParameter; 2], Option<Open>) {
    let fits: Vec<&PreslidingFit> = motions.iter().filter_map(|m| m.fit.as_ref().ok()).collect();
    let mean = |name, pick: fn(&PreslidingFit) -> ParameterEstimate| {
        let estimates: Vec<ParameterEstimate> = fits.iter().map(|fit| pick(fit)).collect();
        let freedom = match estimates.as_slice() {
            [_] => fits.iter().map(|fit| fit.samples).sum(),
            many => many.len().saturating_sub(1),
        };
        weighted(&estimates).map(|[value, error]| FoundParameter::of(name, value, error, freedom))
    };
    let found = [
        mean("σ0", |fit| fit.stiffness),
        mean("σ1", |fit| fit.damping),
    ];
    if let [Some(stiffness), Some(damping)] = found {
        return ([stiffness, damping], None);
    }
    // As long a way before sliding as the axis file's bristles have.
    let unit = axis.friction.unit.parameters().stiffness;
    let own = axis.friction.law.parameters();
    let from_file = |name, value| FoundParameter::open(name, value, ParameterSource::AxisFile);
    let bristles = [
        from_file("σ0", unit * statics.coulomb.value),
        from_file("σ1", own.damping),
    ];
    let why = match motions.iter().find_map(|m| m.fit.as_ref().err()) {
        Some(why) => format!("no small motion about a standstill shows them ({why})"),
        None => "no small motion about a standstill is in the logs".to_owned(),
    };
    let open = Open {
        parameters: vec!["σ0", "σ1"],
        why: why + "; the axis file's pre-sliding distance and damping are taken",
        run: "move to and fro about a standstill at 0.5 to 2 Hz, so far that the friction comes to about half of T_C, three cycles or more, with a position that shows at least four steps of its sensor".to_owned(),
    };
    (bristles, Some(open))
}

/// σ0 and its standard error, where small motions tell it.
fn stiffness(motions: &[SmallMotion]) -> Option<[f64; 2]> {
    let fits = motions.iter().filter_map(|m| m.fit.as_ref().ok());
    let estimates: Vec<ParameterEstimate> = fits.map(|fit| fit.stiffness).collect();
    weighted(&estimates)
}

/// The weighted mean of estimates and its standard error, widened where they scatter by more than
/// their own (the Birge ratio); `None` without any.
fn weighted(estimates: &[ParameterEstimate]) -> Option<[f64; 2]> {
    let weight = |e: &ParameterEstimate| 1.0 / e.standard_error.max(f64::MIN_POSITIVE).powi(2);
    let total: f64 = estimates.iter().map(weight).sum();
    if estimates.is_empty() || !total.is_finite() {
        return None;
    }
    let sum: f64 = estimates.iter().map(|e| weight(e) * e.value).sum();
    let mean = sum / total;
    let chi_squared: f64 = estimates
        .iter()
        .map(|e| weight(e) * (e.value - mean).powi(2))
        .sum();
    let ratio = chi_squared / estimates.len().saturating_sub(1).max(1) as f64;
    Some([mean, (ratio.max(1.0) / total).sqrt()])
}
