//! A slide on a linear motor, simulated by code that shares none with the library, whose drive
//! low-passes its speed and commands late, which its axis file does not say.

use std::path::Path;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use discrepancy::controller::better_than_own;
use discrepancy::logs::NamedLog;
use discrepancy::{Discovery, Evidence, Settings, Verdict};
use independent_axis::{
    Random, SLIDE_CASES, SlideDrive, SlideHidden, Table, slide_log, slide_motions,
};

fn hidden(name: &str) -> SlideHidden {
    let mut all = SLIDE_CASES.into_iter();
    all.find(|(own, _)| *own == name).unwrap().1
}

fn axis() -> Axis {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    Axis::read(&root.join("data/axes/linear-motor.toml")).unwrap()
}

pub(crate) fn as_log(table: &Table) -> Log {
    let column = |i: usize| table.rows.iter().map(|row| row[i]).collect();
    let channel = |(i, name): (usize, &&str)| Channel::new(*name, column(i)).unwrap();
    Log::new(table.names.iter().enumerate().map(channel).collect()).unwrap()
}

/// A log to fit and one to check.
fn logs(name: &str) -> [Vec<NamedLog>; 2] {
    let mut seed = 0;
    slide_motions().map(|motion| {
        seed += 1;
        let mut random = Random::new(seed, 1);
        let table = slide_log(&SlideDrive::OTHER, &hidden(name), &motion, &mut random);
        vec![(format!("log {seed}"), as_log(&table), 5e-4)]
    })
}

/// What is found by torque balance.
fn balanced(name: &str) -> Discovery {
    let machine = axis().without_control().unwrap();
    let [fit, check] = logs(name);
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).unwrap();
    let found = evidence.discover(&machine, &Settings::default(), |_| {});
    let told = found.unwrap().1.discovery;
    println!("{name}: {}", told.sentence);
    told
}

/// The only name, and whether its size is inside its interval.
fn only<'a>(told: &'a Discovery, size: &str, truth: f64) -> (&'a str, bool) {
    assert_eq!(told.verdict, Verdict::Explained, "{}", told.sentence);
    assert_eq!(told.effects.len(), 1, "{}", told.sentence);
    let effect = &told.effects[0];
    let mut sizes = effect.parameters.iter().filter(|p| p.name == size);
    // An amplitude below zero is one above, half a turn on.
    let inside = sizes.any(|p| {
        let holds = |value: f64| (p.ci95[0]..=p.ci95[1]).contains(&value);
        holds(truth) || holds(-truth)
    });
    (&effect.name, inside)
}

#[test]
fn forces_are_named_by_balance_whatever_the_drive_does() {
    let told = balanced("nothing");
    assert_eq!(told.verdict, Verdict::NothingMissing, "{}", told.sentence);
    let told = balanced("ripple");
    assert_eq!(only(&told, "amplitude", 9.0), ("force-ripple", true));
    let told = balanced("cable");
    assert_eq!(only(&told, "stiffness", 60.0), ("spring-force", true));
}

/// A drag by the square of the speed is in no library. Viscous friction with less dry friction
/// imitates it, on check motion that goes back twice as fast as the fitted one too.
#[test]
fn a_law_of_no_library_is_said_in_a_formula_and_not_put_together_from_others() {
    let told = balanced("drag");
    assert_eq!(told.verdict, Verdict::Unknown, "{}", told.sentence);
    assert!(told.effects.is_empty());
    let refused = told.refused.unwrap();
    assert_eq!(refused.law.as_deref(), Some("|v|·v"));
    let unknown = told.unknown.unwrap();
    assert_eq!(unknown.depends_on, "speed");
    // force = c · |v|·v, c = 39.94 N·s²/m² (95 %: 39.78 to 40.11) (empirical)
    let formula = unknown.formula.unwrap();
    let [low, high] = ["95 %: ", " to "].map(|before| {
        let rest = formula.split(before).nth(1).unwrap();
        let end = rest.find([' ', ')']).unwrap();
        rest[..end].parse::<f64>().unwrap()
    });
    assert!(low < 40.0 && 40.0 < high && high - low < 0.8, "{formula}");
    let faster = told
        .notes
        .iter()
        .filter(|note| note.contains("goes back at up to 700 mm/s"));
    assert_eq!(faster.count(), 1, "{:?}", told.notes);
}

/// A spring against a load imitates a force that turns at a place; a curve over the position does better.
#[test]
fn a_step_along_the_way_is_not_put_together_from_a_spring_and_a_load() {
    let told = balanced("edge");
    assert_eq!(told.verdict, Verdict::Unknown, "{}", told.sentence);
    assert_eq!(told.unknown.unwrap().depends_on, "position");
}

/// A load, a spring and a friction bump together imitate a force that grows with the square of the way; a law over the
/// position explains and predicts more than they do.
#[test]
fn effects_do_not_imitate_a_law_over_the_position_together() {
    let told = balanced("bend");
    assert_eq!(told.verdict, Verdict::Unknown, "{}", told.sentence);
    assert!(told.effects.is_empty());
    assert_eq!(told.unknown.unwrap().depends_on, "position");
    let refused = told.refused.unwrap();
    assert_eq!(refused.law_over.as_deref(), Some("position"));
    assert!(refused.effects.len() > 1, "{:?}", refused.effects);
}

/// What the file's controller does not give, one with a low pass of the speed does, whatever the
/// machine hides.
#[test]
fn a_drive_with_more_in_it_than_its_file_is_told_from_its_commands() {
    let machine = axis();
    for name in ["nothing", "ripple"] {
        let [fit, check] = logs(name);
        let other = better_than_own(&machine, &fit, &check).unwrap();
        assert!(other.better.contains("speed_lowpass"), "{other:?}");
        assert!(other.better_left < 1e-4 * other.left, "{other:?}");
    }
}
