//! A stand-in for the EMPS stage (see `emps.rs`), whose logs may not be part of this project: friction of the kind
//! that its authors published, other figures, simulated here in the plainest way. Nothing is shared with the
//! library: dry friction is set-valued (it holds or it slides), the step is 2 µs, the encoder is perfect.

use std::fmt::Write;

use axis_log::read_log;
use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, Replay};

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
fn log(moves: &[(f64, f64)]) -> String {
    let (mut q, mut v) = (0.0_f64, 0.0_f64);
    let (mut seen_before, mut mean_before) = (0.0, 0.0);
    let duration: f64 = moves.iter().map(|(_, time)| 2.0 * time + 0.5).sum::<f64>() + 0.25;
    let mut csv = "t_s,q_ref_m,q_meas_m,u_V\n".to_owned();
    for k in 0..(duration / PERIOD) as usize {
        let t = k as f64 * PERIOD;
        let seen = q;
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

/// Root of the mean square of what two channels differ by.
fn rms(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (squares / a.len() as f64).sqrt()
}

#[test]
fn the_rigid_loop_follows_an_independent_one() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/emps.toml");
    let text = std::fs::read_to_string(file).unwrap();
    // Bristles that give way over 10 nm, for friction that holds or slides.
    let text = text
        .replace("presliding_um = 1 ", "presliding_um = 0.01 ")
        .replace("step_us = 50", "step_us = 5");
    let machine = Axis::parse(file, &text).unwrap();
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    let presliding = machine.friction.values().number("presliding").unwrap();
    assert!(near(presliding, 1e-8) && near(machine.simulation.step, 5e-6));

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, log(&[(0.2, 1.2), (0.08, 1.6)])).unwrap();
    let log = read_log(&path, &machine.log, &["position_ref_m", "position_m"]).unwrap();
    let replay = Replay::new(&log, PERIOD).unwrap();
    let effect = |name: &str, values: [f64; 2]| ActiveEffect {
        effect: Effect::named(name).unwrap(),
        values: values.to_vec(),
    };
    let effects = [
        effect("asymmetric-friction", DRY),
        effect("asymmetric-viscous-friction", VISCOUS.map(|v| v - 203.5034)),
    ];
    let deviation = |effects: &[ActiveEffect]| {
        let trace = replay.run(&machine, effects, None).unwrap();
        let rms = |channel| {
            let both = [log.channel(channel).ok(), trace.channel(channel)];
            rms(both[0].unwrap(), both[1].unwrap())
        };
        [rms("position_m"), rms("drive_command_v")]
    };
    // 16.5 µm and 0.645 V without the friction, so that the logs show it at all.
    let [position, command] = deviation(&[]);
    assert!(
        position > 1.5e-5 && command > 0.6,
        "{position} m, {command} V"
    );
    // With it 40 nm and 1.6 mV (0.06 N) are measured, a tenth of what bristles of 1 µm leave.
    let [position, command] = deviation(&effects);
    assert!(
        position < 1e-7 && command < 4e-3,
        "{position} m, {command} V"
    );
}
