//! What files of parts are refused for, with file, line and what would fit.

use axis_sim::{Axis, AxisFileError, ClosedLoop, SetupError, Tolerances};

use crate::{change, changed, text};

/// A change to a file, and what must be said about it.
struct Case {
    file: &'static str,
    from: &'static str,
    to: &'static str,
    /// Text that stands on the line to be named.
    line_of: &'static str,
    field: &'static str,
    says: &'static [&'static str],
}

const fn case(
    [file, from, to]: [&'static str; 3],
    line_of: &'static str,
    field: &'static str,
    says: &'static [&'static str],
) -> Case {
    Case {
        file,
        from,
        to,
        line_of,
        field,
        says,
    }
}

#[rustfmt::skip]
const CASES: &[Case] = &[
    // Sensors where they cannot be.
    case(["joint.toml", "[sensors.motor]", "[sensors.load]\nkind = \"scale\"\n[sensors.motor]"], "kind = \"scale\"", "sensors.load.kind",
        &["\"scale\"", "a sensor in m, but the position is in rad", "valid: encoder, resolver"]),
    case(["rack.toml", "kind = \"scale\"\nresolution_um = 0.1\nsignal_period_um = 40\nperiodic_error_um = 0.2", "kind = \"encoder\"\nlines = 2048"],
        "kind = \"encoder\"", "sensors.load.kind", &["a sensor in rad, but the position is in m", "valid: scale"]),
    case(["linear-motor.toml", "[stroke]", "[sensors.motor]\nkind = \"encoder\"\nlines = 1024\n[stroke]"], "[sensors.load]", "sensors",
        &["\"linear-motor\" moves as one with it", "[sensors.load] alone"]),
    // Filters above what a sampled loop can hold.
    case(["rack.toml", "position_rate_khz = 4", "notch_hz = 3601"], "[control]", "control",
        &["a notch at 3601 Hz", "sampled at 8000 Hz", "at most 3600 Hz"]),
    case(["rack.toml", "position_rate_khz = 4", "speed_rate_khz = 2\nspeed_lowpass_hz = 901"], "[control]", "control",
        &["a lowpass at 901 Hz", "sampled at 2000 Hz", "at most 900 Hz"]),
    // A current loop that is too slow for its gain.
    case(["linear-motor.toml", "frequency_khz = 10", "frequency_khz = 2"], "[control]", "control",
        &["2000 Hz", "current_d_proportional = 90 V/A", "18 mH unstable", "current controller, or less than 68."]),
    // Numbers and units that do not fit the mechanism.
    case(["joint.toml", "ratio = 100", "ratio = 0"], "ratio = 0", "mechanism.ratio", &["is 0", "from 0.01 to 10000"]),
    case(["joint.toml", "minimum_deg = -120", "minimum_mm = -120"], "minimum_mm", "stroke.minimum_mm",
        &["`mm`, which is no unit of angle", "minimum_deg"]),
    case(["rack.toml", "maximum_mm = 4000", "maximum_deg = 4000"], "maximum_deg", "stroke.maximum_deg",
        &["`deg`, which is no unit of length", "maximum_mm"]),
    case(["belt.toml", "minimum_mm = 0", "minimum_mm = -300"], "[stroke]", "stroke",
        &["reaches from -0.3 m to 2 m", "reaches from -0.2974 m to 2.2974 m"]),
    case(["belt.toml", "strand_at_zero_mm = 300", "strand_at_zero_mm = 2600"], "[mechanism]", "mechanism",
        &["strands_together greater than strand_at_zero"]),
    case(["screw-datasheet.toml", "mounting = \"fixed-free\"", "mounting = \"fixed-fre\""], "mounting", "mechanism.mounting",
        &["did you mean \"fixed-free\"?"]),
    // Gains of another actuator's unit.
    case(["rack.toml", "speed_proportional_n_m_s_per_rad", "speed_proportional_a_s_per_rad"], "[control]", "control",
        &["a command in A", "\"torque-source\" takes one in N·m", "gains in units of N·m"]),
    case(["linear-stage.toml", "proportional_n_per_m", "proportional_v_per_m"], "[control]", "control",
        &["a command in V", "\"force-source\" takes one in N;", "gains in units of N"]),
    case(["rack.toml", "speed_integral_time_ms = 25", "speed_integral_a_per_rad = 40"], "speed_integral_a", "control.speed_integral_a_per_rad",
        &["is in a_per_rad", "takes N·m and what turns", "valid: speed_integral_n_m_per_rad"]),
    case(["linear-motor.toml", "speed_proportional_a_s_per_m", "speed_proportional_a_s_per_rad"], "speed_proportional_a_s_per_rad",
        "control.speed_proportional_a_s_per_rad", &["moves along a line", "valid: speed_proportional_a_s_per_m"]),
    case(["belt.toml", "speed_proportional_a_s_per_rad", "speed_proportional_a_s_per_m"], "speed_proportional_a_s_per_m",
        "control.speed_proportional_a_s_per_m", &["what turns", "speed_proportional_a_per_rpm, speed_proportional_a_s_per_rad"]),
    case(["joint.toml", "kv_per_s = 6", "position_gain_rpm_per_mm = 6"], "position_gain", "control.position_gain_rpm_per_mm", &["what turns"]),
    case(["linear-stage.toml", "derivative_n_s_per_m", "derivative_n_m_s_per_rad"], "derivative_n_m", "control.derivative_n_m_s_per_rad",
        &["takes N and", "valid: derivative_n_s_per_m"]),
    // Friction of the other freedom.
    case(["joint.toml", "kind = \"lugre-rotary\"", "kind = \"lugre\""], "coulomb_n_m", "friction.coulomb_n_m",
        &["`n_m`, which is no unit of force", "coulomb_n"]),
    case(["rotary-table.toml",
        "kind = \"coulomb-rotary\"\ncoulomb_n_m = 8\nviscous_n_m_s_per_rad = 5\npresliding_arcsec = 20",
        "kind = \"lugre\"\ncoulomb_n = 1\nstiction_n = 1\nstribeck_speed_m_per_s = 1\nbristle_stiffness_n_per_m = 1\nbristle_damping_n_s_per_m = 1\nviscous_n_s_per_m = 1"],
        "[friction]", "friction", &["\"lugre\", per m", "\"torque-motor\" moves in rad",
            "valid: lugre-at-motor, lugre-rotary, coulomb-rotary"]),
    // Kinds that do not exist.
    case(["rack.toml", "kind = \"rack\"", "kind = \"rac\""], "kind = \"rac\"", "mechanism.kind", &["did you mean \"rack\"?", "\"belt\""]),
    case(["rack.toml", "kind = \"torque-source\"", "kind = \"torque-sorce\""], "torque-sorce", "actuator.kind", &["did you mean \"torque-source\"?"]),
    case(["rack.toml", "kind = \"p-pi\"", "kind = \"ppi\""], "\"ppi\"", "control.kind", &["did you mean \"p-pi\"", "\"pid\""]),
    case(["rack.toml", "kind = \"coulomb\"", "kind = \"coulom\""], "\"coulom\"", "friction.kind", &["did you mean \"coulomb\"?"]),
    case(["joint.toml", "kind = \"pendulum\"", "kind = \"pendelum\""], "pendelum", "load[1].kind", &["did you mean \"pendulum\"?"]),
    case(["joint.toml", "kind = \"encoder\"", "kind = \"encodr\""], "encodr", "sensors.motor.kind", &["did you mean \"encoder\"?"]),
    case(["rack.toml", "[mechanism]\nkind = \"rack\"\n", "[mechanism]\n"], "[mechanism]", "mechanism.kind", &["missing", "\"rack\""]),
    case(["rack.toml", "kind = \"rack\"", "kind = \"belt\""], "gearbox_inertia_kg_m2", "mechanism.gearbox_inertia_kg_m2",
        &["not a key of this table", "pulley_inertia_kg_m2"]),
    // Sections that are missing or doubled.
    case(["rack.toml", "schema = 2", "schema = 1"], "schema = 1", "schema", &["is 1", "valid: 2"]),
    case(["rack.toml", "[friction]", "[fricton]"], "[fricton]", "fricton", &["did you mean `[friction]`?"]),
    // Tolerances.
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = \"20\""], "carriage_mass = ", "tolerances.carriage_mass",
        &["is \"20\"", "\"20 %\"", "\"unknown\""]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = \"about a fifth\""], "carriage_mass = ", "tolerances.carriage_mass",
        &["\"about a fifth\"", "from 0.001 % to 90 %"]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = \"-20 %\""], "carriage_mass = ", "tolerances.carriage_mass", &["\"-20 %\""]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = \"100 %\""], "carriage_mass = ", "tolerances.carriage_mass", &["to 90 %"]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = \"nan %\""], "carriage_mass = ", "tolerances.carriage_mass", &["\"nan %\""]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mass = 0.2"], "carriage_mass = ", "tolerances.carriage_mass", &["a text in quotes"]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "carriage_mas = \"20 %\""], "carriage_mas = ", "tolerances.carriage_mas",
        &["did you mean `carriage_mass`?"]),
    case(["rack.toml", "carriage_mass = \"20 %\"", "weight = \"20 %\""], "weight", "tolerances.weight", &["not a key"]),
    // Rates.
    case(["rack.toml", "position_rate_khz = 4", "position_rate_khz = 3"], "position_rate_khz", "control.position_rate_khz",
        &["is 3000 Hz", "the control frequency of 8000 Hz, or that divided by a whole number"]),
    case(["rack.toml", "position_rate_khz = 4", "speed_rate_khz = 16"], "speed_rate_khz", "control.speed_rate_khz", &["is 16000 Hz"]),
    // What is given twice or not at all.
    case(["rack.toml", "kv_m_per_min_per_mm = 1.0 ", "kv_m_per_min_per_mm = 1.0\nposition_gain_rpm_per_mm = 10 "], "kv_m_per_min", "control.kv_m_per_min_per_mm",
        &["a second time", "one of position_gain and kv"]),
    case(["rack.toml", "kv_m_per_min_per_mm = 1.0 ", "#"], "[control]", "control.position_gain_rpm_per_mm", &["missing", "kv_per_s"]),
    case(["rack.toml", "speed_integral_time_ms = 25", "speed_integral_time_ms = 25\nspeed_integral_n_m_per_rad = 40"], "speed_integral_time_ms",
        "control.speed_integral_time_ms", &["a second time"]),
    case(["rack.toml", "position_rate_khz = 4", "feedback = \"blend\""], "[control]", "control.blend_khz", &["missing", "blend_hz"]),
];

#[test]
fn messages_name_file_line_field_and_what_would_fit() {
    let mut wrong = Vec::new();
    for c in CASES {
        let good = text(c.file);
        let bad = good.replacen(c.from, c.to, 1);
        assert_ne!(bad, good, "`{}` is not in {}", c.from, c.file);
        let line_of = |l: &str| l.contains(c.line_of);
        let expected = 1 + bad.lines().position(line_of).unwrap();
        let error = match Axis::parse("some/axis.toml", &bad) {
            Ok(_) => {
                wrong.push(format!("{} `{}`: accepted", c.file, c.to));
                continue;
            }
            Err(error) => error,
        };
        let message = error.to_string();
        let AxisFileError::Field {
            line, field, valid, ..
        } = &error
        else {
            panic!("{message}");
        };
        let good = *line == expected
            && field == c.field
            && !valid.is_empty()
            && message.starts_with(&format!("some/axis.toml:{expected}: `{}`", c.field))
            && c.says.iter().all(|part| message.contains(part));
        if !good {
            wrong.push(format!(
                "{} `{}`: line {expected}?\n  {message}",
                c.file, c.to
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn tolerances_that_are_given() {
    let axis = changed(
        "rack.toml",
        &[("carriage_mass = \"20 %\"", "carriage_mass = \"± 12.5%\"")],
    );
    assert_eq!(axis.tolerances.of("carriage_mass"), 0.125);
    assert_eq!(axis.tolerances.of("mesh_stiffness"), Tolerances::UNKNOWN);
    assert_eq!(axis.tolerances.of("motor_inertia"), 0.01);
    // A load's parameter is known, and so is how far it may be off.
    let joint = crate::axis("joint.toml");
    assert!(joint.known().contains(&"gravity_torque"));
    assert_eq!(joint.tolerances.of("gravity_torque"), 0.3);
    // They count for the fingerprint.
    assert_ne!(axis.fingerprint, crate::axis("rack.toml").fingerprint);
}

/// A loop that no file can have is refused when it is set up.
#[test]
fn parts_that_are_changed_are_checked_again() {
    let mut axis = crate::axis("rack.toml");
    change(&mut axis.control, &[("notch", 5000.0)]);
    let error = ClosedLoop::new(&axis).unwrap_err();
    assert!(matches!(error, SetupError::Part(_)), "{error}");
    assert!(error.to_string().contains("at most 3600 Hz"), "{error}");
    let refused = axis.mechanism.change(|v| v.set("carriage_mass", 0.0));
    assert!(refused.is_err());
    // It stays as it was.
    assert_eq!(crate::number(&axis.mechanism, "carriage_mass"), 300.0);
}
