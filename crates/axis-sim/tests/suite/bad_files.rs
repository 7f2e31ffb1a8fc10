//! Bad axis files are refused with file, line, field and what is valid.

use axis_sim::{Axis, AxisFileError};
use proptest::prelude::*;

use crate::{OTHERS, PRINTED, RIGID, text};

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
    case("lead_mm = 10", "lead_mm = 10\npitch_mm = 3", "pitch_mm", "mechanism.pitch_mm",
        &["not a key of this table;", "lead_mm | lead_m | lead_um", "elements"]),
    case("schema = 2", "schema = 2\ncolour = \"red\"", "colour", "colour", &["not a key of this file;", "[mechanism]", "[[trajectory]]"]),
    case("[stroke]", "[spindle]\nspeed_rpm = 3\n[stroke]", "[spindle]", "spindle", &["not a key", "[actuator]"]),
    case("dc_link_v = 540", "", "[actuator]", "actuator.dc_link_v", &["missing", "a number from 1 to 100000, in v"]),
    case("pole_pairs = 4", "", "[actuator]", "actuator.pole_pairs", &["missing", "whole number from 1 to 100"]),
    case("poisson_ratio = 0.3", "", "[mechanism]", "mechanism.poisson_ratio", &["missing", "a number from -0.99 to 0.49"]),
    case("name = \"liu2025\"", "", "# The ball-screw axis", "name", &["missing", "text in quotes"]),
    case("lead_mm = 10", "", "[mechanism]", "mechanism.lead_mm", &["missing", "one of lead_mm, lead_m, lead_um", "from 0.1 to 1000, in mm"]),
    case("[friction] ", "[fricton] ", "[fricton]", "fricton", &["not a key of this file; did you mean `[friction]`?"]),
    case("[[trajectory]] ", "[[trajectroy]] ", "[[trajectroy]]", "trajectroy", &["did you mean `[[trajectory]]`?"]),
    case("name = \"liu2025\"", "nmae = \"liu2025\"", "nmae", "nmae", &["did you mean `name`?"]),
    // Types.
    case("table_mass_kg = 515 ", "table_mass_kg = \"515\" ", "table_mass_kg", "mechanism.table_mass_kg",
        &["a text", "a number from 0.001 to 1000000, in kg"]),
    case("elements = 10 ", "elements = 10.5 ", "elements", "mechanism.elements", &["10.5", "whole number from 2 to 1000"]),
    case("elements = 10 ", "elements = 1 ", "elements", "mechanism.elements", &["is 1", "from 2 to 1000"]),
    case("dc_link_v = 540", "dc_link_v = true", "dc_link_v", "actuator.dc_link_v", &["true or false"]),
    case("lead_mm = 10", "lead_mm = [10]", "lead_mm", "mechanism.lead_mm", &["a list"]),
    case("name = \"liu2025\"", "name = 3", "name = 3", "name", &["whole number", "text in quotes"]),
    case("[stroke]", "[[stroke]]", "[[stroke]]", "stroke", &["a list", "a table"]),
    // Words.
    case("method = \"fast\"", "method = \"rigid\"", "method", "simulation.method", &["is \"rigid\";", "\"fast\" or \"exact\""]),
    case("method = \"fast\"", "method = \"exatc\"", "method", "simulation.method", &["did you mean \"exact\"?"]),
    case("kind = \"ball-screw\"", "kind = \"rigid\"", "\"rigid\"", "mechanism.kind", &["\"rigid\"", "\"ball-screw\""]),
    case("kind = \"ball-screw\"", "knd = \"ball-screw\"", "knd", "mechanism.knd", &["did you mean `kind`?"]),
    case("kind = \"ball-screw\"", "kind = \"rigid-mass\"", "length_mm", "mechanism.length_mm", &["not a key of this table", "mass_kg"]),
    // Values.
    case("table_mass_kg = 515 ", "table_mass_kg = nan ", "table_mass_kg", "mechanism.table_mass_kg", &["is nan", "in kg"]),
    case("displacement_mm = 300", "displacement_mm = nan", "displacement_mm", "trajectory[1].displacement_mm", &["nan", "in mm"]),
    case("stiction_n_m = 0.7653", "stiction_n_m = inf", "stiction_n_m", "friction.stiction_n_m", &["is inf"]),
    case("minimum_mm = 0", "minimum_mm = -inf", "minimum_mm", "stroke.minimum_mm", &["-inf"]),
    case("youngs_modulus_gpa = 206 ", "youngs_modulus_gpa = 1e305 ", "youngs_modulus_gpa", "mechanism.youngs_modulus_gpa",
        &["is 1e305", "from 0.1 to 10000, in gpa"]),
    case("lead_mm = 10", "lead_mm = 1e-322", "lead_mm = 1e", "mechanism.lead_mm", &["is 1e-322", "from 0.1 to 1000, in mm"]),
    case("table_mass_kg = 515 ", "table_mass_kg = -515 ", "table_mass_kg", "mechanism.table_mass_kg", &["is -515"]),
    case("inductance_q_mh = 13.2", "inductance_q_mh = -13.2", "inductance_q_mh", "actuator.inductance_q_mh", &["is -13.2"]),
    case("table_mass_kg = 515 ", "table_mass_kg = 0 ", "table_mass_kg", "mechanism.table_mass_kg", &["is 0"]),
    case("poisson_ratio = 0.3", "poisson_ratio = 0.5", "poisson_ratio", "mechanism.poisson_ratio", &["to 0.49"]),
    case("resistance_ohm = 0.75", "resistance_ohm = -0.75", "resistance_ohm", "actuator.resistance_ohm", &["from 0 to"]),
    case("stiction_n_m = 0.7653", "stiction_n_m = 0.6", "[friction]", "friction", &["stiction", "coulomb"]),
    case("jerk_mm_per_s3 = 1400", "jerk_mm_per_s3 = 0", "jerk_mm_per_s3 = 0", "trajectory[2].jerk_mm_per_s3", &["from 0.001 to"]),
    case("frequency_khz = 10", "frequency_khz = 1e20", "frequency_khz", "control.frequency_khz", &["is 1e20", "from 0.1 to 1000, in khz"]),
    case("frequency_khz = 10", "frequency_hz = 99", "frequency_hz", "control.frequency_hz", &["is 99", "from 100 to 1000000, in hz"]),
    // More work than a run may be.
    case("step_us = 100 ", "step_us = 0.0099 ", "step_us", "simulation.step_us", &["is 0.0099", "from 0.01 to 10000, in us"]),
    // Units.
    case("lead_mm = 10", "lead_inch = 10", "lead_inch", "mechanism.lead_inch",
        &["`inch`", "no unit of length", "lead_mm, lead_m, lead_um"]),
    case("length_mm = 1500 ", "length_cm = 150 ", "length_cm", "mechanism.length_cm",
        &["`cm`", "no unit of length", "length_mm, length_m, length_um"]),
    case("viscous_n_m_per_rpm = 0.0003", "viscous_n_m_per_hz = 0.0003", "viscous_n_m_per_hz", "friction.viscous_n_m_per_hz",
        &["`n_m_per_hz`", "rotary damping", "viscous_n_m_s_per_rad"]),
    case("lead_mm = 10", "lead = 10", "lead = 10", "mechanism.lead", &["no unit of length", "lead_mm, lead_m, lead_um"]),
    case("lead_mm = 10", "lead_mm = 10\nlead_m = 0.01", "lead_m = 0.01", "mechanism.lead_m",
        &["a second time", "one of lead_mm, lead_m, lead_um"]),
    // Off the stroke or the screw.
    case("start_mm = 600", "start_mm = 1600", "[stroke]", "stroke", &["1.6 m", "start inside the stroke"]),
    case("maximum_mm = 1500", "maximum_mm = 1501", "[stroke]", "stroke", &["1.501", "reaches from 0 m to 1.5 m"]),
    case("minimum_mm = 0", "minimum_mm = -1", "[stroke]", "stroke", &["-0.001 m", "0 m <= minimum < maximum <= 1.5 m"]),
    case("minimum_mm = 0", "minimum_mm = 1500", "[stroke]", "stroke", &["minimum < maximum"]),
    case("position_max_mm = 1500", "position_max_mm = 1600", "[samples]", "samples", &["does not reach", "positions from 0 m to 1.5 m"]),
    case("current_min_a = -15", "current_min_a = 15", "[samples]", "samples", &["current_min", "minimum below"]),
    case("displacement_mm = 300", "displacement_mm = 901", "[[trajectory]]", "trajectory[1]",
        &["1.501", "outside the stroke", "0 m to 1.5 m"]),
    // Schema.
    case("schema = 2", "schema = 1", "schema = 1", "schema", &["is 1", "valid: 2"]),
    case("schema = 2", "schema = \"2\"", "schema = ", "schema", &["is \"2\";", "valid: 2"]),
    case("schema = 2", "", "# The ball-screw axis", "schema", &["missing", "valid: 2"]),
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
        ("[actuator] ", "[actuator "),
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

/// More internal steps than a cycle or a run may have: each value is within
/// its own limits.
#[test]
fn work_without_end_is_refused() {
    let good = text(PRINTED);
    let slow = good.replacen("speed_mm_per_s = 100", "speed_mm_per_s = 0.001", 1);
    // 300 s at 10 kHz are 3e6 cycles; 3e5 s with 10 steps a cycle are 3e10 steps.
    assert!(Axis::parse("axis.toml", &slow.replace("= 0.001", "= 1")).is_ok());
    let fine = slow.replace("step_us = 100 ", "step_us = 10 ");
    for (content, field, line_of, says) in [
        (
            fine,
            "trajectory[1]",
            "[[trajectory]]",
            ["takes 300000 s, 3e10", "at most 1e10 internal steps"],
        ),
        (
            good.replace("frequency_khz = 10", "frequency_hz = 100")
                .replace("step_us = 100 ", "step_us = 0.1 "),
            "simulation",
            "[simulation]",
            ["step of 1e-7 s", "1e-6 s or longer"],
        ),
    ] {
        let error = Axis::parse("axis.toml", &content).unwrap_err();
        let line = 1 + content.lines().position(|l| l.contains(line_of)).unwrap();
        let message = error.to_string();
        let start = format!("axis.toml:{line}: `{field}`");
        assert!(message.starts_with(&start), "{message}");
        assert!(says.iter().all(|part| message.contains(part)), "{message}");
    }
}

/// A key whose last or first unit letter is lost may be another unit: metres
/// for millimetres are no slip that can be seen.
fn is_another_unit(key: &str, slip: &str) -> bool {
    [
        ("_mm", "_m"),
        ("_um", "_m"),
        ("_khz", "_hz"),
        ("_us", "_s"),
        ("_ms", "_s"),
        ("_gpa", "_pa"),
        ("_mh", "_h"),
    ]
    .iter()
    .any(|(from, to)| key.replacen(from, to, 1) == slip)
}

/// Every spelling with a letter dropped, or two neighbours swapped.
fn slips(key: &str) -> Vec<String> {
    let letters: Vec<char> = key.chars().collect();
    let mut all = Vec::new();
    for i in 0..letters.len() {
        let mut dropped = letters.clone();
        dropped.remove(i);
        all.push(dropped.into_iter().collect());
        if i + 1 < letters.len() {
            let mut swapped = letters.clone();
            swapped.swap(i, i + 1);
            all.push(swapped.into_iter().collect());
        }
    }
    all.retain(|slip: &String| slip != key && !slip.is_empty() && !is_another_unit(key, slip));
    all
}

/// Name of the key or table of a line, and how a message shows it.
fn named(line: &str) -> Option<(String, String)> {
    let code = line.split('#').next().unwrap_or_default().trim();
    if let Some(inner) = code.strip_prefix("[[").and_then(|c| c.strip_suffix("]]")) {
        let last = inner.rsplit('.').next()?;
        return Some((last.to_owned(), format!("[[{last}]]")));
    }
    if let Some(inner) = code.strip_prefix('[').and_then(|c| c.strip_suffix(']')) {
        let last = inner.rsplit('.').next()?;
        return Some((last.to_owned(), format!("[{last}]")));
    }
    let (key, _) = code.split_once('=')?;
    Some((key.trim().to_owned(), key.trim().to_owned()))
}

/// A slip in any key or table of the example files is told at its line, with
/// the key that was meant.
#[test]
fn every_slip_of_the_pen_is_named_with_what_was_meant() {
    let (mut tried, mut wrong) = (0, Vec::new());
    for file in [PRINTED, RIGID].into_iter().chain(OTHERS) {
        let good = text(file);
        let lines: Vec<&str> = good.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let Some((key, shown)) = named(line) else {
                continue;
            };
            for slip in slips(&key) {
                let mut bad: Vec<String> = lines.iter().map(|l| (*l).to_owned()).collect();
                bad[at] = line.replacen(&key, &slip, 1);
                tried += 1;
                let place = format!("axis.toml:{}:", at + 1);
                let message = match Axis::parse("axis.toml", &bad.join("\n")) {
                    Ok(_) => "accepted".to_owned(),
                    Err(error) => error.to_string(),
                };
                // Before the list of all that is valid.
                let said = message.split("valid:").next().unwrap_or_default();
                let mut words = said.split(|c: char| " `,;?".contains(c));
                if !(message.starts_with(&place) && words.any(|word| word == shown)) {
                    wrong.push(format!("{slip}: {message}"));
                }
            }
        }
    }
    assert!(tried > 2000, "{tried}");
    assert!(
        wrong.is_empty(),
        "{} of {tried}: {}",
        wrong.len(),
        wrong.join("\n")
    );
}
