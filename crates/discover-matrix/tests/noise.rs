//! The noise of hidden machines beside that which the search supposes.

use axis_sim::Measured;
use discover_matrix::hidden::{Noise, supposed};

fn drawn(mut sensors: impl FnMut(&mut Measured), n: usize) -> Vec<f64> {
    let one = |_| {
        let mut seen = Measured::default();
        sensors(&mut seen);
        let currents = [seen.current.d, seen.current.q];
        [seen.position, seen.motor_angle, seen.motor_speed]
            .into_iter()
            .chain(currents)
    };
    (0..n).flat_map(one).collect()
}

/// Truth and model agree on how large noise is, and on no number of it.
#[test]
fn the_search_does_not_know_the_noise_of_a_seed() {
    let (seed, n) = (8, 40_000);
    let unit = Noise {
        position: 1.0,
        angle: 1.0,
        speed: 1.0,
        current: 1.0,
    };
    let truth = drawn(unit.sensors(seed), n);
    let model = drawn(supposed(unit).sensors(seed), n);
    let power = |all: &[f64]| all.iter().map(|z| z * z).sum::<f64>() / all.len() as f64;
    let scatter = 4.0 / (truth.len() as f64).sqrt();
    assert!((power(&truth) / power(&model) - 1.0).abs() < 2.0 * scatter);
    for lag in 0..8 {
        let pairs = truth.iter().zip(&model[lag..]).map(|(a, b)| a * b);
        let along = pairs.sum::<f64>() / truth.len() as f64;
        assert!(along.abs() < scatter, "{lag}: {along}");
    }
}
