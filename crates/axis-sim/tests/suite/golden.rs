//! Trajectory 1, instant by instant, against programs that share no code with
//! the crates.

use axis_sim::{ClosedLoop, Cycle};

use crate::obvious::{EVERY, HEADER, PERIOD, STEPS, duration, line, simulate};
use crate::{PRINTED, axis, errors_um, follow};

const COMMITTED: &str = include_str!("../reference/trajectory1.csv");

fn cycles() -> Vec<Cycle> {
    follow(&ClosedLoop::new(&axis(PRINTED)).unwrap(), 1)
}

/// Rows of six numbers: time, reference, position, angle, speed, q current.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEADER));
    let row = |line: &str| line.split(',').map(|v| v.parse().unwrap()).collect();
    lines.filter(|l| !l.starts_with('#')).map(row).collect()
}

/// Greatest deviations of reference, position, angle, speed and current; the
/// rows are `every` cycles apart.
fn deviations(cycles: &[Cycle], rows: &[Vec<f64>], every: usize) -> [f64; 5] {
    let mut most = [0.0_f64; 5];
    for (i, row) in rows.iter().enumerate() {
        let c = &cycles[every * i];
        assert!((c.time - row[0]).abs() < 1e-9);
        let ours = [
            c.reference.position,
            c.position,
            // From where the motion began, on a motor whose angle is absolute.
            c.motor_angle - cycles[0].motor_angle,
            c.motor_speed,
            c.current.q,
        ];
        for (most, (a, b)) in most.iter_mut().zip(ours.iter().zip(&row[1..])) {
            *most = most.max((a - b).abs());
        }
    }
    most
}

#[test]
fn the_committed_reference_is_what_the_obvious_program_gives() {
    let mut text = format!("{HEADER}\n");
    let mut k = 0;
    simulate(10_000, STEPS, |row| {
        if k % EVERY == 0 {
            text += &(line(row) + "\n");
        }
        k += 1;
    });
    let (now, committed) = (rows(&text), rows(COMMITTED));
    assert_eq!(now.len(), 200);
    assert_eq!(committed.len(), (duration() / PERIOD) as usize / EVERY + 1);
    // The exponential of another platform may differ in its last bit; here
    // every digit is the same.
    for (a, b) in now.iter().zip(&committed) {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-8 * b.abs().max(1e-3);
        assert!(a.iter().zip(b).all(near), "{a:?} {b:?}");
    }
}

#[test]
fn trajectory_1_of_the_obvious_program() {
    let cycles = cycles();
    // 0.6 m of a lead of 10 mm.
    let turned = 60.0 * std::f64::consts::TAU;
    assert!((cycles[0].motor_angle - turned).abs() < 1e-12 * turned);
    let most = deviations(&cycles, &rows(COMMITTED), EVERY);
    println!("obvious program: reference, position, angle, speed, iq within {most:?}");
    // Measured 4.9e-14 m (the file has 13 decimals), 2.5e-10 m, 1.7e-7 rad,
    // 3.2e-6 rad/s, 1.1e-5 A.
    assert!(most[0] < 2e-13, "{most:?}");
    assert!(most[1] < 1e-9, "{most:?}");
    assert!(most[2] < 1e-6, "{most:?}");
    assert!(most[3] < 2e-5, "{most:?}");
    assert!(most[4] < 1e-4, "{most:?}");

    let figure = |name: &str| -> f64 {
        let line = COMMITTED.lines().find_map(|l| l.strip_prefix(name));
        1e6 * line.unwrap().parse::<f64>().unwrap()
    };
    let expected = [figure("# error_max_m,"), figure("# error_mean_m,")];
    let ours = errors_um(&cycles);
    println!("error {ours:?}, obvious program {expected:?} µm");
    // Measured 1.3e-4 and 4.6e-5 µm.
    assert!((ours[0] - expected[0]).abs() < 1e-3, "{ours:?}");
    assert!((ours[1] - expected[1]).abs() < 3e-4, "{ours:?}");
}

#[test]
fn trajectory_1_of_the_independent_program() {
    // The log of a program that is not published, every millisecond, with the columns of HEADER. The comparison with
    // tests/reference/trajectory1.csv needs nothing.
    let Some(file) = crate::needs::shared("golden/trajectory1_published.csv") else {
        return;
    };
    let rows = rows(&std::fs::read_to_string(file).unwrap());
    assert_eq!(rows.len(), 3632);
    let most = deviations(&cycles(), &rows, 10);
    println!("independent program: reference, position, angle, speed, iq within {most:?}");
    // Measured 5e-13 m (the file has 12 decimals), 2.6e-10 m, 1.5e-7 rad,
    // 3.4e-6 rad/s, 1.2e-5 A.
    assert!(most[0] < 2e-12, "{most:?}");
    assert!(most[1] < 1e-9, "{most:?}");
    assert!(most[2] < 1e-6, "{most:?}");
    assert!(most[3] < 2e-5, "{most:?}");
    assert!(most[4] < 1e-4, "{most:?}");
}
