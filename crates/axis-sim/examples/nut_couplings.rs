//! Tracking errors of all trajectories with both nut couplings: the fixed mesh
//! with shape functions, and the paper's moving node. Slow without `--release`.
//!
//! `cargo run --release -p axis-sim --example nut_couplings`

use std::path::Path;

use axis_sim::{Axis, ClosedLoop};
use compensator::NoCompensation;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    println!("                        shape functions, µm      moving node, µm       apart, µm");
    println!("file, trajectory          max      mean         max      mean       max     mean");
    for file in ["liu2025.toml", "liu2025-machine.toml"] {
        let axis = Axis::read(&folder.join(file))?;
        let loops = [ClosedLoop::new(&axis)?, ClosedLoop::exact(&axis, 1e-5)?];
        let figures = [errors_um(&loops[0])?, errors_um(&loops[1])?];
        for (i, (a, b)) in figures[0].iter().zip(&figures[1]).enumerate() {
            println!(
                "{:20} {}  {:8.4} {:8.5}   {:8.4} {:8.5}   {:+7.4} {:+8.5}",
                axis.name,
                i + 1,
                a[0],
                a[1],
                b[0],
                b[1],
                b[0] - a[0],
                b[1] - a[1]
            );
        }
    }
    Ok(())
}

/// Maximum and mean of |S_ref − S|, µm, of each trajectory.
fn errors_um(closed_loop: &ClosedLoop) -> Result<Vec<[f64; 2]>, Box<dyn std::error::Error>> {
    let axis = closed_loop.axis();
    let mut all = Vec::new();
    for spec in &axis.trajectories {
        let (mut most, mut sum, mut cycles) = (0.0_f64, 0.0, 0.0);
        closed_loop
            .run(&axis.plan(spec)?, &mut NoCompensation, |cycle| {
                most = most.max(cycle.error().abs());
                sum += cycle.error().abs();
                cycles += 1.0;
            })
            .completed()?;
        all.push([1e6 * most, 1e6 * sum / cycles]);
    }
    Ok(all)
}
