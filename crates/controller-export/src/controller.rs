//! A strategy with everything that its export needs.

use axis_pipeline::strategies::{CYCLE_BY_CYCLE, CycleLaw, PositionLaw, Predictors};
use axis_sim::Axis;
use compensator::{Guard, GuardLimits, Kinematics};

use crate::ExportError;
use crate::law::{ExportedLaw, NetworkLaw, PlanLaw, Position};
use crate::name::check_name;

/// Names of the strategies that can be exported.
pub const EXPORTED: &[&str] = CYCLE_BY_CYCLE;

/// Strategies that learn between moves, and what of them runs cycle by cycle.
const LEARNING: &[(&str, &str)] = &[
    ("adaptive", "plan"),
    ("iterative", "plan"),
    ("adaptive_feedback", "feedback"),
    ("learned", "feedback"),
];

/// SI units of an axis, in ASCII.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Units {
    /// Of the load's position: m or rad.
    pub load: String,
    /// Of the actuator's command: A, N m, N or V.
    pub effort: String,
}

/// A compensator to export: the law, its guard, and where it comes from.
#[derive(Clone, Debug)]
pub struct ExportedController {
    /// Name of files, types and functions: that of the strategy, or another one
    /// ([`ExportedController::named`]).
    pub name: String,
    /// Name of the strategy: words in lower case, `_` between them.
    pub strategy: String,
    /// Name of the axis.
    pub axis: String,
    /// The axis in a line.
    pub description: String,
    /// Hash of every value of the axis file.
    pub fingerprint: String,
    /// Its units.
    pub units: Units,
    /// Control period, s.
    pub period: f64,
    /// What is computed.
    pub law: ExportedLaw,
    /// What the guard keeps to.
    pub limits: GuardLimits,
}

impl ExportedController {
    /// The strategy `name` (`-` counts as `_`) made of `predictors`, behind a guard with
    /// `limits`.
    ///
    /// # Errors
    /// [`ExportError::NoStrategy`] and [`ExportError::LearnsBetweenMoves`] name the strategies
    /// that can be exported; others where the predictors lack what it needs, or a limit is not
    /// above 0.
    pub fn of(
        predictors: &Predictors,
        name: &str,
        limits: GuardLimits,
    ) -> Result<Self, ExportError> {
        let name = name.replace('-', "_");
        let law = law(predictors, &name)?;
        let axis = &predictors.axis;
        Ok(Self {
            strategy: name.clone(),
            name,
            axis: axis.name.clone(),
            description: axis.description.clone(),
            fingerprint: axis.fingerprint.clone(),
            units: Units::of(axis),
            period: axis.period,
            law,
            limits: *Guard::new(limits)?.limits(),
        })
    }

    /// The same with another name of files, types and functions, so that several can stand in
    /// one firmware.
    ///
    /// # Errors
    /// [`ExportError::Name`] for one that cannot stand in C.
    pub fn named(self, name: &str) -> Result<Self, ExportError> {
        check_name(name)?;
        Ok(Self {
            name: name.to_owned(),
            ..self
        })
    }
}

impl Units {
    /// Of an axis.
    pub fn of(axis: &Axis) -> Self {
        Self {
            load: axis.freedom().unit().to_owned(),
            effort: axis.actuator.effort().unit().replace('·', " "),
        }
    }
}

fn law(predictors: &Predictors, name: &str) -> Result<ExportedLaw, ExportError> {
    if !EXPORTED.contains(&name) {
        return Err(refused(name));
    }
    if matches!(name, "plan" | "feedback") {
        can_be_planned(predictors, name)?;
    }
    let law = CycleLaw::of(predictors, name)?;
    Ok(ExportedLaw {
        position: match law.position {
            PositionLaw::Nothing => Position::Nothing,
            PositionLaw::Network(network) => Position::Network(NetworkLaw::of(&network)?),
            PositionLaw::Transfer(filter) => Position::Transfer(filter),
        },
        friction: law.friction,
        plan: law.plan.map(|plan| PlanLaw {
            planner: plan.planner,
            feedback: plan.feedback,
        }),
    })
}

/// Whether the exported planner has all that the model asks for.
fn can_be_planned(predictors: &Predictors, name: &str) -> Result<(), ExportError> {
    if predictors.assumed_model()?.kinematics == Kinematics::default() {
        return Ok(());
    }
    Err(ExportError::Unsupported {
        name: name.to_owned(),
        what: "its model has free travel or a kinematic error of the transmission",
        valid: "a model without them, or another strategy".to_owned(),
    })
}

/// Whether the strategy `name` (`-` counts as `_`) is one that a controller can run.
///
/// # Errors
/// [`ExportError::NoStrategy`] and [`ExportError::LearnsBetweenMoves`] name those that are.
pub fn exportable(name: &str) -> Result<(), ExportError> {
    let name = name.replace('-', "_");
    match EXPORTED.contains(&&*name) {
        true => Ok(()),
        false => Err(refused(&name)),
    }
}

fn refused(name: &str) -> ExportError {
    let (name, valid) = (name.to_owned(), EXPORTED.join(", "));
    if name == "drive_terms" {
        return ExportError::ForDrives { name, valid };
    }
    match LEARNING.iter().find(|(learning, _)| *learning == name) {
        Some((_, instead)) => ExportError::LearnsBetweenMoves {
            name,
            instead,
            valid,
        },
        None => ExportError::NoStrategy { name, valid },
    }
}
