//! Parameters are the numbers of the axis file.

use axis_fmu::{Unit, VariableKind};

use crate::{at, get, set, text, unit};

fn begun(unit: &mut Unit) {
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
}

/// A step of the reference, then what the machine does.
fn answer(unit: &mut Unit) -> Vec<u64> {
    set(unit, "position_ref_m", 0.6001);
    unit.step(0.0, 0.02).unwrap();
    let all = unit.variables().clone();
    let outputs = all
        .iter()
        .filter(|v| matches!(v.kind, VariableKind::Output(_)));
    outputs
        .map(|v| unit.get(v.reference).unwrap().to_bits())
        .collect()
}

#[test]
fn a_parameter_that_is_set_is_one_of_another_file() {
    let text = text("liu2025.toml");
    for (name, before, after, value) in [
        (
            "mechanism.table_mass_kg",
            "table_mass_kg = 515",
            "table_mass_kg = 300.0",
            300.0,
        ),
        ("mechanism.lead_mm", "lead_mm = 10", "lead_mm = 12.5", 12.5),
        (
            "friction.coulomb_n_m",
            "coulomb_n_m = 0.6757",
            "coulomb_n_m = 0.1",
            0.1,
        ),
        (
            "control.position_gain_rpm_per_mm",
            "position_gain_rpm_per_mm = 280.2",
            "position_gain_rpm_per_mm = 140.0",
            140.0,
        ),
    ] {
        assert!(text.contains(before));
        let mut other = Unit::new("other", &text.replace(before, after)).unwrap();
        let [mut changed, mut same] = [unit("liu2025.toml"), unit("liu2025.toml")];
        set(&mut changed, name, value);
        assert_eq!(get(&mut changed, name), value);
        for unit in [&mut other, &mut changed, &mut same] {
            begun(unit);
        }
        let expected = answer(&mut other);
        assert_eq!(answer(&mut changed), expected, "{name}");
        assert_ne!(answer(&mut same), expected, "{name}");
    }
}

/// Until the initialisation ends: the last value counts, and what was read before is not kept.
#[test]
fn parameters_may_be_set_after_outputs_were_read() {
    let [mut early, mut late] = [unit("liu2025.toml"), unit("liu2025.toml")];
    set(&mut early, "mechanism.table_mass_kg", 300.0);
    begun(&mut early);
    late.enter_initialization(0.0, None).unwrap();
    let _ = get(&mut late, "machine.position_m");
    set(&mut late, "mechanism.table_mass_kg", 300.0);
    late.exit_initialization().unwrap();
    assert_eq!(answer(&mut early), answer(&mut late));
}

#[test]
fn a_value_out_of_range_is_refused_in_the_files_words() {
    let mut unit = unit("liu2025.toml");
    set(&mut unit, "mechanism.table_mass_kg", -1.0);
    unit.enter_initialization(0.0, None).unwrap();
    let refused = unit.exit_initialization().unwrap_err().to_string();
    assert!(
        refused.contains("table_mass_kg") && refused.contains("-1"),
        "{refused}"
    );
    set(&mut unit, "mechanism.table_mass_kg", 515.0);
    unit.exit_initialization().unwrap();
}

/// The step of the unit is in its description: the control's frequency stays. What is no
/// number of a part is no parameter.
#[test]
fn what_makes_the_unit_is_no_parameter() {
    for name in ["liu2025.toml", "belt.toml"] {
        let unit = unit(name);
        let all = unit.variables();
        for absent in [
            "control.frequency_khz",
            "stroke.start_mm",
            "mechanism.elements",
            "schema",
            "simulation.step_us",
        ] {
            assert!(all.named(absent).is_none(), "{absent}");
        }
        let parameters = all
            .iter()
            .filter(|v| matches!(v.kind, VariableKind::Parameter { .. }));
        assert!(parameters.clone().count() > 20);
        for parameter in parameters {
            let is_plain = parameter.measure.is_none();
            assert!(
                parameter.description.contains("a number from"),
                "{}",
                parameter.name
            );
            assert!(
                !is_plain || !parameter.description.contains(", in "),
                "{}",
                parameter.name
            );
        }
    }
    let unit = unit("belt.toml");
    assert_eq!(
        unit.variables()
            .get(at(&unit, "mechanism.carriage_mass_kg"))
            .unwrap()
            .start,
        Some(12.0)
    );
}

/// The limits of a variable are those that the file's check states in words, in the variable's unit:
/// the value there is taken, one beyond is refused.
#[test]
fn limits_are_those_of_the_axis_files_check() {
    let mut tried = 0;
    for file in ["liu2025.toml", "belt.toml", "joint.toml"] {
        let all = unit(file).variables().clone();
        for variable in all.iter() {
            let Some([least, most]) = variable.limits else {
                assert!(!matches!(variable.kind, VariableKind::Parameter { .. }));
                continue;
            };
            let start = variable.start.unwrap();
            assert!((least..=most).contains(&start), "{}", variable.name);
            let key = variable.name.rsplit('.').next().unwrap();
            let range = [
                (least - 1e-6 * least.abs().max(1e-300), true),
                (least, false),
                (most, false),
                (most + 1e-6 * most.abs(), true),
            ];
            for (value, is_beyond) in range.into_iter().filter(|_| key != "exact_between_samples") {
                let mut unit = unit(file);
                set(&mut unit, &variable.name, value);
                unit.enter_initialization(0.0, None).unwrap();
                // Inside, other checks may refuse what does not fit together.
                let said = unit.exit_initialization().map_err(|e| e.to_string());
                let of_key = format!("{key}` is ");
                let is_refused = said.is_err_and(|words| {
                    words.contains(&of_key) && words.contains("valid: a number from")
                });
                assert_eq!(is_refused, is_beyond, "{} = {value}", variable.name);
                tried += 1;
            }
        }
    }
    assert!(tried > 200, "{tried}");
}
