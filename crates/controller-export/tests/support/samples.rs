//! Samples as a controller records them: motions there and back, rests, noise; and what an
//! operator does meanwhile.

use axis_sim::Axis;
use compensator::{Reference, Sample};
use trajectories::{Limits, Motion, SCurve};

use super::Outcome;

/// What happens before a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    None = 0,
    On = 1,
    Off = 2,
    Reset = 3,
}

/// Uniform numbers in [−1, 1), always the same.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The paper's axis.
pub fn axis() -> Outcome<Axis> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    Ok(Axis::read(file.as_ref())?)
}

/// References of `count` cycles and one more: drawn moves with rests between them.
pub fn references(axis: &Axis, count: usize) -> Outcome<Vec<Reference>> {
    let mut random = Random(1);
    let mut all = Vec::with_capacity(count + 1);
    let mut at = axis.stroke.start;
    while all.len() <= count {
        // Short, so that the axis accelerates for much of the time.
        let way = 0.05 * random.next();
        let margin = 0.1 * (axis.stroke.maximum - axis.stroke.minimum);
        let inside = axis.stroke.minimum + margin..=axis.stroke.maximum - margin;
        let to = if inside.contains(&(at + way)) {
            at + way
        } else {
            at - way
        };
        let limits = Limits::new(
            0.05 + 0.2 * random.next().abs(),
            0.2 + 0.8 * random.next().abs(),
            2.0 + 8.0 * random.next().abs(),
        )?;
        let motion = SCurve::plan(at, to, &limits)?;
        let cycles = (motion.duration() / axis.period) as usize + 300;
        for k in 0..cycles {
            let now = motion.at(k as f64 * axis.period);
            all.push(Reference {
                position: now.position,
                velocity: now.velocity,
                acceleration: now.acceleration,
            });
        }
        at = to;
    }
    all.truncate(count + 1);
    Ok(all)
}

/// Samples of `count` cycles: the load follows with an error, sensors are noisy. The next reference
/// is that of `ahead` cycles later.
pub fn samples(axis: &Axis, count: usize, ahead: usize) -> Outcome<Vec<Sample>> {
    let references = references(axis, count + ahead)?;
    let mut random = Random(2);
    let (mut error, mut before) = (0.0, 0.0);
    let samples = references[..count]
        .iter()
        .zip(&references[ahead..])
        .map(|pair| {
            error += 0.01 * (2e-5 * random.next() - error);
            let speed = pair.0.velocity / axis.travel_per_radian();
            let command = 0.6 * speed.signum() + 0.03 * speed + 0.2 * random.next();
            let sample = Sample {
                reference: *pair.0,
                next_reference: *pair.1,
                position: pair.0.position + error + 1e-7 * random.next(),
                motor_angle: pair.0.position / axis.travel_per_radian(),
                motor_speed: speed + 0.05 * random.next(),
                iq: before,
                last_command: command,
            };
            before = command;
            sample
        });
    Ok(samples.collect())
}

/// What happens in cycle `k` of `count`: switched on and off and on, a sensor that gives no
/// number, a motion that begins anew, an axis that jumps.
pub fn event(k: usize, count: usize, sample: &mut Sample) -> Event {
    let part = |share: f64| (share * count as f64) as usize;
    if k == part(0.30) {
        sample.position = f64::NAN;
        sample.reference.velocity = f64::NAN;
        sample.next_reference.acceleration = f64::NAN;
    }
    if (part(0.6)..part(0.6) + 40).contains(&k) {
        // A command beyond its limit for longer than a while.
        sample.position += 0.3;
        sample.reference.velocity += 400.0;
        sample.next_reference.acceleration += 1e4;
    }
    match k {
        _ if [part(0.01), part(0.2), part(0.32), part(0.62), part(0.82)].contains(&k) => Event::On,
        _ if [part(0.19), part(0.8)].contains(&k) => Event::Off,
        _ if [part(0.31), part(0.61), part(0.9)].contains(&k) => Event::Reset,
        _ => Event::None,
    }
}
