//! Torque balance on logs of real machines, none of which tells its controller.
//!
//! The data have no licence that would let them be part of this project. Each test says
//! where they come from; put them as CSV beside the project, in shared/data, or name that
//! folder in FEED_AXIS_DATA.

mod bench;
mod emps;
mod hsm;
mod rack;

use std::path::{Path, PathBuf};

use axis_log::quality::check_sampling;
use axis_log::{Log, read_log};
use axis_sim::Axis;
use discrepancy::{Discovery, EffectFound, Found, LogSet, Settings, discovery, search};

use crate::needs;

/// The folder of a data set; where it is not there, that is said with where to get it.
pub(crate) fn folder(name: &str, from: &str) -> Option<PathBuf> {
    let named = std::env::var_os("FEED_AXIS_DATA").map(|all| Path::new(&all).join(name));
    let found = named
        .filter(|folder| folder.is_dir())
        .or_else(|| needs::shared(&format!("data/{name}")));
    if found.is_none() {
        eprintln!("get the data of {name} from {from}");
    }
    found
}

/// An axis file of this project, with more at its end.
fn axis(name: &str, more: &str) -> Axis {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/axes");
    let text = std::fs::read_to_string(root.join(format!("{name}.toml"))).unwrap();
    Axis::parse(name, &(text + more)).unwrap()
}

fn read(machine: &Axis, folder: &Path, names: &[&str]) -> LogSet {
    let one = |name: &&str| {
        let log = read_log(folder.join(name), &machine.log, &[]).unwrap();
        let period = check_sampling(&log).unwrap().period;
        ((*name).to_owned(), log, period)
    };
    prepared(machine, names.iter().map(one).collect())
}

fn prepared(machine: &Axis, logs: Vec<(String, Log, f64)>) -> LogSet {
    let set = LogSet::new(logs, machine).unwrap();
    set.notes().iter().for_each(|note| println!("{note}"));
    set
}

/// A model of just these effects.
fn only(effects: &[&str]) -> Settings {
    Settings {
        accepted: effects.iter().map(|name| (*name).to_owned()).collect(),
        most_effects: effects.len(),
        ..Settings::default()
    }
}

/// What was found, and in words.
struct Told {
    found: Found,
    discovery: Discovery,
}

fn discover(machine: &Axis, fit: &LogSet, check: &LogSet, settings: &Settings) -> Told {
    let found = search(machine, fit, check, settings, |_| ()).unwrap();
    let discovery = discovery(machine, fit, check, &found).unwrap().discovery;
    println!("{}", discovery.sentence);
    for effect in &discovery.effects {
        for p in &effect.parameters {
            let [low, high] = p.ci95;
            println!(
                "  {} {} = {:.5e} {} [{low:.4e} {high:.4e}]",
                effect.name, p.name, p.value, p.unit
            );
        }
    }
    let told = Told { found, discovery };
    for known in &told.discovery.recalibrated {
        println!("  {:?}", told.known(&known.name));
    }
    for gap in [&told.discovery.gap.fit, &told.discovery.gap.check] {
        println!("  {:?}", gap.channels);
    }
    assert_eq!(told.discovery.answer, "torque-balance");
    told
}

impl Told {
    fn effect(&self, name: &str) -> &EffectFound {
        let found = self.discovery.effects.iter().find(|e| e.name == name);
        found.unwrap_or_else(|| panic!("no {name} in {:?}", self.discovery.sentence))
    }

    /// A parameter of an effect, and its 95 % interval.
    fn value(&self, effect: &str, parameter: usize) -> (f64, [f64; 2]) {
        let p = &self.effect(effect).parameters[parameter];
        (p.value, p.ci95)
    }

    /// What a known parameter is multiplied by, and its 95 % interval.
    fn known(&self, name: &str) -> (f64, [f64; 2]) {
        let all = self.discovery.recalibrated.iter();
        let at = all.clone().position(|k| k.name == name).unwrap();
        let by = 1.0 + self.discovery.recalibrated[at].share;
        let half = self.found.half_width(at, by);
        (by, [by - half, by + half])
    }
}

fn holds((_, [low, high]): (f64, [f64; 2]), value: f64) -> bool {
    (low..=high).contains(&value)
}

fn off((found, _): (f64, [f64; 2]), value: f64) -> f64 {
    (found / value - 1.0).abs()
}
