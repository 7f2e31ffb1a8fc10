//! Temperatures against closed forms.

use axis_thermal::{
    Duty, DutySample, FrictionLaws, FrictionShares, HeatNode, ScrewAir, TemperatureLaw,
    ThermalAccuracy, ThermalBody, ThermalError, ThermalLinks, ThermalModel, ThermalParameters,
    ThermalScrew,
};

const NO_LINKS: ThermalLinks = ThermalLinks {
    winding_to_housing: 0.0,
    housing_to_front_bearing: 0.0,
    housing_to_table: 0.0,
    housing_to_bed: 0.0,
    front_bearing_to_bed: 0.0,
    rear_bearing_to_bed: 0.0,
    front_bearing_to_screw: 0.0,
    rear_bearing_to_screw: 0.0,
    nut_to_screw: 0.0,
    nut_to_table: 0.0,
    table_to_bed: 0.0,
    scale_to_bed: 0.0,
};

/// A table alone that takes all friction.
fn table(capacity: f64, to_air: f64, friction: FrictionLaws) -> ThermalParameters {
    let mut p = ThermalParameters::without_screw();
    p.links = NO_LINKS;
    p.bodies.table = ThermalBody { capacity, to_air };
    p.shares.guide_into_table = 1.0;
    p.friction = friction;
    p
}

/// So much viscous and dry power without end, at the middle of the screw.
fn power(model: &ThermalModel, [dry, viscous]: [f64; 2]) -> Duty {
    let mut duty = model.duty();
    duty.push(&DutySample {
        duration: 1.0,
        position: 0.75,
        dry_power: dry,
        viscous_power: viscous,
        ..DutySample::default()
    });
    duty
}

/// T = T_a + P/g (1 − exp(−g t/C)).
#[test]
fn a_body_warms_up_by_a_step_response_of_first_order() {
    let model = ThermalModel::new(table(2000.0, 4.0, FrictionLaws::CONSTANT)).unwrap();
    let at_work = model.under(&power(&model, [25.0, 35.0])).unwrap();
    let mut state = model.at_rest(18.0);
    for k in 1..=20 {
        at_work.run(&mut state, 18.0, 100.0).unwrap();
        let t = 100.0 * f64::from(k);
        let expected = 18.0 + 15.0 * (1.0 - (-t / 500.0_f64).exp());
        assert!((state.of(HeatNode::Table) - expected).abs() < 1e-11, "{t}");
        assert_eq!(state.time, t);
    }
}

/// Air that warms up by r a second: the body lags it by r C/g.
#[test]
fn a_ramp_of_the_air_is_exact() {
    let model = ThermalModel::new(table(2000.0, 4.0, FrictionLaws::CONSTANT)).unwrap();
    let at_work = model.under(&power(&model, [0.0, 0.0])).unwrap();
    let mut state = model.at_rest(20.0);
    let accuracy = ThermalAccuracy::default();
    let rate = 1e-3;
    let air = |t: f64| 20.0 + rate * t;
    at_work.run_in(&mut state, air, 1700.0, &accuracy).unwrap();
    let lag = 500.0 * (1.0 - (-1700.0_f64 / 500.0).exp());
    let expected = 20.0 + rate * (1700.0 - lag);
    assert!((state.of(HeatNode::Table) - expected).abs() < 1e-11);
}

/// Without any loss C Ṫ = P exp(−c (T − T₀)): T = T₀ + ln(1 + c P t/C)/c. The tolerance is a bound on
/// the steps' differences; what is kept is better by an order.
#[test]
fn friction_that_falls_with_temperature_follows_its_integral() {
    let law = FrictionLaws {
        viscous: TemperatureLaw::Exponential { per_kelvin: 0.03 },
        ..FrictionLaws::CONSTANT
    };
    let model = ThermalModel::new(table(1000.0, 0.0, law)).unwrap();
    let at_work = model.under(&power(&model, [0.0, 50.0])).unwrap();
    let mut errors = Vec::new();
    for tolerance in [5e-2, 5e-3, 5e-4] {
        let mut state = model.at_rest(20.0);
        let accuracy = ThermalAccuracy {
            tolerance,
            ..ThermalAccuracy::default()
        };
        at_work
            .run_in(&mut state, |_| 20.0, 3600.0, &accuracy)
            .unwrap();
        let expected = 20.0 + (1.0_f64 + 0.03 * 50.0 * 3600.0 / 1000.0).ln() / 0.03;
        errors.push((state.of(HeatNode::Table) - expected).abs());
    }
    // Measured: 4.9e-3, 5.4e-4, 5.6e-5 K of 62: the error follows the tolerance.
    let [coarse, usual, fine] = errors[..] else {
        panic!()
    };
    assert!(coarse < 0.01 && usual < 1e-3 && fine < 1e-4, "{errors:?}");
}

/// A bar heated at one end, air around it: θ = P cosh(m (L − x))/(k A m sinh(m L)), m² = 4 h/(k D)
/// (Incropera, DeWitt, Fundamentals of Heat and Mass Transfer, 6th ed., table 3.4, case B, with the flux at the
/// base in the place of its temperature).
#[test]
fn a_screw_that_a_bearing_heats_is_a_fin() {
    let screw = ThermalScrew {
        segments: 150,
        air: ScrewAir {
            still: 12.0,
            turning: 0.0,
        },
        ..ThermalScrew::default()
    };
    let mut p = ThermalParameters {
        screw: Some(screw),
        links: ThermalLinks {
            front_bearing_to_screw: 6.0,
            ..NO_LINKS
        },
        friction: FrictionLaws::CONSTANT,
        ..ThermalParameters::default()
    };
    let none = FrictionShares {
        dry: 0.0,
        viscous: 0.0,
    };
    p.shares.nut = none;
    p.shares.bearings = FrictionShares {
        dry: 1.0,
        viscous: 1.0,
    };
    p.shares.front_of_bearings = 1.0;
    let model = ThermalModel::new(p).unwrap();
    let heat = 20.0;
    let at_work = model.under(&power(&model, [heat, 0.0])).unwrap();
    let cold = model.at_rest(20.0);
    let mut state = cold.clone();
    at_work.run(&mut state, 20.0, 1e6).unwrap();
    let area = std::f64::consts::FRAC_PI_4 * 0.04_f64.powi(2);
    let m = (4.0 * 12.0 / (46.0 * 0.04_f64)).sqrt();
    let theta = |x: f64| heat * (m * (1.5 - x)).cosh() / (46.0 * area * m * (m * 1.5).sinh());
    for (i, temperature) in state.screw().iter().enumerate() {
        let expected = 20.0 + theta((i as f64 + 0.5) * 0.01);
        // Of the grid: 2 (cosh(m'Δx) − 1) = (m Δx)², so m' is m less the share (m Δx)²/24.
        let x = (i as f64 + 0.5) * 0.01;
        let close = (m * 0.01).powi(2) / 24.0 * (1.0 + m * x) * (expected - 20.0);
        assert!(
            (temperature - expected).abs() < close,
            "{i}: {temperature} {expected}"
        );
    }
    // All heat leaves into the air: α P/(h π D) is the growth of the whole screw.
    let shaft = 0.08 * 11.5e-6 * (state.of(HeatNode::FrontBearing) - 20.0);
    let whole = model.growth(&cold, &state, 1.5).screw - shaft;
    let expected = 11.5e-6 * heat / (12.0 * std::f64::consts::PI * 0.04);
    assert!((whole / expected - 1.0).abs() < 1e-9, "{whole} {expected}");
    // The last half segment is a straight line: θ″ Δx²/8 more, and (m Δx)²/24 of the bar.
    let base = state.of(HeatNode::FrontBearing) - 20.0;
    let expected = theta(0.0) + heat / 6.0;
    let close = (m * 0.01).powi(2) / 6.0 * theta(0.0);
    assert!((base - expected).abs() < close, "{base} {expected}");
}

/// Nothing is lost where nothing goes to the air: Σ C ΔT = ∫ P dt.
#[test]
fn heat_is_kept() {
    let mut p = ThermalParameters::default();
    let bodies = &mut p.bodies;
    for body in [
        &mut bodies.housing,
        &mut bodies.nut,
        &mut bodies.table,
        &mut bodies.bed,
        &mut bodies.scale,
    ] {
        body.to_air = 0.0;
    }
    p.friction = FrictionLaws::CONSTANT;
    p.winding.per_torque_squared = 0.4;
    p.winding.resistance_per_kelvin = 0.0;
    let screw = p.screw.as_mut().unwrap();
    screw.air = ScrewAir {
        still: 0.0,
        turning: 0.0,
    };
    let bar = 7850.0 * 460.0 * std::f64::consts::FRAC_PI_4 * 0.04_f64.powi(2) * 1.5;
    let bodies = p.bodies;
    let model = ThermalModel::new(p).unwrap();
    let mut duty = model.duty();
    for (position, torque) in [(0.01, 5.0), (0.7, 0.0), (1.49, -3.0)] {
        duty.push(&DutySample {
            duration: 2.0,
            position,
            screw_speed: 30.0,
            dry_power: 40.0,
            viscous_power: 25.0,
            torque: [torque, 1.0, 0.5],
        });
    }
    // 0.4 W/(N·m)² times the mean of 6.5², 1.5² and 1.5².
    let winding = 0.4 * (6.5_f64.powi(2) + 2.0 * 1.5_f64.powi(2)) / 3.0;
    let at_work = model.under(&duty).unwrap();
    let mut state = model.at_rest(20.0);
    let losses = at_work.losses(&state);
    assert!((losses.winding - winding).abs() < 1e-12, "{losses:?}");
    assert!(
        (losses.total() - winding - 65.0).abs() < 1e-11,
        "{losses:?}"
    );
    at_work.run(&mut state, 5.0, 7200.0).unwrap();
    let all = [
        bodies.winding,
        bodies.housing,
        bodies.front_bearing,
        bodies.rear_bearing,
        bodies.nut,
        bodies.table,
        bodies.bed,
        bodies.scale,
    ];
    let stored = HeatNode::ALL.iter().zip(all);
    let stored: f64 = stored
        .map(|(n, body)| body.capacity * (state.of(*n) - 20.0))
        .sum();
    let of_screw = state.screw().iter().map(|t| (t - 20.0) * bar / 60.0);
    let stored = stored + of_screw.sum::<f64>();
    let given = 7200.0 * losses.total();
    assert!((stored / given - 1.0).abs() < 1e-11, "{stored} {given}");
}

/// One run, or many: the same state, as far as the tolerance goes. Measured: 0.13 mK.
#[test]
fn a_run_may_be_divided() {
    let model = ThermalModel::new(ThermalParameters::default()).unwrap();
    let at_work = model.under(&power(&model, [60.0, 300.0])).unwrap();
    let [mut whole, mut parts] = [model.at_rest(20.0), model.at_rest(20.0)];
    let work = at_work.run(&mut whole, 20.0, 7200.0).unwrap();
    for _ in 0..720 {
        at_work.run(&mut parts, 20.0, 10.0).unwrap();
    }
    let nut = |state: &axis_thermal::ThermalState| state.of(HeatNode::Nut);
    assert!((nut(&whole) - nut(&parts)).abs() < 1e-3);
    // Measured: 150 steps.
    assert!(work.steps <= 200, "{work:?}");
}

/// A day's steps are few: they grow as the temperatures settle.
#[test]
fn a_day_takes_few_steps() {
    let model = ThermalModel::new(ThermalParameters::default()).unwrap();
    let at_work = model.under(&power(&model, [60.0, 300.0])).unwrap();
    let mut state = model.at_rest(20.0);
    let work = at_work.run(&mut state, 20.0, 86_400.0).unwrap();
    assert!(work.steps < 600 && work.repeated < 20, "{work:?}");
}

#[test]
fn losses_that_run_away_are_refused() {
    let law = FrictionLaws {
        viscous: TemperatureLaw::Exponential { per_kelvin: -0.1 },
        ..FrictionLaws::CONSTANT
    };
    let model = ThermalModel::new(table(1000.0, 1.0, law)).unwrap();
    let at_work = model.under(&power(&model, [0.0, 50.0])).unwrap();
    let error = at_work
        .run(&mut model.at_rest(20.0), 20.0, 3600.0)
        .unwrap_err();
    assert!(matches!(error, ThermalError::RunsAway { .. }), "{error}");
    assert!(error.to_string().contains("valid"), "{error}");
}
