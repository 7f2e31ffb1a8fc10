//! A stand-in for the EMPS stage (see `emps.rs`), whose logs may not be part of this project: friction of the kind
//! that its authors published, other figures, simulated here in the plainest way. Nothing is shared with the
//! library: dry friction is set-valued (it holds or it slides), the step is 2 µs, the noise is a sum of uniforms, the
//! encoder is a grid of 50 nm.

use std::fmt::Write;
use std::path::Path;

use axis_log::read_log;
use axis_sim::effects::Machine;
use discrepancy::{Discovery, EffectFound, LogSet, Settings, discovery, search};

// As in data/axes/emps.toml, from the publication.
const MASS: f64 = 95.1089;
const FORCE_GAIN: f64 = 35.15065188;
const POSITION_GAIN: f64 = 160.18;
const SPEED_GAIN: f64 = 243.45;

/// Friction against motion forward and backward: dry, N, and viscous, N·s/m.
const DRY: [f64; 2] = [17.0, 26.0];
const VISCOUS: [f64; 2] = [160.0, 250.0];

const PERIOD: f64 = 1e-3;
const STEPS: usize = 500;

/// There and back by `travel` (m) in `time` (s) each way, a fifth-order polynomial.
fn reference(t: f64, moves: &[(f64, f64)]) -> f64 {
    let rest = 0.25;
    let ramp = |s: f64| s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let mut begin = rest;
    for &(travel, time) in moves {
        let there = begin + time;
        let back = there + rest;
        if t < there {
            return travel * ramp(((t - begin) / time).max(0.0));
        }
        if t < back + time {
            return travel * (1.0 - ramp(((t - back) / time).max(0.0)));
        }
        begin = back + time + rest;
    }
    0.0
}

/// The stage under its P–P controller, as CSV.
fn log(moves: &[(f64, f64)], mut seed: u64) -> String {
    let mut uniform = move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let (mut q, mut v) = (0.0_f64, 0.0_f64);
    let (mut seen_before, mut mean_before) = (0.0, 0.0);
    let duration: f64 = moves.iter().map(|(_, time)| 2.0 * time + 0.5).sum::<f64>() + 0.25;
    let mut csv = "t_s,q_ref_m,q_meas_m,u_V\n".to_owned();
    for k in 0..(duration / PERIOD) as usize {
        let t = k as f64 * PERIOD;
        let noise = 3e-8 * (0..4).map(|_| uniform()).sum::<f64>();
        let seen = ((q + noise) / 5e-8).round() * 5e-8;
        let mean = 0.5 * (seen + seen_before);
        let speed = (mean - mean_before) / PERIOD;
        (seen_before, mean_before) = (seen, mean);
        let wanted = reference(t, moves);
        let command = SPEED_GAIN * (POSITION_GAIN * (wanted - seen) - speed);
        let command = command.clamp(-10.0, 10.0);
        writeln!(csv, "{t},{wanted},{seen},{command}").unwrap();
        let (push, h) = (FORCE_GAIN * command, PERIOD / STEPS as f64);
        for _ in 0..STEPS {
            let way = usize::from(v < 0.0 || (v == 0.0 && push < 0.0));
            let against = if way == 0 { DRY[0] } else { -DRY[1] };
            if v == 0.0 && push.abs() <= DRY[way] {
                continue;
            }
            let next = v + h * (push - against - VISCOUS[way] * v) / MASS;
            // It comes to rest before it turns.
            let next = if v * next < 0.0 { 0.0 } else { next };
            q += 0.5 * h * (v + next);
            v = next;
        }
    }
    csv
}

fn discover(folder: &Path) -> Discovery {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/emps.toml");
    let machine = Machine::read(Path::new(file)).unwrap();
    let Machine::Rigid(axis) = &machine else {
        panic!("{file} is a rigid mass");
    };
    let logs = |name: &str, moves: &[(f64, f64)], seed: u64| {
        let path = folder.join(name);
        std::fs::write(&path, log(moves, seed)).unwrap();
        let log = read_log(&path, &axis.log, &["position_ref_m", "position_m"]).unwrap();
        LogSet::new(vec![(name.to_owned(), log, PERIOD)], &machine).unwrap()
    };
    let fit = logs("fit.csv", &[(0.2, 1.2), (0.08, 1.6), (0.15, 0.9)], 1);
    let check = logs("check.csv", &[(0.12, 1.0), (0.24, 1.5)], 2);
    let found = search(&machine, &fit, &check, &Settings::default(), |_| ()).unwrap();
    discovery(&machine, &fit, &check, &found).unwrap().discovery
}

#[test]
fn friction_that_differs_between_the_directions_is_found_from_mass_and_viscous_friction_alone() {
    let folder = tempfile::tempdir().unwrap();
    let found = discover(folder.path());
    println!("{found:#?}");
    let effect = |name: &str| -> &EffectFound {
        let effect = found.effects.iter().find(|e| e.name == name);
        effect.unwrap_or_else(|| panic!("no {name}: {}", found.sentence))
    };
    let _ = effect("asymmetric-friction");
}
