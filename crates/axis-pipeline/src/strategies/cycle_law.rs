//! Strategies that run cycle by cycle, as parts that can be copied: what a controller, or a drive
//! inside another simulator, runs.
//!
//! A plan that runs so knows no motion ahead: it is shown each set point when it comes, and the axis
//! follows it [`CycleLaw::look_ahead`] cycles later.

use compensator::{
    Combined, Compensator, Correction, Feedback, FrictionFeedforward, PlanSettings, Planned,
    Planner, Reference, Sample, Standstill, Target, TransferFunction,
};

use super::{NetworkStrategy, Predictors, assumed_feedback};
use crate::PipelineError;

/// A strategy that runs cycle by cycle. A copy is its state.
#[derive(Clone, Debug)]
pub struct CycleLaw {
    /// What is added to the position.
    pub position: PositionLaw,
    /// What is added to the command.
    pub friction: Option<FrictionFeedforward>,
    /// A plan of the motion ahead, which stands alone.
    pub plan: Option<StreamedPlan>,
}

/// The error of the position that is predicted for the end of a cycle.
#[derive(Clone, Debug)]
pub enum PositionLaw {
    /// None.
    Nothing,
    /// By the one-cycle network.
    Network(Box<NetworkStrategy>),
    /// By a linear model of the error.
    Transfer(Box<TransferFunction>),
}

/// A plan of set points that come one by one, and where there is one the feedback around it.
#[derive(Clone, Debug)]
pub struct StreamedPlan {
    /// The planner.
    pub planner: Box<Planner>,
    /// The feedback.
    pub feedback: Option<Box<Feedback>>,
    /// Whether a motion has begun.
    has_begun: bool,
    planned: Planned,
}

impl CycleLaw {
    /// The strategy `name` (`_` between its words) made of `predictors`, at the start of a motion.
    ///
    /// # Errors
    /// [`PipelineError::NotByCycle`] names those that there are; others if the predictors lack what
    /// it needs, or the axis has no such strategy.
    pub fn of(predictors: &Predictors, name: &str) -> Result<Self, PipelineError> {
        let network = || -> Result<_, PipelineError> {
            Ok(PositionLaw::Network(Box::new(predictors.network()?)))
        };
        let filter = |model| -> Result<_, PipelineError> {
            Ok(PositionLaw::Transfer(Box::new(predictors.leading(model)?)))
        };
        let friction = || predictors.friction(predictors.identified()?);
        let printed = || predictors.friction(predictors.axis.friction.law);
        let nothing = PositionLaw::Nothing;
        let (position, friction, plan) = match name {
            "network" => (network()?, None, None),
            "network_lugre" => (network()?, Some(friction()?), None),
            "network_lugre_printed" => (network()?, Some(printed()?), None),
            "transfer_function" => (filter(predictors.transfer()?.alone)?, None, None),
            "transfer_function_lugre" => {
                let model = predictors.transfer()?.with_feedforward;
                (filter(model)?, Some(friction()?), None)
            }
            "lugre" => (nothing, Some(friction()?), None),
            "plan" => (nothing, None, Some(StreamedPlan::of(predictors, None)?)),
            "feedback" => {
                let feedback = Some(assumed_feedback(predictors)?);
                (nothing, None, Some(StreamedPlan::of(predictors, feedback)?))
            }
            _ => return Err(PipelineError::NotByCycle(name.to_owned())),
        };
        Ok(Self {
            position,
            friction,
            plan,
        })
    }

    /// Cycles by which the axis follows a set point after it has come.
    pub fn look_ahead(&self) -> usize {
        match (&self.plan, &self.position) {
            (Some(plan), _) => plan.planner.look_ahead(),
            (None, PositionLaw::Nothing) => 0,
            // The next reference, in a sample.
            (None, PositionLaw::Network(_) | PositionLaw::Transfer(_)) => 1,
        }
    }

    /// Forgets everything; the next sample is the first of a motion from rest.
    pub fn reset(&mut self) {
        match &mut self.position {
            PositionLaw::Nothing => {}
            PositionLaw::Network(law) => law.reset(),
            PositionLaw::Transfer(law) => law.reset(),
        }
        if let Some(friction) = &mut self.friction {
            friction.reset();
        }
        if let Some(plan) = &mut self.plan {
            plan.reset();
        }
    }

    /// The correction of the cycle that begins with `sample`; `newest` is the set point of
    /// [`CycleLaw::look_ahead`] cycles later.
    pub fn correct(&mut self, sample: &Sample, newest: &Reference) -> Correction {
        if let Some(plan) = &mut self.plan {
            return plan.correct(sample, newest);
        }
        match (&mut self.position, &mut self.friction) {
            (PositionLaw::Nothing, None) => Correction::default(),
            (PositionLaw::Nothing, Some(friction)) => friction.correct(sample),
            (PositionLaw::Network(law), friction) => sum(&mut **law, friction, sample),
            (PositionLaw::Transfer(law), friction) => sum(&mut **law, friction, sample),
        }
    }
}

/// The corrections of one law and of friction.
fn sum(
    law: &mut impl Compensator,
    friction: &mut Option<FrictionFeedforward>,
    sample: &Sample,
) -> Correction {
    match friction {
        None => law.correct(sample),
        Some(friction) => Combined::new(Borrowed(law), Borrowed(friction)).correct(sample),
    }
}

/// A law of somebody else.
struct Borrowed<'a, C>(&'a mut C);

impl<C: Compensator> Compensator for Borrowed<'_, C> {
    fn reset(&mut self) {
        self.0.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.0.correct(sample)
    }
}

impl StreamedPlan {
    fn of(predictors: &Predictors, feedback: Option<Feedback>) -> Result<Self, PipelineError> {
        let model = predictors.assumed_model()?;
        Ok(Self {
            planner: Box::new(Planner::new(&model, &PlanSettings::default())?),
            feedback: feedback.map(Box::new),
            has_begun: false,
            planned: Planned::default(),
        })
    }

    fn reset(&mut self) {
        self.has_begun = false;
        if let Some(feedback) = &mut self.feedback {
            feedback.reset();
        }
    }

    /// As [`compensator::Plan::advance`] on a motion that begins with as many cycles at rest as the
    /// plan looks ahead.
    fn correct(&mut self, sample: &Sample, newest: &Reference) -> Correction {
        if !self.has_begun {
            let position = sample.reference.position;
            let standstill = Standstill {
                effort: sample.last_command,
                motor_angle: sample.motor_angle,
                ..Standstill::default()
            };
            self.planner.begin(position, &standstill);
            let rest = Target::of(Reference {
                position,
                ..Reference::default()
            });
            for _ in 0..self.planner.look_ahead() {
                self.planner.push(rest);
            }
            self.has_begun = true;
        }
        if let Some(planned) = self.planner.push(Target::of(*newest)) {
            self.planned = planned;
        }
        match &mut self.feedback {
            Some(feedback) => feedback.correct(sample, &self.planned),
            None => self.planned.correction,
        }
    }
}
