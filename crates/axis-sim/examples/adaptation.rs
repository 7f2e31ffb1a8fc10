//! How much of the tracking error a plan takes away while its model is adapted from move to
//! move: `cargo run --release -p axis-sim --example adaptation [draws] [seed]`.
//!
//! The machine is the stand-in. Each draw begins with friction level, viscosity, bristle
//! stiffness and damping assumed wrong by up to 20 %, and mass by up to 10 %, and makes
//! four of the six trajectories in its own order, each from rest, none twice.

use axis_sim::{Axis, ClosedLoop, Measured};
use compensator::{
    AdaptPrior, Adaptation, Compensator, Correction, DriveModel, NoCompensation, Plan,
    PlanSettings, Reference, Sample, Target,
};
use lugre::{LuGre, Parameters};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trajectories::{Motion, SCurve};

/// A compensator, and what it was shown.
struct Logged<C> {
    inner: C,
    log: Vec<Sample>,
}

impl<C: Compensator> Compensator for Logged<C> {
    fn reset(&mut self) {
        self.inner.reset();
        self.log.clear();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.log.push(*sample);
        self.inner.correct(sample)
    }

    fn surprise(&self) -> f64 {
        self.inner.surprise()
    }
}

/// Greatest tracking error, m, and the log.
fn run(
    closed_loop: &ClosedLoop,
    motion: &SCurve,
    compensator: impl Compensator,
    random: &mut ChaCha8Rng,
) -> Result<(f64, Vec<Sample>), axis_sim::RunStopped> {
    let mut logged = Logged {
        inner: compensator,
        log: Vec::new(),
    };
    let sense = |m: &mut Measured| {
        let mut noise = |deviation: f64| {
            let unit: f64 = StandardNormal.sample(random);
            deviation * unit
        };
        m.position += noise(1e-8);
        m.motor_angle += noise(2e-6);
        m.motor_speed += noise(0.01);
        m.current.q += noise(5e-3);
        m.current.d += noise(5e-3);
    };
    let mut most = 0.0f64;
    let outcome = closed_loop.run_sensed(motion, &mut logged, sense, |cycle| {
        most = most.max(cycle.error().abs());
    });
    outcome.completed()?;
    Ok((most, logged.log))
}

fn plan<'a>(
    model: &DriveModel,
    motion: &'a SCurve,
) -> Result<impl Compensator + 'a, compensator::CompensatorError> {
    let period = model.period;
    Plan::new(model, &PlanSettings::default(), move |k| {
        let at = motion.at(k as f64 * period);
        Target::of(Reference {
            position: at.position,
            velocity: at.velocity,
            acceleration: at.acceleration,
        })
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |otherwise: u64| arguments.next().map_or(Ok(otherwise), |a| a.parse());
    let (draws, seed) = (number(50)?, number(1)?);
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/liu2025-machine.toml"
    );
    let axis = Axis::read(file.as_ref())?;
    let closed_loop = ClosedLoop::new(&axis)?;
    let model = axis.drive_model()?;
    let p = model.friction.parameters();
    let specs = axis.trajectories.iter();
    let motions: Vec<SCurve> = specs
        .map(|spec| axis.plan(spec))
        .collect::<Result<_, _>>()?;

    let mut moves: [Vec<[f64; 2]>; 4] = Default::default();
    for draw in 0..draws {
        let mut random = ChaCha8Rng::seed_from_u64(1000 * seed + draw);
        let mut off = |share: f64| 1.0 + share * (2.0 * random.random::<f64>() - 1.0);
        let level = off(0.2);
        let mut assumed = model;
        assumed.friction = LuGre::new(Parameters {
            coulomb: p.coulomb * level,
            stiction: p.stiction * level,
            viscous: p.viscous * off(0.2),
            stiffness: p.stiffness * off(0.2),
            damping: p.damping * off(0.2),
            ..p
        })?;
        assumed.load_inertia *= off(0.1);
        let mut order: Vec<usize> = (0..motions.len()).collect();
        order.shuffle(&mut random);
        let mut adaptation = Adaptation::new(&assumed, &AdaptPrior::default())?;
        for (errors, i) in moves.iter_mut().zip(order) {
            let motion = &motions[i];
            let (without, _) = run(&closed_loop, motion, NoCompensation, &mut random)?;
            let planned = plan(&adaptation.model(), motion)?;
            let (with, log) = run(&closed_loop, motion, planned, &mut random)?;
            errors.push([1.0 - with / without, 1e6 * with]);
            let learned = adaptation.learn(&log)?;
            if draw == 0 {
                println!("after move {}:", learned.moves);
                for p in &learned.parameters {
                    println!(
                        "  {:18} {:+8.3} ± {:.3} %",
                        p.parameter.name(),
                        100.0 * p.relative,
                        100.0 * p.standard_error
                    );
                }
            }
        }
    }
    println!("taken away of the peak error, and what is left:");
    for (i, errors) in moves.iter_mut().enumerate() {
        errors.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let ([Some(worst), middle], number) =
            ([errors.first(), errors.get(errors.len() / 2)], i + 1)
        else {
            continue;
        };
        let middle = middle.unwrap_or(worst);
        println!(
            "move {number}: worst {:.2} % ({:.3} µm), median {:.2} % ({:.3} µm)",
            100.0 * worst[0],
            worst[1],
            100.0 * middle[0],
            middle[1]
        );
    }
    Ok(())
}
