//! A real machine: the EMPS benchmark (A. Janot, M. Gautier, M. Brunot, "Data
//! Set and Reference Models of EMPS", Workshop on Nonlinear System
//! Identification Benchmarks, Eindhoven, 10–12 April 2019).
//!
//! Its data have no licence and are not part of this project. Put `emps.csv`
//! and `emps_pulses.csv` (made from the benchmark's MAT files, columns as in
//! data/axes/emps.toml) beside the project, in shared/data/emps, or name their
//! folder in EMPS_DATA.

use std::path::Path;

use axis_log::read_log;
use axis_sim::Axis;
use discrepancy::{Discovery, EffectFound, LogSet, Settings, Verdict, discovery, search};

use crate::needs;

/// Published force gain, N/V.
const GAIN: f64 = 35.15065188;

fn discover(folder: &Path) -> Discovery {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/emps.toml");
    let machine = Axis::read(Path::new(file)).unwrap();
    let required = ["position_ref_m", "position_m"];
    let logs = |name: &str| {
        let log = read_log(folder.join(name), &machine.log, &required).unwrap();
        LogSet::new(vec![(name.to_owned(), log, 1e-3)], &machine).unwrap()
    };
    let (fit, check) = (logs("emps.csv"), logs("emps_pulses.csv"));
    let found = search(&machine, &fit, &check, &Settings::default(), |_| ()).unwrap();
    discovery(&machine, &fit, &check, &found).unwrap().discovery
}

fn off(value: f64, published: f64) -> f64 {
    (value / published - 1.0).abs()
}

#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn published_friction_of_a_real_stage_is_found_from_mass_and_viscous_friction_alone() {
    // Of nonlinearbenchmark.org.
    let Some(folder) = needs::named_or_shared("EMPS_DATA", "data/emps") else {
        return;
    };
    let found = discover(&folder);
    let effect = |name: &str| -> &EffectFound {
        let effect = found.effects.iter().find(|e| e.name == name);
        effect.unwrap_or_else(|| panic!("no {name} in {:?}", found.sentence))
    };
    // As it was named first, alone: the published symmetric model has Coulomb
    // friction of 20.3935 N and a constant load of −3.1648 N.
    let dry = &effect("asymmetric-friction").parameters;
    let (forward, backward) = (dry[0].when_named, dry[1].when_named);
    assert!(off(0.5 * (forward + backward), 20.3935) < 0.05, "{dry:?}");
    assert!(off(0.5 * (forward - backward), -3.1648) < 0.05, "{dry:?}");
    // In the end: the published asymmetric model, Fc 20.1440 and 20.6277 N,
    // Fv 166.7061 and 240.4236 N·s/m.
    assert!(off(dry[0].value, 20.1440) < 0.05, "{dry:?}");
    assert!(off(dry[1].value, 20.6277) < 0.05, "{dry:?}");
    let known = found.recalibrated.iter().find(|k| k.name == "viscous");
    let base = 203.5034 * (1.0 + known.unwrap().share);
    let viscous = &effect("asymmetric-viscous-friction").parameters;
    assert!(off(base + viscous[0].value, 166.7061) < 0.05, "{viscous:?}");
    assert!(off(base + viscous[1].value, 240.4236) < 0.05, "{viscous:?}");
    // Closed-loop force error on the file with pulses: the published asymmetric
    // model leaves 2.68 N, mass and viscous friction alone 21.7 N.
    let mut channels = found.gap.check.channels.iter();
    let command = channels.find(|c| c.channel == "drive_command_v").unwrap();
    assert!(off(GAIN * command.before, 21.9) < 0.01, "{command:?}");
    assert!(GAIN * command.after < 2.7, "{command:?}");
    // Something is left: a ripple once per motor turn whose phase is another in
    // the second file, so that no effect fitted to the first may have it.
    assert_eq!(found.verdict, Verdict::PartlyExplained);
    assert!(
        found
            .not_added
            .iter()
            .any(|(name, _)| name == "cogging-torque")
    );
}
