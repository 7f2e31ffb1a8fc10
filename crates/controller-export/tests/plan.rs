//! What is exported as a plan is the strategy that the simulator runs.

use std::sync::Arc;

use crate::support::laws::{LIMITS, Runs, Streaming};
use crate::support::{Outcome, laws, samples};
use axis_pipeline::strategies::{STRATEGIES, named};
use compensator::{Correction, Reference, Sample};
use controller_export::c::{self, Precision};
use controller_export::{ExportError, ExportedController};
use trajectories::Motion;

/// Set points one by one, held back by the look-ahead, give what the strategy gives that knows
/// the motion to its end.
#[test]
fn streaming_is_the_strategy() -> Outcome<()> {
    let axis = samples::axis()?;
    let predictors = laws::predictors(&axis)?;
    let controller = ExportedController::of(&predictors, "plan", LIMITS)?;
    let ahead = c::export(&controller, Precision::F64, None)?
        .look_ahead
        .ok_or("no plan")?;
    let mut streaming = Streaming::new(&controller.law.plan.ok_or("no plan")?);

    let motion = Arc::new(axis.plan(&axis.trajectories[0])?);
    let kind = named(STRATEGIES, "plan").ok_or("no strategy")?;
    let mut whole = kind.compensator(&predictors, motion.clone())?;
    let sample = |cycle: usize| {
        let at = motion.at(cycle as f64 * axis.period);
        let next = Reference {
            position: at.position,
            velocity: at.velocity,
            acceleration: at.acceleration,
        };
        Sample {
            next_reference: next,
            last_command: 0.3,
            ..Sample::default()
        }
    };
    let cycles = (motion.duration() / axis.period) as usize + 200;
    let mut most = 0.0_f64;
    for k in 0..cycles + ahead {
        let now = streaming.correct(&sample(k));
        if k < ahead {
            assert_eq!(now, Correction::default());
        } else {
            assert_eq!(now, whole.correct(&sample(k - ahead)), "cycle {k}");
        }
        most = most.max(now.command.abs());
    }
    assert!(most > 1.0, "{most} A");
    Ok(())
}

/// Strategies that learn between moves are the work of a host; the message says what of them runs
/// on a controller. One that nobody knows is refused with those that can be exported.
#[test]
fn what_a_controller_cannot_run_is_refused() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    let refused = |name| ExportedController::of(&predictors, name, LIMITS).expect_err("refused");
    let learning = refused("adaptive-feedback");
    assert!(matches!(
        learning,
        ExportError::LearnsBetweenMoves {
            instead: "feedback",
            ..
        }
    ));
    for error in [learning, refused("none"), refused("drive_terms")] {
        assert!(error.to_string().contains("network_lugre, "), "{error}");
    }
    Ok(())
}

/// A limit that is not above 0 would switch everything off without a word.
#[test]
fn a_limit_of_nothing_is_refused() -> Outcome<()> {
    let predictors = laws::predictors(&samples::axis()?)?;
    let limits = compensator::GuardLimits {
        position: 0.0,
        ..LIMITS
    };
    let refused = ExportedController::of(&predictors, "lugre", limits).expect_err("refused");
    assert!(refused.to_string().contains("position = 0"), "{refused}");
    Ok(())
}
