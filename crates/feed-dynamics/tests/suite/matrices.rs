//! Laws that M(x) and K(x) must obey at every x and for every drive.

use feed_dynamics::{DriveMatrices, DriveParameters, FeedDrive, NutCoupling};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use proptest::prelude::*;

use crate::{COUPLINGS, paper};

/// Drives around the paper's, over more than a decade in what matters most.
fn drives() -> impl Strategy<Value = FeedDrive> {
    (
        2..24_usize,
        0.3..4.0,
        0.002..0.05,
        20.0..3000.0,
        1e7..1e9,
        (500.0..2e4, 500.0..2e4),
        1e-4..0.05,
    )
        .prop_map(|(elements, length, lead, mass, nut, couplings, inertia)| {
            FeedDrive::new(DriveParameters {
                elements,
                screw_length: length,
                lead,
                table_mass: mass,
                nut_stiffness: nut,
                motor_coupling_stiffness: couplings.0,
                screw_coupling_stiffness: couplings.1,
                motor_inertia: inertia,
                ..paper()
            })
            .unwrap()
        })
}

fn coupling() -> impl Strategy<Value = NutCoupling> {
    proptest::sample::select(COUPLINGS.to_vec())
}

/// Rigid motion by one radian: every rotation 1, the table r.
fn rigid(drive: &FeedDrive) -> DVector<f64> {
    let n = drive.coordinates();
    let mut q = DVector::from_element(n, 1.0);
    q[n - 1] = drive.travel_per_radian();
    q
}

fn matrices(drive: &FeedDrive, part: f64, coupling: NutCoupling) -> DriveMatrices {
    let x = part * drive.parameters().screw_length;
    drive.matrices(x, coupling).unwrap()
}

/// Scaled to a unit diagonal, so that rad and m can be compared.
fn balanced(m: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
        m[(i, j)] / (m[(i, i)] * m[(j, j)]).sqrt()
    })
}

fn eigenvalues(m: DMatrix<f64>) -> Vec<f64> {
    let mut values = SymmetricEigen::new(m).eigenvalues.as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    values
}

proptest! {
    #[test]
    fn symmetric_definite_and_one_rigid_mode(
        drive in drives(), part in 0.0..=1.0, coupling in coupling()
    ) {
        let m = matrices(&drive, part, coupling);
        prop_assert_eq!(&m.mass, &m.mass.transpose());
        prop_assert_eq!(&m.stiffness, &m.stiffness.transpose());
        prop_assert_eq!(&m.damping, &(&m.stiffness * drive.parameters().stiffness_damping));

        // Consistent mass of a rod: the balanced matrix has eigenvalues from
        // 1 − 1/√2 (end) up, whatever the element lengths.
        prop_assert!(eigenvalues(balanced(&m.mass))[0] > 0.2);

        // No energy below rounding, and exactly one motion without any.
        let energies = eigenvalues(balanced(&m.stiffness));
        prop_assert!(energies[0] > -1e-13, "{:e}", energies[0]);
        prop_assert!(energies[0] < 1e-13, "{:e}", energies[0]);
        prop_assert!(energies[1] > 1e-9, "{:e}", energies[1]);

        // That motion is the rigid one: each row cancels to rounding.
        let q = rigid(&drive);
        let force = &m.stiffness * &q;
        let scale = m.stiffness.abs() * q.abs();
        for (f, s) in force.iter().zip(&scale) {
            prop_assert!(f.abs() <= 1e-14 * s, "{f:e} of {s:e}");
        }
    }

    #[test]
    fn rigid_motion_has_the_total_inertia(
        drive in drives(), part in 0.0..=1.0, coupling in coupling()
    ) {
        let m = matrices(&drive, part, coupling);
        let q = rigid(&drive);
        let inertia = q.dot(&(&m.mass * &q));
        // The sum of N + 4 numbers; the total from the parameters by hand.
        let p = drive.parameters();
        let polar = std::f64::consts::PI * 0.040_f64.powi(4) / 32.0;
        let by_hand = p.motor_inertia
            + p.sensor_inertia
            + 7850.0 * polar * p.screw_length
            + p.table_mass * (p.lead / std::f64::consts::TAU).powi(2);
        prop_assert!((inertia / by_hand - 1.0).abs() < 1e-13);
        prop_assert!((drive.total_inertia() / by_hand - 1.0).abs() < 1e-13);
    }

    #[test]
    fn nut_stiffness_has_rank_one(
        drive in drives(), part in 0.0..=1.0, coupling in coupling()
    ) {
        let k = drive.parameters().nut_stiffness;
        let softer = FeedDrive::new(DriveParameters {
            nut_stiffness: 0.5 * k,
            ..drive.parameters().clone()
        })
        .unwrap();
        let nut = matrices(&drive, part, coupling).stiffness
            - matrices(&softer, part, coupling).stiffness;
        // In metres at the nut all entries are of the size of k.
        let n = drive.coordinates();
        let r = drive.travel_per_radian();
        let scale = |i: usize| if i + 1 == n { 1.0 } else { 1.0 / r };
        let nut = DMatrix::from_fn(n, n, |i, j| 2.0 / k * nut[(i, j)] * scale(i) * scale(j));
        let energies = eigenvalues(nut.clone());
        // b bᵀ has the eigenvalue |b|² = 1 + n₁² + n₂², from 1.5 to 2. What is
        // left beside it is the rounding of the screw's stiffness, up to
        // 1e10 N·m/rad in an element a thousandth as long, seen through 1/r².
        let largest = energies[n - 1];
        prop_assert!((1.5 - 1e-6..=2.0 + 1e-6).contains(&largest), "{largest}");
        prop_assert!(energies[n - 2].abs() < 1e-5 * largest, "{:e}", energies[n - 2]);
        prop_assert!(energies[0].abs() < 1e-5 * largest, "{:e}", energies[0]);
    }
}

#[test]
fn the_nut_acts_where_the_table_is() {
    // Eq. (4), lost signs restored: k [[r², −r], [−r, 1]] on the node at x = 0.6 m.
    let drive = crate::drive();
    let (k, r) = (7.45e7, 0.010 / std::f64::consts::TAU);
    for coupling in COUPLINGS {
        let m = drive.matrices(0.6, coupling).unwrap();
        let n = drive.coordinates();
        assert_eq!(m.stiffness[(n - 1, n - 1)], k);
        for node in 0..=10 {
            let expected = if node == 4 { -k * r } else { 0.0 };
            let entry = m.stiffness[(2 + node, n - 1)];
            // 0.6 m is four elements of 0.15 m to rounding.
            assert!((entry - expected).abs() < 1e-14 * k, "node {node}: {entry}");
        }
    }
}
