//! What plan, feedback, adaptation and learning share: one strategy with options.
//!
//! ```text
//! axis file ─► model ─► plan (+ feedback) ─► move ─► log ─► adaptation, residual, repetition
//!                ▲                                                    │
//!                └────────────────────────────────────────────────────┘
//! ```

use std::sync::Arc;

use axis_sim::Axis;
use compensator::{
    AdaptError, AdaptPrior, Adaptation, Compensator, DriveModel, Feedback, FeedbackDesign,
    FeedbackSettings, LearnedMove, LearningSettings, PlanWithFeedback, ResidualLearner, Sample,
    UnexplainedTorque,
};
use trajectories::Motion;

use super::feedback_helps;
use super::plan::{Left, plan};
use super::{DesignOnce, LearnedValues, NextMove, Predictors, SharedMotion, Strategy};
use crate::heat::HeatAhead;
use crate::residuals::{AnyLearner, AnyResidual};

use crate::{ErrorUnit, NoFeedback, PipelineError};

/// What a strategy adds to the plan.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlanOptions {
    /// State feedback that knows the friction's state.
    pub feedback: bool,
    /// Adaptation of the model's parameters between moves.
    pub adaptation: bool,
    /// Torque over angle and force over position, learned from all moves.
    pub residual: bool,
    /// Iterative learning of a move that is made again.
    pub repetition: bool,
}

/// The plan, and what the options add to it.
pub(super) struct PlanStrategy {
    axis: Axis,
    assumed_model: DriveModel,
    /// The feedback for that.
    first_design: DesignOnce,
    options: PlanOptions,
    adaptation: Option<Adaptation>,
    residual: Option<ResidualModel>,
    /// The feedback, and the model that it was designed for.
    design: Option<(FeedbackDesign, DriveModel)>,
    repeated: Vec<Repeated>,
    /// Which of them runs now.
    now: Option<usize>,
    left: Left,
    heat: Option<Arc<HeatAhead>>,
}

/// Learned forces that no parameter describes, and the parameters adapted together with them.
struct ResidualModel {
    learner: AnyLearner,
    adaptation: Adaptation,
}

/// A move that has been made before.
struct Repeated {
    motion: SharedMotion,
    /// Assumed since its first repetition: what is learned of a move holds beside one
    /// model.
    frozen: Option<(DriveModel, Option<AnyResidual>)>,
    learned: LearnedMove,
}

impl PlanStrategy {
    /// For the axis of the predictors.
    pub fn new(predictors: &Predictors, options: PlanOptions) -> Result<Self, PipelineError> {
        let axis = predictors.axis.clone();
        let assumed_model = predictors.assumed_model()?;
        let adaptation = match options.adaptation {
            true => Some(Adaptation::new(&assumed_model, &AdaptPrior::default())?),
            false => None,
        };
        let stroke = [axis.stroke.minimum, axis.stroke.maximum];
        let level = assumed_model.friction.parameters().coulomb * assumed_model.travel
            / assumed_model.lever;
        let tables =
            || AnyLearner::Tables(ResidualLearner::new(stroke, assumed_model.travel, level));
        let mut strategy = Self {
            axis,
            assumed_model,
            first_design: predictors.design.clone(),
            options,
            adaptation,
            residual: None,
            design: None,
            repeated: Vec::new(),
            now: None,
            left: Left::default(),
            heat: None,
        }
        .with_learner(options.residual.then(tables));
        if options.feedback {
            // Refused before anything is computed.
            strategy.feedback(&assumed_model)?;
        }
        Ok(strategy)
    }

    /// The same with another learner of what no parameter holds.
    pub fn with_learner(mut self, learner: Option<AnyLearner>) -> Self {
        let beside = learner.zip(self.adaptation.clone());
        self.residual = beside.map(|(learner, adaptation)| ResidualModel {
            learner,
            adaptation,
        });
        self
    }

    /// The model after all moves so far: parameters, and what none of them holds.
    fn model(&self) -> (DriveModel, Option<AnyResidual>) {
        let beside = self.residual.as_ref();
        let used = beside.and_then(|b| Some((b.adaptation.model(), Some(b.learner.model()?))));
        let adapted = self.adaptation.as_ref().map(Adaptation::model);
        used.unwrap_or((adapted.unwrap_or(self.assumed_model), None))
    }

    /// The feedback for a model. It is designed anew where the model has left what the margins
    /// of the last design hold for.
    fn feedback(&mut self, model: &DriveModel) -> Result<Feedback, PipelineError> {
        match &self.design {
            Some((design, of)) if near(model, of) => Ok(design.feedback()),
            _ => {
                let design = self.designed(model)?;
                let feedback = design.feedback();
                self.design = Some((design, *model));
                Ok(feedback)
            }
        }
    }

    fn designed(&self, model: &DriveModel) -> Result<FeedbackDesign, PipelineError> {
        let mechanism = self.axis.planned_mechanism()?;
        let stroke = &self.axis.stroke;
        let modes = |share: f64| {
            let x = stroke.minimum + share * (stroke.maximum - stroke.minimum);
            mechanism
                .participation(x)
                .map_err(axis_sim::SetupError::from)
        };
        let [near, middle, far] = [modes(0.05)?, modes(0.5)?, modes(0.95)?];
        let settings = FeedbackSettings {
            speed_by_differences: self.axis.derives_speed(),
            ..FeedbackSettings::default()
        };
        let elsewhere: [&[_]; 2] = [&near, &far];
        let design = || {
            let designed = FeedbackDesign::within_margins(model, &middle, &elsewhere, &settings);
            designed.map_err(|why| NoFeedback {
                helps: feedback_helps::helps(model, &middle, &elsewhere, &settings),
                why: Box::new(why),
            })
        };
        Ok(match *model == self.assumed_model {
            true => self.first_design.get(design)?,
            false => design()?,
        })
    }

    /// The repetitions of a motion, where it has been made before.
    fn repeats(&mut self, motion: &SharedMotion) -> Result<usize, PipelineError> {
        let known = self.repeated.iter();
        if let Some(found) = known.clone().position(|r| same(&*r.motion, &**motion)) {
            return Ok(found);
        }
        let settings = LearningSettings::default();
        self.repeated.push(Repeated {
            motion: motion.clone(),
            frozen: None,
            learned: LearnedMove::new(self.assumed_model.period, &settings)?,
        });
        Ok(self.repeated.len() - 1)
    }
}

/// The state feedback around a plan of the model.
///
/// # Errors
/// [`PipelineError`] if the axis has none within the margins.
pub fn assumed_feedback(predictors: &Predictors) -> Result<Feedback, PipelineError> {
    let mut strategy = PlanStrategy::new(predictors, PlanOptions::default())?;
    let assumed_model = strategy.assumed_model;
    strategy.feedback(&assumed_model)
}

/// Whether a feedback designed for one model holds for another: well inside the shares of
/// mass and friction that its margins are asked for.
fn near(model: &DriveModel, designed: &DriveModel) -> bool {
    let (a, b) = (model.friction.parameters(), designed.friction.parameters());
    let shares = [
        a.coulomb / b.coulomb,
        a.stiffness / b.stiffness,
        a.damping / b.damping,
        a.viscous / b.viscous,
    ];
    let within = |share: f64| share.is_nan() || (0.7..=1.4).contains(&share);
    let mass = model.load_inertia / designed.load_inertia;
    (0.95..=1.2).contains(&mass) && shares.into_iter().all(within)
}

/// Whether two motions are one.
fn same(a: &dyn Motion, b: &dyn Motion) -> bool {
    let duration = a.duration();
    duration == b.duration()
        && (0..=256).all(|i| {
            let t = duration * f64::from(i) / 256.0;
            a.at(t).position == b.at(t).position
        })
}

impl ResidualModel {
    /// Learns from a move; what the residual explained of it before, where that could be told.
    /// `alone` are the parameters without it, which have not learned of the move yet.
    fn learn(&mut self, record: &[Sample], alone: &Adaptation) -> Option<f64> {
        // A log that cannot be learned from leaves everything as it was.
        let mut latest = self.learner.latest();
        let before = self.unexplained(record, latest.as_mut()).ok()?;
        let explained = self
            .learner
            .judge(&before, &alone.unexplained(record).ok()?);
        let learned = match &mut latest {
            Some(residual) => self.adaptation.learn_beside(record, residual),
            None => self.adaptation.learn(record),
        };
        learned.ok()?;
        let rest = self.unexplained(record, latest.as_mut()).ok()?;
        self.learner.fit(&rest);
        Some(explained)
    }

    fn unexplained(
        &self,
        record: &[Sample],
        residual: Option<&mut AnyResidual>,
    ) -> Result<UnexplainedTorque, AdaptError> {
        match residual {
            Some(residual) => self.adaptation.unexplained_beside(record, residual),
            None => self.adaptation.unexplained(record),
        }
    }
}

impl Strategy for PlanStrategy {
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        let mut next = next.clone();
        let (mut model, mut residual) = self.model();
        if self.options.repetition {
            let made = self.repeated.len();
            let now = self.repeats(&next.motion)?;
            if now < made || !self.options.adaptation {
                // Beside one model: from its first repetition on where that is adapted.
                let repeated = &mut self.repeated[now];
                (model, residual) = repeated.frozen.get_or_insert((model, residual)).clone();
                next.learned = Some(Arc::new(repeated.learned.clone()));
            }
            self.now = Some(now);
        }
        // An adapted model has learned its friction at the temperature of now.
        let heat = self.heat.clone().map(|heat| match self.adaptation {
            Some(_) => Arc::new(heat.growth_alone()),
            None => heat,
        });
        let plan = plan(&model, &next, &self.left, heat)?.with_residual(residual);
        if !self.options.feedback {
            return Ok(Box::new(self.left.watching(plan, |plan| plan.planned())));
        }
        let law = PlanWithFeedback::new(plan, self.feedback(&model)?);
        Ok(Box::new(self.left.watching(law, |law| law.planned())))
    }

    fn warmed(&mut self, heat: Option<Arc<HeatAhead>>) {
        self.heat = heat;
    }

    fn learn(&mut self, record: &[Sample]) -> Result<LearnedValues, PipelineError> {
        let mut known = LearnedValues::new();
        let unit = ErrorUnit::of(&self.axis).key();
        if let Some(adaptation) = &mut self.adaptation {
            // What repeats with a move is not what repeats with angle and position.
            let again = self
                .now
                .is_some_and(|now| self.repeated[now].frozen.is_some());
            let mut residual = self.residual.as_mut().filter(|_| !again);
            // Judged before anything is learned of the move.
            if let Some(beside) = &mut residual {
                if let Some(explained) = beside.learn(record, adaptation) {
                    known.insert("residual_explained".to_owned(), explained);
                }
                let used = beside.learner.model().is_some();
                known.insert("residual_used".to_owned(), f64::from(u8::from(used)));
            }
            // A log that cannot be learned from leaves everything as it was.
            let refused = adaptation.learn(record).err();
            known.insert(
                "moves_refused".to_owned(),
                f64::from(u8::from(refused.is_some())),
            );
            if let Some(refused) = refused {
                tracing::warn!("nothing learned from this move: {refused}");
            }
            let used = residual.filter(|beside| beside.learner.model().is_some());
            let told = used.map_or(&*adaptation, |beside| &beside.adaptation);
            let free = told.model().kinematics.free_travel;
            known.insert(format!("free_travel_{unit}"), 1e6 * free);
            for estimate in told.estimates() {
                let name = estimate.parameter.name().replace(' ', "_");
                known.insert(format!("{name}_relative"), estimate.relative);
                known.insert(format!("{name}_standard_error"), estimate.standard_error);
            }
        }
        if let Some(now) = self.now.take() {
            let repeated = &mut self.repeated[now];
            if repeated.frozen.is_some() {
                let errors: Vec<_> = record
                    .iter()
                    .map(|s| Some(s.reference.position - s.position))
                    .collect();
                let round = repeated.learned.learn(&errors);
                known.insert("repetitions".to_owned(), f64::from(round.rounds));
                known.insert(format!("learnable_{unit}"), 1e6 * round.learnable);
                known.insert(format!("noise_{unit}"), 1e6 * round.floor);
            }
        }
        Ok(known)
    }
}
