//! The implicit stepper's energy, nut and mesh, which only its inner state shows.

use super::{ImplicitState, ImplicitStepper};
use crate::drive::tests_support::drive_with_damping;
use crate::stepper::nut::tests::{obeys_its_law, torques};
use crate::{NutCoupling, Settled, TimeStepper};

/// Energies after a load of 1 kN is let go; as in the modal stepper's test.
fn ringing(damping: f64, coupling: NutCoupling) -> Vec<f64> {
    let drive = drive_with_damping(damping);
    let stepper = ImplicitStepper::new(&drive, coupling, 1e-4).unwrap();
    let motion = Settled {
        load: 1000.0,
        ..Settled::default()
    };
    let mut state = stepper.settled(1.5, &motion).unwrap();
    state.origin = 10.0;
    (0..3000)
        .map(|_| {
            assert!(stepper.step(&mut state, 0.0, |_| 0.0).load.converged);
            stepper.energy(&state)
        })
        .collect()
}

#[test]
fn undamped_energy_is_kept_to_rounding() {
    for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
        let energies = ringing(0.0, coupling);
        // Average acceleration conserves it (Newmark 1959), to 3000 steps of
        // rounding on springs up to 1e8 N·m/rad: 1.1e-12 and 2.6e-10 measured.
        let rounding = match coupling {
            NutCoupling::ShapeFunctions => 1e-11,
            NutCoupling::MovingNode => 2e-9,
        };
        for e in &energies {
            assert!(
                (e / energies[0] - 1.0).abs() < rounding,
                "{e:e} of {:e}",
                energies[0]
            );
        }
    }
}

#[test]
fn damping_only_takes_energy() {
    for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
        let energies = ringing(1e-5, coupling);
        for pair in energies.windows(2) {
            // ΔE = −h v̄ᵀ C v̄ in every step; rounding aside.
            assert!(pair[1] <= pair[0] + 1e-12 * energies[0], "{pair:?}");
        }
        assert!(energies[energies.len() - 1] < 0.9 * energies[0]);
    }
}

#[test]
fn followed_matrices_are_those_of_the_mesh_made_anew() {
    let drive = drive_with_damping(1e-5);
    let p = drive.parameters();
    let stepper = ImplicitStepper::new(&drive, NutCoupling::MovingNode, 1e-4).unwrap();
    let middle = 0.5 * p.screw_length;
    let mut state = stepper.settled(middle, &Settled::default()).unwrap();
    // To the ends and across many places, by less and by more than an element.
    for i in 0..200 {
        let x = p.screw_length * (0.5 + 0.5 * (0.37 * f64::from(i)).sin());
        stepper.move_seat(&mut state, x);
        let anew = drive.chain(x, NutCoupling::MovingNode).unwrap();
        assert_eq!(state.nodes, stepper.nodes(x));
        assert_eq!(state.chain.mass, anew.mass);
        assert_eq!(state.chain.stiffness, anew.stiffness);
        assert_eq!(state.chain.seat, anew.seat);
    }
}

#[test]
fn the_nut_obeys_its_law_and_never_pulls() {
    let mut places = [0; 3];
    for (i, gap) in [1e-7, 2e-6, 2e-5, 2e-4].into_iter().enumerate() {
        for (j, step) in [1e-5, 1e-4, 2e-4].into_iter().enumerate() {
            for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
                let drive = drive_with_damping([0.0, 1e-5, 1e-4][j]);
                let s = ImplicitStepper::new(&drive, coupling, step).unwrap();
                let compression = |state: &ImplicitState| {
                    let of = |values: &[f64]| s.stretch(values, &state.chain.seat);
                    [of(&state.q), of(&state.v)]
                };
                let torques = torques((3 * i + j) as u32);
                let of = obeys_its_law(&drive, &s, &torques, gap, compression);
                places.iter_mut().zip(of).for_each(|(all, of)| *all += of);
            }
        }
    }
    println!("in the gap, pushed back, pushed on: {places:?}");
    assert!(places.iter().all(|n| *n > 1000), "{places:?}");
}
