//! `plan`: offsets of position and torque from the motion that is known ahead.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use compensator::{
    Compensator, Correction, DriveModel, Plan, PlanSettings, Planned, Reference, Sample, Target,
};

use super::{Build, NextMove, ReportTable, Strategy, StrategyKind};
use crate::PipelineError;
use crate::heat::HeatAhead;

pub(super) static KIND: StrategyKind = StrategyKind {
    name: "plan",
    label: "plan",
    heading: "Plan",
    summary: "inertia, friction and wind-up along the motion ahead, the current loop inverted",
    table: ReportTable::More,
    needs: &[],
    build: Build::Carrying(|predictors| {
        Ok(Box::new(Planning {
            model: predictors.assumed_model()?,
            left: Left::default(),
            heat: None,
        }))
    }),
};

struct Planning {
    model: DriveModel,
    left: Left,
    heat: Option<Arc<HeatAhead>>,
}

impl Strategy for Planning {
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        let plan = plan(&self.model, next, &self.left, self.heat.clone())?;
        Ok(Box::new(self.left.watching(plan, |plan| plan.planned())))
    }

    fn warmed(&mut self, heat: Option<Arc<HeatAhead>>) {
        self.heat = heat;
    }
}

/// Friction that the plan of the last move has left the load with, N; no number before the
/// first.
#[derive(Clone, Debug)]
pub(super) struct Left(Arc<AtomicU64>);

impl Default for Left {
    fn default() -> Self {
        Self(Arc::new(AtomicU64::new(f64::NAN.to_bits())))
    }
}

impl Left {
    fn friction(&self) -> Option<f64> {
        let left = f64::from_bits(self.0.load(Ordering::Relaxed));
        left.is_finite().then_some(left)
    }

    /// A law whose plan is kept in mind.
    pub fn watching<C: Compensator>(
        &self,
        law: C,
        planned: fn(&C) -> &Planned,
    ) -> impl Compensator + use<C> {
        Watching {
            law,
            planned,
            left: self.clone(),
        }
    }
}

struct Watching<C> {
    law: C,
    planned: fn(&C) -> &Planned,
    left: Left,
}

impl<C: Compensator> Compensator for Watching<C> {
    fn reset(&mut self) {
        self.law.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let correction = self.law.correct(sample);
        let friction = (self.planned)(&self.law).friction;
        self.left.0.store(friction.to_bits(), Ordering::Relaxed);
        correction
    }

    fn surprise(&self) -> f64 {
        self.law.surprise()
    }
}

/// The plan of a move; `heat` says how the axis grows along it, and how its friction falls.
pub(super) fn plan(
    model: &DriveModel,
    next: &NextMove,
    left: &Left,
    heat: Option<Arc<HeatAhead>>,
) -> Result<Plan<impl FnMut(usize) -> Target + use<>>, PipelineError> {
    let (motion, learned) = (next.motion.clone(), next.learned.clone());
    let period = model.period;
    let target = move |cycle: usize| {
        let time = cycle as f64 * period;
        let at = motion.at(time);
        let reference = Reference {
            position: at.position,
            velocity: at.velocity,
            acceleration: at.acceleration,
        };
        let shift = learned
            .as_ref()
            .map_or_else(Reference::default, |l| l.at(cycle));
        let target = Target {
            reference,
            shift,
            ..Target::default()
        };
        match &heat {
            None => target,
            Some(heat) => heat.on(time, target),
        }
    };
    let plan = Plan::new(model, &PlanSettings::default(), target)?;
    let Some(before) = &next.continued else {
        return Ok(plan);
    };
    let plan = plan.after(&before.own).homed(before.homed);
    Ok(match left.friction() {
        Some(friction) => plan.held(friction),
        None => plan,
    })
}
