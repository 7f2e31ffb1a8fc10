//! Learning from repetition, on logs as a controller would write them.

use axis_log::Log;
use axis_pipeline::learning::{LearningError, StoredCorrection};
use axis_pipeline::strategies::{NextMove, Predictors, STRATEGIES, SharedMotion, named};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::{Advice, Compensator};
use lugre::{LuGre, Parameters};
use std::sync::Arc;

fn machine() -> Axis {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/liu2025-machine.toml"
    );
    Axis::read(path.as_ref()).unwrap()
}

fn motion(axis: &Axis, trajectory: usize) -> SharedMotion {
    Arc::new(axis.plan(&axis.trajectories[trajectory]).unwrap())
}

/// The model: friction levels at 80 %.
fn assumed_model(axis: &Axis) -> Predictors {
    let p = axis.friction.law.parameters();
    let law = LuGre::new(Parameters {
        coulomb: 0.8 * p.coulomb,
        stiction: 0.8 * p.stiction,
        ..p
    });
    Predictors {
        identified: Some(law.unwrap()),
        ..Predictors::of(axis)
    }
}

struct Rig {
    axis: Axis,
    predictors: Predictors,
    closed_loop: ClosedLoop,
    motion: SharedMotion,
}

impl Rig {
    fn new() -> Self {
        let axis = machine();
        Self {
            predictors: assumed_model(&axis),
            closed_loop: ClosedLoop::new(&axis).unwrap(),
            motion: motion(&axis, 2),
            axis,
        }
    }

    /// The log of the move under the plan with what was learned, and its peak, µm.
    fn run(&self, correction: Option<&StoredCorrection>) -> (Log, f64) {
        let kind = named(STRATEGIES, "plan").unwrap();
        let mut strategy = kind.strategy(&self.predictors).unwrap();
        let learned = correction.map(|c| Arc::new(c.on(&self.axis, &*self.motion).unwrap()));
        let mut law: Box<dyn Compensator> = strategy
            .compensator(&NextMove {
                motion: self.motion.clone(),
                continued: None,
                learned,
            })
            .unwrap();
        let mut recorder = Recorder::new(&self.axis);
        let mut peak = 0.0_f64;
        self.closed_loop
            .run(&*self.motion, &mut *law, |cycle| {
                recorder.push(cycle);
                peak = peak.max(1e6 * cycle.error().abs());
            })
            .completed()
            .unwrap();
        (recorder.log().unwrap(), peak)
    }
}

#[test]
fn a_repeated_move_is_learned_from_its_logs_late_holed_and_all() {
    let rig = Rig::new();
    let (log, first) = rig.run(None);
    assert!(first > 5.0, "{first}");
    let mut correction = StoredCorrection::of(&rig.axis, &log).unwrap();
    correction.learn(&rig.axis, &log).unwrap();
    let (log, second) = rig.run(Some(&correction));
    // The second log starts 20 ms late and lacks every seventh sample.
    let late = log.skip(200).unwrap();
    let keep: Vec<usize> = (0..late.len()).filter(|k| k % 7 != 3).collect();
    let holed = late.channels().iter().map(|channel| {
        let samples = keep.iter().map(|k| channel.samples[*k]).collect();
        axis_log::Channel::new(channel.name.clone(), samples).unwrap()
    });
    let holed = Log::new(holed.collect()).unwrap();
    correction.learn(&rig.axis, &holed).unwrap();
    let (log, third) = rig.run(Some(&correction));
    let round = correction.learn(&rig.axis, &log).unwrap();
    let (_, fourth) = rig.run(Some(&correction));
    assert_eq!(round.rounds, 3);
    assert_ne!(round.advice, Advice::Restarted);
    assert!(
        second < 0.25 * first && third < 0.35 * second,
        "{first} {second} {third}"
    );
    assert!(fourth < 0.1, "{first} {second} {third} {fourth}");

    // What is kept in a file is the same.
    let text = serde_json::to_string(&correction).unwrap();
    let again: StoredCorrection = serde_json::from_str(&text).unwrap();
    assert_eq!(again, correction);
}

#[test]
fn another_move_is_refused_and_so_is_a_log_that_stands_still() {
    let rig = Rig::new();
    let (log, _) = rig.run(None);
    let mut correction = StoredCorrection::of(&rig.axis, &log).unwrap();
    let other = motion(&rig.axis, 0);
    let refused = correction.on(&rig.axis, &*other).unwrap_err();
    assert!(matches!(refused, LearningError::OtherMove(..)), "{refused}");
    let still = Log::new(vec![
        axis_log::Channel::new("t_s", (0..100).map(|k| 1e-4 * f64::from(k)).collect()).unwrap(),
        axis_log::Channel::new("position_ref_m", vec![0.6; 100]).unwrap(),
        axis_log::Channel::new("position_m", vec![0.6; 100]).unwrap(),
    ]);
    let refused = correction.learn(&rig.axis, &still.unwrap()).unwrap_err();
    assert!(refused.to_string().contains("does not move"), "{refused}");
}
