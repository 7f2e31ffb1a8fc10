//! The closed loop over trajectory 1, all trajectories one after the other and
//! on two threads, and one-cycle samples.
//!
//! Elements are control cycles of 100 µs: at 3 Melem/s the closed loop runs
//! 300 times faster than real time.

use std::hint::black_box;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use axis_sim::{Axis, ClosedLoop, CycleInput, OneCycle};
use compensator::NoCompensation;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use trajectories::{Motion, SCurve};

fn axis() -> Axis {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    Axis::read(&folder.join("liu2025.toml")).expect("the axis file is part of the project")
}

fn closed_loop(c: &mut Criterion) {
    let axis = axis();
    let motion = axis
        .plan(&axis.trajectories[0])
        .expect("the trajectory has an S-curve");
    let mut group =
        c.benchmark_group("closed loop, trajectory 1 (10^4 elements = 1 s of real time)");
    for (name, closed_loop, samples) in [
        ("modal, 100 µs", ClosedLoop::new(&axis), 100),
        ("moving node, 10 µs", ClosedLoop::exact(&axis, 1e-5), 10),
    ] {
        let closed_loop = closed_loop.expect("the axis was checked");
        let run = || {
            let (mut most, mut cycles) = (0.0_f64, 0);
            let outcome = closed_loop.run(&motion, &mut NoCompensation, |cycle| {
                most = most.max(cycle.error().abs());
                cycles += 1;
            });
            black_box((outcome, most));
            cycles
        };
        group.sample_size(samples);
        group.throughput(Throughput::Elements(run()));
        group.bench_function(name, |b| b.iter(run));
    }
    group.finish();
}

/// Every trajectory of the file, four times: on one thread, and the same
/// shared out to two, each of which takes the next motion when it is free.
fn batch(c: &mut Criterion) {
    let axis = axis();
    let closed_loop = ClosedLoop::new(&axis).expect("the axis was checked");
    let motions: Vec<SCurve> = std::iter::repeat_n(&axis.trajectories, 4)
        .flatten()
        .map(|spec| axis.plan(spec).expect("the trajectory has an S-curve"))
        .collect();
    let seconds: f64 = motions.iter().map(Motion::duration).sum();
    let mut group = c.benchmark_group("closed loop, all trajectories four times");
    group.sample_size(10);
    group.throughput(Throughput::Elements((seconds / axis.period) as u64));
    for threads in [1, 2] {
        let next = AtomicUsize::new(0);
        let work = || {
            while let Some(motion) = motions.get(next.fetch_add(1, Ordering::Relaxed)) {
                black_box(closed_loop.run(motion, &mut NoCompensation, |_| ()));
            }
        };
        group.bench_function(format!("{threads} threads"), |b| {
            b.iter(|| {
                next.store(0, Ordering::Relaxed);
                thread::scope(|scope| {
                    for _ in 0..threads {
                        scope.spawn(work);
                    }
                });
            });
        });
    }
    group.finish();
}

/// Points that fill Table 5 evenly: multiples of irrational numbers, mod 1.
fn inputs(axis: &Axis, count: usize) -> Vec<CycleInput> {
    let part = |p: f64, i: usize| (p.sqrt() * (i + 1) as f64).fract();
    let s = axis.samples.expect("the axis file has ranges");
    let within =
        |range: axis_sim::ValueRange, part: f64| range.least + part * (range.most - range.least);
    (0..count)
        .map(|i| CycleInput {
            position: within(s.position, part(2.0, i)),
            speed: within(s.speed, part(3.0, i)),
            acceleration: within(s.acceleration, part(5.0, i)),
            command: within(s.effort, part(7.0, i)),
        })
        .collect()
}

fn samples(c: &mut Criterion) {
    let axis = axis();
    let one = OneCycle::new(&axis).expect("the axis was checked");
    let inputs = inputs(&axis, 5000);
    let mut group = c.benchmark_group("one-cycle samples");
    group.throughput(Throughput::Elements(inputs.len() as u64));
    group.bench_function("5000", |b| {
        b.iter(|| {
            inputs
                .iter()
                .map(|input| one.increment(black_box(input)).expect("on the screw"))
                .sum::<f64>()
        });
    });
    group.finish();
}

criterion_group!(benches, closed_loop, batch, samples);
criterion_main!(benches);
