//! Iterative learning on a loop that is written down here: a delayed, smoothed response.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{Advice, LearnedMove, LearningSettings};

const PERIOD: f64 = 1e-4;
const CYCLES: usize = 6000;

/// What the axis is off by under a correction: a slow disturbance, of which the correction
/// takes its share, late by four cycles; and noise from a linear congruence.
struct Axis {
    state: u64,
    noise: f64,
    scale: f64,
}

impl Axis {
    fn errors(&mut self, learned: &LearnedMove) -> Vec<Option<f64>> {
        (0..CYCLES)
            .map(|k| {
                let t = k as f64 * PERIOD;
                let disturbance = self.scale * 9e-6 * (-((t - 0.1) / 0.03).powi(2)).exp();
                let led = 0.9 * learned.at(k.saturating_sub(4)).position;
                // Twelve uniform draws: a deviation of 1.
                let mut sum = -6.0;
                for _ in 0..12 {
                    self.state = self
                        .state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    sum += (self.state >> 11) as f64 / (1_u64 << 53) as f64;
                }
                Some(disturbance - led + self.noise * sum)
            })
            .collect()
    }
}

fn axis(noise: f64) -> Axis {
    Axis {
        state: 7,
        noise,
        scale: 1.0,
    }
}

#[test]
fn a_move_is_learned_down_to_the_noise_and_then_left() {
    let mut axis = axis(1e-8);
    let mut learned = LearnedMove::new(PERIOD, &LearningSettings::default()).unwrap();
    let mut peaks = Vec::new();
    let last = loop {
        let errors = axis.errors(&learned);
        let round = learned.learn(&errors);
        peaks.push(round.peak);
        if round.advice != Advice::Again {
            break round;
        }
        assert!(peaks.len() < 10, "{peaks:?}");
    };
    // The Gaussian keeps half a per cent of a disturbance ten times as long as itself.
    assert!(matches!(last.advice, Advice::Done | Advice::Enough));
    assert!(
        peaks[0] > 8.9e-6 && *peaks.last().unwrap() < 1.5e-7,
        "{peaks:?}"
    );
    // A round more leaves it as it is.
    let before = learned.shift().to_vec();
    let errors = axis.errors(&learned);
    learned.learn(&errors);
    assert_eq!(learned.shift(), before);
}

#[test]
fn missing_samples_are_bridged_and_a_whole_gap_of_them_learns_nothing() {
    let mut axis = axis(0.0);
    let fresh = || LearnedMove::new(PERIOD, &LearningSettings::default()).unwrap();
    let (mut whole, mut holed) = (fresh(), fresh());
    let errors = axis.errors(&whole);
    let missing: Vec<_> = errors
        .iter()
        .enumerate()
        .map(|(k, e)| e.filter(|_| k % 7 != 3 && !(900..920).contains(&k)))
        .collect();
    whole.learn(&errors);
    holed.learn(&missing);
    for (a, b) in whole.shift().iter().zip(holed.shift()) {
        assert!((a - b).abs() < 2e-8, "{a} {b}");
    }
    let mut none = fresh();
    none.learn(&vec![None; CYCLES]);
    assert!(none.shift().iter().all(|d| *d == 0.0));
}

#[test]
fn a_part_that_has_changed_makes_learning_start_anew() {
    let mut axis = axis(1e-9);
    let mut learned = LearnedMove::new(PERIOD, &LearningSettings::default()).unwrap();
    for _ in 0..3 {
        let errors = axis.errors(&learned);
        learned.learn(&errors);
    }
    axis.scale = -1.0;
    let errors = axis.errors(&learned);
    let round = learned.learn(&errors);
    assert_eq!((round.advice, round.rounds), (Advice::Restarted, 0));
    assert!(learned.shift().iter().all(|d| *d == 0.0));
    let mut peak = round.peak;
    for _ in 0..3 {
        let errors = axis.errors(&learned);
        peak = learned.learn(&errors).peak;
    }
    assert!(peak < 0.02 * round.peak, "{peak}");
}

/// A move that is off by more than at its best, and by far less than without a correction, has not
/// lost what was learned: dropping that would make the next one as bad as the first.
#[test]
fn what_is_learned_stays_where_a_part_has_changed_a_little() {
    let mut axis = axis(1e-10);
    let mut learned = LearnedMove::new(PERIOD, &LearningSettings::default()).unwrap();
    let mut peaks = Vec::new();
    for lap in 0..12 {
        // 1 % more of the disturbance now and then: many times what the best laps leave.
        axis.scale = if lap % 4 == 3 { 1.01 } else { 1.0 };
        let round = learned.learn(&axis.errors(&learned));
        assert_ne!(round.advice, Advice::Restarted, "lap {lap}");
        peaks.push(round.peak);
    }
    assert!(
        peaks[3..].iter().all(|peak| *peak < 0.03 * peaks[0]),
        "{peaks:?}"
    );
}

#[test]
fn a_stored_correction_goes_on_where_it_was() {
    let mut axis = axis(1e-9);
    let settings = LearningSettings::default();
    let mut learned = LearnedMove::new(PERIOD, &settings).unwrap();
    let errors = axis.errors(&learned);
    learned.learn(&errors);
    let again = LearnedMove::stored(
        PERIOD,
        &settings,
        learned.shift().to_vec(),
        learned.rounds(),
        learned.history(),
    );
    let again = again.unwrap();
    assert_eq!(
        (again.shift(), again.rounds(), again.history()),
        (learned.shift(), learned.rounds(), learned.history())
    );
    for bad in [f64::NAN, 1.0] {
        let refused = LearnedMove::stored(PERIOD, &settings, vec![0.0, bad], 1, [1e-6; 2]);
        assert!(refused.unwrap_err().to_string().contains("shift"));
    }
}
