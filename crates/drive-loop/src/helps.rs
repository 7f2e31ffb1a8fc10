//! What would help most: each change tried, the axis tuned again with it.

use axis_sim::Axis;
use axis_sim::part::Role;
use compensator::Drive;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::LoopError;
use crate::gains::Limits;
use crate::law::LoopGains;
use crate::plant::LoopModel;
use crate::quick_current::with_quick_current;
use crate::set::{AxisLoops, LoopSet};
use crate::tune_settings::TuneSettings;

/// Share by which a change must improve the loop to be told.
const TOLD: f64 = 0.02;

/// A change of the axis, and what gains that were tuned with it are worth.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Help {
    /// The change.
    pub change: String,
    /// Compliance from 1 to 300 Hz, as a share of what the tuned axis has.
    pub compliance_rms: f64,
    /// Compliance at low frequencies while sliding, likewise; none without an integral.
    pub compliance_slope: Option<f64>,
    /// Both together, as the search weighs them.
    pub together: f64,
}

/// All changes that this axis can have and that help, the most first.
pub(crate) fn helps(
    axis: &Axis,
    settings: &TuneSettings,
    tuned: &AxisLoops,
    gains: &LoopGains,
    limits: &Limits,
) -> Result<Vec<Help>, LoopError> {
    let before = tuned.figures(gains);
    let mut all = Vec::new();
    for (change, loops) in changes(axis, settings)? {
        // Where even no gains are found, it is no help.
        let Ok((gains, _)) = loops.tuned(limits, Some(gains)) else {
            continue;
        };
        let after = loops.figures(&gains);
        let together = (after.objective - before.objective).exp();
        if together < 1.0 - TOLD {
            all.push(Help {
                change,
                compliance_rms: after.compliance_rms / before.compliance_rms,
                compliance_slope: after
                    .compliance_slope
                    .zip(before.compliance_slope)
                    .map(|(after, before)| after / before),
                together,
            });
        }
    }
    all.sort_by(|a, b| a.together.total_cmp(&b.together));
    Ok(all)
}

/// The axis with each change, its loops not tuned.
fn changes(axis: &Axis, settings: &TuneSettings) -> Result<Vec<(String, AxisLoops)>, LoopError> {
    // A change of the axis would change what was measured too.
    let set = &LoopSet {
        measured: Vec::new(),
        ..settings.set.clone()
    };
    let own = LoopModel::new(axis)?;
    let mut all = Vec::new();
    let mut model = |what: &str, change: &dyn Fn(&mut LoopModel)| -> Result<(), LoopError> {
        let mut model = own.clone();
        change(&mut model);
        all.push((what.to_owned(), AxisLoops::of_model(axis, model, set)?));
        Ok(())
    };
    if own.sensing.load_from_motor || own.cascade().from_motor {
        model("a sensor at the load for the position loop", &|m| {
            m.sensing.load_from_motor = false;
            m.sensing.load_delay = 0.0;
            m.model.cascade.from_motor = false;
            m.model.cascade.signal_path.blend = None;
        })?;
    }
    if own.model.delay + own.model.drive.late() > 0.0 {
        model(
            "a drive without delay of the command and of the voltage",
            &|m| {
                m.model.delay = 0.0;
                if let Drive::FieldOriented { late, .. } = &mut m.model.drive {
                    *late = 0.0;
                }
            },
        )?;
    }
    if let Drive::Lag { bandwidth, .. } = own.model.drive
        && bandwidth.is_finite()
    {
        model("torque of twice the bandwidth", &|m| {
            if let Drive::Lag { bandwidth, .. } = &mut m.model.drive {
                *bandwidth *= 2.0;
            }
        })?;
    }
    if own.sensing.by_differences && own.sensing.step > 0.0 {
        model("a sensor of a quarter of the step for the speed", &|m| {
            m.sensing.step *= 0.25;
        })?;
    }
    if !settings.current {
        let mut quick = axis.clone();
        if with_quick_current(&mut quick).is_ok_and(|is_there| is_there) {
            let what = "current controllers by the magnitude optimum (--current)";
            all.push((what.to_owned(), AxisLoops::new(&quick, set)?));
        }
    }
    let mut stiff = axis.clone();
    if stiff.mechanism.has(Role::TransmissionStiffness)
        && stiff
            .mechanism
            .change_role(Role::TransmissionStiffness, |k| 2.0 * k)
            .is_ok()
    {
        let key = stiff
            .mechanism
            .kind()
            .keys
            .iter()
            .find(|key| key.has_role(Role::TransmissionStiffness));
        let name = key.map_or("the transmission", |key| key.name());
        all.push((
            format!("twice the stiffness of {name}"),
            AxisLoops::new(&stiff, set)?,
        ));
    }
    let mut quick = axis.clone();
    quick.period *= 0.5;
    if quick.actuator.runs_at(quick.period).is_ok() {
        all.push((
            "controllers at twice the rate".to_owned(),
            AxisLoops::new(&quick, set)?,
        ));
    }
    Ok(all)
}
