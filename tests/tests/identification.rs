//! Friction identified on the whole simulated axis, against the truth.

use axis_pipeline::identification::{IdentificationPlan, Identified, identify};
use axis_sim::Axis;

fn axis(name: &str) -> Axis {
    let file = format!("{}/../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}

fn identified(axis: &Axis, seed: u64) -> Identified {
    let plan = IdentificationPlan {
        seed,
        ..IdentificationPlan::default()
    };
    identify(axis, &plan, || {}).unwrap()
}

#[test]
fn all_six_parameters_are_found_on_both_axes() {
    for name in ["liu2025", "liu2025-machine"] {
        let axis = axis(name);
        let truth = axis.friction.law.parameters();
        for seed in 0..3 {
            let found = identified(&axis, seed).parameters;
            let close = |what: &str, found: f64, truth: f64, share: f64| {
                let off = (found / truth - 1.0).abs();
                assert!(
                    off <= share,
                    "{name}, seed {seed}: {what} is off by {off:.4}"
                );
            };
            // The project's own targets for 1 % torque noise.
            close("T_C", found.coulomb, truth.coulomb, 0.02);
            close("σ2", found.viscous, truth.viscous, 0.02);
            close("T_S", found.stiction, truth.stiction, 0.05);
            close("Ω_S", found.stribeck_speed, truth.stribeck_speed, 0.05);
            close("σ0", found.stiffness, truth.stiffness, 0.05);
            close("σ1", found.damping, truth.damping, 0.15);
        }
    }
}

#[test]
fn runs_in_which_the_axis_vibrates_are_left_out() {
    let axis = axis("liu2025");
    let found = identified(&axis, 0);
    let r = axis.travel_per_radian();
    for left in &found.statics.left_out {
        let speed = 1e3 * r * found.runs[left.run].speed.abs();
        // The axis vibrates by itself from about 3 to 7 mm/s.
        assert!((2.5..8.0).contains(&speed), "{speed} mm/s: {}", left.reason);
    }
    for speed in [4.0, 5.0, 6.0] {
        let out = found.statics.left_out.iter().filter(|left| {
            let own = 1e3 * r * found.runs[left.run].speed.abs();
            (own - speed).abs() < 0.2
        });
        assert_eq!(out.count(), 2, "{speed} mm/s, both ways");
    }
}

/// The parameters' errors in units of their standard errors, over noise seeds.
#[test]
fn standard_errors_cover_the_truth() {
    let axis = axis("liu2025-machine");
    let truth = axis.friction.law.parameters();
    let mut within_two = 0;
    let mut total = 0;
    for seed in 100..110 {
        let found = identified(&axis, seed);
        let (s, p) = (found.statics, found.presliding);
        let pairs = [
            (p.stiffness, truth.stiffness),
            (p.damping, truth.damping),
            (s.coulomb, truth.coulomb),
            (s.stiction, truth.stiction),
            (s.stribeck_speed, truth.stribeck_speed),
            (s.viscous, truth.viscous),
        ];
        for (estimate, truth) in pairs {
            total += 1;
            within_two += u32::from(estimate.covers(truth, 2.0));
            assert!(
                estimate.covers(truth, 5.0),
                "seed {seed}: {estimate:?}, truth {truth}"
            );
        }
    }
    // 95 % expected of 60, correlated by sixes: at least 80 %.
    assert!(within_two * 10 >= total * 8, "{within_two} of {total}");
}
