//! Cost of one step, as the control loop calls it.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use lugre::{LuGre, Parameters};

/// Liu et al. 2025, Table 1, in SI units.
const PAPER: Parameters = Parameters {
    coulomb: 0.6757,
    stiction: 0.7653,
    stribeck_speed: 2.713781,
    stiffness: 15.159508,
    damping: 1.521203,
    viscous: 0.002865,
};

/// A chain of steps, each waiting for the one before, as in a simulation.
/// The time shown is that of 1000 steps.
fn chain(c: &mut Criterion, name: &str, from: f64, to: f64, h: f64) {
    let law = LuGre::new(black_box(PAPER)).expect("the paper's law is valid");
    let increment = (to - from) / 1000.0;
    c.bench_function(&format!("1000 step_torque, {name}"), |b| {
        b.iter(|| {
            let (mut z, mut w, mut sum) = (0.0, black_box(from), 0.0);
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
    c.bench_function(&format!("1000 step, {name}"), |b| {
        b.iter(|| {
            let (mut z, mut w) = (0.0, black_box(from));
            for _ in 0..1000 {
                let next = w + increment;
                z = law.step(z, w, next, black_box(h));
                w = next;
            }
            z
        });
    });
}

/// The same step with the standard library's exponentials, always computed:
/// what the crate's own are measured against.
fn plain_step(p: &Parameters, z0: f64, w0: f64, w1: f64, h: f64) -> f64 {
    let w = 0.5 * (w0 + w1);
    let x = w / p.stribeck_speed;
    let level = p.coulomb + (p.stiction - p.coulomb) * (-x * x).exp();
    let steady = (level / p.stiffness).copysign(w);
    z0 - (steady - z0) * (-p.stiffness * w.abs() * h / level).exp_m1()
}

fn plain(c: &mut Criterion, name: &str, from: f64, to: f64, h: f64) {
    let p = black_box(PAPER);
    let increment = (to - from) / 1000.0;
    c.bench_function(&format!("1000 plain steps, {name}"), |b| {
        b.iter(|| {
            let (mut z, mut w) = (0.0, black_box(from));
            for _ in 0..1000 {
                let next = w + increment;
                z = plain_step(&p, z, w, next, black_box(h));
                w = next;
            }
            z
        });
    });
}

fn steps(c: &mut Criterion) {
    chain(c, "traverse 60 to 190 rad/s", 60.0, 190.0, 25e-6);
    chain(c, "Stribeck 0.1 to 10 rad/s", 0.1, 10.0, 25e-6);
    chain(c, "stiff 60 to 190 rad/s, 1 ms", 60.0, 190.0, 1e-3);
    plain(c, "traverse 60 to 190 rad/s", 60.0, 190.0, 25e-6);
    plain(c, "Stribeck 0.1 to 10 rad/s", 0.1, 10.0, 25e-6);
}

criterion_group!(benches, steps);
criterion_main!(benches);
