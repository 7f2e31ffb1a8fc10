//! Torque balance on measured logs, no controller known.

use std::path::{Path, PathBuf};

use axis_log::read_log;
use axis_sim::Axis;
use discrepancy::{Discovery, LogSet, Settings, discovery, search};

fn folder(name: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    Some(root.join(name)).filter(|f| f.is_dir())
}

fn axis(name: &str) -> Axis {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/axes");
    Axis::read(&root.join(format!("{name}.toml"))).unwrap()
}

fn discover(machine: &Axis, folder: &Path, fit: &[&str], check: &[&str]) -> Discovery {
    let set = |names: &[&str]| {
        let one = |name: &&str| {
            let log = read_log(folder.join(name), &machine.log, &[]).unwrap();
            let period = axis_log::quality::check_sampling(&log).unwrap().period;
            ((*name).to_owned(), log, period)
        };
        let set = LogSet::new(names.iter().map(one).collect(), machine).unwrap();
        for (b, l) in set.balances().iter().zip(&set.logs) {
            println!("{}", b.quality().sentence(&l.name));
        }
        set
    };
    let (fit, check) = (set(fit), set(check));
    let found = search(machine, &fit, &check, &Settings::default(), |_| ()).unwrap();
    let d = discovery(machine, &fit, &check, &found).unwrap().discovery;
    println!("{}", d.sentence);
    for e in &d.effects {
        println!("{} {:?} alike {:?}", e.name, e.evidence, e.indistinguishable_from);
        for p in &e.parameters {
            println!("   {} {:.5e} {} [{:.5e} {:.5e}] when named {:.4e}", p.name, p.value, p.unit, p.ci95[0], p.ci95[1], p.when_named);
        }
    }
    for k in &d.recalibrated {
        println!("{} {:.5} of {}", k.name, k.share, k.tolerance);
    }
    println!("replaced {:?}", d.replaced);
    println!("not added {:?}", d.not_added);
    println!("refused {:?}", d.refused);
    println!("fit {:?}\ncheck {:?}", d.gap.fit, d.gap.check);
    d
}

#[test]
fn emps() {
    let Some(folder) = folder("emps") else { return };
    discover(&axis("emps-balance"), &folder, &["emps.csv"], &["emps_pulses.csv"]);
}
