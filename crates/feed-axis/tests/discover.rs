//! `discover` as a user runs it: an axis file that every other command takes; logs from
//! which nothing may be concluded are refused, with file, place and what would be valid,
//! and leave no result behind.

use std::path::Path;

use crate::common::{refuse, succeed};
use crate::schema_of::assert_validates;
use axis_sim::Axis;

/// A log of a rest, a move, a rest, the way back and a rest at 1 kHz.
fn lines() -> Vec<String> {
    moved(0.05)
}

/// The same of a motion of so many metres, beside noise of its own.
fn moved(distance: f64) -> Vec<String> {
    let ramp = |share: f64| {
        let s = share.clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    let reference = |t: f64| 0.7 + distance * (ramp(2.0 * t - 1.0) - ramp(2.0 * t - 3.0));
    let row = |k: u32| {
        let t = f64::from(k) * 1e-3;
        let position = reference(t - 2e-3) + 1e-7 * (300.0 * t + 1e3 * distance).sin();
        let iq = (40.0 * t + 1e3 * distance).sin();
        format!("{t},{},{position},{iq}", reference(t))
    };
    let head = "t_s,position_ref_m,position_m,iq_a".to_owned();
    std::iter::once(head).chain((0..2500).map(row)).collect()
}

/// Another motion, of 40 mm.
fn other() -> Vec<String> {
    moved(0.04)
}

fn write(folder: &Path, name: &str, lines: &[String]) -> String {
    let path = folder.join(name);
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    path.to_str().unwrap().to_owned()
}

/// A line, one of its cells changed.
fn with_cell(line: &str, cell: usize, change: impl Fn(&str) -> String) -> String {
    let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
    cells[cell] = change(&cells[cell]);
    cells.join(",")
}

/// The message of a search that must be refused, without blanks.
fn message(folder: &Path, fit: &str, check: &str) -> String {
    let out = folder.join("out");
    let to = out.to_str().unwrap();
    let said = refuse(&["discover", "--fit", fit, "--check", check, "--out", to]);
    assert!(!out.exists(), "a result was left behind: {said}");
    said.replace(' ', "")
}

/// Significant digits of a number.
fn digits(number: &str) -> usize {
    let mantissa = number.split('e').next().unwrap();
    let digits = mantissa.chars().filter(char::is_ascii_digit);
    digits.skip_while(|d| *d == '0').count()
}

/// The README's example: the machine has ten times the viscous friction of the axis file.
#[test]
fn the_new_axis_file_is_the_machine_for_every_other_command() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let machine = "data/axes/liu2025-machine.toml";
    let log = |program: &str, seed: &str| {
        let (program, whole) = (format!("data/programs/{program}.toml"), at("whole.csv"));
        #[rustfmt::skip]
        succeed(&[
            "simulate", "--axis", machine, "--program", &program, "--noise", "1", "--exact",
            "--seed", seed,
            "--log", &whole,
        ]);
        // 1 kHz: head, and every tenth sample.
        let text = std::fs::read_to_string(whole).unwrap();
        let lines = text.lines().enumerate();
        let some = lines.filter(|(k, _)| *k == 0 || k % 10 == 1);
        let some: Vec<String> = some.map(|(_, line)| line.to_owned()).collect();
        write(folder.path(), &format!("{seed}.csv"), &some)
    };
    let (fit, check) = (log("there-and-back", "1"), log("there-and-back-check", "2"));
    let out = at("out");
    std::fs::create_dir(&out).unwrap();
    let stale = format!("{out}/next-experiment.toml");
    std::fs::write(&stale, "").unwrap();
    // By balance, which takes a thirtieth of a replay's time.
    let search = ["discover", "--balance", "--fit", &fit, "--check", &check];
    let said = succeed(&[&search[..], &["--out", &out]].concat());
    assert!(said.contains("The model lacks viscous-friction."), "{said}");
    for number in said.split_whitespace().filter(|w| w.parse::<f64>().is_ok()) {
        assert!(digits(number) <= 6, "{number} in {said}");
    }
    assert!(!Path::new(&stale).exists(), "of an earlier search");
    let discovery = std::fs::read_to_string(format!("{out}/discovery.json")).unwrap();
    assert_validates("discovery", &serde_json::from_str(&discovery).unwrap());

    let axis = format!("{out}/axis.toml");
    let text = std::fs::read_to_string(&axis).unwrap();
    let added = text.split("[[effects]]").nth(1).unwrap();
    let coefficient = added.split("coefficient = ").nth(1).unwrap();
    let coefficient = coefficient.split_whitespace().next().unwrap();
    assert!(
        digits(coefficient) > 12,
        "the file keeps all digits: {added}"
    );
    let run = |axis: &str| {
        let said = succeed(&[
            "simulate",
            "--axis",
            axis,
            "--trajectory",
            "1",
            "--log",
            &at("1.csv"),
        ]);
        let after = said.split("error max ").nth(1).unwrap();
        after.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let (model, found, machine) = (run("data/axes/liu2025.toml"), run(&axis), run(machine));
    // Micrometres; the interval of the friction is ± 0.7 %.
    assert!((found - machine).abs() < 7e-3 * (machine - model).abs());
    // Files that the axis file names are found from where the new one is.
    let experiment = Axis::read(axis.as_ref()).unwrap().experiment.unwrap();
    assert!(experiment.machine.is_file() && experiment.paper_tables.unwrap().is_dir());

    // A table of errors leaves the logs' report where it is.
    let report = || std::fs::read(format!("{out}/report.html")).unwrap();
    let before = report();
    // Its first section is the gap, its logs have no folder, and a figure names no column as a quantity.
    let page = String::from_utf8(before.clone()).unwrap();
    let section = page.split("<h2").nth(1).unwrap();
    assert!(
        section.contains("The gap before and after"),
        "{section:.300}"
    );
    assert!(page.contains("</b> 2.csv: q current (iq_a)"));
    assert!(page.contains("log − model") && !page.contains("log − model: iq_a"));
    // Of what is shown: coordinates of curves are data.
    let parts = page.split("<script");
    let shown: String = parts
        .map(|part| part.split_once("</script>").map_or(part, |(_, text)| text))
        .collect();
    for minus in ['-', '\u{2212}'] {
        let signed = format!("{minus}0.000 %");
        assert!(!shown.contains(&signed), "a share of nothing has no sign");
    }
    let table = "data/reference/liu2025/table13_model_vs_experiment.csv";
    let said = succeed(&["discover", "--summary", table, "--out", &out]);
    assert!(said.contains("1. viscous-friction"), "{said}");
    assert!(Path::new(&format!("{out}/ranking.html")).exists() && report() == before);
}

#[test]
fn bad_logs_are_refused_with_file_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let sound = lines();
    let check = write(folder.path(), "check.csv", &other());
    type Damage = fn(&mut Vec<String>);
    // What is broken, how, and what the message must say (blanks left out, as
    // the terminal breaks lines where it likes).
    let cases: [(&str, Damage, &[&str]); 8] = [
        (
            "nan.csv",
            |l| {
                for line in &mut l[700..720] {
                    *line = with_cell(line, 2, |_| "NaN".to_owned());
                }
            },
            &["20samples", "position_m"],
        ),
        (
            "word.csv",
            |l| l[700] = with_cell(&l[700], 3, |_| "much".to_owned()),
            &["line701", "iq_a"],
        ),
        // The same instant with two values; a row that is there twice is dropped.
        (
            "repeated.csv",
            |l| l[900] = with_cell(&l[899], 3, |_| "0.125".to_owned()),
            &["line901"],
        ),
        ("unsorted.csv", |l| l.swap(400, 401), &["line402"]),
        (
            "gap.csv",
            |l| {
                l.drain(800..860);
            },
            &["0.79", "s"],
        ),
        (
            "millimetres.csv",
            |l| {
                for line in l.iter_mut().skip(1) {
                    *line = with_cell(line, 2, |x| format!("{}", 1e3 * x.parse::<f64>().unwrap()));
                }
            },
            &["scale=0.001"],
        ),
        (
            "no-position.csv",
            |l| l[0] = "t_s,position_ref_m,weight_kg,iq_a".to_owned(),
            &["position_m", "weight_kg"],
        ),
        ("one-way.csv", |l| l.truncate(1200), &["onedirectiononly"]),
    ];
    for (name, damage, says) in cases {
        let mut broken = sound.clone();
        damage(&mut broken);
        let fit = write(folder.path(), name, &broken);
        let said = message(folder.path(), &fit, &check);
        assert!(said.contains(name), "{name}: {said}");
        for what in says {
            assert!(said.contains(what), "{name}: no {what} in {said}");
        }
    }
}

#[test]
fn an_effect_that_the_machine_cannot_have_is_not_accepted() {
    let emps = "data/axes/emps.toml";
    #[rustfmt::skip]
    let said = refuse(&[
        "discover", "--axis", emps, "--fit", "a.csv", "--check", "b.csv", "--accept", "backlash",
    ]);
    assert!(
        said.contains("backlash") && said.contains("rigid-mass"),
        "{said}"
    );
    assert!(
        said.contains("coulomb-friction") && !said.contains("lead-error"),
        "{said}"
    );
}

/// Neither option takes anything from what an earlier search left in the folder.
#[test]
fn accepting_and_rejecting_say_that_the_search_is_made_anew() {
    let help = succeed(&["discover", "--help"]);
    assert_eq!(help.matches("Search again").count(), 2, "{help}");
}

#[test]
fn the_same_motion_to_fit_and_to_check_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let fit = write(folder.path(), "fit.csv", &lines());
    let copy = write(folder.path(), "copy.csv", &lines());
    let said = message(folder.path(), &fit, &copy);
    assert!(
        said.contains("copy.csv") && said.contains("samesamples"),
        "{said}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let fit = write(folder.path(), "fit.csv", &lines());
    let check = write(folder.path(), "check.csv", &other());
    let out = "/dev/null/results";
    let said = refuse(&["discover", "--fit", &fit, "--check", &check, "--out", out]);
    assert!(said.contains(out) && said.contains("--out"), "{said}");
}
