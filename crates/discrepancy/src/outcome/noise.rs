//! How much of a rest is noise.

use axis_sim::effects::Machine;
use axis_sim::{Axis, ClosedLoop, ReplayError};

use super::Rest;
use crate::fit::Fit;
use crate::hidden::Noise;
use crate::known::with_known;
use crate::model::{LogSet, State};
use crate::spectrum::Layout;

/// Noise of the sensors of a ball-screw loop, as the fitted logs show it.
///
/// The upper half of the bins lies above what the loop answers to, and shows
/// each sensor's own noise there: position and angle directly, the speed's
/// through the speed controller's gain, the current's through the current
/// controller's.
pub(super) fn sensor_noise(
    machine: &Machine,
    set: &LogSet,
    state: &State,
    fit: &Fit,
) -> Option<Noise> {
    let Machine::BallScrew(axis) = with_known(machine, &state.shares) else {
        return None;
    };
    Some(noise_at(&axis, set, &set.rest(&fit.traces)))
}

fn noise_at(axis: &Axis, set: &LogSet, rest: &Rest) -> Noise {
    let level = |name: &str| {
        let channel = set.channels.iter().position(|c| *c == name);
        channel.map_or(0.0, |c| upper_level(set, rest, c))
    };
    let gains = *axis.servo.gains();
    let per = |level: f64, gain: f64| if gain > 0.0 { level / gain } else { 0.0 };
    Noise {
        position: level("position_m"),
        angle: level("motor_angle_rad"),
        speed: per(level("iq_ref_a"), gains.speed_p),
        current: per(level("ud_v"), gains.d_p),
    }
}

/// RMS of noise alone in each channel: a ball-screw loop is simulated with
/// sensors as noisy as its logs show, since most of what they do lies where the
/// loop answers. For a rigid machine the upper spectrum is taken for white.
pub(super) fn floors(
    machine: &Machine,
    set: &LogSet,
    state: &State,
    best: &Rest,
) -> Result<Vec<f64>, ReplayError> {
    let Machine::BallScrew(axis) = with_known(machine, &state.shares) else {
        let levels = (0..set.channels.len()).map(|c| upper_level(set, best, c));
        return Ok(levels.collect());
    };
    let noise = noise_at(&axis, set, best);
    let mut axis = *axis;
    axis.effects.extend_from_slice(&state.effects);
    let closed_loop = ClosedLoop::new(&axis)?;
    let mut squares = vec![0.0; set.channels.len()];
    let mut samples = 0;
    for (seed, log) in set.logs.iter().enumerate() {
        let with = log
            .replay
            .follow(&closed_loop, noise.sensors(seed as u64))?;
        let without = log.replay.follow(&closed_loop, |_| ())?;
        for (square, name) in squares.iter_mut().zip(&set.channels) {
            let pair = with.channel(name).zip(without.channel(name));
            let Some((a, b)) = pair else { continue };
            *square += a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        }
        samples += log.log.len();
    }
    Ok(squares
        .iter()
        .map(|s| (s / f64::from(samples.max(1) as u32)).sqrt())
        .collect())
}

/// RMS of white noise with the level of the upper half of the bins.
fn upper_level(set: &LogSet, rest: &Rest, channel: usize) -> f64 {
    let sizes: Vec<(usize, f64)> = set.logs.iter().map(|l| (l.log.len(), l.period)).collect();
    let layout = Layout::new(1, &sizes);
    let (mut sum, mut n) = (0.0, 0usize);
    for (log, series) in rest.iter().enumerate() {
        let bins = layout.transform(log, &series[channel..=channel], &[false]);
        for value in &bins[bins.len() / 2..] {
            sum += value.norm_sqr();
            n += 1;
        }
    }
    (sum / n.max(1) as f64).sqrt()
}
