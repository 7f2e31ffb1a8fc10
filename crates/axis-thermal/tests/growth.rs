//! Growth and force against closed forms. States of even temperature come from bodies at rest in
//! air of that temperature.

use axis_thermal::{
    Expansions, Growth, HeatNode, ScrewEnds, ThermalModel, ThermalParameters, ThermalScrew,
    ThermalState,
};

const RIGIDITY: f64 = 206e9 * std::f64::consts::FRAC_PI_4 * 0.04 * 0.04;

fn model(ends: ScrewEnds, shaft: f64) -> ThermalModel {
    let screw = ThermalScrew {
        ends,
        shaft,
        ..ThermalScrew::default()
    };
    ThermalModel::new(ThermalParameters {
        screw: Some(screw),
        ..ThermalParameters::default()
    })
    .unwrap()
}

fn both(bearing_stiffness: f64) -> ScrewEnds {
    ScrewEnds::BothFixed {
        rigidity: RIGIDITY,
        bearing_stiffness,
        pretension: 8000.0,
    }
}

/// α ΔT (l + x); a scale α_s ΔT (x − x_f) + α_b ΔT x_f; a bed α_b ΔT x.
#[test]
fn an_even_temperature_gives_alpha_dt_x() {
    let parameters = ThermalParameters {
        expansion: Expansions {
            scale: 8e-6,
            scale_fixed_at: 0.5,
            bed: 10e-6,
        },
        ..ThermalParameters::default()
    };
    let model = ThermalModel::new(parameters).unwrap();
    let [cold, warm] = [20.0, 27.0].map(|t| model.at_rest(t));
    for x in [0.0, 0.013, 0.3, 0.9999, 1.5] {
        let Growth { screw, scale, bed } = model.growth(&cold, &warm, x);
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-17, "{x}");
        near(screw, 11.5e-6 * 7.0 * (0.08 + x));
        near(scale, 8e-6 * 7.0 * (x - 0.5) + 10e-6 * 7.0 * 0.5);
        near(bed, 10e-6 * 7.0 * x);
    }
    assert_eq!(model.thermal_force(&cold, &warm), None);
}

/// Between rigid bearings on a bed that does not grow F = E A α ΔT, and no place moves.
#[test]
fn a_screw_between_rigid_walls_presses_with_ea_alpha_dt() {
    let mut parameters = model(both(1e13), 0.0).parameters().clone();
    parameters.expansion.bed = 0.0;
    let model = ThermalModel::new(parameters).unwrap();
    let [cold, warm] = [20.0, 40.0].map(|t| model.at_rest(t));
    let force = model.thermal_force(&cold, &warm).unwrap();
    let expected = RIGIDITY * 11.5e-6 * 20.0;
    // The bearings give way by 2e-13 m/N, the screw by 5.8e-9.
    assert!(
        (force.compression / expected - 1.0).abs() < 1e-4,
        "{force:?} {expected}"
    );
    assert!((force.compression + force.tension - 8000.0).abs() < 1e-9);
    for x in [0.0, 0.4, 1.5] {
        let growth = model.growth(&cold, &warm, x).screw;
        assert!(growth.abs() < 1e-8, "{x}: {growth}");
    }
}

/// 40.8 kN at 20 K and 750 N/µm: α ΔT L/(L/(E A) + 2/k). The ends move outward by F/k, alike.
#[test]
fn bearings_that_give_way_are_springs_in_series() {
    let mut parameters = model(both(750e6), 0.0).parameters().clone();
    parameters.expansion.bed = 0.0;
    let model = ThermalModel::new(parameters).unwrap();
    let [cold, warm] = [20.0, 40.0].map(|t| model.at_rest(t));
    let force = model.thermal_force(&cold, &warm).unwrap().compression;
    let expected = 11.5e-6 * 20.0 * 1.5 / (1.5 / RIGIDITY + 2.0 / 750e6);
    assert!(
        (force / expected - 1.0).abs() < 1e-12 && (force - 40.8e3).abs() < 200.0,
        "{force}"
    );
    let end = |x| model.growth(&cold, &warm, x).screw;
    assert!((end(0.0) + force / 750e6).abs() < 1e-12);
    assert!((end(1.5) - force / 750e6).abs() < 1e-12);
    assert!(end(0.75).abs() < 1e-12);
}

/// A bed that grows as the screw does takes all force away; each place moves with the bed.
#[test]
fn a_bed_that_grows_alike_leaves_no_force() {
    let mut parameters = model(both(500e6), 0.1).parameters().clone();
    parameters.expansion.bed = 11.5e-6;
    let model = ThermalModel::new(parameters).unwrap();
    let [cold, warm] = [20.0, 35.0].map(|t| model.at_rest(t));
    assert!(model.thermal_force(&cold, &warm).unwrap().compression.abs() < 1e-6);
    let growth = model.growth(&cold, &warm, 1.0).screw;
    assert!((growth - 11.5e-6 * 15.0 * 1.1).abs() < 1e-15);
}

/// Growth is counted from any state, and adds up.
#[test]
fn growth_adds_up_from_state_to_state() {
    let model = model(ScrewEnds::OneFixed, 0.08);
    let mut duty = model.duty();
    duty.push(&axis_thermal::DutySample {
        duration: 1.0,
        position: 0.6,
        screw_speed: 100.0,
        dry_power: 60.0,
        viscous_power: 200.0,
        ..Default::default()
    });
    let at_work = model.under(&duty).unwrap();
    let cold = model.at_rest(20.0);
    let mut states: Vec<ThermalState> = vec![cold.clone()];
    for _ in 0..3 {
        let mut next = states.last().unwrap().clone();
        at_work.run(&mut next, 22.0, 600.0).unwrap();
        states.push(next);
    }
    let at = 1.1;
    let steps = states
        .windows(2)
        .map(|two| model.growth(&two[0], &two[1], at).screw);
    let whole = model.growth(&cold, &states[3], at).screw;
    assert!((steps.sum::<f64>() - whole).abs() < 1e-15 && whole > 20e-6);
    assert!(states[3].of(HeatNode::Nut) > 22.0);
}
