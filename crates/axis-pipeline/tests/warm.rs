//! Moves on an axis that warms up, against a second simulator that shares no code (`independent_axis::HeatedScrew`).

use std::sync::Arc;

use axis_pipeline::heat::{DutyHeat, HeatError, ModelHeat, WarmMoves};
use axis_pipeline::moves::NamedMotion;
use axis_pipeline::strategies::{Predictors, STRATEGIES, SharedMotion, named};
use axis_sim::{Axis, Measured};
use independent_axis::{HeatedScrew, Motion, there_and_back};
use trajectories::{Limits, Program, Step};

use crate::heat::{axis, program};

/// The second simulator warms the machine up.
struct Brute(HeatedScrew, Motion);

impl DutyHeat for Brute {
    fn until(&mut self, time: f64) -> Result<(), HeatError> {
        let more = time - self.0.time;
        if more > 0.0 {
            self.0.run(Some(&self.1), more, |_| 20.0);
        }
        Ok(())
    }

    fn friction(&self) -> Result<[f64; 2], HeatError> {
        Ok(self.0.friction_factors(0.7))
    }

    fn growth(&self, x: f64) -> f64 {
        self.0.growth(20.0, x)
    }
}

/// Each half alone leaves more than 50 µm after ten minutes; both leave what a plan leaves on the cold axis.
#[test]
fn growth_and_friction_are_planned_together() {
    let axis = axis();
    let stroke: SharedMotion = Arc::new(program(0.45, 0.95, 0.2));
    let mut truth = Brute(
        HeatedScrew::assumed(20.0),
        there_and_back(0.45, 0.95, 0.2, 1.0),
    );
    let warm = WarmMoves::new(&axis, &mut truth, &[0.0, 600.0], 8.0).unwrap();
    let moves = [NamedMotion {
        name: "stroke".to_owned(),
        motion: stroke.clone(),
        learned: None,
    }];
    let run = |name: &str, heat: bool| {
        let kind = named(STRATEGIES, name).unwrap();
        let mut strategy = kind.strategy(&Predictors::of(&axis)).unwrap();
        let model = ModelHeat::new(&axis, std::slice::from_ref(&stroke), 20.0).unwrap();
        let model = heat.then_some(model);
        let passes = warm.run(&mut *strategy, &moves, model, |_: &mut Measured| (), || ());
        let passes = passes.unwrap();
        [0, 1].map(|pass| passes[pass][0].figures.max)
    };
    let (blind, both) = (run("plan", false), run("plan", true));
    println!("{blind:?} {both:?}");
    // In the eight seconds of a cold stroke the screw grows by a micrometre.
    assert!(both[0] < 2.0 && blind[0] < 3.0, "{blind:?} {both:?}");
    assert!(blind[1] > 70.0 && both[1] < 2.5, "{blind:?} {both:?}");
}

#[test]
fn a_duty_of_nothing_tells_no_friction() {
    let heat = ModelHeat::new(&axis(), &[], 20.0).unwrap();
    let error = heat.friction().unwrap_err().to_string();
    assert!(error.contains("the duty has no duration"), "{error}");
}

#[test]
fn passes_that_would_overlap_are_refused() {
    let axis = axis();
    let stroke: SharedMotion = Arc::new(program(0.45, 0.95, 0.2));
    let refused = |after: &[f64]| {
        let mut heat = ModelHeat::new(&axis, std::slice::from_ref(&stroke), 20.0).unwrap();
        WarmMoves::new(&axis, &mut heat, after, 8.0).err()
    };
    let error = refused(&[0.0, 5.0]).unwrap();
    assert!(error.to_string().contains("the moves take 8"), "{error}");
    assert!(refused(&[0.0, 600.0, 607.0]).is_some());
    assert!(refused(&[0.0, 8.0]).is_none());
}

/// A scale that turns keeps its angles: what grows with its radius is no angle.
#[test]
fn an_axis_that_turns_warms_up_and_does_not_grow() {
    let text = include_str!("../../../data/axes/rotary-table.toml");
    let text = format!("{text}\n[thermal]\nscale_expansion_um_per_m_k = 10\n");
    let axis = Axis::parse("rotary-table.toml", &text).unwrap();
    let limits = Limits::new(3.0, 25.0, 800.0).unwrap();
    let steps = [1.5, 0.0].map(|to| Step::Move { to, limits }).to_vec();
    let turn = Arc::new(Program::new(0.0, steps).unwrap());
    let mut heat = ModelHeat::new(&axis, &[turn.clone() as SharedMotion], 20.0).unwrap();
    heat.until(3600.0).unwrap();
    let friction = heat.friction().unwrap();
    assert!(friction[1] < 0.999, "{friction:?}");
    assert_eq!([0.0, 1.5].map(|x| heat.growth(x)), [0.0; 2]);
    let ahead = heat.ahead(&*turn).unwrap();
    assert_eq!(ahead.growth(0.5, 1.5), [0.0; 2]);
}

/// Along a motion of minutes growth and friction change on the way.
#[test]
fn what_is_ahead_of_a_long_motion_is_what_the_network_does() {
    let axis = axis();
    let one = program(0.45, 0.95, 0.2);
    let limits = Limits::new(0.2, 1.0, 10.0).unwrap();
    let rest = Step::Dwell { duration: 1.0 };
    let steps = [0.95, 0.45]
        .map(|to| [Step::Move { to, limits }, rest])
        .concat();
    let long = Program::new(0.45, steps.repeat(20)).unwrap();
    let mut heat = ModelHeat::new(&axis, &[Arc::new(one) as SharedMotion], 20.0).unwrap();
    let ahead = heat.ahead(&long).unwrap();
    let end = trajectories::Motion::duration(&long);
    assert_eq!(ahead.growth(0.0, 0.9)[0], 0.0);
    for share in [0.5, 1.0] {
        heat.until(share * end).unwrap();
        let [growth, slope] = ahead.growth(share * end, 0.9);
        assert!(
            (growth - heat.growth(0.9)).abs() < 0.3e-6,
            "{growth} {}",
            heat.growth(0.9)
        );
        let rise = (heat.growth(0.91) - heat.growth(0.89)) / 0.02;
        assert!((slope / rise - 1.0).abs() < 0.02, "{slope} {rise}");
        for (a, b) in ahead
            .friction(share * end)
            .iter()
            .zip(heat.friction().unwrap())
        {
            assert!((a - b).abs() < 0.01, "{a} {b}");
        }
    }
}
