//! The fingerprint follows the values, and nothing else.

use axis_sim::Axis;

use crate::{MACHINE, OTHERS, PRINTED, RIGID, text};

fn fingerprint(content: &str) -> String {
    Axis::parse("axis.toml", content).unwrap().fingerprint
}

#[test]
fn comments_names_order_and_units_do_not_count() {
    let original = text(PRINTED);
    let expected = fingerprint(&original);

    let bare: String = original
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default().trim_end())
        .filter(|line| !line.is_empty())
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(fingerprint(&bare), expected);

    let renamed = original.replace("name = \"liu2025\"", "name = \"other\"");
    assert_ne!(renamed, original);
    assert_eq!(fingerprint(&renamed), expected);

    // Tables from the last to the first, the keys in them too; the list of
    // trajectories keeps its order, which has a meaning.
    let mut tables: Vec<Vec<&str>> = vec![Vec::new()];
    for line in bare.lines() {
        if line.starts_with('[') {
            tables.push(Vec::new());
        }
        tables.last_mut().unwrap().push(line);
    }
    let (moves, mut others): (Vec<_>, Vec<_>) =
        tables[1..].iter().partition(|t| t[0] == "[[trajectory]]");
    others.reverse();
    let mut shuffled = tables[0]
        .iter()
        .rev()
        .fold(String::new(), |s, l| s + l + "\n");
    for table in others.into_iter().chain(moves) {
        shuffled += &format!("{}\n", table[0]);
        for line in table[1..].iter().rev() {
            shuffled += &format!("{line}\n");
        }
    }
    assert_ne!(shuffled, bare);
    assert_eq!(fingerprint(&shuffled), expected);

    // Another unit counts as the same value where both convert to the same
    // f64. That is not so for every decimal (the last bit may differ), so
    // these are chosen: 1500 × 1e-3 = 1.5, 10 × 1e3 = 1e4, 100 × 1e-6 = 1e-4.
    let units = original
        .replace("length_mm = 1500 ", "length_m = 1.5 ")
        .replace("frequency_khz = 10", "frequency_hz = 10000")
        .replace("table_mass_kg = 515 ", "table_mass_kg = 5.15e2 ");
    assert_ne!(units, original);
    assert_eq!(fingerprint(&units), expected);
}

/// Changes every number of a file in turn; how many there are.
fn change_each(file: &str) -> (usize, Vec<String>) {
    let original = text(file);
    let mut seen = vec![fingerprint(&original)];
    let mut changed = 0;
    for (i, line) in original.lines().enumerate() {
        let code = line.split('#').next().unwrap_or_default();
        let Some((key, value)) = code.split_once('=') else {
            continue;
        };
        let Ok(number) = value.trim().parse::<f64>() else {
            continue;
        };
        if key.trim() == "schema" {
            continue;
        }
        // A hundredth less or more, whichever is still an axis; counts by one.
        let whole = ["elements", "pole_pairs", "lines", "bits"].contains(&key.trim());
        let others = if whole {
            vec![number + 1.0, number - 1.0]
        } else if number == 0.0 {
            vec![1.0, -1.0]
        } else {
            // Rates divide each other.
            vec![0.99 * number, 1.01 * number, 2.0 * number, 0.5 * number]
        };
        let with = |other: f64| -> String {
            let replace = |(j, l): (usize, &str)| {
                if i == j {
                    format!("{key}= {other}\n")
                } else {
                    format!("{l}\n")
                }
            };
            original.lines().enumerate().map(replace).collect()
        };
        let parsed = others
            .iter()
            .find_map(|&o| Axis::parse("axis.toml", &with(o)).ok());
        let found = parsed
            .unwrap_or_else(|| panic!("line {}: {line}", i + 1))
            .fingerprint;
        assert!(!seen.contains(&found), "line {}: {line}", i + 1);
        seen.push(found);
        changed += 1;
    }
    (changed, seen)
}

#[test]
fn every_value_counts() {
    let (changed, seen) = change_each(PRINTED);
    let original = text(PRINTED);
    // 14 of the mechanism, 12 of the actuator, 5 of the control, 6 of the friction, 3 of the
    // stroke, 8 of the samples, the step, and 4 of each of the six trajectories.
    assert_eq!(changed, 73);
    let moving = original.replace("\"fast\"", "\"exact\"");
    assert!(!seen.contains(&fingerprint(&moving)));
}

#[test]
fn every_value_of_the_other_axes_counts() {
    let numbers = OTHERS.map(|file| change_each(file).0);
    // As many as the files have, but for the schema.
    assert_eq!(numbers, [43, 48, 38, 37, 37, 29, 46]);
}

#[test]
fn the_order_of_trajectories_counts() {
    let original = text(PRINTED);
    let swapped = original
        .replace("jerk_mm_per_s3 = 1200", "jerk_mm_per_s3 = 0.5")
        .replace("jerk_mm_per_s3 = 1400", "jerk_mm_per_s3 = 1200")
        .replace("jerk_mm_per_s3 = 0.5", "jerk_mm_per_s3 = 1400");
    assert_ne!(fingerprint(&swapped), fingerprint(&original));
}

/// Fingerprints tell which results belong to which values, so they outlive the
/// program's versions. `[control] following_error_limit` is in the third alone.
#[test]
fn fingerprints_of_the_files_as_they_are() {
    for (file, expected) in [
        (
            PRINTED,
            "c5a89e28f84e5bcfc0c73703fe89128e9ed8b732d1ed9ab472ed742640e5da9a",
        ),
        (
            MACHINE,
            "515f680622290dd4560dcffb7e9f5d5a6cec5c24b58c2847bbb44b658cbc9b01",
        ),
        (
            RIGID,
            "a4e46c4e5527c329544feb3f6d41a82c1795f02a47f73c15553ccab74b73f67b",
        ),
    ] {
        assert_eq!(fingerprint(&text(file)), expected, "{file}");
    }
    let more = text(PRINTED)
        + "\n[tolerances]\nknown_parameters_percent = 3\n[[log.column]]\nsource = \"a\"\nchannel = \"t_s\"\nscale = 1e-3\n[[effects]]\nname = \"backlash\"\ngap = 4e-6\n[[effects]]\nname = \"periodic-lead-error\"\namplitude = 1e-6\nphase = 1\n";
    assert_eq!(
        fingerprint(&more),
        "427330b03ac4989e8d552effc06e32ac5edbd0dc1296306f72d5f9615c3bba1c"
    );
}

/// A file without the key has the delay of most drives, not what files without it once had: it
/// counts as if it were given.
#[test]
fn a_current_delay_that_is_left_out_counts() {
    let original = text(PRINTED);
    let without: String = original
        .lines()
        .filter(|line| !line.starts_with("current_delay_periods"))
        .map(|line| format!("{line}\n"))
        .collect();
    let given = |value: &str| {
        fingerprint(&original.replace(
            "current_delay_periods = 0 ",
            &format!("current_delay_periods = {value} "),
        ))
    };
    assert_eq!(given("0"), fingerprint(&original));
    assert_eq!(given("1.5"), fingerprint(&without));
    assert_ne!(fingerprint(&without), fingerprint(&original));
}

#[test]
fn a_limit_that_is_given_counts() {
    let original = text(PRINTED);
    let limited = original.replace("\"p-pi\"", "\"p-pi\"\nfollowing_error_limit_mm = 20");
    assert_ne!(limited, original);
    assert_ne!(fingerprint(&limited), fingerprint(&original));
}
