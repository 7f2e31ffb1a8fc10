//! One step of each stepper in motion: the paper's drive, a belt and a rigid axis.

use std::hint::black_box;
use std::sync::Arc;

use beam_fem::{CrossSection, Material};
use criterion::{Criterion, criterion_group, criterion_main};
use feed_dynamics::{
    BeltStrands, DriveParameters, ElasticDrive, ElasticDriveParameters, ElasticStepper, FeedDrive,
    ImplicitStepper, ModalStepper, NutCoupling, NutErrors, RigidDrive, RigidStepper, Settled,
    Stiffness, TimeStepper,
};

fn drive(elements: usize) -> FeedDrive {
    let steel = Material::new(206e9, 0.3, 7850.0).expect("valid");
    FeedDrive::new(DriveParameters {
        section: CrossSection::solid_circle(0.040, &steel).expect("valid"),
        material: steel,
        screw_length: 1.5,
        elements,
        lead: 0.010,
        motor_inertia: 0.0053,
        sensor_inertia: 1e-4,
        motor_coupling_stiffness: 2800.0,
        screw_coupling_stiffness: 2800.0,
        table_mass: 515.0,
        nut_stiffness: 7.45e7,
        axial: None,
        stiffness_damping: 1e-5,
    })
    .expect("valid")
}

fn elastic(stiffness: Arc<dyn Stiffness>) -> ElasticStepper {
    let drive = ElasticDrive::new(ElasticDriveParameters {
        motor_inertia: 2e-4,
        load_inertia: 12.0,
        travel_per_radian: 0.02,
        stiffness,
        stiffness_damping: 1e-5,
    });
    ElasticStepper::new(&drive.expect("valid"), 1e-4).expect("valid")
}

/// Steps from a settled motion under what keeps it up; the state starts anew before
/// it runs off.
fn step<S: TimeStepper>(c: &mut Criterion, name: &str, stepper: &S, gap: f64, drag: f64) {
    let errors = NutErrors::new(0.0, 0.0, gap).expect("valid");
    let motion = Settled {
        speed: 0.1,
        acceleration: 0.0,
        load: 420.0,
    };
    let start = stepper.settled(0.2, &motion).expect("on the screw");
    let torque = stepper.settled_torque(0.2, &motion);
    let mut state = start.clone();
    let mut steps = 0_u32;
    c.bench_function(name, |b| {
        b.iter(|| {
            let report =
                stepper.step_through(&mut state, black_box(torque), black_box(&errors), |table| {
                    420.0 + drag * (table.speed - 0.1)
                });
            assert!(black_box(report).load.converged);
            steps += 1;
            if steps.is_multiple_of(10_000) {
                state = start.clone();
            }
            black_box(stepper.observe(&state))
        });
    });
}

fn steps(c: &mut Criterion) {
    for elements in [10, 40] {
        let drive = drive(elements);
        let modal = ModalStepper::new(&drive, 1e-4).expect("valid");
        step(
            c,
            &format!("modal step, N = {elements}"),
            &modal,
            0.0,
            300.0,
        );
        for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
            let implicit = ImplicitStepper::new(&drive, coupling, 1e-5).expect("valid");
            step(
                c,
                &format!("implicit step, {coupling:?}, N = {elements}"),
                &implicit,
                0.0,
                300.0,
            );
        }
    }
    let belt = BeltStrands::new(8e5, 0.3, 2.5).expect("valid");
    let (constant, belt) = (elastic(Arc::new(2e6)), elastic(Arc::new(belt)));
    for (name, stepper, gap, drag) in [
        ("elastic step, load given", &constant, 0.0, 0.0),
        ("elastic step", &constant, 0.0, 300.0),
        ("elastic step, belt", &belt, 0.0, 300.0),
        ("elastic step, gap", &constant, 2e-6, 300.0),
    ] {
        step(c, name, stepper, gap, drag);
    }
    let rigid = RigidDrive::new(95.0, 0.02).expect("valid");
    let rigid = RigidStepper::new(&rigid, 1e-4).expect("valid");
    step(c, "rigid step", &rigid, 0.0, 300.0);
}

criterion_group!(benches, steps);
criterion_main!(benches);
