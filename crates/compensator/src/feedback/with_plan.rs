//! A plan and the feedback around it, as one strategy.

use lugre::Exponential;

use super::{Deviations, Feedback};
use crate::plan::{Plan, Planned, Target};
use crate::{Compensator, Correction, Residual, ResidualModel, Sample};

/// A [`Plan`] whose deviations a [`Feedback`] takes back.
#[derive(Clone, Debug)]
pub struct PlanWithFeedback<F, T = f64, R = ResidualModel<T>> {
    plan: Plan<F, T, R>,
    feedback: Feedback<T>,
    last: Correction<T>,
}

impl<T: Exponential, F: FnMut(usize) -> Target<T>, R: Residual<T>> PlanWithFeedback<F, T, R> {
    /// `feedback` around `plan`, both of the same axis.
    pub fn new(plan: Plan<F, T, R>, feedback: Feedback<T>) -> Self {
        Self {
            plan,
            feedback,
            last: Correction::default(),
        }
    }

    /// What the plan said last.
    pub fn planned(&self) -> &Planned<T> {
        self.plan.planned()
    }

    /// What the feedback assumed last.
    pub fn deviations(&self) -> &Deviations<T> {
        self.feedback.deviations()
    }

    /// The correction of the last cycle: the part of the command that is its own, for the
    /// next motion's [`Plan::after`].
    pub fn last(&self) -> &Correction<T> {
        &self.last
    }

    /// The feedback, as it is now.
    pub fn feedback(&self) -> &Feedback<T> {
        &self.feedback
    }
}

impl<T: Exponential, F: FnMut(usize) -> Target<T>, R: Residual<T>> Compensator<T>
    for PlanWithFeedback<F, T, R>
{
    fn reset(&mut self) {
        self.plan.reset();
        self.feedback.reset();
        self.last = Correction::default();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let planned = self.plan.advance(sample);
        self.last = self.feedback.correct(sample, &planned);
        self.last
    }

    fn surprise(&self) -> T {
        self.deviations().surprise
    }
}
