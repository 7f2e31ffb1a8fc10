//! Bad axis files are refused with file, line, field and what is valid.

use axis_sim::{Axis, AxisFileError};
use proptest::prelude::*;

use crate::{PRINTED, text};

/// A change to the good file, and what must be said about it.
struct Case {
    from: &'static str,
    to: &'static str,
    /// Text that stands on the line to be named.
    line_of: &'static str,
    field: &'static str,
    /// Parts of the message.
    says: &'static [&'static str],
}

const fn case(
    from: &'static str,
    to: &'static str,
    line_of: &'static str,
    field: &'static str,
    says: &'static [&'static str],
) -> Case {
    Case {
        from,
        to,
        line_of,
        field,
        says,
    }
}

#[rustfmt::skip]
const CASES: &[Case] = &[
    // Keys.
    case("lead_mm = 10", "lead_mm = 10\npitch_mm = 3", "pitch_mm", "screw.pitch_mm",
        &["not a key", "lead_mm | lead_m | lead_um", "elements"]),
    case("schema = 1", "schema = 1\ncolour = \"red\"", "colour", "colour", &["not a key", "[screw]"]),
    case("[stroke]", "[spindle]\nspeed_rpm = 3\n[stroke]", "[spindle]", "spindle", &["not a key", "[motor]"]),
    case("dc_link_v = 540", "", "[inverter]", "inverter.dc_link", &["missing", "dc_link_v"]),
    case("pole_pairs = 4", "", "[motor]", "motor.pole_pairs", &["missing", "whole number from 1 to 100"]),
    case("poisson_ratio = 0.3", "", "[screw]", "screw.poisson_ratio", &["missing", "a number"]),
    case("name = \"liu2025\"", "", "# The ball-screw axis", "name", &["missing", "text in quotes"]),
    case("[friction] ", "[fricton] ", "# The ball-screw axis", "friction", &["missing", "[friction]"]),
    // Types.
    case("table_mass_kg = 515 ", "table_mass_kg = \"515\" ", "table_mass_kg", "drive.table_mass_kg",
        &["a text", "finite number above zero"]),
    case("elements = 10 ", "elements = 10.5 ", "elements", "screw.elements", &["10.5", "whole number from 2 to 1000"]),
    case("elements = 10 ", "elements = 1 ", "elements", "screw.elements", &["is 1", "from 2 to 1000"]),
    case("dc_link_v = 540", "dc_link_v = true", "dc_link_v", "inverter.dc_link_v", &["true or false"]),
    case("lead_mm = 10", "lead_mm = [10]", "lead_mm", "screw.lead_mm", &["a list"]),
    case("name = \"liu2025\"", "name = 3", "name = 3", "name", &["whole number", "text in quotes"]),
    case("[stroke]", "[[stroke]]", "[[stroke]]", "stroke", &["a list", "a table"]),
    case("\"shape-functions\"", "\"rigid\"", "nut_coupling", "simulation.nut_coupling",
        &["\"rigid\"", "\"shape-functions\" or \"moving-node\""]),
    // Values.
    case("table_mass_kg = 515 ", "table_mass_kg = nan ", "table_mass_kg", "drive.table_mass_kg", &["nan", "finite"]),
    case("displacement_mm = 300", "displacement_mm = nan", "displacement_mm", "trajectory[1].displacement_mm", &["nan", "finite"]),
    case("stiction_n_m = 0.7653", "stiction_n_m = inf", "stiction_n_m", "friction.stiction_n_m", &["inf", "finite"]),
    case("minimum_mm = 0", "minimum_mm = -inf", "minimum_mm", "stroke.minimum_mm", &["-inf", "zero or above"]),
    case("youngs_modulus_gpa = 206 ", "youngs_modulus_gpa = 1e305 ", "youngs_modulus_gpa", "screw.youngs_modulus_gpa",
        &["inf in SI", "finite"]),
    case("lead_mm = 10", "lead_mm = 1e-322", "lead_mm = 1e", "screw.lead_mm", &["0 in SI", "above zero"]),
    case("table_mass_kg = 515 ", "table_mass_kg = -515 ", "table_mass_kg", "drive.table_mass_kg", &["-515", "above zero"]),
    case("inductance_q_mh = 13.2", "inductance_q_mh = -13.2", "inductance_q_mh", "motor.inductance_q_mh",
        &["-13.2", "above zero"]),
    case("table_mass_kg = 515 ", "table_mass_kg = 0 ", "table_mass_kg", "drive.table_mass_kg", &["above zero"]),
    case("poisson_ratio = 0.3", "poisson_ratio = 0.5", "poisson_ratio", "screw.poisson_ratio", &["below 0.5"]),
    case("resistance_ohm = 0.75", "resistance_ohm = -0.75", "resistance_ohm", "motor.resistance_ohm", &["zero or above"]),
    case("stiction_n_m = 0.7653", "stiction_n_m = 0.6", "[friction]", "friction", &["stiction", "coulomb"]),
    case("jerk_mm_per_s3 = 1400", "jerk_mm_per_s3 = 0", "jerk_mm_per_s3 = 0", "trajectory[2].jerk_mm_per_s3", &["above zero"]),
    // Units.
    case("lead_mm = 10", "lead_inch = 10", "lead_inch", "screw.lead_inch",
        &["`inch`", "no unit of length", "lead_mm, lead_m, lead_um"]),
    case("viscous_n_m_per_rpm = 0.0003", "viscous_n_m_per_hz = 0.0003", "viscous_n_m_per_hz", "friction.viscous_n_m_per_hz",
        &["`n_m_per_hz`", "rotary damping", "viscous_n_m_s_per_rad"]),
    case("lead_mm = 10", "lead = 10", "[screw]", "screw.lead", &["missing", "lead_mm"]),
    case("lead_mm = 10", "lead_mm = 10\nlead_m = 0.01", "lead_m = 0.01", "screw.lead_m",
        &["a second time", "one of lead_mm, lead_m, lead_um"]),
    // Off the stroke or the screw.
    case("start_mm = 600", "start_mm = 1600", "[stroke]", "stroke", &["1.6 m", "start inside the stroke"]),
    case("maximum_mm = 1500", "maximum_mm = 1501", "[stroke]", "stroke", &["1.501", "screw's length"]),
    case("minimum_mm = 0", "minimum_mm = 1500", "[stroke]", "stroke", &["minimum < maximum"]),
    case("position_max_mm = 1500", "position_max_mm = 1600", "[samples]", "samples", &["off the screw"]),
    case("current_min_a = -15", "current_min_a = 15", "[samples]", "samples", &["current_min", "minimum below"]),
    case("displacement_mm = 300", "displacement_mm = 901", "[[trajectory]]", "trajectory[1]",
        &["1.501", "outside the stroke", "0 m to 1.5 m"]),
    // Schema.
    case("schema = 1", "schema = 2", "schema = 2", "schema", &["is 2", "from 1 to 1"]),
    case("schema = 1", "schema = \"1\"", "schema = ", "schema", &["from 1 to 1"]),
    case("schema = 1", "", "# The ball-screw axis", "schema", &["missing", "from 1 to 1"]),
];

#[test]
fn messages_name_file_line_field_and_what_is_valid() {
    let good = text(PRINTED);
    let mut wrong = Vec::new();
    for c in CASES {
        let bad = good.replacen(c.from, c.to, 1);
        assert_ne!(bad, good, "`{}` is not in the file", c.from);
        let expected = 1 + bad.lines().position(|l| l.contains(c.line_of)).unwrap();
        let error = Axis::parse("some/axis.toml", &bad).expect_err(c.to);
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
            wrong.push(format!("`{}`: line {expected}?\n  {message}", c.to));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_not_toml_is_refused_with_its_line() {
    let good = text(PRINTED);
    for (from, to) in [
        ("lead_mm = 10", "lead_mm 10"),
        ("lead_mm = 10", "lead_mm = 10\nlead_mm = 11"),
        ("[motor] ", "[motor "),
        ("name = \"liu2025\"", "name = \"liu2025"),
        ("pole_pairs = 4", "pole_pairs = 04"),
    ] {
        let bad = good.replacen(from, to, 1);
        let error = Axis::parse("axis.toml", &bad).unwrap_err();
        let AxisFileError::Syntax { line, .. } = &error else {
            panic!("{error}");
        };
        let expected = 1 + bad
            .lines()
            .position(|l| l.contains(to.lines().last().unwrap()))
            .unwrap();
        assert_eq!(*line, expected, "{error}");
        assert!(
            error
                .to_string()
                .starts_with(&format!("axis.toml:{expected}: not TOML"))
        );
    }
    assert!(Axis::parse("empty.toml", "").is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    /// A file cut anywhere, or with any byte changed, is read or refused;
    /// nothing panics.
    #[test]
    fn no_text_makes_it_panic(at in 0..4000_usize, other in 0..128_u8, cut in any::<bool>()) {
        let mut bytes = text(PRINTED).into_bytes();
        let at = at.min(bytes.len() - 1);
        if cut {
            bytes.truncate(at);
        } else {
            bytes[at] = other;
        }
        if let Ok(content) = String::from_utf8(bytes)
            && let Err(error) = Axis::parse("axis.toml", &content)
        {
            prop_assert!(error.to_string().starts_with("axis.toml:"));
        }
    }
}
