//! What is no part is refused in words.

use axis_rating::{
    BeltTeeth, DcLink, MotorVoltage, PowerCourse, Rating, Regeneration, RollingElement,
    ScrewMounting, ScrewStrength, TorqueCurve, WindingModel, belt, life, motor, preload, screw,
};

const WRONG: [f64; 4] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0];

#[test]
fn numbers_of_no_part_are_refused() {
    for x in WRONG {
        assert!(motor::speed(x, 1.0).is_err() && motor::speed(1.0, x).is_err());
        assert!(motor::inertia_ratio(1.0, x, 1.0).is_err());
        assert!(TorqueCurve::constant(x).is_err());
        assert!(TorqueCurve::new(vec![[0.0, x]]).is_err());
        assert!(TorqueCurve::new(vec![[x, 1.0]]).is_err());
        assert!(screw::dn_value(x, 1.0, 1.0).is_err());
        assert!(life::nominal_life(1e6, x, 1.0, RollingElement::Ball).is_err());
        assert!(life::nominal_life(1e6, 1.0, x, RollingElement::Ball).is_err());
        assert!(life::life_h(1.0, x).is_err() && life::life(1.0, x).is_err());
        assert!(life::static_safety(x, 1.0, 1.0).is_err());
        assert!(life::equivalent_load_n(1.0, x, [1.0, 1.0]).is_err());
        assert!(preload::preloaded_n(1.0, x, RollingElement::Ball).is_err());
        assert!(belt::cord_load(1.0, x, 1.0).is_err());
        assert!(Regeneration::default().energy(x).is_err());
        let steel = ScrewStrength {
            root_diameter_m: x,
            youngs_modulus_pa: 2e11,
            density_kg_per_m3: 7850.0,
            mounting: ScrewMounting::FixedFree,
        };
        assert!(steel.buckling(1.0, 1.0, 0.5).is_err());
        assert!(steel.critical_speed(1.0, 1.0, 0.8).is_err());
        let teeth = BeltTeeth {
            force_per_width_n_per_m: 1.0,
            width_m: x,
            in_mesh: 6.0,
        };
        assert!(teeth.tooth_load(1.0).is_err());
        let motor = MotorVoltage {
            resistance_ohm: 1.0,
            inductance_d_h: 1e-3,
            inductance_q_h: 1e-3,
            flux_v_s: x,
            electrical_per_motor: 4.0,
            dc_link_v: 540.0,
        };
        assert!(motor.base_speed_rad_per_s(1.0).is_err() && motor.back_emf(1.0, 800.0).is_err());
        let winding = WindingModel {
            thermal_resistance_k_per_w: x,
            time_constant_s: 1.0,
            ambient_deg_c: 20.0,
            reference_deg_c: 20.0,
            resistance_rise_per_k: 0.0,
        };
        assert!(winding.rise(&PowerCourse::default(), 100.0).is_err());
    }
}

#[test]
fn messages_say_what_would_be_valid() {
    let link = DcLink {
        capacitance_f: 1e-3,
        voltage_v: 700.0,
        brake_on_v: 650.0,
    };
    let message = link.capacitor_energy_j().unwrap_err().to_string();
    assert_eq!(
        message,
        "brake_on_v, less voltage_v, is -50; valid: a finite number, 0 or above"
    );
    for points in [vec![], vec![[1.0, 2.0], [1.0, 1.0]], vec![[0.0, 0.0]]] {
        let message = TorqueCurve::new(points).unwrap_err().to_string();
        assert!(message.contains("at least one point"), "{message}");
    }
}

#[test]
fn a_value_that_is_no_number_keeps_no_limit() {
    let good = Rating::at_most(1.0, 2.0, "N");
    let none = Rating::at_most(f64::NAN, 2.0, "N");
    assert!(!none.holds() && !Rating::at_least(f64::NAN, 2.0, "h").holds());
    assert!(good.worse(none).value.is_nan());
    assert!(Rating::at_most(0.0, 2.0, "N").margin().is_infinite());
    assert!(Rating::at_least(f64::INFINITY, 2.0, "h").holds());
}
