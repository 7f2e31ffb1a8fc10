//! The implicit stepper's energy and mesh, which only its inner state shows.

use super::{ImplicitState, ImplicitStepper};
use crate::drive::tests_support::drive_with_damping;
use crate::{NutCoupling, Settled, TimeStepper};
use nalgebra::DVector;

/// ½ q̇ᵀ M q̇ + ½ qᵀ K q, J, with the nut on the screw's last node.
fn energy(s: &ImplicitStepper, state: &ImplicitState) -> f64 {
    let m = s
        .drive
        .matrices(s.drive.parameters().screw_length, s.coupling)
        .unwrap();
    let (q, v) = (
        DVector::from_column_slice(&state.q),
        DVector::from_column_slice(&state.v),
    );
    0.5 * v.dot(&(&m.mass * &v)) + 0.5 * q.dot(&(&m.stiffness * &q))
}

/// Energies after a load of 1 kN is let go; as in the modal stepper's test.
fn ringing(damping: f64, coupling: NutCoupling) -> Vec<f64> {
    let drive = drive_with_damping(damping);
    let stepper = ImplicitStepper::new(&drive, coupling, 1e-4).unwrap();
    let mut state = stepper.settled(
        10.0,
        &Settled {
            load: 1000.0,
            ..Settled::default()
        },
    );
    (0..3000)
        .map(|_| {
            stepper.step(&mut state, 0.0, |_| 0.0);
            energy(&stepper, &state)
        })
        .collect()
}

#[test]
fn undamped_energy_is_kept_to_rounding() {
    for coupling in [NutCoupling::ShapeFunctions, NutCoupling::MovingNode] {
        let energies = ringing(0.0, coupling);
        for e in &energies {
            // Average acceleration conserves it (Newmark 1959); 3000 steps of
            // rounding on springs up to 1e8 N·m/rad.
            assert!(
                (e / energies[0] - 1.0).abs() < 1e-9,
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
    let mut state = stepper.settled(0.5 * p.screw_length, &Settled::default());
    // To the ends and across many places, by less and by more than an element.
    for i in 0..200 {
        let x = p.screw_length * (0.5 + 0.5 * (0.37 * f64::from(i)).sin());
        stepper.move_seat(&mut state, x);
        let anew = stepper.chain(x);
        assert_eq!(state.nodes, stepper.nodes(x));
        assert_eq!(state.chain.mass, anew.mass);
        assert_eq!(state.chain.stiffness, anew.stiffness);
        assert_eq!(state.chain.seat, anew.seat);
    }
}
