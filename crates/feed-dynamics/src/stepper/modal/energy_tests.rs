//! The modal stepper's energy and nut, which only its inner state shows.

use super::{ModalState, ModalStepper, nut_rotation};
use crate::drive::tests_support::drive_with_damping;
use crate::stepper::nut::tests::{obeys_its_law, torques};
use crate::{Settled, TimeStepper};

/// Energies after a load of 1 kN is let go, the nut held on the screw's last
/// node (a start beyond the end), as a nut that moves changes K.
fn ringing(damping: f64, step: f64, duration: f64) -> Vec<f64> {
    let drive = drive_with_damping(damping);
    let stepper = ModalStepper::new(&drive, step).unwrap();
    let motion = Settled {
        load: 1000.0,
        ..Settled::default()
    };
    let mut state = stepper.settled(1.5, &motion).unwrap();
    state.origin = 10.0;
    // Torque and load fall to zero over the first step; then it is free.
    (0..(duration / step).round() as usize)
        .map(|_| {
            assert!(stepper.step(&mut state, 0.0, |_| 0.0).load.converged);
            stepper.energy(&state)
        })
        .collect()
}

#[test]
fn undamped_energy_is_kept_within_the_order() {
    let drift = |step| {
        let energies = ringing(0.0, step, 0.1);
        let off = energies.iter().map(|e| (e / energies[0] - 1.0).abs());
        off.fold(0.0, f64::max)
    };
    let drifts = [1e-4, 5e-5, 2.5e-5].map(drift);
    println!("modal energy drift over 0.1 s: {drifts:?}");
    assert!(drifts[0] < 5e-4, "{drifts:?}");
    // Second order: sixteenfold over two halvings.
    assert!(drifts[2] < drifts[0] / 12.0, "{drifts:?}");
}

#[test]
fn damping_only_takes_energy() {
    let energies = ringing(1e-5, 1e-4, 0.5);
    // The scheme is no energy method: allow a step to gain what its order
    // does: 1.5e-8 of the energy at the start, as measured.
    let gain = energies.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    println!(
        "modal greatest gain {:.2e} of the start",
        gain / energies[0]
    );
    assert!(gain < 1e-7 * energies[0], "{gain:e}");
    assert!(energies[energies.len() - 1] < 0.9 * energies[0]);
}

#[test]
fn the_nut_obeys_its_law_and_never_pulls() {
    let mut places = [0; 3];
    for (i, gap) in [1e-7, 2e-6, 2e-5, 2e-4].into_iter().enumerate() {
        for (j, step) in [1e-5, 1e-4, 2e-4].into_iter().enumerate() {
            let drive = drive_with_damping([0.0, 1e-5, 1e-4][j]);
            let s = ModalStepper::new(&drive, step).unwrap();
            let compression = |state: &ModalState| {
                let [angle, rate] = nut_rotation(&state.modes);
                [s.r * angle - state.displacement, s.r * rate - state.speed]
            };
            let torques = torques((3 * i + j) as u32);
            let of = obeys_its_law(&drive, &s, &torques, gap, compression);
            places.iter_mut().zip(of).for_each(|(all, of)| *all += of);
        }
    }
    println!("in the gap, pushed back, pushed on: {places:?}");
    assert!(places.iter().all(|n| *n > 1000), "{places:?}");
}
