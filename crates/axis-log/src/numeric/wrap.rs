//! Angles and counters that begin anew after a turn.

/// Share of the period that all jumps must come to it within, and by which the values may go
/// beyond it.
const NEAR: f64 = 0.02;
/// Greatest step of a motion that is told from a jump the other way, as a share of the period: a
/// motion of half a period in a sample looks the same either way, and half of that leaves room.
const FASTEST: f64 = 0.25;

/// The period of these after which the samples plainly begin anew, and how often they do: all
/// values lie within one period; steps are those of a motion, or jumps of a period beside what
/// their neighbours move by; and the motion goes through one jump at least, the other way: a
/// command that steps by a turn stands before and behind. Samples without a value are passed
/// over, and so are a few other steps, as spikes make them.
pub(crate) fn wrap(samples: &[f64], periods: &[f64]) -> Option<(f64, usize)> {
    let values = samples.iter().copied().filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    // A jump comes to its period less a step on either side.
    let fits =
        |period: &&f64| (1.0 - 2.0 * FASTEST..=1.0 + NEAR).contains(&((high - low) / **period));
    let of = |period: &f64| Some((*period, jumps(samples, *period)?));
    periods.iter().filter(fits).find_map(of)
}

/// How many steps are jumps of that period.
fn jumps(samples: &[f64], period: f64) -> Option<usize> {
    let steps: Vec<f64> = samples.windows(2).map(|w| w[1] - w[0]).collect();
    let moves = |k: Option<usize>| {
        let step = *steps.get(k?)?;
        (step.abs() <= FASTEST * period).then_some(step)
    };
    let (mut count, mut through, mut odd) = (0, 0, 0);
    for (k, &step) in steps.iter().enumerate() {
        // A step beside a sample without a value is no number.
        let is_fast = step.abs() > FASTEST * period;
        if !is_fast {
            continue;
        }
        let around = [moves(k.checked_sub(1)), moves(Some(k + 1))];
        let around: Vec<f64> = around.into_iter().flatten().collect();
        let beside = around.iter().sum::<f64>() / around.len().max(1) as f64;
        // What is left of a jump is a step of the motion, as large as those beside it.
        let left = step - step.signum() * period;
        if (left - beside).abs() > NEAR * period + 0.5 * beside.abs() {
            odd += 1;
            continue;
        }
        count += 1;
        through += usize::from(beside * step < 0.0);
    }
    (through > 0 && SPIKES * odd <= count).then_some(count)
}

/// Jumps for each step that is neither a jump nor a motion.
const SPIKES: usize = 4;

/// Takes the jumps out: each sample is moved by whole periods to where it is nearest to the
/// one before; behind samples without a value, nearest to where the last step leads.
pub(crate) fn unwrap(samples: &mut [f64], period: f64) {
    let (mut last, mut step, mut gone): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
    for value in samples {
        gone += 1.0;
        if !value.is_finite() {
            continue;
        }
        if let Some(last) = last {
            let expected = if gone > 1.0 { last + gone * step } else { last };
            *value += period * ((expected - *value) / period).round();
            step = (*value - last) / gone;
        }
        (last, gone) = (Some(*value), 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_told_from_a_step_of_another_size() {
        let ramp = |period: f64, rate: f64| -> Vec<f64> {
            (0..400)
                .map(|k| (f64::from(k) * rate).rem_euclid(period))
                .collect()
        };
        let turns = [std::f64::consts::TAU, 360.0, 1.0];
        for (period, rate) in [(360.0, 7.0), (360.0, -31.0), (1.0, 0.2), (turns[0], 0.05)] {
            let mut samples = ramp(period, rate);
            assert_eq!(wrap(&samples, &turns).map(|w| w.0), Some(period));
            unwrap(&mut samples, period);
            let moves = samples.windows(2).map(|w| w[1] - w[0]);
            assert!(moves.clone().all(|step| (step - rate).abs() < 1e-9));
        }
        // A period that is none of these, a command that steps by a turn, and no jump at all.
        assert_eq!(wrap(&ramp(300.0, 7.0), &turns), None);
        let step: Vec<f64> = (0..100).map(|k| if k < 50 { 0.0 } else { 360.0 }).collect();
        assert_eq!(wrap(&step, &turns), None);
        assert_eq!(wrap(&ramp(1e9, 0.9), &turns), None);
    }

    #[test]
    fn a_hole_is_crossed_as_the_motion_goes_on() {
        let truth = |k: i32| f64::from(k) * 50.0;
        let mut samples: Vec<f64> = (0..60).map(|k| truth(k).rem_euclid(360.0)).collect();
        samples[20..25].fill(f64::NAN);
        unwrap(&mut samples, 360.0);
        for k in (0..20).chain(25..60) {
            assert!((samples[k as usize] - truth(k)).abs() < 1e-9, "{k}");
        }
    }
}
