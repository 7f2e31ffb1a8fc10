//! Noise that is not what the search supposes: coloured, quantised, with outliers, and in
//! the logger.

use axis_log::quality::outliers;
use axis_log::{Channel, Log, LogError};
use axis_sim::Measured;

use super::Noise;
use super::rough_kind::{Entry, NoiseColour, Rough};
use super::rough_stream::Stream;

impl Rough {
    /// White noise in the loop, so many times that of good sensors, and nothing beside it.
    pub fn white(level: f64) -> Self {
        Self {
            level,
            colour: NoiseColour::White,
            entry: Entry::Loop,
            share: 0.0,
            corner: 100.0,
            line: 50.0,
            rare: 0.0,
            far: 0.0,
        }
    }

    /// In tables: what comes beside the white noise, and where.
    pub fn name(&self) -> &'static str {
        match (self.colour, self.entry) {
            (NoiseColour::White, Entry::Loop) => "white, loop",
            (NoiseColour::White, Entry::Logger) => "white, logger",
            (NoiseColour::Coloured, Entry::Loop) => "coloured, loop",
            (NoiseColour::Coloured, Entry::Logger) => "coloured, logger",
            (NoiseColour::Quantised, Entry::Loop) => "quantised, loop",
            (NoiseColour::Quantised, Entry::Logger) => "quantised, logger",
            (NoiseColour::Outliers, _) => "outliers, logger",
        }
    }

    fn has(&self, entry: Entry) -> bool {
        let own = match self.colour {
            NoiseColour::Outliers => Entry::Logger,
            _ => self.entry,
        };
        own == entry
    }

    /// Sensors with this noise, `good` ones as the measure, sampled every `period` seconds,
    /// for [`axis_sim::ClosedLoop::run_sensed`]: the same seed gives the same noise.
    pub fn sensors(self, good: Noise, period: f64, seed: u64) -> impl FnMut(&mut Measured) {
        let base = good.scaled(self.level);
        let mut white = base.sensors(seed);
        let deviations = [
            base.position,
            base.angle,
            base.speed,
            base.current,
            base.current,
        ];
        let entered = self.has(Entry::Loop);
        let mut streams: Vec<Stream> = (deviations.into_iter().enumerate())
            .map(|(i, d)| Stream::new(self, d, period, seed ^ (0x6c6f_6f70 + ((i as u64) << 40))))
            .collect();
        move |seen: &mut Measured| {
            white(seen);
            if !entered {
                return;
            }
            let shown = [
                &mut seen.position,
                &mut seen.motor_angle,
                &mut seen.motor_speed,
                &mut seen.current.d,
                &mut seen.current.q,
            ];
            for (value, stream) in shown.into_iter().zip(&mut streams) {
                *value = stream.show(*value);
            }
        }
    }

    /// The log as this logger writes it, one sample every `period` seconds; outliers are
    /// found, bridged and marked as `discover` does on reading a file.
    ///
    /// # Errors
    /// [`LogError`] never of a log with finite samples.
    pub fn logged(&self, log: &Log, good: Noise, period: f64, seed: u64) -> Result<Log, LogError> {
        if !self.has(Entry::Logger) {
            return Ok(log.clone());
        }
        let base = good.scaled(self.level);
        let one = |(c, channel): (usize, &Channel)| {
            let seed = seed ^ (0x6c6f_6767 + ((c as u64) << 40));
            let mut samples = channel.samples.clone();
            if let Some(deviation) = deviation_in(&base, &channel.name) {
                let mut stream = Stream::new(*self, deviation, period, seed);
                samples.iter_mut().for_each(|v| *v = stream.show(*v));
            }
            Channel {
                samples,
                ..channel.clone()
            }
        };
        let log = Log::new(log.channels().iter().enumerate().map(one).collect())?;
        match self.colour {
            NoiseColour::Outliers => corrected(&log, &base),
            _ => Ok(log),
        }
    }
}

/// The noise of the sensor or converter behind a channel, in the channel's unit; `None` of
/// what a logger passes on as a number: time, references, voltages.
fn deviation_in(noise: &Noise, channel: &str) -> Option<f64> {
    match channel {
        "position_m" | "position_rad" => Some(noise.position),
        "motor_angle_rad" => Some(noise.angle),
        "motor_speed_rad_s" => Some(noise.speed),
        "iq_a" | "id_a" | "iq_ref_a" | "torque_ref_n_m" | "force_ref_n" => Some(noise.current),
        _ => None,
    }
}

/// The log with isolated outliers of its measured channels bridged and marked as missing.
fn corrected(log: &Log, noise: &Noise) -> Result<Log, LogError> {
    let mut marks = Vec::new();
    let mut one = |channel: &Channel| {
        let mut channel = channel.clone();
        if deviation_in(noise, &channel.name).is_some() {
            let holes: Vec<usize> = (outliers(&channel.samples).iter())
                .map(|o| o.index)
                .collect();
            bridge(&mut channel.samples, &holes);
            marks.push((channel.name.clone(), holes));
        }
        channel
    };
    let channels = log.channels().iter().map(&mut one).collect();
    let mut log = Log::new(channels)?;
    for (name, holes) in marks {
        log.mark_missing(&name, holes.into_iter().map(|k| k..k + 1))?;
    }
    Ok(log)
}

/// Straight lines over single samples.
fn bridge(samples: &mut [f64], holes: &[usize]) {
    let last = samples.len() - 1;
    let sound = |k: &usize| !holes.contains(k);
    for &hole in holes {
        let before = (0..hole).rev().find(sound);
        let after = (hole + 1..=last).find(sound);
        samples[hole] = match (before, after) {
            (Some(a), Some(b)) => {
                let along = (hole - a) as f64 / (b - a) as f64;
                samples[a] + along * (samples[b] - samples[a])
            }
            (Some(k), None) | (None, Some(k)) => samples[k],
            (None, None) => samples[hole],
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axis_sim::NormalNumbers;

    fn stream(rough: Rough) -> Vec<f64> {
        let mut stream = Stream::new(rough, 1.0, 1e-3, 5);
        (0..200_000).map(|_| stream.show(0.0)).collect()
    }

    fn covariance(x: &[f64], lag: usize) -> f64 {
        let pairs = x.iter().zip(&x[lag..]).map(|(a, b)| a * b);
        pairs.sum::<f64>() / (x.len() - lag) as f64
    }

    /// Variance 1, half of it a line, half that of a filter: its covariance over a lag τ is
    /// (e^(−2π f_c τ) + cos 2π f τ) / 2.
    #[test]
    fn coloured_noise_has_the_covariance_of_a_filter_and_a_line() {
        let rough = Rough {
            colour: NoiseColour::Coloured,
            share: 1.0,
            corner: 20.0,
            line: 61.0,
            ..Rough::white(1.0)
        };
        let x = stream(rough);
        for lag in [0, 3, 11] {
            let tau = std::f64::consts::TAU * lag as f64 * 1e-3;
            let expected = 0.5 * ((-rough.corner * tau).exp() + (rough.line * tau).cos());
            // Some 12 600 independent values: four deviations of their mean square.
            let off = covariance(&x, lag) - expected;
            assert!(
                off.abs() < 4.0 * (1.0 / 12_600.0_f64).sqrt(),
                "{lag}: {off}"
            );
        }
    }

    #[test]
    fn steps_are_no_more_than_half_a_resolution_off() {
        let rough = Rough {
            colour: NoiseColour::Quantised,
            share: 0.3,
            ..Rough::white(1.0)
        };
        let mut stream = Stream::new(rough, 1.0, 1e-3, 5);
        for k in 0..1000 {
            let value = 0.017 * f64::from(k);
            let shown = stream.show(value);
            assert!((shown - value).abs() <= 0.15 + 1e-12);
            assert!((shown / 0.3 - (shown / 0.3).round()).abs() < 1e-9);
        }
    }

    #[test]
    fn outliers_are_as_rare_as_asked_and_are_taken_out() {
        let rough = Rough {
            colour: NoiseColour::Outliers,
            rare: 1e-3,
            far: 300.0,
            ..Rough::white(1.0)
        };
        let found = stream(rough).iter().filter(|v| **v != 0.0).count();
        // Poisson of 200: four deviations.
        assert!(
            (found as f64 - 200.0).abs() < 4.0 * 200f64.sqrt(),
            "{found}"
        );
        let good = Noise {
            position: 1e-8,
            ..Noise::GOOD
        };
        let mut normal = NormalNumbers::new(2);
        let quiet: Vec<f64> = (0..20_000).map(|_| 1e-8 * normal.draw()).collect();
        let channel = |name: &str, samples| Channel::new(name, samples).unwrap();
        let time = (0..20_000).map(|k| 1e-3 * f64::from(k)).collect();
        let log = Log::new(vec![channel("t_s", time), channel("position_m", quiet)]).unwrap();
        // So rare that none stands beside another, which would be taken for a swing.
        let rarer = Rough {
            rare: 2e-4,
            ..rough
        };
        let shown = rarer.logged(&log, good, 1e-3, 3).unwrap();
        let most = shown.channel("position_m").unwrap().iter();
        assert!(most.fold(0.0_f64, |m, v| m.max(v.abs())) < 1e-7);
        assert!(!shown.missing("position_m").is_empty());
    }
}
