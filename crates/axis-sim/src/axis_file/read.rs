//! An axis from the tables of its file.

use std::path::PathBuf;

use trajectories::{Limits, Motion, SCurve};

use super::error::AxisFileError;
use super::extras::{self, check_step};
use super::fields::Fields;
use super::keys::{effort_names, keys};
use super::layout::{Layout, Section, kind_of, kinds_key};
use super::registry::Registry;
use crate::SixDigits;
use crate::actuator::{Actuator, Effort};
use crate::axis::{
    Axis, Experiment, FOLLOWING_ERROR_LIMIT, LoadSensor, MoveSpec, SampleRanges, Sensors,
    Simulation, Stroke, Tolerances,
};
use crate::closed_loop::ClosedLoop;
use crate::control::{Control, absent, gain_fits, gain_turns};
use crate::friction::{Friction, FrictionPlace};
use crate::load::Load;
use crate::mechanism::{Freedom, Mechanism, SolutionMethod};
use crate::part::{Key, Part, PartKind, Values};
use crate::rating::DataSheets;
use crate::sensor::Sensor;
use crate::value_range::ValueRange;
use crate::work::{MOST_STEPS, cycles_of, substeps_of};

/// Tracking error at which a run is given up where a file of an axis that turns does
/// not say, rad.
const FOLLOWING_ANGLE_LIMIT: f64 = 0.1;

/// Control period of an axis without control, s: what asks for one has nothing better.
const PERIOD: f64 = 1e-3;

/// Step of an exact method at which a whole file runs, s.
const EXACT_STEP: f64 = 1e-5;

/// What the rest of a file depends on, read first.
struct First<'a> {
    layout: Layout,
    /// With the keys that such a file may have.
    root: Fields<'a>,
    mechanism: Part<dyn Mechanism>,
    actuator: Part<dyn Actuator>,
}

fn first<'a>(root: Fields<'a>, registry: &Registry) -> Result<First<'a>, AxisFileError> {
    let layout = Layout::of(&root, registry)?;
    // A mistyped table is named before what it would have held is missed; what is in the
    // tables depends on how the load moves and on what the actuator takes.
    let root = root.with_keys(keys(&layout, Freedom::Linear, Effort::Current))?;
    let mechanism = part(&root, &layout, Section::Mechanism, layout.mechanism)?;
    let actuator = part(&root, &layout, Section::Actuator, layout.actuator)?;
    let root = root.with_keys(keys(&layout, mechanism.freedom(), actuator.effort()))?;
    Ok(First {
        layout,
        root,
        mechanism,
        actuator,
    })
}

/// All keys that a file with these parts may have.
pub(super) fn keys_of(root: Fields<'_>, registry: &Registry) -> Result<Vec<Key>, AxisFileError> {
    let first = first(root, registry)?;
    let (freedom, effort) = (first.mechanism.freedom(), first.actuator.effort());
    Ok(keys(&first.layout, freedom, effort))
}

pub(super) fn axis(root: Fields<'_>, registry: &Registry) -> Result<Axis, AxisFileError> {
    let First {
        layout,
        root,
        mechanism,
        actuator,
    } = first(root, registry)?;
    let freedom = mechanism.freedom();
    root.count("schema")?;
    let friction = part(&root, &layout, Section::Friction, layout.friction)?;
    check_friction(&root, registry, &friction, &mechanism)?;
    let control = part(&root, &layout, Section::Control, layout.control)?;
    let has_control = !std::ptr::eq(layout.control, &absent::KIND);
    // Where there is none, no message is about it.
    let control_table = root.table(if has_control { "control" } else { "actuator" })?;
    check_effort(&control_table, &control, &actuator)?;
    check_gains(&control_table, &control, actuator.effort(), &*mechanism)?;
    let period = match has_control {
        true => 1.0 / control_table.number("frequency")?,
        false => PERIOD,
    };
    // What is not simulated needs no step.
    let simulation = match has_control || root.has("simulation") {
        true => simulation(&root, mechanism.exact_step().is_some())?,
        false => Simulation {
            step: PERIOD,
            method: SolutionMethod::Fast,
        },
    };
    if root.has("simulation") {
        check_step(&root.table("simulation")?, period, simulation.step)?;
    }
    let stroke = extras::stroke(&root.table("stroke")?, mechanism.reach(), freedom)?;
    let control_estimated =
        has_control && control_table.has("gains") && control_table.word("gains")? == "estimated";
    let pace = Pace {
        period,
        steps: substeps_of(period, simulation.step),
    };
    let mut axis = Axis {
        name: root.text("name")?.to_owned(),
        description: root.optional_text("description")?.unwrap_or("").to_owned(),
        loads: loads(&root, registry)?,
        sensors: sensors(&root, registry, freedom)?,
        samples: None,
        trajectories: trajectories(&root, &stroke, &pace, freedom)?,
        fastest: None,
        experiment: experiment(root.optional_table("experiment")?)?,
        effects: Vec::new(),
        tolerances: Tolerances::all(0.01),
        log: extras::log(&root)?,
        balance: extras::balance(&root)?,
        rating: DataSheets::default(),
        thermal: extras::thermal(&root, mechanism.screw().is_some())?,
        fingerprint: String::new(),
        mechanism,
        actuator,
        control,
        control_estimated,
        friction,
        period,
        following_error_limit: following_error_limit(&root, freedom)?,
        simulation,
        stroke,
    };
    axis.samples = match root.optional_table("samples")? {
        Some(f) => Some(sample_ranges(&f, &axis)?),
        None => implied_ranges(&axis),
    };
    axis.tolerances = extras::tolerances(&root, &axis.may_be_known())?;
    fits(&root, &control_table, &axis)?;
    axis.effects = extras::effects(&root, &axis, &registry.effects)?;
    if let Some(thermal) = root.optional_table("thermal")? {
        axis.thermal_model()
            .map_err(|e| thermal.refuse_table(e.to_string(), "other values"))?;
    }
    axis.rating = extras::rating(&root, &axis)?;
    extras::check_rating(&root, &axis)?;
    Ok(axis)
}

/// Tracking error at which a run is given up.
fn following_error_limit(root: &Fields<'_>, freedom: Freedom) -> Result<f64, AxisFileError> {
    let limit = match root.optional_table("control")? {
        Some(control) => control.optional_number("following_error_limit")?,
        None => None,
    };
    Ok(limit.unwrap_or(match freedom {
        Freedom::Linear => FOLLOWING_ERROR_LIMIT,
        Freedom::Rotary => FOLLOWING_ANGLE_LIMIT,
    }))
}

/// A friction per m or per rad of the load is of a load that moves like that.
fn check_friction(
    root: &Fields<'_>,
    registry: &Registry,
    friction: &Part<Friction>,
    mechanism: &Part<dyn Mechanism>,
) -> Result<(), AxisFileError> {
    let freedom = mechanism.freedom();
    if let FrictionPlace::Load(of) = friction.at
        && of != freedom
    {
        let what = format!(
            "is of kind \"{}\", per {}, and the load of the mechanism \"{}\" moves in {}",
            friction.kind().name,
            of.unit(),
            mechanism.kind().name,
            freedom.unit()
        );
        let fits = names(&registry.frictions, |friction| match friction.at {
            FrictionPlace::Motor => true,
            FrictionPlace::Load(of) => of == freedom,
        });
        return Err(root.table("friction")?.refuse_table(what, &fits));
    }
    Ok(())
}

/// A controller whose gains end in a command is of an actuator that takes it.
fn check_effort(
    table: &Fields<'_>,
    control: &Part<dyn Control>,
    actuator: &Part<dyn Actuator>,
) -> Result<(), AxisFileError> {
    if let Some(effort) = control.effort()
        && effort != actuator.effort()
    {
        let what = format!(
            "has gains that end in a command in {}, but the actuator \"{}\" takes one in {}",
            effort.unit(),
            actuator.kind().name,
            actuator.effort().unit()
        );
        let valid = format!("gains in units of {}", actuator.effort().unit());
        return Err(table.refuse_table(what, &valid));
    }
    Ok(())
}

/// Every gain ends in the actuator's command, per m or per rad as what it acts on moves.
fn check_gains(
    table: &Fields<'_>,
    control: &Part<dyn Control>,
    effort: Effort,
    mechanism: &dyn Mechanism,
) -> Result<(), AxisFileError> {
    for key in control.kind().keys {
        let given = control.values().unit(key.name);
        let turns = gain_turns(&**control, key.name, mechanism);
        let fits = |unit: &str| gain_fits(unit, turns, effort);
        if fits(given) {
            continue;
        }
        let prefix = format!("{}_", key.name);
        let spellings = key.spellings();
        let valid = spellings
            .iter()
            .filter(|s| s.strip_prefix(&prefix).is_some_and(fits));
        let valid: Vec<&str> = valid.map(String::as_str).collect();
        let valid = match valid.as_slice() {
            [] => "this gain under a key of another unit".to_owned(),
            valid => valid.join(", "),
        };
        let moves = if turns { "turns" } else { "moves along a line" };
        let what = format!(
            "is in {given}, for an actuator that takes {} and what {moves}",
            effort.unit()
        );
        return Err(table.refuse_value(&format!("{prefix}{given}"), what, valid));
    }
    Ok(())
}

/// A part from its section; the control that is absent has none.
fn part<P: ?Sized>(
    root: &Fields<'_>,
    layout: &Layout,
    section: Section,
    kind: &'static PartKind<P>,
) -> Result<Part<P>, AxisFileError> {
    let mut values = Values::default();
    let table = root.optional_table(section.name())?;
    if let Some(table) = &table {
        table.part(layout.keys(section), &mut values)?;
    }
    Part::new(kind, values).map_err(|error| table.as_ref().unwrap_or(root).refuse_part(&error))
}

/// A part in a table of its own, which names its kind.
fn own_part<P: ?Sized>(
    table: Fields<'_>,
    kinds: &[&'static PartKind<P>],
) -> Result<Part<P>, AxisFileError> {
    let mut values = Values::default();
    let kind = kind_of(&table.with_kind(kinds_key(kinds)), kinds)?;
    let mut keys = kind.keys.to_vec();
    keys.push(kinds_key(kinds));
    let table = table.with_keys(keys)?;
    table.part(kind.keys, &mut values)?;
    Part::new(kind, values).map_err(|error| table.refuse_part(&error))
}

/// Names of the kinds whose parts would fit; a kind of which that is not to be seen
/// counts as one.
fn names<P: ?Sized>(kinds: &[&'static PartKind<P>], fits: impl Fn(&P) -> bool) -> String {
    let fitting = kinds
        .iter()
        .filter(|kind| kind.example().is_none_or(|part| fits(&part)));
    let names: Vec<&str> = fitting.map(|kind| kind.name).collect();
    names.join(", ")
}

fn loads(root: &Fields<'_>, registry: &Registry) -> Result<Vec<Part<dyn Load>>, AxisFileError> {
    let tables = root.unchecked("load", vec![kinds_key(&registry.loads)])?;
    let one = |table: Fields<'_>| own_part(table, &registry.loads);
    tables.into_iter().map(one).collect()
}

/// `[sensors]`; without it they are perfect.
fn sensors(
    root: &Fields<'_>,
    registry: &Registry,
    freedom: Freedom,
) -> Result<Sensors, AxisFileError> {
    let Some(table) = root.optional_table("sensors")? else {
        return Ok(Sensors::default());
    };
    let sensor = |name: &str, of: Freedom| -> Result<Option<Part<dyn Sensor>>, AxisFileError> {
        if !table.has(name) {
            return Ok(None);
        }
        let section = || table.peek(name, vec![kinds_key(&registry.sensors)]);
        let part = own_part(section()?, &registry.sensors)?;
        if part.freedom() == of {
            return Ok(Some(part));
        }
        let what = format!(
            "is \"{}\", a sensor in {}, but the position is in {}",
            part.kind().name,
            part.freedom().unit(),
            of.unit()
        );
        let fits = names(&registry.sensors, |sensor| sensor.freedom() == of);
        Err(section()?.refuse_value("kind", what, fits))
    };
    Ok(Sensors {
        load: sensor("load", freedom)?.map_or(LoadSensor::Missing, LoadSensor::Fitted),
        motor: sensor("motor", Freedom::Rotary)?,
    })
}

/// Whether the parts make a loop at all, and the sensors are where they can be.
fn fits(root: &Fields<'_>, control: &Fields<'_>, axis: &Axis) -> Result<(), AxisFileError> {
    if axis.sensors.motor.is_some() && !axis.mechanism.has_motor_encoder() {
        let what = format!(
            "has a motor of its own, but the mechanism \"{}\" moves as one with it",
            axis.mechanism.kind().name
        );
        let valid = "[sensors.load] alone";
        return Err(root.table("sensors")?.refuse_table(what, valid));
    }
    if !axis.has_control() {
        let started = axis.actuator.start(&axis.surroundings());
        return started.map(|_| ()).map_err(|e| control.refuse_part(&e));
    }
    ClosedLoop::new(axis).map_err(|error| match error {
        crate::SetupError::Part(error) => control.refuse_part(&error),
        error => control.refuse_table(error.to_string(), "other parameters"),
    })?;
    Ok(())
}

fn sample_ranges(f: &Fields<'_>, axis: &Axis) -> Result<SampleRanges, AxisFileError> {
    let range = |[low, high]: [&str; 2]| {
        let (least, most) = (f.number(low)?, f.number(high)?);
        if least < most {
            return Ok(ValueRange { least, most });
        }
        let (a, b) = (SixDigits(least), SixDigits(most));
        let what = format!("has {low} = {a}, not below {high} = {b} (SI)");
        Err(f.refuse_table(what, "a minimum below the maximum"))
    };
    let ranges = SampleRanges {
        position: range(["position_min", "position_max"])?,
        speed: range(["speed_min", "speed_max"])?,
        acceleration: range(["acceleration_min", "acceleration_max"])?,
        effort: range(effort_names(axis.actuator.effort()))?,
    };
    let inside = |reach: ValueRange| {
        reach.contains(ranges.position.least) && reach.contains(ranges.position.most)
    };
    if let Some(reach) = axis.mechanism.reach()
        && !inside(reach)
    {
        let what = "asks for positions that the mechanism does not reach".to_owned();
        let (least, most) = (SixDigits(reach.least), SixDigits(reach.most));
        let unit = axis.freedom().unit();
        let valid = format!("positions from {least} {unit} to {most} {unit}");
        return Err(f.refuse_table(what, &valid));
    }
    Ok(ranges)
}

/// Sample ranges of a file that has none: the stroke, and what the trajectories and the
/// actuator reach. None if there are no trajectories.
fn implied_ranges(axis: &Axis) -> Option<SampleRanges> {
    let most = |of: fn(&Limits) -> f64| {
        let all = axis.trajectories.iter().map(|t| of(&t.limits));
        all.fold(0.0, f64::max)
    };
    let both_ways = |most: f64| ValueRange { least: -most, most };
    let (speed, acceleration) = (most(Limits::velocity), most(Limits::acceleration));
    (speed > 0.0).then(|| SampleRanges {
        position: ValueRange {
            least: axis.stroke.minimum,
            most: axis.stroke.maximum,
        },
        speed: both_ways(1.5 * speed),
        acceleration: both_ways(2.0 * acceleration),
        effort: both_ways(axis.actuator.limit()),
    })
}

fn simulation(root: &Fields<'_>, has_exact: bool) -> Result<Simulation, AxisFileError> {
    let f = root.table("simulation")?;
    let method = match f.has("method") && f.word("method")? == "exact" {
        true => SolutionMethod::Exact,
        false => SolutionMethod::Fast,
    };
    let asked = f.number("step")?;
    let step = match (method, has_exact) {
        (SolutionMethod::Exact, true) => asked.min(EXACT_STEP),
        _ => asked,
    };
    Ok(Simulation { step, method })
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
    freedom: Freedom,
) -> Result<Vec<MoveSpec>, AxisFileError> {
    let unit = freedom.unit();
    // A move to the very end of the stroke may pass it by a rounding error.
    let slack = 1e-12 * stroke.maximum.abs().max(stroke.minimum.abs());
    let one = |f: Fields<'_>| {
        let displacement = f.number("displacement")?;
        let end = stroke.start + displacement;
        if !(stroke.minimum - slack..=stroke.maximum + slack).contains(&end) {
            let what = format!("ends at {} {unit}, outside the stroke", SixDigits(end));
            let (least, most) = (SixDigits(stroke.minimum), SixDigits(stroke.maximum));
            let valid = format!("an end from {least} {unit} to {most} {unit}");
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
