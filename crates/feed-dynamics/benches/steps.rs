//! One step of each stepper, the paper's drive in motion.

use std::hint::black_box;

use beam_fem::{Material, Section};
use criterion::{Criterion, criterion_group, criterion_main};
use feed_dynamics::{
    DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, NutCoupling, Settled, TimeStepper,
};

fn drive(elements: usize) -> FeedDrive {
    let steel = Material::new(206e9, 0.3, 7850.0).expect("valid");
    FeedDrive::new(DriveParameters {
        section: Section::solid_circle(0.040, &steel).expect("valid"),
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

/// Steps from a settled motion; the state starts anew before it runs off.
fn step<S: TimeStepper>(c: &mut Criterion, name: &str, stepper: &S) {
    let motion = Settled {
        speed: 0.1,
        acceleration: 0.0,
        load: 420.0,
    };
    let start = stepper.settled(0.2, &motion).expect("on the screw");
    let mut state = start.clone();
    let mut steps = 0_u32;
    c.bench_function(name, |b| {
        b.iter(|| {
            let report = stepper.step(&mut state, black_box(0.668), |table| {
                420.0 + 300.0 * (table.speed - 0.1)
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
        step(c, &format!("modal step, N = {elements}"), &modal);
        for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
            let implicit = ImplicitStepper::new(&drive, coupling, 1e-5).expect("valid");
            step(
                c,
                &format!("implicit step, {coupling:?}, N = {elements}"),
                &implicit,
            );
        }
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
