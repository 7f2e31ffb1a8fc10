//! A strategy with everything that its export needs.

use axis_pipeline::strategies::{Predictors, assumed_feedback};
use axis_sim::Axis;
use compensator::{Guard, GuardLimits, Kinematics};

use crate::law::{ExportedLaw, NetworkLaw, PlanLaw, Position};
use crate::{ExportError, c};

/// Names of the strategies that can be exported.
pub const EXPORTED: &[&str] = &[
    "network",
    "network_lugre",
    "network_lugre_printed",
    "transfer_function",
    "transfer_function_lugre",
    "lugre",
    "plan",
    "feedback",
];

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
        c::check_name(name)?;
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
    let network = || -> Result<_, ExportError> {
        Ok(Position::Network(NetworkLaw::of(&predictors.network()?)?))
    };
    let filter = |model| -> Result<_, ExportError> {
        Ok(Position::Transfer(Box::new(predictors.leading(model)?)))
    };
    let friction = || predictors.friction(predictors.identified()?);
    let printed = || predictors.friction(predictors.axis.friction.law);
    let (position, friction) = match name {
        "network" => (network()?, None),
        "network_lugre" => (network()?, Some(friction()?)),
        "network_lugre_printed" => (network()?, Some(printed()?)),
        "transfer_function" => (filter(predictors.transfer()?.alone)?, None),
        "transfer_function_lugre" => {
            let model = predictors.transfer()?.with_feedforward;
            (filter(model)?, Some(friction()?))
        }
        "lugre" => (Position::Nothing, Some(friction()?)),
        "plan" | "feedback" => return planned(predictors, name),
        _ => return Err(refused(name)),
    };
    Ok(ExportedLaw {
        position,
        friction,
        plan: None,
    })
}

/// The plan of the model, with the feedback around it or without.
fn planned(predictors: &Predictors, name: &str) -> Result<ExportedLaw, ExportError> {
    let assumed_model = predictors.assumed_model()?;
    if assumed_model.kinematics != Kinematics::default() {
        return Err(ExportError::Unsupported {
            name: name.to_owned(),
            what: "its model has free travel or a kinematic error of the transmission",
            valid: "a model without them, or another strategy".to_owned(),
        });
    }
    let feedback = match name {
        "feedback" => Some(assumed_feedback(predictors)?),
        _ => None,
    };
    Ok(ExportedLaw {
        position: Position::Nothing,
        friction: None,
        plan: Some(PlanLaw::new(&assumed_model, feedback)?),
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
