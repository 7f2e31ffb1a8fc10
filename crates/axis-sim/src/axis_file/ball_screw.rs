//! The file of a ball-screw axis.

use std::path::PathBuf;

use beam_fem::{Material, Section};
use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};
use foc_pmsm::{MotorParameters, Pmsm, Servo, ServoGains, ServoLimits};
use lugre::LuGre;
use trajectories::{Limits, Motion, SCurve};

use super::error::AxisFileError;
use super::extras::{self, check_step, stroke};
use super::fields::Fields;
use crate::SixDigits;
use crate::axis::{
    Axis, Experiment, FOLLOWING_ERROR_LIMIT, MoveSpec, Range, SampleRanges, Simulation, Stroke,
};
use crate::closed_loop::longest_step;
use crate::work::{MOST_STEPS, cycles_of, substeps_of};

pub(super) fn axis(root: &Fields<'_>) -> Result<Axis, AxisFileError> {
    root.count("schema")?;
    let (simulation, coupling) = simulation(&root.table("simulation")?)?;
    let control = control(&root.table("control")?, &root.table("inverter")?)?;
    check_step(&root.table("simulation")?, control.period, simulation.step)?;
    let pace = Pace {
        period: control.period,
        steps: substeps_of(control.period, longest_step(coupling, simulation.step)),
    };
    let (motor, torque_constant) = motor(&root.table("motor")?)?;
    let drive = drive(&root.table("screw")?, &root.table("drive")?)?;
    let length = drive.parameters().screw_length;
    let stroke = stroke(&root.table("stroke")?, Some(length))?;
    Ok(Axis {
        name: root.text("name")?.to_owned(),
        description: root.optional_text("description")?.unwrap_or("").to_owned(),
        friction: friction(&root.table("friction")?)?,
        samples: sample_ranges(&root.table("samples")?, length)?,
        trajectories: trajectories(root, &stroke, &pace)?,
        experiment: experiment(root.optional_table("experiment")?)?,
        stroke,
        drive,
        motor,
        torque_constant,
        servo: control.servo,
        velocity_feedforward: control.feedforward,
        period: control.period,
        following_error_limit: control.following_error,
        coupling,
        simulation,
        effects: extras::effects(root, false)?,
        tolerance: extras::tolerance(root)?,
        log: extras::log(root)?,
        fingerprint: String::new(),
    })
}

fn drive(screw: &Fields<'_>, lumped: &Fields<'_>) -> Result<FeedDrive, AxisFileError> {
    let material = Material::new(
        screw.number("youngs_modulus")?,
        screw.number("poisson_ratio")?,
        screw.number("density")?,
    )
    .map_err(|e| screw.refuse_table(e.to_string(), "another material"))?;
    let section = Section::solid_circle(screw.number("diameter")?, &material)
        .map_err(|e| screw.refuse_table(e.to_string(), "another section"))?;
    let parameters = DriveParameters {
        section,
        material,
        screw_length: screw.number("length")?,
        elements: screw.count("elements")? as usize,
        lead: screw.number("lead")?,
        motor_inertia: lumped.number("motor_inertia")?,
        sensor_inertia: lumped.number("torque_sensor_inertia")?,
        motor_coupling_stiffness: lumped.number("motor_coupling")?,
        screw_coupling_stiffness: lumped.number("screw_coupling")?,
        table_mass: lumped.number("table_mass")?,
        nut_stiffness: lumped.number("nut_stiffness")?,
        stiffness_damping: lumped.number("stiffness_damping")?,
    };
    FeedDrive::new(parameters).map_err(|e| lumped.refuse_table(e.to_string(), "other parameters"))
}

fn friction(f: &Fields<'_>) -> Result<LuGre, AxisFileError> {
    let parameters = lugre::Parameters {
        coulomb: f.number("coulomb")?,
        stiction: f.number("stiction")?,
        stribeck_speed: f.number("stribeck_speed")?,
        stiffness: f.number("bristle_stiffness")?,
        damping: f.number("bristle_damping")?,
        viscous: f.number("viscous")?,
    };
    LuGre::new(parameters)
        .map_err(|e| f.refuse_table(e.to_string(), "stiction at least as great as coulomb"))
}

fn motor(f: &Fields<'_>) -> Result<(Pmsm, f64), AxisFileError> {
    let torque_constant = f.number("torque_constant")?;
    let pole_pairs = f.count("pole_pairs")?;
    let parameters = MotorParameters {
        pole_pairs,
        resistance: f.number("resistance")?,
        inductance_d: f.number("inductance_d")?,
        inductance_q: f.number("inductance_q")?,
        // K_t = 1.5 p ψ at i_d = 0.
        flux_linkage: torque_constant / (1.5 * f64::from(pole_pairs)),
    };
    let motor = Pmsm::new(parameters)
        .map_err(|e| f.refuse_table(e.to_string(), "other motor parameters"))?;
    Ok((motor, torque_constant))
}

/// What `[control]` and `[inverter]` say.
struct Control {
    servo: Servo,
    feedforward: f64,
    period: f64,
    following_error: f64,
}

fn control(f: &Fields<'_>, inverter: &Fields<'_>) -> Result<Control, AxisFileError> {
    let gains = ServoGains {
        position: f.number("position_gain")?,
        speed_p: f.number("speed_proportional")?,
        speed_i: f.number("speed_integral")?,
        d_p: f.number("current_d_proportional")?,
        d_i: f.number("current_d_integral")?,
        q_p: f.number("current_q_proportional")?,
        q_i: f.number("current_q_integral")?,
    };
    let limits = ServoLimits {
        current: f.number("current_limit")?,
        // The largest circle that SVPWM reaches linearly.
        voltage: inverter.number("dc_link")? / 3f64.sqrt(),
    };
    let period = 1.0 / f.number("frequency")?;
    let servo = Servo::new(gains, limits, period)
        .map_err(|e| f.refuse_table(e.to_string(), "other control parameters"))?;
    let following_error = f.optional_number("following_error_limit")?;
    Ok(Control {
        servo,
        feedforward: f.number("velocity_feedforward")?,
        period,
        following_error: following_error.unwrap_or(FOLLOWING_ERROR_LIMIT),
    })
}

fn sample_ranges(f: &Fields<'_>, screw_length: f64) -> Result<SampleRanges, AxisFileError> {
    let range = |name: &str| {
        let least = f.number(&format!("{name}_min"))?;
        let most = f.number(&format!("{name}_max"))?;
        if least < most {
            return Ok(Range { least, most });
        }
        let (a, b) = (SixDigits(least), SixDigits(most));
        let what = format!("has {name}_min = {a}, not below {name}_max = {b} (SI)");
        Err(f.refuse_table(what, "a minimum below the maximum"))
    };
    let ranges = SampleRanges {
        position: range("position")?,
        speed: range("speed")?,
        acceleration: range("acceleration")?,
        current: range("current")?,
    };
    if ranges.position.least < 0.0 || ranges.position.most > screw_length {
        let what = "asks for positions off the screw".to_owned();
        return Err(f.refuse_table(what, "positions from 0 to the screw's length"));
    }
    Ok(ranges)
}

fn simulation(f: &Fields<'_>) -> Result<(Simulation, NutCoupling), AxisFileError> {
    let coupling = match f.word("nut_coupling")? {
        "moving-node" => NutCoupling::MovingNode,
        _ => NutCoupling::ShapeFunctions,
    };
    let step = f.number("step")?;
    Ok((Simulation { step }, coupling))
}

fn experiment(f: Option<Fields<'_>>) -> Result<Option<Experiment>, AxisFileError> {
    let Some(f) = f else {
        return Ok(None);
    };
    Ok(Some(Experiment {
        machine: PathBuf::from(f.text("machine")?),
        paper_tables: f.optional_text("paper_tables")?.map(PathBuf::from),
    }))
}

/// Control period, s, and internal steps in it.
struct Pace {
    period: f64,
    steps: f64,
}

fn trajectories(
    root: &Fields<'_>,
    stroke: &Stroke,
    pace: &Pace,
) -> Result<Vec<MoveSpec>, AxisFileError> {
    // A move to the very end of the stroke may pass it by a rounding error.
    let slack = 1e-12 * stroke.maximum;
    let one = |f: Fields<'_>| {
        let displacement = f.number("displacement")?;
        let end = stroke.start + displacement;
        if !(stroke.minimum - slack..=stroke.maximum + slack).contains(&end) {
            let what = format!("ends at {} m, outside the stroke", SixDigits(end));
            let (least, most) = (SixDigits(stroke.minimum), SixDigits(stroke.maximum));
            let valid = format!("an end from {least} m to {most} m");
            return Err(f.refuse_table(what, &valid));
        }
        let (speed, acceleration) = (f.number("speed")?, f.number("acceleration")?);
        let refuse =
            |e: trajectories::TrajectoryError| f.refuse_table(e.to_string(), "other limits");
        let limits = Limits::new(speed, acceleration, f.number("jerk")?).map_err(refuse)?;
        let motion = SCurve::plan(stroke.start, end, &limits).map_err(refuse)?;
        let steps = cycles_of(motion.duration(), pace.period) * pace.steps;
        if steps > MOST_STEPS {
            let what = format!(
                "takes {} s, {} internal steps",
                SixDigits(motion.duration()),
                SixDigits(steps)
            );
            let valid = format!("a move of at most {} internal steps", SixDigits(MOST_STEPS));
            return Err(f.refuse_table(what, &valid));
        }
        Ok(MoveSpec {
            displacement,
            limits,
        })
    };
    root.tables("trajectory")?.into_iter().map(one).collect()
}
