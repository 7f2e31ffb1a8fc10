//! Programs that own time step the loop themselves.

use axis_sim::{Axis, ClosedLoop, SetupError, Start};
use compensator::NoCompensation;
use trajectories::Motion;

use crate::read;

/// Positions of axes that follow one motion side by side, a row a cycle, m.
fn side_by_side(
    axes: [&Axis; 2],
    motion: &impl Motion,
) -> Result<Vec<[f64; 2]>, Box<dyn std::error::Error>> {
    let loops = [ClosedLoop::new(axes[0])?, ClosedLoop::new(axes[1])?];
    let start = Start::at(motion.at(0.0).position);
    let states: Result<Vec<_>, SetupError> = loops.iter().map(|axis| axis.start(&start)).collect();
    let mut states = states?;
    let mut rows = Vec::new();
    for k in 0..loops[0].cycles(motion) {
        let at = |k: u64| motion.at(k as f64 * axes[0].period);
        let reference = [&at(k), &at(k + 1)];
        let mut row = [0.0; 2];
        for ((axis, state), position) in loops.iter().zip(&mut states).zip(&mut row) {
            let cycle = axis.step(state, reference, &mut NoCompensation, |_| ())?;
            *position = cycle.position;
        }
        rows.push(row);
    }
    Ok(rows)
}

/// Two hoists that lift one beam; the second is heavier. The first goes as in a run of its own.
#[test]
fn two_axes_are_stepped_side_by_side() {
    let first = read(outside::HOIST);
    let second = read(&outside::HOIST.replace("load_mass_kg = 200", "load_mass_kg = 300"));
    let motion = first.plan(&first.trajectories[0]).unwrap();
    let rows = side_by_side([&first, &second], &motion).unwrap();
    let askew = rows.iter().map(|[a, b]| (a - b).abs()).fold(0.0, f64::max);
    assert!((1e-4..1e-3).contains(&askew), "{askew} m");

    let mut alone = Vec::new();
    ClosedLoop::new(&first)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| {
            alone.push(cycle.position)
        })
        .completed()
        .unwrap();
    assert!(rows.iter().map(|[a, _]| *a).eq(alone));
}
