//! Samples, a small network, and its error beside the best linear map's.
//!
//! `cargo run --release -p axis-pipeline --example one_cycle_network`

use axis_pipeline::LinearMap;
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity};
use axis_pipeline::training::{NetworkPlan, test, train};
use axis_sim::Axis;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    let axis = Axis::read(file.as_ref())?;
    let draw = |count, seed, density| {
        let plan = SamplePlan {
            count,
            seed,
            density,
        };
        Sampler::new(&axis, &plan)?.all()
    };
    let seen = draw(2000, 1, SpeedDensity::NearZero { scale: 3e-3 })?;
    let even = draw(2000, 2, SpeedDensity::Uniform)?;
    let unseen = draw(1000, 3, SpeedDensity::Uniform)?;

    let plan = NetworkPlan {
        hidden: vec![14, 8, 4],
        epochs: 150,
        initial_damping: 0.97,
        seed: 1,
        threads: 0,
    };
    let trained = train(
        &axis_pipeline::sampling::ranges(&axis)?,
        &seen,
        &plan,
        None,
        |_, _| {},
    )?;
    let (network, linear) = (
        test(&trained.network, &unseen)?,
        LinearMap::fit(&even)?.errors(&unseen)?,
    );
    println!(
        "one cycle ahead, unseen samples, {} epochs",
        trained.history.len()
    );
    println!(
        "linear map: max {:.2e} µm, mean {:.2e} µm",
        linear.max, linear.mean
    );
    println!(
        "network:    max {:.2e} µm, mean {:.2e} µm",
        network.max, network.mean
    );
    Ok(())
}
