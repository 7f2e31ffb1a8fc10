//! wrong models and motions, drawn.

use std::sync::Arc;

use compensator::DriveModel;
use lugre::{LuGre, Parameters};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use trajectories::{Limits, Program, SCurve, Step};

use crate::PipelineError;
use crate::moves::NamedMotion;

/// A model whose friction levels, σ0, σ1 and σ2 are each off by up to `friction` of their
/// values and whose load's inertia by up to `mass`, all evenly drawn.
///
/// # Errors
/// [`PipelineError::Friction`] if that makes no law.
pub fn wrong_model(
    truth: &DriveModel,
    [friction, mass]: [f64; 2],
    random: &mut ChaCha8Rng,
) -> Result<DriveModel, PipelineError> {
    let mut off = |share: f64| 1.0 + share * random.random_range(-1.0..=1.0);
    let p = truth.friction.parameters();
    let level = off(friction);
    let law = LuGre::new(Parameters {
        coulomb: level * p.coulomb,
        stiction: level * p.stiction,
        viscous: off(friction) * p.viscous,
        stiffness: off(friction) * p.stiffness,
        damping: off(friction) * p.damping,
        ..p
    })?;
    Ok(DriveModel {
        friction: law,
        load_inertia: off(mass) * truth.load_inertia,
        ..*truth
    })
}

/// Five moves on end within `[least, most]` (m), up to 300 mm/s and 1 m/s², with rests
/// between.
///
/// # Errors
/// [`PipelineError::Trajectory`] if the stroke is too short for them.
pub fn random_program(
    name: &str,
    [least, most]: [f64; 2],
    random: &mut ChaCha8Rng,
) -> Result<NamedMotion, PipelineError> {
    let failed = |source| PipelineError::Trajectory { index: 0, source };
    let start = 0.5 * (least + most);
    let mut at = start;
    let mut steps = Vec::new();
    for _ in 0..5 {
        // Far enough that a move is one: some millimetres at least.
        let to = loop {
            let to = random.random_range(least..most);
            if (to - at).abs() > 0.01 * (most - least) {
                break to;
            }
        };
        let limits = Limits::new(
            random.random_range(0.02..0.3),
            random.random_range(0.1..1.0),
            random.random_range(1.0..10.0),
        )
        .map_err(failed)?;
        steps.push(Step::Move { to, limits });
        steps.push(Step::Dwell {
            duration: random.random_range(0.05..0.3),
        });
        at = to;
    }
    let program = Program::new(start, steps).map_err(failed)?;
    Ok(NamedMotion {
        name: name.to_owned(),
        motion: Arc::new(program),
        learned: None,
    })
}

/// A pre-roll: `travel` (m) forward from `start` and back, at 20 mm/s at most. From its log the
/// friction of the first move that counts can be learned.
///
/// # Errors
/// [`PipelineError::Trajectory`] if it cannot be planned.
pub fn pre_roll(start: f64, travel: f64) -> Result<NamedMotion, PipelineError> {
    let failed = |source| PipelineError::Trajectory { index: 0, source };
    let limits = Limits::new(0.02, 0.2, 5.0).map_err(failed)?;
    let steps = vec![
        Step::Move {
            to: start + travel,
            limits,
        },
        Step::Move { to: start, limits },
        Step::Dwell { duration: 0.05 },
    ];
    let program = Program::new(start, steps).map_err(failed)?;
    Ok(NamedMotion {
        name: "pre-roll".to_owned(),
        motion: Arc::new(program),
        learned: None,
    })
}

/// A move over `travel` (m) from `start` at the constant speed `speed` (m/s).
///
/// # Errors
/// [`PipelineError::Trajectory`] if it cannot be planned.
pub fn constant_speed(start: f64, travel: f64, speed: f64) -> Result<NamedMotion, PipelineError> {
    let failed = |source| PipelineError::Trajectory { index: 0, source };
    let limits = Limits::new(speed, 0.1, 1.0).map_err(failed)?;
    let curve = SCurve::plan(start, start + travel, &limits).map_err(failed)?;
    Ok(NamedMotion {
        name: "constant speed".to_owned(),
        motion: Arc::new(curve),
        learned: None,
    })
}
