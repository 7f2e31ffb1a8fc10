//! What of the correction an ordinary drive or CNC can be given, in its units, and what
//! that loses against the plan. `docs/drive-terms.md` says how it is entered.

use std::f64::consts::{PI, TAU};

use axis_sim::{Axis, PositionErrors};
use compensator::DriveTerms;
use serde::Serialize;

use crate::compensation::{compensate_with, find};
use crate::strategies::{NONE, Predictors, STRATEGIES, StrategyKind, named, reversal_start};
use crate::{Figures, PipelineError};

/// A number that a drive takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Term {
    /// Words in lower case, `_` between them.
    pub name: &'static str,
    /// In its SI unit.
    pub value: f64,
    /// That unit.
    pub unit: String,
    /// The same in a unit that drives use.
    pub drive_value: f64,
    /// That unit.
    pub drive_unit: String,
    /// What it is.
    pub meaning: &'static str,
}

/// A table over the position or over the motor's turn.
#[derive(Clone, Debug, PartialEq)]
pub struct TermTable {
    /// Headings, each ending in its unit.
    pub headings: Vec<String>,
    /// Rows of as many values.
    pub rows: Vec<Vec<f64>>,
}

/// Tracking errors of a trajectory, µm or µrad.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loss {
    /// Number of the trajectory, from 1.
    pub trajectory: usize,
    /// Without compensation.
    pub none: Figures,
    /// With the drive terms.
    pub drive_terms: Figures,
    /// With the full plan.
    pub plan: Figures,
}

/// The terms of an axis as its file has it.
///
/// # Errors
/// [`PipelineError::Compensator`] where no terms can be made from it.
pub fn of_axis(axis: &Axis) -> Result<DriveTerms, PipelineError> {
    let model = Predictors::of(axis).believed()?;
    Ok(DriveTerms::new(&model, &reversal_start(axis))?)
}

/// Units of an axis, and factors from SI to those that drives use.
struct Units {
    load: &'static str,
    inertia: &'static str,
    torque: &'static str,
    angle: &'static str,
    effort: &'static str,
    /// Speed of the load.
    feed: (f64, &'static str),
    /// Speed of the motor.
    speed: (f64, &'static str),
    drive_inertia: (f64, &'static str),
    viscous: (f64, &'static str),
    turn: (f64, &'static str),
}

impl Units {
    fn of(axis: &Axis) -> Self {
        const RPM: f64 = 30.0 / PI;
        let load = axis.freedom().unit();
        let linear = (60e3, "mm/min");
        let feed = if load == "m" { linear } else { (RPM, "rpm") };
        let effort = axis.actuator.effort().unit();
        // A linear motor moves as the load does.
        if load == "m" && !axis.mechanism.has_motor_encoder() {
            return Self {
                load,
                inertia: "kg",
                torque: "N",
                angle: "m",
                effort,
                feed,
                speed: linear,
                drive_inertia: (1.0, "kg"),
                viscous: (1.0 / 60.0, "N/(m/min)"),
                turn: (1.0, "1"),
            };
        }
        Self {
            load,
            inertia: "kg·m²",
            torque: "N·m",
            angle: "rad",
            effort,
            feed,
            speed: (RPM, "rpm"),
            drive_inertia: (1e4, "kg·cm²"),
            viscous: (1e3 / RPM, "N·m/(1000 rpm)"),
            turn: match load {
                "m" => (1e3 * TAU, "mm/rev"),
                _ => (1.0, "rev/rev"),
            },
        }
    }
}

/// Every number, in SI units and in those that drives use. What is no number on this axis
/// (a ratio to an inertia of 0) is left out.
pub fn terms(axis: &Axis, of: &DriveTerms) -> Vec<Term> {
    let u = Units::of(axis);
    let per = |a: &str, b: &str| match b.contains('/') {
        true => format!("{a}/({b})"),
        false => format!("{a}/{b}"),
    };
    let (r, k) = (of.travel, of.torque_constant);
    let [least, most] = of.along.ends();
    let row = of.row(0.5 * (least + most));
    let same = |unit: &str| (1.0, unit.to_owned());
    let scaled = |(factor, unit): (f64, &str)| (factor, unit.to_owned());
    let [acceleration, jerk] = ["s²", "s³"].map(|s| format!("{}/{s}", u.load));
    let speed = format!("{}/s", u.angle);
    let micro = format!("µ{}", u.load);
    let feeding = per(u.effort, &acceleration);
    let share = (100.0, "%".to_owned());
    let ms = (1e3, "ms".to_owned());
    let list: [(&str, f64, String, (f64, String), &str); 24] = [
        (
            "travel_per_radian",
            r,
            per(u.load, u.angle),
            scaled(u.turn),
            "travel of the load per angle of the motor",
        ),
        (
            "torque_constant",
            k,
            per(u.torque, u.effort),
            same(&per(u.torque, u.effort)),
            "torque of the motor per command",
        ),
        (
            "inertia_total",
            of.inertia,
            u.inertia.into(),
            scaled(u.drive_inertia),
            "inertia of all that moves, at the motor, for torque feed-forward",
        ),
        (
            "inertia_rotating",
            of.rotating,
            u.inertia.into(),
            scaled(u.drive_inertia),
            "what of it turns with the motor",
        ),
        (
            "inertia_ratio",
            of.inertia / of.rotating,
            "1".into(),
            same("1"),
            "total inertia over the inertia that turns with the motor",
        ),
        (
            "acceleration_feedforward",
            of.effort_per_acceleration,
            feeding.clone(),
            same(&feeding),
            "command per acceleration of the load, in all",
        ),
        (
            "acceleration_feedforward_to_add",
            of.effort_per_acceleration - of.own_effort_per_acceleration(),
            feeding.clone(),
            same(&feeding),
            "what of it the drive of the axis file does not have yet",
        ),
        (
            "velocity_feedforward",
            of.velocity_feedforward,
            "1".into(),
            share.clone(),
            "share of the reference's speed that is fed forward, in all",
        ),
        (
            "velocity_feedforward_to_add",
            of.velocity_feedforward - of.own_velocity_feedforward(),
            "1".into(),
            share,
            "what of it the drive of the axis file does not have yet",
        ),
        (
            "viscous_friction",
            of.viscous,
            per(u.torque, &speed),
            scaled(u.viscous),
            "friction torque per speed of the motor",
        ),
        (
            "viscous_command",
            of.viscous / (r * k),
            per(u.effort, &format!("{}/s", u.load)),
            (1.0 / u.feed.0, per(u.effort, u.feed.1)),
            "command per speed of the load",
        ),
        (
            "coulomb_friction",
            of.coulomb,
            u.torque.into(),
            same(u.torque),
            "friction torque at any speed, with the sign of the motion",
        ),
        (
            "coulomb_command",
            of.coulomb / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
        (
            "reversal_delay",
            of.pulse.delay,
            "s".into(),
            ms.clone(),
            "time from a change of direction to the new friction level and its pulse",
        ),
        (
            "reversal_pulse",
            of.pulse.amplitude,
            u.torque.into(),
            same(u.torque),
            "height of the torque pulse after a start with relaxed friction; twice this after a reversal",
        ),
        (
            "reversal_pulse_command",
            of.pulse.amplitude / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
        (
            "reversal_decay",
            of.pulse.decay,
            "s".into(),
            ms,
            "time in which the pulse falls to 37 %",
        ),
        (
            "reversal_speed_injection",
            of.speed_injection(),
            speed.clone(),
            (r * u.feed.0, u.feed.1.into()),
            "the same pulse on the speed reference instead, for the drive's speed controller to make the torque of; speed of the motor, and of the load in the drive's unit",
        ),
        (
            "reversal_winding_speed",
            of.winding_speed(),
            speed.clone(),
            scaled(u.speed),
            "pulse of the motor's speed that winds the transmission up as the new level comes, after a start, with the same decay; for a position loop closed at the load",
        ),
        (
            "standing_load",
            of.standing,
            u.torque.into(),
            same(u.torque),
            "torque of the axis' own loads at mid-stroke",
        ),
        (
            "standing_load_command",
            of.standing / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
        (
            "wind_up_per_acceleration",
            row.position_per_acceleration,
            per(u.load, &acceleration),
            (1e6, per(&micro, &acceleration)),
            "offset of the position per acceleration at mid-stroke; for a position loop closed at the motor",
        ),
        (
            "speed_per_jerk",
            row.speed_per_jerk,
            per(&speed, &jerk),
            (u.speed.0, per(u.speed.1, &jerk)),
            "offset of the motor's speed per jerk at mid-stroke; for a position loop closed at the load",
        ),
        (
            "lost_motion",
            row.lost_motion,
            u.load.into(),
            (1e6, micro),
            "way lost to wind-up by friction from one direction to the other, at mid-stroke; for a position loop closed at the motor",
        ),
    ];
    let term = |(name, value, unit, (factor, drive_unit), meaning)| Term {
        name,
        value,
        unit,
        drive_value: factor * value,
        drive_unit,
        meaning,
    };
    let list = list.into_iter().map(term);
    list.filter(|t| t.drive_value.is_finite()).collect()
}

/// The table over the position: wind-up, lost motion, load and inertia at the sections of
/// the model, and the lead error of the axis file's effects.
pub fn over_position(axis: &Axis, of: &DriveTerms, errors: &PositionErrors) -> TermTable {
    let u = Units::of(axis);
    let (l, t, a) = (u.load, u.torque, u.angle);
    let headings = vec![
        format!("position ({l})"),
        format!("lead error ({l})"),
        format!("wind-up per acceleration ({l}/({l}/s²))"),
        format!("motor speed per jerk ({a}/s/({l}/s³))"),
        format!("lost motion ({l})"),
        format!("load ({t})"),
        format!("inertia ({})", u.inertia),
    ];
    let row = |row: compensator::DriveTermsRow| {
        vec![
            row.position,
            errors.lead(row.position),
            row.position_per_acceleration,
            row.speed_per_jerk,
            row.lost_motion,
            row.load,
            row.inertia,
        ]
    };
    TermTable {
        headings,
        rows: of.table().map(row).collect(),
    }
}

/// Angles of the table over a turn.
const IN_TURN: u32 = 128;

/// The table over one turn of the motor: cogging torque, and what of the lead error repeats
/// with the turn. None where the axis file has neither.
pub fn over_turn(axis: &Axis, errors: &PositionErrors) -> Option<TermTable> {
    let u = Units::of(axis);
    let at = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(IN_TURN);
        vec![angle, errors.cogging(angle), errors.lead_in_turn(angle)]
    };
    let rows: Vec<Vec<f64>> = (0..IN_TURN).map(at).collect();
    // A straight lead error leaves nothing in a turn but roundings.
    let shows = |row: &Vec<f64>| row[1] != 0.0 || row[2].abs() > 1e-12;
    rows.iter().any(shows).then(|| TermTable {
        headings: vec![
            format!("motor angle ({})", u.angle),
            format!("cogging ({})", u.torque),
            format!("periodic lead error ({})", u.load),
        ],
        rows,
    })
}

/// Runs the trajectories of `model` on `machine` without compensation, with the drive terms
/// and with the plan, both made from `model`; nothing where it has no trajectories.
///
/// # Errors
/// As [`compensate_with`].
pub fn losses(model: &Axis, machine: &Axis) -> Result<Vec<Loss>, PipelineError> {
    if model.trajectories.is_empty() {
        return Ok(Vec::new());
    }
    let kinds: Vec<&StrategyKind> = ["drive_terms", "plan"]
        .into_iter()
        .filter_map(|name| named(STRATEGIES, name))
        .chain([&NONE])
        .collect();
    let runs = compensate_with(model, machine, &Predictors::of(model), &kinds, || ())?;
    let figures = |id, name| find(&runs, id, name).map(|run| run.figures);
    let loss = |id| {
        Some(Loss {
            trajectory: id,
            none: figures(id, NONE.name)?,
            drive_terms: figures(id, "drive_terms")?,
            plan: figures(id, "plan")?,
        })
    };
    Ok((1..=model.trajectories.len()).filter_map(loss).collect())
}
