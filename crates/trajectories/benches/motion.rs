//! Planning a move, and sampling it in order and at random.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use trajectories::{
    Chirp, Limits, Motion, Program, Real, SCurve, Setpoint, Sine, Step, Sweep, Transfer,
    TransferLimits,
};

/// Instants per pass: enough that no branch predictor learns a random order by heart.
const INSTANTS: usize = 100_000;

/// Distances (m) that take each of the planner's ways, and their names.
const CASES: [(&str, f64); 4] = [
    ("all limits", 0.3),
    ("no cruise", 0.04),
    ("jerk only", 1e-3),
    ("nothing", 0.0),
];

fn limits() -> Limits {
    Limits::new(0.1, 0.225, 1.2).expect("positive")
}

fn plan(c: &mut Criterion) {
    let mut group = c.benchmark_group("plan");
    for (name, distance) in CASES {
        let limits = limits();
        group.bench_function(name, |b| {
            b.iter(|| {
                SCurve::plan(
                    black_box(0.6),
                    0.6 + black_box(distance),
                    black_box(&limits),
                )
            });
        });
    }
    let single = limits().cast::<f32>().expect("positive");
    group.bench_function("all limits, f32", |b| {
        b.iter(|| SCurve::plan(black_box(0.6_f32), black_box(0.9), black_box(&single)));
    });
    group.bench_function("all limits, limits checked anew", |b| {
        b.iter(|| {
            let limits = Limits::new(black_box(0.1), black_box(0.225), black_box(1.2))?;
            SCurve::plan(black_box(0.6), black_box(0.9), &limits)
        });
    });
    // Distances in a fixed random order, so that the ways through the planner cannot be predicted.
    let distances: Vec<f64> = random().map(|u| 0.1 * u * u).take(INSTANTS).collect();
    group.throughput(Throughput::Elements(INSTANTS as u64));
    group.bench_function("mixed", |b| {
        let limits = limits();
        b.iter(|| {
            for &distance in &distances {
                black_box(SCurve::plan(0.6, 0.6 + distance, &limits).expect("valid"));
            }
        });
    });
    group.finish();
}

/// Uniform numbers in [0, 1) from a multiplicative congruential generator, always the same.
fn random() -> impl Iterator<Item = f64> {
    let mut state = 1u64;
    std::iter::repeat_with(move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    })
}

fn transfer(c: &mut Criterion) {
    let mut group = c.benchmark_group("transfer");
    let limits = limits().into();
    let mut numbers = random();
    let mut draw = |size: f64| size * (2.0 * numbers.next().expect("endless") - 1.0);
    // Within the limits of 0.1 m/s and 0.225 m/s², whatever the signs.
    let tasks: Vec<[Setpoint; 2]> = (0..INSTANTS)
        .map(|_| {
            [0.0, draw(0.5)].map(|position| Setpoint {
                position,
                velocity: draw(0.08),
                acceleration: draw(0.2),
                jerk: 0.0,
            })
        })
        .collect();
    group.throughput(Throughput::Elements(INSTANTS as u64));
    group.bench_function("plan", |b| b.iter(|| plan_all(&tasks, &limits)));
    let single = |s: &Setpoint| Setpoint {
        position: s.position as f32,
        velocity: s.velocity as f32,
        acceleration: s.acceleration as f32,
        jerk: 0.0,
    };
    let tasks: Vec<_> = tasks
        .iter()
        .map(|ends| ends.each_ref().map(single))
        .collect();
    let limits = self::limits().cast::<f32>().expect("positive").into();
    group.bench_function("plan, f32", |b| b.iter(|| plan_all(&tasks, &limits)));
    group.finish();
}

fn plan_all<T: Real>(tasks: &[[Setpoint<T>; 2]], limits: &TransferLimits<T>) {
    for [start, target] in tasks {
        black_box(Transfer::plan(start, target, limits).expect("valid"));
    }
}

fn program() -> Program {
    let limits = limits();
    let steps = vec![
        Step::Move { to: 0.9, limits },
        Step::Dwell { duration: 0.5 },
        Step::MoveBy { by: -0.05, limits },
        Step::Dwell { duration: 0.5 },
        Step::Move { to: 0.6, limits },
    ];
    Program::new(0.6, steps).expect("valid")
}

fn sample(c: &mut Criterion) {
    let limits = limits();
    let curve = SCurve::plan(0.6, 0.9, &limits).expect("valid");
    let program = program();
    let sine = Sine {
        amplitude: 1e-3,
        frequency: 5.0,
        cycles: 10,
    };
    let chirp = Chirp {
        amplitude: 1e-3,
        from_frequency: 1.0,
        to_frequency: 100.0,
        duration: 10.0,
        ramp: 1.0,
        sweep: Sweep::Logarithmic,
    };
    let sine = Program::new(0.6, vec![Step::Sine(sine)]).expect("valid");
    let chirp = Program::new(0.6, vec![Step::Chirp(chirp)]).expect("valid");
    sample_motion(c, "sample S-curve", &curve);
    sample_motion(c, "sample program of five steps", &program);
    sample_motion(c, "sample sine", &sine);
    sample_motion(c, "sample logarithmic chirp", &chirp);
    let single = limits.cast::<f32>().expect("valid");
    let single = SCurve::plan(0.6, 0.9, &single).expect("valid");
    sample_motion(c, "sample S-curve, f32", &single);
    let single = sine.cast::<f32>().expect("valid");
    sample_motion(c, "sample sine, f32", &single);
    let single = chirp.cast::<f32>().expect("valid");
    sample_motion(c, "sample logarithmic chirp, f32", &single);
}

fn sample_motion<T: Real, M: Motion<T>>(c: &mut Criterion, name: &str, motion: &M) {
    let mut group = c.benchmark_group(name);
    group.throughput(Throughput::Elements(INSTANTS as u64));
    let duration = motion.duration().to_f64();
    let in_order: Vec<T> = (0..INSTANTS)
        .map(|i| T::of(duration * i as f64 / INSTANTS as f64))
        .collect();
    let at_random: Vec<T> = random()
        .map(|u| T::of(duration * u))
        .take(INSTANTS)
        .collect();
    for (order, instants) in [("in order", &in_order), ("at random", &at_random)] {
        group.bench_function(order, |b| b.iter(|| sum(motion, instants)));
    }
    group.finish();
}

/// Uses position, velocity and acceleration of each setpoint, so that none is left out.
fn sum<T: Real, M: Motion<T>>(motion: &M, instants: &[T]) -> T {
    let mut total = T::ZERO;
    for &t in instants {
        let Setpoint {
            position,
            velocity,
            acceleration,
            ..
        } = black_box(motion).at(t);
        total += position + velocity + acceleration;
    }
    total
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(500))
        .measurement_time(std::time::Duration::from_secs(2));
    targets = plan, transfer, sample
}
criterion_main!(benches);
