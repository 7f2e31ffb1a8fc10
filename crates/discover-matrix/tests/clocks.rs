//! Logs whose reference is late, is sampled more slowly than the loop runs, or jitters under even stamps.

use axis_log::{Channel, Log};
use discover_matrix::hidden::{Exercise, exercise};
use discrepancy::{LogSet, Settings, Verdict, discovery, search};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trajectories::{Motion, Program, Setpoint};

use crate::machines::{find_on_stage, hide_in, logs_of, stage, with_only};

/// A reference that is logged late, by more than a sample and by a part of one, is no velocity
/// feed-forward: the delay is named, and nothing else.
#[test]
fn a_late_reference_is_a_delay() {
    let machine = stage();
    for late in [1.5e-3, -0.3e-3] {
        let hidden = hide_in(&machine, Vec::new(), 17);
        let [fit, check] = [false, true].map(|check| {
            let motion = exercise(&machine, Exercise::ThereAndBack, check).unwrap();
            let set = logs_of(&machine, &hidden, &motion, check);
            let log = with_late_reference(&set.logs[0].log, &motion, late);
            LogSet::new(
                vec![("log".to_owned(), log, 5.0 * machine.period)],
                &machine,
            )
            .unwrap()
        });
        let found = search(&machine, &fit, &check, &Settings::default(), |_| ()).unwrap();
        let found = discovery(&machine, &fit, &check, &found).unwrap().discovery;
        let named: Vec<&str> = found.effects.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(named, ["reference-delay"], "{}", found.sentence);
        assert_eq!(found.verdict, Verdict::Explained);
        let time = &found.effects[0].parameters[0];
        let [low, high] = time.ci95;
        // A fiftieth of a sample.
        let is_near = (time.value - late).abs() < 2e-5;
        assert!(is_near && low < late && late < high, "{time:?}");
    }
}

/// The log with the motion of some time before as its reference: evaluated anew, not interpolated.
fn with_late_reference(log: &Log, motion: &Program, late: f64) -> Log {
    let at = |of: fn(Setpoint) -> f64| -> Vec<f64> {
        let before = |t: &f64| motion.at((t - late).max(0.0));
        log.time().iter().map(|t| of(before(t))).collect()
    };
    let shown = |channel: &Channel| {
        let mut channel = channel.clone();
        match channel.name.as_str() {
            "position_ref_m" => channel.samples = at(|s| s.position),
            "velocity_ref_m_s" => channel.samples = at(|s| s.velocity),
            "acceleration_ref_m_s2" => channel.samples = at(|s| s.acceleration),
            _ => {}
        }
        channel
    };
    Log::new(log.channels().iter().map(shown).collect()).unwrap()
}

/// A stage whose loop follows a chirp is logged every fifth cycle: between the samples a cubic was off by
/// so much that a delay of 5 µs was named, and nothing is missing.
#[test]
fn a_reference_is_followed_between_the_samples_of_a_log() {
    let settings = with_only(&["control-delay", "controller-gain", "reference-delay"]);
    let clean = hide_in(&stage(), Vec::new(), 4);
    let found = find_on_stage(&clean, Exercise::WithChirp, &settings);
    assert_eq!(found.verdict, Verdict::NothingMissing, "{}", found.sentence);
}

/// Samples that are off their even stamps by 3 % of a period: the noise stated holds what that makes, nothing is named, and
/// the result says so with its size.
#[test]
fn jitter_under_even_stamps_is_said_beside_the_result() {
    let machine = stage();
    let hidden = hide_in(&machine, Vec::new(), 17);
    let [fit, check] = [false, true].map(|check| {
        let motion = exercise(&machine, Exercise::ThereAndBack, check).unwrap();
        let log = hidden.log(&machine, &motion, 1).unwrap();
        let log = with_jitter(&log, 5, 0.03);
        LogSet::new(
            vec![("log".to_owned(), log, 5.0 * machine.period)],
            &machine,
        )
        .unwrap()
    });
    let settings = with_only(&["clock-offset", "reference-delay", "viscous-friction"]);
    let found = search(&machine, &fit, &check, &settings, |_| ()).unwrap();
    let found = discovery(&machine, &fit, &check, &found).unwrap().discovery;
    assert_eq!(found.verdict, Verdict::NothingMissing, "{}", found.sentence);
    let said = found.notes.iter().find(|note| note.contains("jitter by"));
    let said = said.unwrap_or_else(|| panic!("{:?}", found.notes));
    let share = said.split("jitter by ").nth(1).unwrap().split(' ').next();
    let share: f64 = share.unwrap().parse().unwrap();
    assert!((share - 3.0).abs() < 0.3, "{said}");
}

/// Each `every`-th sample, of channels that are measured as they were some time beside their stamp: linear between
/// cycles, with deviations of this share of the new period.
fn with_jitter(log: &Log, every: usize, share: f64) -> Log {
    let mut random = ChaCha8Rng::seed_from_u64(23);
    let last = log.len() - 1;
    let stamps: Vec<usize> = (0..=last).step_by(every).collect();
    // Twelve uniform numbers have the variance 1, and a sum that is all but normal.
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let off = |_: &usize| share * every as f64 * normal();
    let off: Vec<f64> = stamps.iter().map(off).collect();
    let measured = |samples: &[f64]| -> Vec<f64> {
        let at = |(&k, off): (&usize, &f64)| {
            let along = (k as f64 + off).clamp(0.0, last as f64);
            let i = (along as usize).min(last - 1);
            samples[i] + (along - i as f64) * (samples[i + 1] - samples[i])
        };
        stamps.iter().zip(&off).map(at).collect()
    };
    let shown = |channel: &Channel| {
        let mut channel = channel.clone();
        channel.samples = match channel.name.as_str() {
            "position_m" => measured(&channel.samples),
            _ => stamps.iter().map(|&k| channel.samples[k]).collect(),
        };
        channel
    };
    Log::new(log.channels().iter().map(shown).collect()).unwrap()
}
