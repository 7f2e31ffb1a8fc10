//! Receptance: limits, symmetry, peaks.

use feed_dynamics::{Coordinate, DriveError, DriveParameters, FeedDrive};

use crate::{COUPLINGS, drive, paper, relative};

#[test]
fn low_frequency_moves_the_total_inertia() {
    let drive = drive();
    // The first elastic terms come in as ω²/ω₁²: 2.4e-6 at the motor and 1.1e-5
    // at the table as measured.
    let w = 1.0;
    for coupling in COUPLINGS {
        for x in [0.0, 0.6, 1.234] {
            let h = drive
                .receptance(x, coupling, [Coordinate::Motor, Coordinate::Motor], &[w])
                .unwrap()[0];
            let rigid = -1.0 / (drive.total_inertia() * w * w);
            assert!(relative(h.re, rigid) < 1e-5, "{h} {rigid}");
            let table = drive
                .receptance(x, coupling, [Coordinate::Motor, Coordinate::Table], &[w])
                .unwrap()[0];
            assert!(relative(table.re, rigid * drive.travel_per_radian()) < 5e-5);
        }
    }
}

/// −φ_a φ_b / (J ω²) as the frequency goes to nothing, by the paper's numbers: elastic
/// terms are ω²/(150 rad/s)² of it at most.
#[test]
fn the_rigid_motion_is_right_at_any_low_frequency() {
    let drive = drive();
    let r = 0.010 / std::f64::consts::TAU;
    let screw = 7850.0 * std::f64::consts::PI * 0.04_f64.powi(4) / 32.0 * 1.5;
    let inertia = 0.0053 + 1e-4 + screw + 515.0 * r * r;
    let places = [
        (Coordinate::Motor, 1.0),
        (Coordinate::Sensor, 1.0),
        (Coordinate::Screw(0), 1.0),
        (Coordinate::Screw(10), 1.0),
        (Coordinate::Table, r),
    ];
    let ws = [1e-3, -1e-3, 1e-4, 1e-6, 1e-9, 1e-30, 1e-70];
    let mut worst = 0.0_f64;
    for coupling in COUPLINGS {
        // At 0.6 + 1.51e-4 the moving node has its shortest element, of 0.15 mm.
        for x in [0.0, 0.6, 0.6 + 1.51e-4, 1.234, 1.5] {
            for (input, a) in places {
                for (output, b) in places {
                    let h = drive.receptance(x, coupling, [input, output], &ws).unwrap();
                    for (h, w) in h.into_iter().zip(ws) {
                        let off = (h * (inertia * w * w) / (a * b) + 1.0).norm();
                        worst = worst.max(off - 4.5e-5 * w * w);
                    }
                }
            }
        }
    }
    // 3.3e-15 measured: the rounding of J and of a quotient.
    println!("rigid motion off by {worst:.1e}");
    assert!(worst < 2e-14, "{worst:e}");
}

#[test]
fn a_frequency_that_is_no_number_is_refused_by_name() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        let ws = [1.0, bad];
        let (motor, table) = (Coordinate::Motor, Coordinate::Table);
        let error = drive().receptance(0.6, COUPLINGS[0], [motor, table], &ws);
        let text = error.unwrap_err().to_string();
        assert!(text.starts_with("angular frequency = "), "{text}");
    }
}

#[test]
fn reciprocal_and_built_from_the_modes() {
    let drive = drive();
    let (x, coupling) = (0.81, COUPLINGS[0]);
    let ws: Vec<f64> = (1..60).map(|i| 37.0 * f64::from(i)).collect();
    let h = |a, b| drive.receptance(x, coupling, [a, b], &ws).unwrap();
    let forth = h(Coordinate::Motor, Coordinate::Screw(7));
    let back = h(Coordinate::Screw(7), Coordinate::Motor);
    // Modal sum: Σ φ_a φ_b / (ω_i² + iωβω_i² − ω²).
    let modes = drive.modes(x, coupling).unwrap();
    let (a, b) = (0, drive.row(Coordinate::Screw(7)).unwrap());
    for ((&w, f), g) in ws.iter().zip(&forth).zip(&back) {
        // 4.3e-12 measured, at 851 rad/s: each leaves another row of K out, by whose
        // rounding ω² of the mode at 873 rad/s is 2e-13 apart, and that is 20 times as much
        // of a response so near to it. Elsewhere 5e-13.
        assert!((f - g).norm() < 1e-11 * f.norm().max(1e-9));
        let sum: nalgebra::Complex<f64> = (0..drive.coordinates())
            .map(|i| {
                let square = modes.frequencies_rad_s[i].powi(2);
                let below = nalgebra::Complex::new(square - w * w, w * 1e-5 * square);
                modes.shapes[(a, i)] * modes.shapes[(b, i)] / below
            })
            .sum();
        // 1.2e-11 as measured.
        assert!((f - sum).norm() < 1e-10 * f.norm(), "{f} {sum} at {w}");
    }
}

#[test]
fn peaks_stand_at_the_modes() {
    let drive = FeedDrive::new(DriveParameters {
        stiffness_damping: 1e-7,
        ..paper()
    })
    .unwrap();
    for coupling in COUPLINGS {
        let modes = drive.modes(0.6, coupling).unwrap();
        for &w in &modes.frequencies_rad_s[1..4] {
            // ζ is below 1e-3 there: the peak lies within 1e-6 of ω.
            let grid: Vec<f64> = (-40..=40)
                .map(|i| w * (1.0 + 5e-4 * f64::from(i)))
                .collect();
            let h = drive
                .receptance(0.6, coupling, [Coordinate::Motor, Coordinate::Motor], &grid)
                .unwrap();
            let best = (0..grid.len()).max_by(|&i, &j| h[i].norm().total_cmp(&h[j].norm()));
            assert!(relative(grid[best.unwrap()], w) < 5e-4, "{w}");
        }
    }
}

#[test]
fn refuses_what_has_no_answer() {
    let drive = drive();
    let ask = |x, node, w| {
        let c = COUPLINGS[0];
        drive.receptance(x, c, [Coordinate::Screw(node), Coordinate::Table], &[w])
    };
    let zero = ask(0.6, 3, 0.0).unwrap_err();
    assert!(matches!(zero, DriveError::Singular { .. }));
    assert!(zero.to_string().contains("0 rad/s"));
    let node = ask(0.6, 11, 1.0).unwrap_err().to_string();
    assert!(node.contains("screw node = 11"), "{node}");
    let off = ask(1.6, 3, 1.0).unwrap_err().to_string();
    assert!(off.contains("1.6 m") && off.contains("1.5 m"), "{off}");
}
