//! One type over several kinds of drive, as the documentation of `TimeStepper` has it.

use feed_dynamics::{
    ElasticDrive, ElasticDriveParameters, ElasticStepper, Observation, RigidDrive, RigidStepper,
    Settled, StepReport, TableMotion, TimeStepper,
};
use std::sync::Arc;

trait Machine {
    fn step(&mut self, torque: f64, load: &mut dyn FnMut(TableMotion) -> f64) -> StepReport;
    fn observe(&self) -> Observation;
}

struct Running<S: TimeStepper> {
    stepper: S,
    state: S::State,
}

impl<S: TimeStepper> Machine for Running<S> {
    fn step(&mut self, torque: f64, load: &mut dyn FnMut(TableMotion) -> f64) -> StepReport {
        self.stepper.step(&mut self.state, torque, load)
    }

    fn observe(&self) -> Observation {
        self.stepper.observe(&self.state)
    }
}

fn running<S: TimeStepper + 'static>(stepper: S) -> Box<dyn Machine> {
    let state = stepper.settled(0.1, &Settled::default()).unwrap();
    Box::new(Running { stepper, state })
}

/// 2 N·m on 12 kg at 0.02 m/rad against a damping of 60 N·s/m: the load tends to 100/60 m/s, with a
/// time constant of 12.5/60 s (the rotor adds 0.5 kg).
#[test]
fn steppers_of_several_kinds_behind_one_trait_of_the_caller() {
    let elastic = ElasticDrive::new(ElasticDriveParameters {
        motor_inertia: 2e-4,
        load_inertia: 12.0,
        travel_per_radian: 0.02,
        stiffness: Arc::new(3e6),
        stiffness_damping: 2e-5,
    })
    .unwrap();
    let rigid = RigidDrive::new(12.5, 0.02).unwrap();
    let mut machines = [
        running(ElasticStepper::new(&elastic, 1e-4).unwrap()),
        running(RigidStepper::new(&rigid, 1e-4).unwrap()),
    ];
    for machine in &mut machines {
        for _ in 0..2000 {
            let report = machine.step(2.0, &mut |load: TableMotion| 60.0 * load.speed);
            assert!(report.load.converged);
        }
        let expected = 100.0 / 60.0 * (1.0 - (-0.2_f64 * 60.0 / 12.5).exp());
        let speed = machine.observe().speed;
        assert!(
            (speed - expected).abs() < 1e-3 * expected,
            "{speed} {expected}"
        );
    }
}
