//! The file of a rigid axis: `kind = "rigid-mass"`.

use lugre::LuGre;

use super::error::AxisFileError;
use super::extras;
use super::fields::Fields;
use super::units::*;
use crate::axis::Stroke;
use crate::rigid::RigidAxis;

pub(super) fn rigid(root: &Fields<'_>) -> Result<RigidAxis, AxisFileError> {
    use Valid::{NotNegative, Positive};
    let body = root.table("body")?;
    let control = root.table("control")?;
    let limits = root.table("stroke")?;
    let simulation = root.table("simulation")?;
    let presliding = body.quantity("presliding", &LENGTH, Positive)?;
    let coulomb = body.quantity("coulomb", &FORCE, NotNegative)?;
    let parameters = lugre::Parameters {
        coulomb,
        stiction: coulomb,
        stribeck_speed: 1.0,
        stiffness: coulomb / presliding,
        damping: 0.0,
        viscous: body.quantity("viscous", &LINEAR_DAMPING, NotNegative)?,
    };
    let friction =
        LuGre::new(parameters).map_err(|e| body.refuse_table(e.to_string(), "another friction"))?;
    let axis = RigidAxis {
        name: root.text("name")?.to_owned(),
        description: root.optional_text("description")?.unwrap_or("").to_owned(),
        mass: body.quantity("mass", &MASS, Positive)?,
        force_gain: body.quantity("force_gain", &FORCE_GAIN, Positive)?,
        lead: body.quantity("lead", &LENGTH, Positive)?,
        friction,
        presliding,
        position_gain: control.quantity("position_gain", &RATE, Positive)?,
        speed_gain: control.quantity("speed_gain", &SPEED_GAIN, Positive)?,
        command_limit: control.quantity("command_limit", &VOLTAGE, Positive)?,
        period: 1.0 / control.quantity("frequency", &FREQUENCY, Positive)?,
        step: simulation.quantity("step", &TIME, Positive)?,
        stroke: Stroke {
            minimum: limits.quantity("minimum", &LENGTH, Valid::Finite)?,
            maximum: limits.quantity("maximum", &LENGTH, Valid::Finite)?,
            start: limits.quantity("start", &LENGTH, Valid::Finite)?,
        },
        effects: extras::effects(root, true)?,
        tolerance: extras::tolerance(root)?,
        log: extras::log(root)?,
        fingerprint: String::new(),
    };
    for table in [body, control, limits, simulation] {
        table.finish()?;
    }
    Ok(axis)
}
