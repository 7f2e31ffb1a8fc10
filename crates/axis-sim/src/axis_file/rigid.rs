//! The file of a rigid axis: `kind = "rigid-mass"`.

use lugre::LuGre;

use super::error::AxisFileError;
use super::extras::{self, check_step, stroke};
use super::fields::Fields;
use crate::rigid::RigidAxis;

pub(super) fn rigid(root: &Fields<'_>) -> Result<RigidAxis, AxisFileError> {
    root.count("schema")?;
    let body = root.table("body")?;
    let control = root.table("control")?;
    let simulation = root.table("simulation")?;
    let (coulomb, presliding) = (body.number("coulomb")?, body.number("presliding")?);
    let parameters = lugre::Parameters {
        coulomb,
        stiction: coulomb,
        stribeck_speed: 1.0,
        stiffness: coulomb / presliding,
        damping: 0.0,
        viscous: body.number("viscous")?,
    };
    let friction =
        LuGre::new(parameters).map_err(|e| body.refuse_table(e.to_string(), "another friction"))?;
    let (period, step) = (
        1.0 / control.number("frequency")?,
        simulation.number("step")?,
    );
    check_step(&simulation, period, step)?;
    Ok(RigidAxis {
        name: root.text("name")?.to_owned(),
        description: root.optional_text("description")?.unwrap_or("").to_owned(),
        mass: body.number("mass")?,
        force_gain: body.number("force_gain")?,
        lead: body.number("lead")?,
        friction,
        presliding,
        position_gain: control.number("position_gain")?,
        speed_gain: control.number("speed_gain")?,
        command_limit: control.number("command_limit")?,
        following_error_limit: control.optional_number("following_error_limit")?,
        period,
        step,
        stroke: stroke(&root.table("stroke")?, None)?,
        effects: extras::effects(root, true)?,
        tolerance: extras::tolerance(root)?,
        log: extras::log(root)?,
        fingerprint: String::new(),
    })
}
