//! An hour of heat, from the axis file to the growth, against a simulator that shares no code: the screw as a
//! rod of 5 mm cells, the nut where it is, losses of each instant (`independent_axis::HeatedScrew`).

use axis_sim::Axis;
use axis_thermal::HeatNode;
use independent_axis::{HeatedScrew, there_and_back};
use trajectories::{Limits, Program, Step};

#[test]
fn an_hour_of_the_example_axis_is_that_of_brute_force() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/screw-heat.toml");
    let axis = Axis::read(file.as_ref()).unwrap();
    let [from, to] = [0.45, 0.95];
    let limits = Limits::new(0.2, 1.0, 10.0).unwrap();
    let rest = Step::Dwell { duration: 1.0 };
    let there = Step::Move { to, limits };
    let back = Step::Move { to: from, limits };
    let program = Program::new(from, vec![there, rest, back, rest]).unwrap();
    let motion = there_and_back(from, to, 0.2, 1.0);
    let model = axis.thermal_model().unwrap();
    let at_work = model
        .under(&axis.duty_of(&model, &program).unwrap())
        .unwrap();
    let cold = model.at_rest(20.0);
    let mut state = cold.clone();
    let mut brute = HeatedScrew::assumed(20.0);
    let (mut worst, mut nut, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..60 {
        at_work.run(&mut state, 20.0, 60.0).unwrap();
        brute.run(Some(&motion), 60.0, |_| 20.0);
        for x in [0.2, 0.45, 0.8, 0.95, 1.4] {
            let growth = brute.growth(20.0, x);
            worst = worst.max(1e6 * (model.growth(&cold, &state, x).screw - growth).abs());
            most = most.max(1e6 * growth);
        }
        nut = nut.max((state.of(HeatNode::Nut) - brute.bodies[4]).abs());
    }
    println!("{worst} of {most} µm, nut {nut} K");
    // The second simulator has the torque sensor's inertia and the nominal diameter in that of the screw
    // besides, 0.2 K at the winding.
    assert!(
        worst < 0.5 && nut < 0.05 && most > 150.0,
        "{worst} {nut} {most}"
    );
}
