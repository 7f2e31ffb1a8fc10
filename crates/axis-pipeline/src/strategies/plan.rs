//! `plan`: offsets of position and torque from the motion that is known ahead.

use compensator::{Compensator, DriveModel, Plan, PlanSettings, Reference, Target};

use super::{Build, NextMove, ReportTable, Strategy, StrategyKind};
use crate::PipelineError;

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "plan",
    label: "plan",
    heading: "Plan",
    summary: "inertia, friction and wind-up along the motion ahead, the current loop inverted",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Planning {
            model: predictors.believed()?,
        }))
    }),
};

struct Planning {
    model: DriveModel,
}

impl Strategy for Planning {
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        Ok(Box::new(plan(&self.model, next)?))
    }
}

/// The plan of a move.
pub(super) fn plan(
    model: &DriveModel,
    next: &NextMove,
) -> Result<Plan<impl FnMut(usize) -> Target + use<>>, PipelineError> {
    let (motion, learned) = (next.motion.clone(), next.learned.clone());
    let period = model.period;
    let target = move |cycle: usize| {
        let at = motion.at(cycle as f64 * period);
        Target {
            reference: Reference {
                position: at.position,
                velocity: at.velocity,
                acceleration: at.acceleration,
            },
            shift: learned
                .as_ref()
                .map_or_else(Reference::default, |l| l.at(cycle)),
            ..Target::default()
        }
    };
    let plan = Plan::new(model, &PlanSettings::default(), target)?;
    Ok(match &next.continued {
        Some(before) => plan.after(&before.own).homed(before.homed),
        None => plan,
    })
}
