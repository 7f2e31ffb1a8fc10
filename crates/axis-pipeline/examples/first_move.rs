//! What limits a first move under a plan alone, of which nothing has been learned yet: the
//! share of the peak that is left for each parameter that is assumed wrong, the least that
//! any plan can leave, and what a short move before takes away.
//!
//! `cargo run --release -p axis-pipeline --example first_move`, from the project's folder.
//! Simulated, without noise; the axis of Liu et al. 2025 with the machine's viscous friction.

use std::error::Error;

use axis_pipeline::moves::{Moves, NamedMotion};
use axis_pipeline::robustness::pre_roll;
use axis_pipeline::strategies::{NONE, Predictors, STRATEGIES, Strategy, named};
use axis_pipeline::tracking::{PlannedTrajectory, plan_all};
use axis_sim::{Axis, ClosedLoop, Measured};
use compensator::DriveModel;
use lugre::{LuGre, Parameters};

/// Factors of friction level, σ0, σ1, σ2 and the load's inertia.
type Factors = [f64; 5];

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Axis::read("data/axes/liu2025-machine.toml".as_ref())?;
    let motions: Vec<NamedMotion> = plan_all(&machine)?
        .into_iter()
        .map(PlannedTrajectory::named)
        .collect();
    println!(
        "assumed / true                    peak left, worst of {}",
        motions.len()
    );
    let names = ["friction level", "sigma0", "sigma1", "sigma2", "inertia"];
    for (i, name) in names.into_iter().enumerate() {
        for factor in [0.8, 1.2] {
            let mut factors = [1.0; 5];
            factors[i] = factor;
            println!(
                "{name:<16} {factor}        {:6.2} %",
                worst(&machine, &motions, factors)?
            );
        }
    }
    // Level and σ0 against each other move the break-away; along with each other they do not.
    for factors in [[1.2, 0.8], [0.8, 1.2], [1.2, 1.2], [0.8, 0.8]] {
        let [level, stiffness] = factors;
        let left = worst(&machine, &motions, [level, stiffness, 1.0, 1.0, 1.0])?;
        println!("level {level}, sigma0 {stiffness}      {left:6.2} %");
    }
    println!("least that any plan from a assumed within 20 % can leave, in the worst case:");
    for motion in &motions {
        println!(
            "  trajectory {:<10} {:6.2} %",
            motion.name,
            least(&machine, motion)?
        );
    }
    println!("after a move before it, level 1.2 and sigma0 0.8 assumed:");
    for way in [0.2e-3, 1e-3, 5e-3] {
        let mut most = 0.0_f64;
        for motion in &motions {
            let start = motion.motion.at(0.0).position;
            let before = pre_roll(start, way)?;
            let left = taken(
                &machine,
                &assumed_model(&machine, [1.2, 0.8, 1.0, 1.0, 1.0])?,
                "adaptive",
                &[before, motion.clone()],
            )?;
            most = most.max(left);
        }
        println!("  {:4.1} mm there and back   {most:6.2} %", 1e3 * way);
    }
    Ok(())
}

/// The machine's own model with factors.
fn assumed_model(machine: &Axis, factors: Factors) -> Result<DriveModel, Box<dyn Error>> {
    let mut model = machine.drive_model()?;
    model.friction = law(&model.friction, factors)?;
    model.load_inertia *= factors[4];
    Ok(model)
}

fn law(of: &LuGre, factors: Factors) -> Result<LuGre, Box<dyn Error>> {
    let p = of.parameters();
    Ok(LuGre::new(Parameters {
        coulomb: factors[0] * p.coulomb,
        stiction: factors[0] * p.stiction,
        stiffness: factors[1] * p.stiffness,
        damping: factors[2] * p.damping,
        viscous: factors[3] * p.viscous,
        ..p
    })?)
}

fn worst(machine: &Axis, motions: &[NamedMotion], factors: Factors) -> Result<f64, Box<dyn Error>> {
    let model = assumed_model(machine, factors)?;
    let mut most = 0.0_f64;
    for motion in motions {
        most = most.max(taken(
            machine,
            &model,
            "plan",
            std::slice::from_ref(motion),
        )?);
    }
    Ok(most)
}

/// Peak of the last move as a share of what it is without compensation, %.
fn taken(
    machine: &Axis,
    model: &DriveModel,
    strategy: &str,
    motions: &[NamedMotion],
) -> Result<f64, Box<dyn Error>> {
    let errors =
        |strategy: &mut dyn Strategy, motions: &[NamedMotion]| last(machine, strategy, motions);
    let predictors = Predictors {
        assumed_model: Some(*model),
        ..Predictors::of(machine)
    };
    let kind = named(STRATEGIES, strategy).ok_or("no such strategy")?;
    let with = errors(&mut *kind.strategy(&predictors)?, motions)?;
    let alone = &motions[motions.len() - 1..];
    let none = errors(&mut *NONE.strategy(&predictors)?, alone)?;
    Ok(100.0 * peak(&with) / peak(&none))
}

fn last(
    machine: &Axis,
    strategy: &mut dyn Strategy,
    motions: &[NamedMotion],
) -> Result<Vec<f64>, Box<dyn Error>> {
    let closed_loop = ClosedLoop::new(machine)?;
    let mut moves = Moves::new(&closed_loop, |_: &mut Measured| ());
    let mut errors = Vec::new();
    for motion in motions {
        errors = moves.make(strategy, motion)?.errors;
    }
    Ok(errors)
}

fn peak(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most, e| most.max(e.abs()))
}

/// Half the greatest difference between the errors of two machines under the same plan, both
/// of which the assumed model allows: as the servo adds to them the same for both whatever the plan
/// is, one of them is left with at least that. The truth is assumed within 20 %, so that
/// level and σ0 are 1/1.2 to 1/0.8 of it.
fn least(machine: &Axis, motion: &NamedMotion) -> Result<f64, Box<dyn Error>> {
    let model = machine.drive_model()?;
    let (less, more) = (1.0 / 1.2, 1.0 / 0.8);
    let under = |factors: Factors| -> Result<Vec<f64>, Box<dyn Error>> {
        let mut other = machine.clone();
        let shares: Vec<f64> = other
            .known()
            .iter()
            .map(|name| match *name {
                "coulomb_level" | "break_away" => factors[0] - 1.0,
                "bristle_stiffness" => factors[1] - 1.0,
                _ => 0.0,
            })
            .collect();
        other = other.with_known(&shares);
        let predictors = Predictors {
            assumed_model: Some(model),
            ..Predictors::of(machine)
        };
        let kind = named(STRATEGIES, "plan").ok_or("no such strategy")?;
        last(
            &other,
            &mut *kind.strategy(&predictors)?,
            std::slice::from_ref(motion),
        )
    };
    let apart = under([less, more, 1.0, 1.0, 1.0])?
        .iter()
        .zip(under([more, less, 1.0, 1.0, 1.0])?)
        .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let predictors = Predictors::of(machine);
    let none = last(
        machine,
        &mut *NONE.strategy(&predictors)?,
        std::slice::from_ref(motion),
    )?;
    Ok(100.0 * 0.5 * apart / peak(&none))
}
