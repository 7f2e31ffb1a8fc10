//! Trajectory 1, millisecond by millisecond, against an independent program.

use std::path::PathBuf;

use axis_sim::ClosedLoop;

use crate::{PRINTED, axis, follow};

#[test]
fn trajectory_1_of_the_independent_program() {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/golden/trajectory1_published.csv");
    let Ok(golden) = std::fs::read_to_string(&file) else {
        println!("skipped: {} is not there", file.display());
        return;
    };
    let cycles = follow(&ClosedLoop::new(&axis(PRINTED)).unwrap(), 1);
    let mut lines = golden.lines();
    assert_eq!(
        lines.next(),
        Some("t_s,position_ref_m,position_m,motor_angle_rad,motor_speed_rad_s,iq_a")
    );
    let mut most = [0.0_f64; 5];
    let mut rows = 0;
    for (i, line) in lines.enumerate() {
        let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        let c = &cycles[10 * i];
        assert!((c.time - row[0]).abs() < 1e-9);
        let ours = [
            c.reference.position,
            c.position,
            c.motor_angle,
            c.motor_speed,
            c.current.q,
        ];
        for (most, (a, b)) in most.iter_mut().zip(ours.iter().zip(&row[1..])) {
            *most = most.max((a - b).abs());
        }
        rows += 1;
    }
    println!("{rows} rows; greatest deviations of reference, position, angle, speed, iq: {most:?}");
    assert_eq!(rows, 3632);
    // The file has 12 decimals of a metre. Measured are 4.8e-13 m, 2.6e-10 m,
    // 1.5e-7 rad, 3.4e-6 rad/s and 1.2e-5 A.
    assert!(most[0] < 2e-12, "{most:?}");
    assert!(most[1] < 1e-9 && most[2] < 1e-6, "{most:?}");
    assert!(most[3] < 2e-5 && most[4] < 6e-5, "{most:?}");
}
