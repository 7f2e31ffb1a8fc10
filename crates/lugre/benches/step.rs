//! Cost of one step, as the control loop calls it.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use lugre::{Exponential, LuGre, Parameters};

const PAPER: Parameters = Parameters::LIU_2025;

/// A chain of steps, each waiting for the one before, as in a simulation.
/// The time shown is that of 1000 steps.
fn chain<T: Exponential>(c: &mut Criterion, name: &str, [from, to, h]: [f64; 3]) {
    let law = LuGre::new(black_box(PAPER).cast::<T>()).expect("the paper's law is valid");
    let increment = T::of((to - from) / 1000.0);
    let (from, h) = (T::of(from), T::of(h));
    c.bench_function(&format!("1000 step_torque, {name}"), |b| {
        b.iter(|| {
            let (mut z, mut w, mut sum) = (T::ZERO, black_box(from), T::ZERO);
            for _ in 0..1000 {
                let next = w + increment;
                let (z1, torque) = law.step_torque(z, w, next, black_box(h));
                z = z1;
                sum += torque;
                w = next;
            }
            sum
        });
    });
}

/// The same step, exponential left out alike where the curve is flat, with
/// other exponentials: what the crate's own are measured against.
fn step_with(
    law: &LuGre,
    exp: impl Fn(f64) -> f64,
    exp_m1: impl Fn(f64) -> f64,
) -> impl Fn(f64, f64, f64, f64) -> f64 {
    let p = law.parameters();
    let flat_above = law.flat_above();
    move |z0, w0, w1, h| {
        let w = 0.5 * (w0 + w1);
        let level = if w.abs() >= flat_above {
            p.coulomb
        } else {
            let x = w / p.stribeck_speed;
            p.coulomb + (p.stiction - p.coulomb) * exp(-x * x)
        };
        let steady = (level / p.stiffness).copysign(w);
        z0 - (steady - z0) * exp_m1(-p.stiffness * w.abs() * h / level)
    }
}

fn compare(c: &mut Criterion, name: &str, course: [f64; 3]) {
    let law = LuGre::new(black_box(PAPER)).expect("the paper's law is valid");
    let own = |z: f64, w0: f64, w1: f64, h: f64| law.step(z, w0, w1, h);
    run(c, &format!("own exponentials, {name}"), own, course);
    let with_libm = step_with(&law, libm::exp, libm::expm1);
    run(c, &format!("libm, {name}"), with_libm, course);
    let with_std = step_with(&law, f64::exp, f64::exp_m1);
    run(c, &format!("std, {name}"), with_std, course);
}

fn run(
    c: &mut Criterion,
    name: &str,
    step: impl Fn(f64, f64, f64, f64) -> f64,
    [from, to, h]: [f64; 3],
) {
    let increment = (to - from) / 1000.0;
    c.bench_function(&format!("1000 step, {name}"), |b| {
        b.iter(|| {
            let (mut z, mut w) = (0.0, black_box(from));
            for _ in 0..1000 {
                let next = w + increment;
                z = step(z, w, next, black_box(h));
                w = next;
            }
            z
        });
    });
}

fn steps(c: &mut Criterion) {
    for (name, from, to, h) in [
        ("traverse 60 to 190 rad/s", 60.0, 190.0, 25e-6),
        ("Stribeck 0.1 to 10 rad/s", 0.1, 10.0, 25e-6),
        ("stiff 60 to 190 rad/s, 1 ms", 60.0, 190.0, 1e-3),
    ] {
        chain::<f64>(c, name, [from, to, h]);
        chain::<f32>(c, &format!("f32, {name}"), [from, to, h]);
        compare(c, name, [from, to, h]);
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
