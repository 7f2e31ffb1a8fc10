//! Machines of the tests, with something hidden in them, and searches on them.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect};
use discover_matrix::hidden::{Exercise, Hidden, Noise, exercise};
use discrepancy::{Discovery, LogSet, Settings, discovery, search};
use trajectories::Program;

/// A stage without a transmission, which is simulated in a tenth of a screw's time.
pub fn stage() -> Axis {
    named("linear-stage")
}

pub fn named(name: &str) -> Axis {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes");
    Axis::read(format!("{folder}/{name}.toml").as_ref()).unwrap()
}

pub fn hide_in(axis: &Axis, effects: Vec<(&str, Vec<f64>)>, seed: u64) -> Hidden {
    let active = |(name, values)| ActiveEffect {
        effect: Effect::named(name).unwrap(),
        values,
    };
    Hidden {
        effects: effects.into_iter().map(active).collect(),
        shares: Vec::new(),
        noise: Noise::good(axis),
        seed,
    }
    .with_known_off_by(axis, 0.01)
}

pub fn logs_of(axis: &Axis, hidden: &Hidden, motion: &Program, check: bool) -> LogSet {
    let mut hidden = hidden.clone();
    // Noise of its own, known parameters as they are.
    hidden.seed += u64::from(check);
    // Every fifth cycle, so that logs slower than the control cycle are in the test.
    let log = hidden.log(axis, motion, 5).unwrap();
    LogSet::new(vec![("log".to_owned(), log, 5.0 * axis.period)], axis).unwrap()
}

/// Of the stage, on an exercise.
pub fn find_on_stage(hidden: &Hidden, kind: Exercise, settings: &Settings) -> Discovery {
    let machine = stage();
    let [fit, check] = [false, true].map(|check| {
        let motion = exercise(&machine, kind, check).unwrap();
        logs_of(&machine, hidden, &motion, check)
    });
    let found = search(&machine, &fit, &check, settings, |_| ()).unwrap();
    discovery(&machine, &fit, &check, &found).unwrap().discovery
}

/// A search that may name these effects and no others.
pub fn with_only(library: &[&str]) -> Settings {
    let all = axis_sim::effects::EFFECTS.iter().map(|e| e.name);
    let rejected = all.filter(|name| !library.contains(name));
    Settings {
        rejected: rejected.map(str::to_owned).collect(),
        ..Settings::default()
    }
}
