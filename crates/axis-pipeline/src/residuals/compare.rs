//! The comparison: machines drawn, ordinary moves learned from, other moves counted.

use axis_sim::effects::ActiveEffect;
use axis_sim::{Axis, ClosedLoop, Measured};
use compensator::{DriveModel, NetworkBasis, ResidualLearner};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use super::drawn::drawn_machine;
use super::learner::AnyLearner;
use super::named::NamedEffects;
use crate::measured::{Left, WithoutCompensation};
use crate::moves::{Moves, NamedMotion};
use crate::robustness::{Sense, WRONG, random_program, room, wrong_model};
use crate::strategies::{NONE, Predictors, Strategy, adapted};
use crate::tracking::{PlannedTrajectory, plan_all};
use crate::{ErrorUnit, PipelineError};

/// Programs of five moves that are learned from.
pub const PROGRAMS: usize = 10;
/// After how many of them moves are counted.
pub const AFTER: [usize; 4] = [1, 2, 4, 10];

/// How what no parameter holds is learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ResidualMethod {
    /// Not at all: the parameters are adapted.
    Adapted,
    /// Tables over angle and position.
    Tables,
    /// A network from simulated machines, refined on the logs.
    Network,
    /// The effects that a search has named.
    Named,
}

impl ResidualMethod {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Adapted, Self::Tables, Self::Network, Self::Named];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Adapted => "parameters alone",
            Self::Tables => "tables",
            Self::Network => "network",
            Self::Named => "named effects",
        }
    }
}

/// What residual models are compared on: one machine, its model and its moves.
pub struct ResidualComparison {
    assumed_model: DriveModel,
    machine: Axis,
    named: Vec<ActiveEffect>,
    programs: Vec<NamedMotion>,
    counted: Vec<NamedMotion>,
    seed: u64,
}

/// What one method left on one machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// How it was learned.
    pub method: ResidualMethod,
    /// Without compensation, the counted moves: greatest error.
    #[serde(flatten)]
    pub none: WithoutCompensation<Vec<f64>>,
    /// With it, after each of [`AFTER`]: the same of every counted move.
    #[serde(flatten)]
    pub left: Left<Vec<Vec<f64>>>,
    /// Whether the gate let it be used then.
    pub used: Vec<bool>,
}

/// `count` machines like `machine` with drawn effects, wrong models and drawn moves. Counted
/// are two trajectories of the axis each, in turn.
///
/// # Errors
/// [`PipelineError`] if the axis has no trajectories or no plan can be made of it.
pub fn comparisons(
    axis: &Axis,
    machine: &Axis,
    seed: u64,
    count: usize,
) -> Result<Vec<ResidualComparison>, PipelineError> {
    let truth = machine.drive_model()?;
    let motions: Vec<NamedMotion> = plan_all(axis)?
        .into_iter()
        .map(PlannedTrajectory::named)
        .collect();
    let contest = |i: usize| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(5000 + i as u64);
        let drawn = drawn_machine(machine, room(axis), &mut random);
        let assumed_model = wrong_model(&truth, WRONG, &mut random)?;
        let programs = (0..PROGRAMS)
            .map(|k| random_program(&format!("program {}", k + 1), room(axis), &mut random));
        Ok(ResidualComparison {
            assumed_model,
            machine: drawn.machine,
            named: drawn.named,
            programs: programs.collect::<Result<_, PipelineError>>()?,
            counted: motions
                .iter()
                .cycle()
                .skip(2 * i)
                .take(2)
                .cloned()
                .collect(),
            seed: seed + i as u64,
        })
    };
    (0..count).map(contest).collect()
}

/// Every method on every machine; `sense` gives the sensors' noise, `each` is called once a
/// machine and method.
///
/// # Errors
/// [`PipelineError`] if a move does not come to its end.
pub fn compare(
    axis: &Axis,
    comparisons: &[ResidualComparison],
    network: &NetworkBasis,
    sense: Sense<'_>,
    each: impl Fn() + Sync,
) -> Result<Vec<Vec<Compared>>, PipelineError> {
    let all: Vec<(&ResidualComparison, ResidualMethod)> = comparisons
        .iter()
        .flat_map(|contest| ResidualMethod::ALL.map(|method| (contest, method)))
        .collect();
    let made = all.par_iter().map(|(contest, method)| {
        let made = contest.make(axis, *method, network, sense);
        each();
        made
    });
    let made: Vec<Compared> = made.collect::<Result<_, _>>()?;
    Ok(made
        .chunks(ResidualMethod::ALL.len())
        .map(<[_]>::to_vec)
        .collect())
}

impl ResidualComparison {
    fn learner(
        &self,
        axis: &Axis,
        method: ResidualMethod,
        network: &NetworkBasis,
    ) -> Result<Option<AnyLearner>, PipelineError> {
        let b = &self.assumed_model;
        let level = b.friction.parameters().coulomb * b.travel / b.lever;
        let stroke = [axis.stroke.minimum, axis.stroke.maximum];
        Ok(match method {
            ResidualMethod::Adapted => None,
            ResidualMethod::Tables => Some(AnyLearner::Tables(ResidualLearner::new(
                stroke, b.travel, level,
            ))),
            ResidualMethod::Network => Some(AnyLearner::Network(Box::new(ResidualLearner::of(
                network.clone(),
                level,
            )))),
            ResidualMethod::Named => {
                let effects = NamedEffects::new(axis, &self.named)?;
                Some(AnyLearner::Named(Box::new(ResidualLearner::of(
                    effects, level,
                ))))
            }
        })
    }

    fn make(
        &self,
        axis: &Axis,
        method: ResidualMethod,
        network: &NetworkBasis,
        sense: Sense<'_>,
    ) -> Result<Compared, PipelineError> {
        let (closed_loop, unit) = (ClosedLoop::new(&self.machine)?, ErrorUnit::of(axis));
        let predictors = Predictors {
            assumed_model: Some(self.assumed_model),
            ..Predictors::of(axis)
        };
        let mut moves = Moves::new(&closed_loop, sense(self.seed));
        let none = self.count(&mut moves, &mut *NONE.strategy(&predictors)?)?;
        let mut strategy = adapted(&predictors, self.learner(axis, method, network)?)?;
        let (mut left, mut used) = (Vec::new(), Vec::new());
        for (k, program) in self.programs.iter().enumerate() {
            let made = moves.make(&mut *strategy, program)?;
            if AFTER.contains(&(k + 1)) {
                left.push(self.count(&mut moves, &mut *strategy)?);
                used.push(made.learned.get("residual_used") == Some(&1.0));
            }
        }
        Ok(Compared {
            method,
            none: WithoutCompensation::new(unit, none),
            left: Left::new(unit, left),
            used,
        })
    }

    /// Greatest errors of the counted moves, µm or µrad; nothing is learned from them.
    fn count<S: FnMut(&mut Measured)>(
        &self,
        moves: &mut Moves<'_, S>,
        strategy: &mut dyn Strategy,
    ) -> Result<Vec<f64>, PipelineError> {
        let peaks = self.counted.iter();
        let peaks = peaks.map(|motion| Ok(moves.try_out(strategy, motion)?.figures.max));
        peaks.collect()
    }
}
