//! Programs that own time step the loop themselves.

use axis_sim::{ClosedLoop, Start};
use compensator::NoCompensation;
use trajectories::Motion;

use crate::read;

/// Two hoists that lift one beam, in step with each other; the second is heavier.
#[test]
fn two_axes_are_stepped_side_by_side() {
    let first = read(outside::HOIST);
    let second = read(&outside::HOIST.replace("load_mass_kg = 200", "load_mass_kg = 300"));
    let motion = first.plan(&first.trajectories[0]).unwrap();
    let loops = [&first, &second].map(|axis| ClosedLoop::new(axis).unwrap());
    let at_start = Start::at(first.stroke.start);
    let mut states = loops
        .each_ref()
        .map(|hoist| hoist.start(&at_start).unwrap());

    let mut askew = 0.0_f64;
    for k in 0..loops[0].cycles(&motion) {
        let time = |k| k as f64 * first.period;
        let reference = [&motion.at(time(k)), &motion.at(time(k + 1))];
        let mut positions = [0.0; 2];
        for ((hoist, state), position) in loops.iter().zip(&mut states).zip(&mut positions) {
            let cycle = hoist.step(state, reference, &mut NoCompensation, |_| ());
            *position = cycle.unwrap().position;
        }
        askew = askew.max((positions[0] - positions[1]).abs());
    }
    assert!((1e-4..1e-3).contains(&askew), "{askew} m");

    // The loop's own run takes the same steps.
    let mut last = 0.0;
    loops[0]
        .run(&motion, &mut NoCompensation, |cycle| last = cycle.position)
        .completed()
        .unwrap();
    let mut state = loops[0].start(&at_start).unwrap();
    let mut stepped = 0.0;
    for k in 0..loops[0].cycles(&motion) {
        let at = |k| motion.at(k as f64 * first.period);
        let cycle = loops[0].step(
            &mut state,
            [&at(k), &at(k + 1)],
            &mut NoCompensation,
            |_| (),
        );
        stepped = cycle.unwrap().position;
    }
    assert_eq!(last, stepped);
}
