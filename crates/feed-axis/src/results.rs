//! Results of all stages together: what the report shows.

use axis_pipeline::compensation::{CompensatedRun, find};
use axis_pipeline::measured::{LinearMaxAbsError, LinearMeanAbsError, MaxAbsError, MeanAbsError};
use axis_pipeline::strategies::{STRATEGIES, StrategyKind};
use axis_pipeline::study::StudyRow;
use axis_pipeline::summary::{self, LoopsSummary, MarginsSummary, NetworkSummary, Summary};
use axis_pipeline::validation::Validation;
use axis_sim::Axis;
use drive_loop::{CutMargins, LoopAnalysis, LoopError, LoopSet};
use miette::{Result, miette};

use crate::commands::identify::{Friction, Transfer};
use crate::commands::train::Training;
use crate::commands::{compensate, identify, study, train, validate};
use crate::context::Context;
use crate::paper;

/// Everything that the page shows.
pub struct Results {
    pub summary: Summary,
    pub training: Training,
    pub friction: Friction,
    pub friction_law: lugre::LuGre,
    /// Without and with friction feed-forward.
    pub transfer: [Transfer; 2],
    pub validation: Validation,
    pub compensation: Vec<CompensatedRun>,
    pub study: Vec<StudyRow>,
    pub paper: Option<paper::Tables>,
    pub loops: Loops,
}

/// The drive's loops, or why they have no margins.
pub struct Loops {
    pub model: Result<LoopAnalysis, LoopError>,
    /// None where the machine is the model.
    pub machine: Option<Result<LoopAnalysis, LoopError>>,
}

impl Loops {
    fn of(context: &Context) -> Self {
        let of = |axis: &Axis| LoopAnalysis::of(axis, &LoopSet::default());
        Self {
            model: of(&context.axis),
            machine: context.has_machine.then(|| of(&context.machine)),
        }
    }

    fn summary(&self) -> LoopsSummary {
        let of = |found: &Result<LoopAnalysis, LoopError>| found.as_ref().ok().map(margins);
        LoopsSummary {
            model: of(&self.model),
            machine: of(self.machine.as_ref().unwrap_or(&self.model)),
        }
    }
}

/// The worst margins of all cases.
fn margins(found: &LoopAnalysis) -> MarginsSummary {
    let all_stable = found.worst.unstable == 0;
    let worst = |of: fn(&CutMargins) -> Option<f64>, worse: fn(f64, f64) -> f64| {
        let all = found.corners.iter().filter_map(|at| of(&at.command));
        all.reduce(worse).filter(|_| all_stable)
    };
    MarginsSummary {
        cases: found.corners.len(),
        unstable: found.worst.unstable,
        sensitivity: found.worst.sensitivity,
        sensitivity_late: found.worst.sensitivity_late,
        gain_up: worst(|cut| cut.gain_up, f64::min),
        gain_down: worst(|cut| cut.gain_down, f64::max),
        phase_deg: worst(|cut| cut.phase_deg, f64::min),
        delay_s: worst(|cut| cut.delay_s, f64::min),
    }
}

/// Reads the results of all finished stages.
pub fn gather(context: &Context) -> Result<Results> {
    let validation = validate::load(context)?;
    let compensation = compensate::load(context)?;
    let training = train::load_training(context)?;
    let (friction, friction_law) = identify::load_friction(context)?;
    let (transfer, _) = identify::load_transfer(context)?;
    let folder = context.axis.experiment.as_ref();
    let folder = folder.and_then(|experiment| experiment.paper_tables.as_ref());
    let paper = folder.map(|folder| paper::read(folder)).transpose()?;
    let loops = Loops::of(context);
    let mut summary = summarise(context, &validation, &compensation, &training)?;
    summary.loops = loops.summary();
    Ok(Results {
        summary,
        study: study::load(context)?,
        training,
        friction,
        friction_law,
        transfer,
        validation,
        compensation,
        paper,
        loops,
    })
}

/// A strategy that has runs, and the first trajectory that it has none for. Strategies that the
/// axis cannot have are left out for all trajectories.
fn unfinished(
    mut ids: impl Iterator<Item = usize> + Clone,
    runs: &[CompensatedRun],
) -> Option<(usize, &'static StrategyKind)> {
    let all = ids.clone();
    ids.find_map(|id| {
        let without = |kind: &&&StrategyKind| find(runs, id, kind.name).is_none();
        let mut missing = STRATEGIES.iter().filter(without);
        let elsewhere = |kind: &&&StrategyKind| {
            let mut others = all.clone();
            others.any(|other| find(runs, other, kind.name).is_some())
        };
        missing.find(elsewhere).map(|kind| (id, *kind))
    })
}

fn summarise(
    context: &Context,
    validation: &Validation,
    compensation: &[CompensatedRun],
    training: &Training,
) -> Result<Summary> {
    let ids = validation.trajectories.iter().map(|t| t.id);
    if let Some((id, kind)) = unfinished(ids, compensation) {
        return Err(miette!(
            "trajectory {id} was not compensated with \"{}\", others were; run `{}`",
            kind.label,
            context.line("compensate")
        ));
    }
    let unit = context.unit();
    Ok(Summary {
        schema: Summary::SCHEMA,
        axis: context.axis.name.clone(),
        axis_fingerprint: context.axis.fingerprint.clone(),
        machine: context.machine.name.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: context.seed,
        quick: context.quick,
        trajectories: summary::trajectories(validation, compensation),
        network: NetworkSummary {
            hidden: training.hidden.clone(),
            epochs: training.epochs,
            train_samples: training.train_samples,
            test_samples: training.test_samples,
            max_abs_error: MaxAbsError::new(unit, training.network.max),
            mean_abs_error: MeanAbsError::new(unit, training.network.mean),
            linear_max_abs_error: LinearMaxAbsError::new(unit, training.linear.max),
            linear_mean_abs_error: LinearMeanAbsError::new(unit, training.linear.mean),
            train_seconds: training.seconds,
        },
        loops: LoopsSummary::default(),
    })
}

#[cfg(test)]
mod tests {
    use axis_pipeline::strategies::{NETWORK, NETWORK_LUGRE};
    use axis_pipeline::tracking::Run;

    use super::*;

    fn ran(id: usize, kind: &StrategyKind) -> CompensatedRun {
        CompensatedRun {
            id,
            strategy: kind.name.to_owned(),
            run: Run::default(),
        }
    }

    /// A strategy that has no run at all is one that the axis cannot have.
    #[test]
    fn results_are_unfinished_where_a_strategy_lacks_some_trajectories() {
        let runs = [
            ran(1, &NETWORK),
            ran(1, &NETWORK_LUGRE),
            ran(2, &NETWORK),
            ran(2, &NETWORK_LUGRE),
        ];
        let told = |runs: &[CompensatedRun]| unfinished(1..=2, runs).map(|(id, k)| (id, k.name));
        assert_eq!(told(&runs), None);
        assert_eq!(told(&runs[..3]), Some((2, NETWORK_LUGRE.name)));
        assert_eq!(told(&runs[1..]), Some((1, NETWORK.name)));
        assert_eq!(told(&[]), None);
    }
}
