//! `[thermal]`, and losses against closed forms.

use std::f64::consts::{PI, TAU};

use axis_sim::Axis;
use axis_thermal::ScrewEnds;
use trajectories::{Motion, Setpoint};

use crate::{axis, text};

const AMPLITUDE: f64 = 0.05;
const FREQUENCY: f64 = 0.5;

/// x₀ + A sin(2π f t), whole cycles.
struct PureSine;

impl Motion for PureSine {
    fn duration(&self) -> f64 {
        2.0 / FREQUENCY
    }

    fn at(&self, t: f64) -> Setpoint {
        let (sin, cos) = (TAU * FREQUENCY * t).sin_cos();
        let w = TAU * FREQUENCY;
        Setpoint {
            position: 0.4 + AMPLITUDE * sin,
            velocity: AMPLITUDE * w * cos,
            acceleration: -AMPLITUDE * w * w * sin,
            ..Setpoint::default()
        }
    }
}

/// Mean of |v| is 4 f A, of v² half the square of its peak, of a² likewise; Coulomb's force and the
/// viscous one are in phase, inertia's a quarter of a cycle off.
#[test]
fn losses_of_a_sine_are_those_of_its_closed_form() {
    let axis = axis("linear-motor.toml");
    let model = axis.thermal_model().unwrap();
    let duty = axis.duty_of(&model, &PureSine).unwrap();
    let peak = TAU * FREQUENCY * AMPLITUDE;
    let [dry, viscous] = duty.friction_power();
    // Sums over 2000 samples a cycle; the sign of the speed changes between two of them.
    assert!(
        (dry / (25.0 * 4.0 * FREQUENCY * AMPLITUDE) - 1.0).abs() < 1e-5,
        "{dry}"
    );
    assert!(
        (viscous / (50.0 * 0.5 * peak * peak) - 1.0).abs() < 1e-9,
        "{viscous}"
    );
    let inertia = 40.0 * TAU * FREQUENCY * peak;
    // ⟨(c sgn + d v)²⟩ = c² + 2 c d ⟨|v|⟩ + d² ⟨v²⟩.
    let friction = 25.0 * 25.0 + 2.0 * 25.0 * 50.0 * peak * 2.0 / PI + (50.0 * peak).powi(2) / 2.0;
    let expected = 0.5 * inertia * inertia + friction;
    let found = duty.torque_squared([1.0, 1.0]);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    // 1.5 R/K_t² of it, at the temperature of reference.
    let at_work = model.under(&duty).unwrap();
    let winding = at_work.losses(&model.at_rest(20.0)).winding;
    let expected = 1.5 * 2.5 / (93.0 * 93.0) * found;
    assert!(
        (winding / expected - 1.0).abs() < 1e-12,
        "{winding} {expected}"
    );
}

/// Weight is carried all the time, and heats the winding at standstill.
#[test]
fn a_weight_heats_the_winding_at_standstill() {
    struct Standstill;
    impl Motion for Standstill {
        fn duration(&self) -> f64 {
            1.0
        }
        fn at(&self, _: f64) -> Setpoint {
            Setpoint {
                position: 0.4,
                ..Setpoint::default()
            }
        }
    }
    let heavy = text("linear-motor.toml") + "\n[[load]]\nkind = \"gravity\"\nweight_n = 120\n";
    let axis = Axis::parse("heavy.toml", &heavy).unwrap();
    let model = axis.thermal_model().unwrap();
    let duty = axis.duty_of(&model, &Standstill).unwrap();
    assert!((duty.torque_squared([0.7, 0.3]) - 120.0 * 120.0).abs() < 1e-6);
    assert_eq!(duty.friction_power(), [0.0; 2]);
}

/// The screw is the mechanism's; what the file states stands, and counts in the fingerprint.
#[test]
fn a_file_states_what_is_known() {
    let plain = axis("screw-datasheet.toml");
    assert_eq!(plain.thermal_keys_stated(), 0);
    let screw = plain.thermal_parameters().screw.unwrap();
    assert_eq!([screw.length, screw.diameter], [1.5, 0.0344]);
    assert_eq!(screw.ends, ScrewEnds::OneFixed);
    let more = "\n[thermal]\nnut_to_screw_w_per_k = 9\nscrew_pretension_kn = 5\nviscous_fall_percent_per_k = 3\n";
    let content = text("screw-datasheet.toml").replace("fixed-free", "fixed-fixed") + more;
    let stated = Axis::parse("stated.toml", &content).unwrap();
    assert_eq!(stated.thermal_keys_stated(), 3);
    assert_ne!(stated.fingerprint, plain.fingerprint);
    let parameters = stated.thermal_parameters();
    assert_eq!(parameters.links.nut_to_screw, 9.0);
    let screw = parameters.screw.unwrap();
    let ScrewEnds::BothFixed {
        rigidity,
        bearing_stiffness,
        pretension,
    } = screw.ends
    else {
        panic!("{:?}", screw.ends);
    };
    assert_eq!([bearing_stiffness, pretension], [750e6, 5000.0]);
    let area = PI / 4.0 * 0.0344_f64.powi(2);
    assert!((rigidity / (206e9 * area) - 1.0).abs() < 1e-12);
    // A ball screw of elements has one as well.
    let elements = axis("liu2025.toml").thermal_parameters().screw.unwrap();
    assert_eq!([elements.length, elements.diameter], [1.5, 0.04]);
}

#[test]
fn bad_values_are_refused_with_their_place() {
    let refused = |file: &str, more: &str| {
        let content = text(file) + "\n[thermal]\n" + more;
        Axis::parse("bad.toml", &content).unwrap_err().to_string()
    };
    let message = refused("linear-motor.toml", "nut_capacity_j_per_k = 3000\n");
    assert!(
        message.contains("about a screw") && message.contains("table_capacity"),
        "{message}"
    );
    let message = refused("screw-datasheet.toml", "nut_dry_share = 0.8\n");
    assert!(message.contains("at most 1 together"), "{message}");
    let message = refused("screw-datasheet.toml", "nut_capacity_kj = 3\n");
    assert!(
        message.contains("nut_capacity_j_per_k, nut_capacity_kj_per_k"),
        "{message}"
    );
    let message = refused("screw-datasheet.toml", "screw_nut_length_mm = 2000\n");
    assert!(message.contains("nut_length is 2 m"), "{message}");
}
