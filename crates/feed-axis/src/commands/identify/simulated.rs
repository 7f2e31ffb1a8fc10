//! Friction from logs that a simulated machine makes.

use axis_log::Log;
use axis_pipeline::identification::{IdentificationPlan, identify as identify_on};
use axis_sim::NoiseLevels;
use axis_sim::{Axis, LoadSensor, Measured};
use miette::{IntoDiagnostic, Result, WrapErr};

use super::friction::Friction;
use crate::context::Context;
use crate::progress::bar;
use crate::store::Stage;

/// The logs, as they are kept beside the results.
pub(super) const SPEEDS: &str = "constant-speed.parquet";
pub(super) const PRESLIDING: &str = "pre-sliding.parquet";

/// Makes the experiments on the simulated machine, writes their logs and identifies friction
/// from them.
pub(super) fn identify(context: &Context, stage: &Stage<'_>) -> Result<Friction> {
    let plan = plan(context);
    let progress = bar("friction", plan.motions());
    let (machine, axis) = (&context.machine, &context.axis);
    let sense = sensors(machine, context.seed);
    let session = identify_on(machine, axis, &plan, sense, || progress.inc(1)).into_diagnostic()?;
    progress.finish_and_clear();
    for ((_, log), file) in session.logs.iter().zip([SPEEDS, PRESLIDING]) {
        let path = stage.path(file);
        axis_log::write(&path, &logged(log)?)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write the log {}", path.display()))?;
    }
    let names = [SPEEDS, PRESLIDING].map(str::to_owned);
    // The truth is that of another coordinate where the two files differ in it.
    let truth =
        (machine.friction.at == axis.friction.at).then(|| machine.friction.law.parameters());
    let mut friction = Friction::of(&session.found, &names, &axis.friction, truth.as_ref());
    friction.simulated = true;
    Ok(friction)
}

/// What noise the drive's sensors have beside what the axis file says of them: of a good scale,
/// motor encoder and current sensor where it says nothing.
fn sensors(machine: &Axis, seed: u64) -> impl FnMut(&mut Measured) {
    let good = NoiseLevels::good(machine);
    let has_scale = matches!(machine.sensors.load, LoadSensor::Perfect);
    let has_encoder = machine.sensors.motor.is_none();
    let noise = NoiseLevels {
        position: if has_scale { good.position } else { 0.0 },
        angle: if has_encoder { good.angle } else { 0.0 },
        speed: if has_encoder { good.speed } else { 0.0 },
        current: good.current,
    };
    noise.sensors(seed)
}

/// The channels of a log that identification is about: a drive's trace has few.
fn logged(log: &Log) -> Result<Log> {
    let of_controller = ["speed_ref_rad_s", "ud_v", "uq_v", "id_a"];
    let unused = |name: &str| {
        of_controller.contains(&name)
            || name.starts_with("correction_")
            || name == "iq_feedforward_a"
    };
    let kept = log.channels().iter().filter(|c| !unused(&c.name));
    Log::new(kept.cloned().collect()).into_diagnostic()
}

/// The experiments.
pub(super) fn plan(context: &Context) -> IdentificationPlan {
    let mut plan = IdentificationPlan {
        seed: context.seed,
        ..IdentificationPlan::of(&context.axis)
    };
    if context.quick {
        plan.record_time = 0.4;
    }
    plan
}
