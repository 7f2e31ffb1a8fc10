//! The axis file: TOML to a checked [`Axis`].

mod error;
mod extras;
mod fields;
mod rigid;
mod units;

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use beam_fem::{Material, Section};
use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};
use foc_pmsm::{MotorParameters, Pmsm, Servo, ServoGains, ServoLimits};
use lugre::LuGre;
use toml::de::DeTable;
use trajectories::Limits;

use crate::axis::{Axis, Experiment, MoveSpec, Range, SampleRanges, Simulation, Stroke};
use crate::effects::Machine;
pub use error::AxisFileError;
use error::Source;
use fields::{Fields, Record};
use units::*;

/// The version of the axis file's layout that this program reads.
const SCHEMA: u32 = 1;

impl Axis {
    /// Reads an axis file.
    ///
    /// # Errors
    /// [`AxisFileError`] names file, line and field, and what would be valid.
    pub fn read(path: &Path) -> Result<Self, AxisFileError> {
        let content = std::fs::read_to_string(path).map_err(|reason| AxisFileError::Read {
            path: path.to_owned(),
            reason,
        })?;
        let mut axis = Self::parse(&path.display().to_string(), &content)?;
        // Files that an axis file names lie relative to it.
        if let (Some(experiment), Some(folder)) = (&mut axis.experiment, path.parent()) {
            experiment.machine = folder.join(&experiment.machine);
            experiment.paper_tables = experiment.paper_tables.take().map(|p| folder.join(p));
        }
        Ok(axis)
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(name: &str, content: &str) -> Result<Self, AxisFileError> {
        let (mut axis, fingerprint) = parse(name, content, axis)?;
        axis.fingerprint = fingerprint;
        Ok(axis)
    }
}

impl Machine {
    /// Reads the file of either kind of machine: `kind = "rigid-mass"`, or
    /// `kind = "ball-screw"`, which is what a file without a kind is.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn read(path: &Path) -> Result<Self, AxisFileError> {
        let content = std::fs::read_to_string(path).map_err(|reason| AxisFileError::Read {
            path: path.to_owned(),
            reason,
        })?;
        match Self::parse(&path.display().to_string(), &content)? {
            Self::BallScrew(_) => Ok(Self::BallScrew(Box::new(Axis::read(path)?))),
            rigid => Ok(rigid),
        }
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(name: &str, content: &str) -> Result<Self, AxisFileError> {
        let (mut machine, fingerprint) = parse(name, content, |root| {
            if kind(&root)? {
                root.count("schema", SCHEMA, SCHEMA)?;
                let rigid = rigid::rigid(&root)?;
                root.finish()?;
                return Ok(Self::Rigid(Box::new(rigid)));
            }
            Ok(Self::BallScrew(Box::new(axis(root)?)))
        })?;
        match &mut machine {
            Self::BallScrew(axis) => axis.fingerprint = fingerprint,
            Self::Rigid(axis) => axis.fingerprint = fingerprint,
        }
        Ok(machine)
    }
}

/// Whether the file is of a rigid mass.
fn kind(root: &Fields<'_>) -> Result<bool, AxisFileError> {
    match root.optional_text("kind")? {
        None => Ok(false),
        Some(_) => root.word("kind", &[("ball-screw", false), ("rigid-mass", true)]),
    }
}

/// What `read` makes of the file, and the hash of its values.
fn parse<T>(
    name: &str,
    content: &str,
    read: impl FnOnce(Fields<'_>) -> Result<T, AxisFileError>,
) -> Result<(T, String), AxisFileError> {
    let source = Source {
        name: name.to_owned(),
        content: content.to_owned(),
    };
    let table = DeTable::parse(content).map_err(|e| AxisFileError::syntax(&source, &e))?;
    let record: Record = Rc::new(RefCell::new(Vec::new()));
    let read = read(Fields::root(&source, &table, record.clone()))?;
    let mut lines = record.take();
    lines.sort();
    let hash = blake3::hash(lines.join("\n").as_bytes());
    Ok((read, hash.to_hex().to_string()))
}

fn axis(root: Fields<'_>) -> Result<Axis, AxisFileError> {
    root.count("schema", SCHEMA, SCHEMA)?;
    if kind(&root)? {
        let what = "is \"rigid-mass\": this command needs a ball screw".to_owned();
        return Err(root.refuse_table(what, "\"ball-screw\", or no kind"));
    }
    let (simulation, coupling) = simulation(root.table("simulation")?)?;
    let (servo, period) = servo(root.table("control")?, root.table("inverter")?)?;
    let (motor, torque_constant) = motor(root.table("motor")?)?;
    let (samples, screw_length) = (root.table("samples")?, root.table("screw")?);
    let drive = drive(screw_length, root.table("drive")?)?;
    let length = drive.parameters().screw_length;
    let stroke = stroke(root.table("stroke")?, length)?;
    let axis = Axis {
        name: root.text("name")?.to_owned(),
        description: root.optional_text("description")?.unwrap_or("").to_owned(),
        friction: friction(root.table("friction")?)?,
        samples: sample_ranges(samples, length)?,
        trajectories: trajectories(&root, &stroke)?,
        experiment: experiment(root.optional_table("experiment")?)?,
        stroke,
        drive,
        motor,
        torque_constant,
        servo: servo.0,
        velocity_feedforward: servo.1,
        period,
        coupling,
        simulation,
        effects: extras::effects(&root, false)?,
        tolerance: extras::tolerance(&root)?,
        log: extras::log(&root)?,
        fingerprint: String::new(),
    };
    root.finish()?;
    Ok(axis)
}

fn drive(screw: Fields<'_>, lumped: Fields<'_>) -> Result<FeedDrive, AxisFileError> {
    use Valid::{NotNegative, PoissonRatio, Positive};
    let material = Material::new(
        screw.quantity("youngs_modulus", &PRESSURE, Positive)?,
        screw.number("poisson_ratio", PoissonRatio)?,
        screw.quantity("density", &DENSITY, Positive)?,
    )
    .map_err(|e| screw.refuse_table(e.to_string(), "another material"))?;
    let diameter = screw.quantity("diameter", &LENGTH, Positive)?;
    let section = Section::solid_circle(diameter, &material)
        .map_err(|e| screw.refuse_table(e.to_string(), "another section"))?;
    let parameters = DriveParameters {
        section,
        material,
        screw_length: screw.quantity("length", &LENGTH, Positive)?,
        elements: screw.count("elements", 2, 1000)? as usize,
        lead: screw.quantity("lead", &LENGTH, Positive)?,
        motor_inertia: lumped.quantity("motor_inertia", &INERTIA, Positive)?,
        sensor_inertia: lumped.quantity("torque_sensor_inertia", &INERTIA, Positive)?,
        motor_coupling_stiffness: lumped.quantity("motor_coupling", &TORSION, Positive)?,
        screw_coupling_stiffness: lumped.quantity("screw_coupling", &TORSION, Positive)?,
        table_mass: lumped.quantity("table_mass", &MASS, Positive)?,
        nut_stiffness: lumped.quantity("nut_stiffness", &STIFFNESS, Positive)?,
        stiffness_damping: lumped.quantity("stiffness_damping", &TIME, NotNegative)?,
    };
    let drive = FeedDrive::new(parameters)
        .map_err(|e| lumped.refuse_table(e.to_string(), "other parameters"))?;
    screw.finish()?;
    lumped.finish()?;
    Ok(drive)
}

fn friction(f: Fields<'_>) -> Result<LuGre, AxisFileError> {
    use Valid::{NotNegative, Positive};
    let parameters = lugre::Parameters {
        coulomb: f.quantity("coulomb", &TORQUE, Positive)?,
        stiction: f.quantity("stiction", &TORQUE, Positive)?,
        stribeck_speed: f.quantity("stribeck_speed", &ROTATION, Positive)?,
        stiffness: f.quantity("bristle_stiffness", &BRISTLE_STIFFNESS, Positive)?,
        damping: f.quantity("bristle_damping", &ROTARY_DAMPING, NotNegative)?,
        viscous: f.quantity("viscous", &ROTARY_DAMPING, NotNegative)?,
    };
    let law = LuGre::new(parameters)
        .map_err(|e| f.refuse_table(e.to_string(), "stiction at least as great as coulomb"))?;
    f.finish()?;
    Ok(law)
}

fn motor(f: Fields<'_>) -> Result<(Pmsm, f64), AxisFileError> {
    use Valid::{NotNegative, Positive};
    let torque_constant = f.quantity("torque_constant", &TORQUE_CONSTANT, Positive)?;
    let pole_pairs = f.count("pole_pairs", 1, 100)?;
    let parameters = MotorParameters {
        pole_pairs,
        resistance: f.quantity("resistance", &RESISTANCE, NotNegative)?,
        inductance_d: f.quantity("inductance_d", &INDUCTANCE, Positive)?,
        inductance_q: f.quantity("inductance_q", &INDUCTANCE, Positive)?,
        // K_t = 1.5 p ψ at i_d = 0.
        flux_linkage: torque_constant / (1.5 * f64::from(pole_pairs)),
    };
    let motor = Pmsm::new(parameters)
        .map_err(|e| f.refuse_table(e.to_string(), "other motor parameters"))?;
    f.finish()?;
    Ok((motor, torque_constant))
}

/// The cascade with its velocity feed-forward, and the control period.
fn servo(f: Fields<'_>, inverter: Fields<'_>) -> Result<((Servo, f64), f64), AxisFileError> {
    use Valid::{Finite, NotNegative, Positive};
    let gains = ServoGains {
        position: f.quantity("position_gain", &POSITION_GAIN, NotNegative)?,
        speed_p: f.quantity("speed_proportional", &SPEED_PROPORTIONAL, NotNegative)?,
        speed_i: f.quantity("speed_integral", &SPEED_INTEGRAL, NotNegative)?,
        d_p: f.quantity("current_d_proportional", &CURRENT_PROPORTIONAL, NotNegative)?,
        d_i: f.quantity("current_d_integral", &CURRENT_INTEGRAL, NotNegative)?,
        q_p: f.quantity("current_q_proportional", &CURRENT_PROPORTIONAL, NotNegative)?,
        q_i: f.quantity("current_q_integral", &CURRENT_INTEGRAL, NotNegative)?,
    };
    let dc_link = inverter.quantity("dc_link", &VOLTAGE, Positive)?;
    inverter.finish()?;
    let limits = ServoLimits {
        current: f.quantity("current_limit", &CURRENT, Positive)?,
        // The largest circle that SVPWM reaches linearly.
        voltage: dc_link / 3f64.sqrt(),
    };
    let feedforward = f.number("velocity_feedforward", Finite)?;
    let period = 1.0 / f.quantity("frequency", &FREQUENCY, Positive)?;
    let servo = Servo::new(gains, limits, period)
        .map_err(|e| f.refuse_table(e.to_string(), "other control parameters"))?;
    f.finish()?;
    Ok(((servo, feedforward), period))
}

fn stroke(f: Fields<'_>, screw_length: f64) -> Result<Stroke, AxisFileError> {
    let stroke = Stroke {
        minimum: f.quantity("minimum", &LENGTH, Valid::NotNegative)?,
        maximum: f.quantity("maximum", &LENGTH, Valid::Positive)?,
        start: f.quantity("start", &LENGTH, Valid::NotNegative)?,
    };
    if !(stroke.minimum < stroke.maximum && stroke.maximum <= screw_length) {
        let what = format!(
            "reaches from {} m to {} m on a screw of {screw_length} m",
            stroke.minimum, stroke.maximum
        );
        return Err(f.refuse_table(what, "minimum < maximum <= the screw's length"));
    }
    if !(stroke.minimum..=stroke.maximum).contains(&stroke.start) {
        let what = format!(
            "starts at {} m, outside {} m to {} m",
            stroke.start, stroke.minimum, stroke.maximum
        );
        return Err(f.refuse_table(what, "a start inside the stroke"));
    }
    f.finish()?;
    Ok(stroke)
}

fn sample_ranges(f: Fields<'_>, screw_length: f64) -> Result<SampleRanges, AxisFileError> {
    let range = |name: &str, dimension: &Dimension| {
        let least = f.quantity(&format!("{name}_min"), dimension, Valid::Finite)?;
        let most = f.quantity(&format!("{name}_max"), dimension, Valid::Finite)?;
        if least < most {
            return Ok(Range { least, most });
        }
        let what = format!("has {name}_min = {least}, not below {name}_max = {most} (SI)");
        Err(f.refuse_table(what, "a minimum below the maximum"))
    };
    let ranges = SampleRanges {
        position: range("position", &LENGTH)?,
        speed: range("speed", &SPEED)?,
        acceleration: range("acceleration", &ACCELERATION)?,
        current: range("current", &CURRENT)?,
    };
    if ranges.position.least < 0.0 || ranges.position.most > screw_length {
        let what = "asks for positions off the screw".to_owned();
        return Err(f.refuse_table(what, "positions from 0 to the screw's length"));
    }
    f.finish()?;
    Ok(ranges)
}

fn simulation(f: Fields<'_>) -> Result<(Simulation, NutCoupling), AxisFileError> {
    let coupling = f.word(
        "nut_coupling",
        &[
            ("shape-functions", NutCoupling::ShapeFunctions),
            ("moving-node", NutCoupling::MovingNode),
        ],
    )?;
    let step = f.quantity("step", &TIME, Valid::Positive)?;
    f.finish()?;
    Ok((Simulation { step }, coupling))
}

fn experiment(f: Option<Fields<'_>>) -> Result<Option<Experiment>, AxisFileError> {
    let Some(f) = f else {
        return Ok(None);
    };
    let experiment = Experiment {
        machine: PathBuf::from(f.text("machine")?),
        paper_tables: f.optional_text("paper_tables")?.map(PathBuf::from),
    };
    f.finish()?;
    Ok(Some(experiment))
}

fn trajectories(root: &Fields<'_>, stroke: &Stroke) -> Result<Vec<MoveSpec>, AxisFileError> {
    // A move to the very end of the stroke may pass it by a rounding error.
    let slack = 1e-12 * stroke.maximum;
    let one = |f: Fields<'_>| {
        let displacement = f.quantity("displacement", &LENGTH, Valid::Finite)?;
        let end = stroke.start + displacement;
        if !(stroke.minimum - slack..=stroke.maximum + slack).contains(&end) {
            let what = format!("ends at {end} m, outside the stroke");
            let valid = format!("an end from {} m to {} m", stroke.minimum, stroke.maximum);
            return Err(f.refuse_table(what, &valid));
        }
        let limits = Limits::new(
            f.quantity("speed", &SPEED, Valid::Positive)?,
            f.quantity("acceleration", &ACCELERATION, Valid::Positive)?,
            f.quantity("jerk", &JERK, Valid::Positive)?,
        )
        .map_err(|e| f.refuse_table(e.to_string(), "other limits"))?;
        f.finish()?;
        Ok(MoveSpec {
            displacement,
            limits,
        })
    };
    root.tables("trajectory")?.into_iter().map(one).collect()
}
