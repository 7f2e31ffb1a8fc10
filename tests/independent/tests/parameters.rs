//! The parameters are those of the axis file that the logs are compared with.

use independent_axis::{Parameters, Random};
use toml::{Table, Value};

const RPM: f64 = std::f64::consts::PI / 30.0;

#[test]
#[expect(clippy::too_many_lines, reason = "a table: one line a number")]
fn parameters_are_those_of_the_axis_file() {
    let file = include_str!("../../../data/axes/liu2025.toml");
    let file: Table = file.parse().unwrap();
    let p = Parameters::paper();
    let same = |table: &str, key: &str, unit: f64, own: f64| {
        let told = match &file[table][key] {
            Value::Integer(whole) => *whole as f64,
            other => other.as_float().unwrap(),
        };
        assert!((told * unit / own - 1.0).abs() < 1e-12, "{table}.{key}");
    };
    same("mechanism", "length_mm", 1e-3, p.screw_length);
    same("mechanism", "diameter_mm", 1e-3, p.screw_diameter);
    same("mechanism", "lead_mm", 1e-3, p.lead);
    same("mechanism", "youngs_modulus_gpa", 1e9, p.youngs_modulus);
    same("mechanism", "poisson_ratio", 1.0, p.poisson_ratio);
    same("mechanism", "density_kg_per_m3", 1.0, p.density);
    same("mechanism", "motor_inertia_kg_m2", 1.0, p.motor_inertia);
    same(
        "mechanism",
        "torque_sensor_inertia_kg_m2",
        1.0,
        p.sensor_inertia,
    );
    same(
        "mechanism",
        "motor_coupling_n_m_per_rad",
        1.0,
        p.motor_coupling,
    );
    same(
        "mechanism",
        "screw_coupling_n_m_per_rad",
        1.0,
        p.screw_coupling,
    );
    same("mechanism", "nut_stiffness_n_per_m", 1.0, p.nut_stiffness);
    same("mechanism", "table_mass_kg", 1.0, p.table_mass);
    same("mechanism", "stiffness_damping_s", 1.0, p.stiffness_damping);
    same("friction", "coulomb_n_m", 1.0, p.coulomb);
    same("friction", "stiction_n_m", 1.0, p.stiction);
    same("friction", "stribeck_speed_rpm", RPM, p.stribeck_speed);
    same(
        "friction",
        "bristle_stiffness_n_m_per_rpm_s",
        1.0 / RPM,
        p.bristle_stiffness,
    );
    same(
        "friction",
        "bristle_damping_n_m_per_rpm",
        1.0 / RPM,
        p.bristle_damping,
    );
    same("friction", "viscous_n_m_per_rpm", 1.0 / RPM, p.viscous);
    same("actuator", "pole_pairs", 1.0, p.pole_pairs);
    same(
        "actuator",
        "torque_constant_n_m_per_a",
        1.0,
        p.torque_constant,
    );
    same("actuator", "resistance_ohm", 1.0, p.resistance);
    same("actuator", "inductance_d_mh", 1e-3, p.inductance_d);
    same("actuator", "inductance_q_mh", 1e-3, p.inductance_q);
    same("actuator", "dc_link_v", 1.0, p.dc_link);
    same("control", "frequency_khz", 1e3, 1.0 / p.period);
    same(
        "control",
        "position_gain_rpm_per_mm",
        1e3 * RPM,
        p.position_gain,
    );
    same(
        "control",
        "velocity_feedforward",
        1.0,
        p.velocity_feedforward,
    );
    same(
        "control",
        "speed_proportional_a_per_rpm",
        1.0 / RPM,
        p.speed_p,
    );
    same(
        "control",
        "speed_integral_a_per_rpm_s",
        1.0 / RPM,
        p.speed_i,
    );
    same("actuator", "current_d_proportional_v_per_a", 1.0, p.d_p);
    same("actuator", "current_d_integral_v_per_a_s", 1.0, p.d_i);
    same("actuator", "current_q_proportional_v_per_a", 1.0, p.q_p);
    same("actuator", "current_q_integral_v_per_a_s", 1.0, p.q_i);
    same("actuator", "current_limit_a", 1.0, p.current_limit);
}

/// Every draw lies within the share, and friction never begins below its sliding level.
#[test]
fn parameters_are_put_off_by_no_more_than_their_share() {
    let paper = Parameters::paper();
    let mut largest = 0.0_f64;
    for seed in 0..300 {
        let mut p = paper;
        let by = p.put_off(0.2, &mut Random::new(seed, 0));
        largest = by
            .iter()
            .fold(largest, |most, (_, off)| most.max(off.abs()));
        let stiction = by.iter().find(|(name, _)| *name == "stiction").unwrap();
        assert!((p.stiction / paper.stiction - 1.0 - stiction.1).abs() < 1e-12);
        assert!(p.stiction >= p.coulomb);
        assert_eq!(p.lead, paper.lead);
        assert_eq!(p.position_gain, paper.position_gain);
    }
    assert!(largest <= 0.2 && largest > 0.199, "{largest}");
}
