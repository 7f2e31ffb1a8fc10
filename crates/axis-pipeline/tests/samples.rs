//! Samples and their file.

use axis_pipeline::LinearMap;
use axis_pipeline::sample_file::{SampleFileError, read, write};
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity, ranges};
use axis_pipeline::training::{NetworkPlan, residuals, train};
use axis_sim::Axis;

fn axis() -> Axis {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    Axis::read(file.as_ref()).unwrap()
}

fn sampler(count: usize, density: SpeedDensity) -> Sampler {
    let plan = SamplePlan {
        count,
        seed: 5,
        density,
    };
    Sampler::new(&axis(), &plan).unwrap()
}

#[test]
fn any_rows_are_those_of_the_whole() {
    let sampler = sampler(500, SpeedDensity::Uniform);
    let whole = sampler.all().unwrap();
    let part = sampler.rows(123..321).unwrap();
    assert_eq!(part.inputs, whole.inputs[123..321]);
    assert_eq!(part.increments, whole.increments[123..321]);
}

#[test]
fn the_dense_speeds_stay_in_range_and_do_not_reverse() {
    let axis = axis();
    let set = sampler(4000, SpeedDensity::NearZero { scale: 3e-3 })
        .all()
        .unwrap();
    let range = ranges(&axis).unwrap().speed;
    // What a moved sample may gain: one cycle's change of speed.
    let change = ranges(&axis).unwrap().acceleration.most * axis.period;
    for input in &set.inputs {
        assert!(input.speed >= range.least - change && input.speed <= range.most + change);
        assert!(input.speed * (input.speed + input.acceleration * axis.period) >= -1e-18);
    }
    // asinh(3/3)/asinh(333/3) = 16 % lie within the scale, of an even design 0.9 %.
    let slow = set
        .inputs
        .iter()
        .filter(|input| input.speed.abs() < 3e-3)
        .count();
    assert!((600..700).contains(&slow), "{slow}");
}

#[test]
fn a_file_comes_back_bit_for_bit_and_damage_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("some.samples");
    let axis = axis();
    let sampler = sampler(50, SpeedDensity::Uniform);
    let mut rows = 0;
    write(&path, &sampler, &axis.fingerprint, |n| rows += n).unwrap();
    assert_eq!(rows, 50);
    assert_eq!(
        read(&path, &axis.fingerprint).unwrap(),
        sampler.all().unwrap()
    );

    let whole = std::fs::read(&path).unwrap();
    let refused = |bytes: &[u8], fingerprint: &str| {
        std::fs::write(&path, bytes).unwrap();
        match read(&path, fingerprint) {
            Err(SampleFileError::Refused { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    };
    for byte in 0..whole.len() {
        let mut flipped = whole.clone();
        flipped[byte] ^= 4;
        refused(&flipped, &axis.fingerprint);
    }
    for length in 0..whole.len() {
        refused(&whole[..length], &axis.fingerprint);
    }
    assert!(refused(&whole, "another").contains("another axis file"));
}

/// Folding the linear map into the direct links changes nothing but rounding:
/// with no epoch run, the network's residuals are those of map and start.
#[test]
fn a_folded_network_is_map_plus_residual() {
    let axis = axis();
    let set = sampler(300, SpeedDensity::NearZero { scale: 3e-3 })
        .all()
        .unwrap();
    let plan = NetworkPlan {
        hidden: vec![5, 3],
        epochs: 30,
        initial_damping: 0.97,
        seed: 2,
        threads: 1,
    };
    let trained = train(&ranges(&axis).unwrap(), &set, &plan, None, |_, _| {}).unwrap();
    let left = residuals(&trained.network, &set).unwrap();
    let rms = (left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64).sqrt();
    // The trainer saw the residual network, scaled by the map's own residual.
    let told = trained.residual_scale * trained.history.last().unwrap().loss.sqrt();
    // Increments reach 33 µm: folding rounds at some 1e-20 m.
    assert!((rms - told).abs() < 1e-18, "{rms:e} {told:e}");
    let map = LinearMap::fit(&set).unwrap();
    assert!(rms < rms_of(&map.residuals(&set)));
}

#[test]
fn a_linear_map_is_found_exactly() {
    let mut set = sampler(40, SpeedDensity::Uniform).all().unwrap();
    set.increments = (set.inputs.iter())
        .map(|i| 2.0 + 3.0 * i.position - i.speed + 0.5 * i.acceleration + 0.25 * i.command)
        .collect();
    let map = LinearMap::fit(&set).unwrap();
    assert!((map.offset - 2.0).abs() < 1e-13);
    for (found, truth) in map.slopes.iter().zip([3.0, -1.0, 0.5, 0.25]) {
        assert!((found - truth).abs() < 1e-12, "{found} {truth}");
    }
    set.inputs.truncate(4);
    set.increments.truncate(4);
    assert!(LinearMap::fit(&set).is_err());
}

fn rms_of(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}
