//! Coloured noise that sensors bring into the loop.
//!
//! A sensor's noise need not be white: hum, a fan, an interpolation that beats with the sampling.
//! A line that stands out is taken from the logs before ([`Hum`](super::Hum)). Where such noise
//! goes round the loop, it shows in all channels, as a force does. In a band in which
//! the residual neither follows the motion ([`MotionAndRest`]) nor asks whether the axis moves
//! ([`Steadiness`]), what is above the white noise is taken for noise of the sensors, shared among
//! them as their white noise would have to be to show so in all channels. Below the second band
//! nobody can tell noise from what the model lacks: there it is taken to go on as in the quietest
//! of the next bands. What the loop makes of it is simulated, friction and all: noise shakes
//! bristles that hold, and so changes how an axis stands and starts.

use axis_sim::effects::Measure;
use axis_sim::{Axis, ReplayError};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::level::{Spectra, shows_noise};
use super::motion::{MotionAndRest, Simulated};
use super::sensor::{Sensor, SensorNoise};
use super::sources::{Powers, variances};
use super::steady::{Steadiness, shaped};
use super::{LogNoise, at_state};
use crate::answers::State;

/// Noise of each sensor beside its white noise, by band.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colour {
    /// Upper edges of the bands, Hz.
    ends: Vec<f64>,
    /// In the order of [`Sensor::ALL`]: standard deviation of white noise with the power that the
    /// sensor's noise has in the band, in its unit. Empty of white noise.
    deviations: Vec<[f64; 4]>,
}

/// Share of the white noise of a channel that may be beside it where nothing is seen.
const LEAST: f64 = 0.1;

/// Share of a channel's white noise that the white noise of a sensor must make to be seen there.
const HARDLY: f64 = 1e-6;

/// Share of a sensor's white noise below which its noise is none.
const NOTHING: f64 = 1e-3;

/// Bands from which on noise is told from what the model lacks, and of which the quietest goes on
/// below.
const TOLD: std::ops::Range<usize> = 1..4;

/// Noise of the `check` logs (with their simulations) with its colour; `None` if no band of
/// them shows any. Filters from motion to rest are sought on the `fit` logs too.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
pub(crate) fn coloured_noise(
    machine: &Axis,
    state: &State,
    fit: Simulated,
    check: Simulated,
) -> Result<Option<LogNoise>, ReplayError> {
    let (set, traces) = check;
    let axis = at_state(machine, state);
    if !shows_noise(&axis, set) {
        return Ok(None);
    }
    let rest = set.rest(traces);
    let spectra = Spectra::of(&axis, set, &rest, traces);
    let mut noise = spectra.white();
    let predicted = spectra.predicted(&noise);
    let of_motion = MotionAndRest::new(fit, check);
    let steadiness = Steadiness::new(set, &rest, traces);
    // Filters take bins of all channels: bands are wider then.
    let wider = |[low, high]: [f64; 2]| {
        let mut bands = set.layout.bands().map(|(edges, _)| edges);
        bands.find(|edges| 0.5 * (low + high) < edges[1])
    };
    let is_noise = |(b, band): (usize, [f64; 2])| {
        let white: Vec<f64> = predicted.iter().map(|channel| channel[b]).collect();
        b >= TOLD.start
            && steadiness.holds(band, &white)
            && wider(band).is_some_and(|edges| !of_motion.follows(edges))
    };
    let is_noise: Vec<bool> = spectra.bands.edges().enumerate().map(is_noise).collect();
    if !is_noise.contains(&true) {
        return Ok(None);
    }
    let answers = spectra.answers_in_bands(&axis, traces);
    let deviations = coloured(&spectra, &answers, &predicted, &is_noise);
    noise.colour = Colour {
        ends: spectra.bands.edges().map(|[_, high]| high).collect(),
        deviations,
    };
    tracing::debug!(colour = ?noise.colour, "noise in the loop");
    Ok(Some(noise))
}

/// Of a band (`[low, high]`, Hz): whether what the logs' rest has there beside white noise is
/// there while the
/// axis stands. What repeats with its way does not follow its motion as filters do, but comes with
/// it.
pub(crate) fn steady_bands(
    machine: &Axis,
    state: &State,
    (set, traces): Simulated,
) -> impl Fn([f64; 2]) -> bool {
    let rest = set.rest(traces);
    let spectra = Spectra::of(&at_state(machine, state), set, &rest, traces);
    let predicted = spectra.predicted(&spectra.white());
    let steadiness = Steadiness::new(set, &rest, traces);
    let holds = |(b, band): (usize, [f64; 2])| {
        let white: Vec<f64> = predicted.iter().map(|channel| channel[b]).collect();
        (band, steadiness.holds(band, &white))
    };
    let bands: Vec<([f64; 2], bool)> = spectra.bands.edges().enumerate().map(holds).collect();
    move |[low, high]| {
        let middle = |[a, b]: [f64; 2]| 0.5 * (a + b);
        let mut inside = bands
            .iter()
            .filter(|(band, _)| (low..high).contains(&middle(*band)));
        inside.all(|(_, holds)| *holds)
    }
}

/// Deviations of each sensor's noise beside its white noise, a row a band, by the powers of their
/// `answers` to noise in the bands and those `predicted` of white noise. In bands that are none of
/// noise
/// there is none.
fn coloured(
    spectra: &Spectra,
    answers: &[Powers],
    predicted: &Powers,
    is_noise: &[bool],
) -> Vec<[f64; 4]> {
    let one = |(b, is_noise): (usize, &bool)| {
        if !is_noise {
            return [0.0; 4];
        }
        let cells = spectra.observed.iter().zip(predicted);
        let above: Vec<Vec<f64>> = cells
            .map(|(seen, white)| vec![(seen[b] - white[b]).max(LEAST * white[b])])
            .collect();
        // What hardly shows a sensor's noise cannot tell how much of it there is.
        let shown = |answer: f64, white: f64| if answer > HARDLY * white { answer } else { 0.0 };
        let of_sensors: Vec<Powers> = (answers.iter())
            .map(|channels| {
                let pairs = channels.iter().zip(predicted);
                pairs
                    .map(|(c, white)| vec![shown(c[b], white[b])])
                    .collect()
            })
            .collect();
        let shares = variances(&above, &of_sensors, &[1.0], 0, of_sensors.len());
        let mut guess = spectra.guess;
        let mut deviations = [0.0; 4];
        for ((deviation, sensor), share) in deviations.iter_mut().zip(Sensor::ALL).zip(shares) {
            let share = if share < NOTHING { 0.0 } else { share };
            *deviation = *sensor.of(&mut guess) * share.sqrt();
        }
        deviations
    };
    let mut all: Vec<[f64; 4]> = is_noise.iter().enumerate().map(one).collect();
    // As a whole: of few channels noise of one sensor may pass for another's.
    let mut guess = spectra.guess;
    let levels = Sensor::ALL.map(|sensor| sensor.of(&mut guess).max(f64::MIN_POSITIVE));
    let power = |d: &[f64; 4]| -> f64 { d.iter().zip(levels).map(|(d, l)| (d / l).powi(2)).sum() };
    let told = &all[TOLD.start.min(all.len())..TOLD.end.min(all.len())];
    let quietest = told.iter().min_by(|a, b| power(a).total_cmp(&power(b)));
    if let Some(quietest) = quietest.copied() {
        all[..TOLD.start].fill(quietest);
    }
    all
}

impl Colour {
    /// White up to a frequency, Hz.
    pub(super) fn up_to(end: f64, mut sensors: SensorNoise) -> Self {
        Self {
            ends: vec![end],
            deviations: vec![Sensor::ALL.map(|sensor| *sensor.of(&mut sensors))],
        }
    }

    /// What must be known of it to read a result; `None` if there is nothing.
    pub(super) fn note(&self, machine: &Axis) -> Option<String> {
        let named = [
            ("a position sensor", Measure::Travel.unit(machine.freedom())),
            ("a motor encoder", "rad"),
            ("a speed sensor", "rad/s"),
            ("a current sensor", "A"),
        ];
        let begin = |b: usize| if b == 0 { 0.0 } else { self.ends[b - 1] };
        let of = |(s, (name, unit)): (usize, (&str, &str))| {
            let power = |b: usize| self.deviations[b][s].powi(2) * (self.ends[b] - begin(b));
            let bands = 0..self.ends.len();
            let most = bands
                .clone()
                .max_by(|&a, &b| power(a).total_cmp(&power(b)))?;
            // White noise has its power up to half of the control rate.
            let rms = (2.0 * machine.period * bands.map(power).sum::<f64>()).sqrt();
            (rms > 0.0).then(|| {
                let [low, high] = [begin(most), self.ends[most]];
                format!("{name} with {rms:.1e} {unit} RMS (most from {low:.0} to {high:.0} Hz)")
            })
        };
        let all: Vec<String> = named.into_iter().enumerate().filter_map(of).collect();
        (!all.is_empty()).then(|| {
            format!(
                "noise in the loop is not white: beside white noise there is as much as {} would cause; it does not follow the motion, is there at standstill too, and is taken for noise",
                all.join(", ")
            )
        })
    }

    /// Noise beside the white noise, one sample every `period` seconds without end, of the sensors
    /// of [`Sensor::ALL`], the current's on the q axis, and then on the d axis; none if there is
    /// not any.
    pub(super) fn samples(&self, seed: u64, period: f64) -> Samples {
        let mut samples = Samples {
            colour: self.clone(),
            period,
            random: ChaCha8Rng::seed_from_u64(seed),
            fading: Vec::new(),
            ready: Vec::new().into_iter(),
        };
        if !self.deviations.is_empty() {
            samples.fading = samples.block().split_off(BLOCK / 2);
        }
        samples
    }
}

/// Samples that are shaped at once: blocks fade into each other over half of their length.
const BLOCK: usize = 1 << 16;

/// Coloured noise, sample by sample.
pub(super) struct Samples {
    colour: Colour,
    period: f64,
    random: ChaCha8Rng,
    /// Second half of the last block.
    fading: Vec<[f64; 5]>,
    ready: std::vec::IntoIter<[f64; 5]>,
}

impl Samples {
    /// A block, faded in and out so that powers of neighbours add up to one.
    fn block(&mut self) -> Vec<[f64; 5]> {
        let fade = |k: usize| (std::f64::consts::PI * (k as f64 + 0.5) / BLOCK as f64).sin();
        let mut all = vec![[0.0; 5]; BLOCK];
        for (place, s) in [0, 1, 2, 3, 3].into_iter().enumerate() {
            let deviations = &self.colour.deviations;
            if deviations.iter().all(|d| d[s] == 0.0) {
                continue;
            }
            let white: Vec<f64> = (0..BLOCK)
                .map(|_| StandardNormal.sample(&mut self.random))
                .collect();
            let own = shaped(&white, |k| {
                let frequency = k as f64 / (BLOCK as f64 * self.period);
                let band = self.colour.ends.iter().position(|end| frequency < *end);
                band.map_or(0.0, |b| deviations[b][s])
            });
            for ((k, into), value) in all.iter_mut().enumerate().zip(own) {
                into[place] = fade(k) * value;
            }
        }
        all
    }
}

impl Iterator for Samples {
    type Item = [f64; 5];

    fn next(&mut self) -> Option<[f64; 5]> {
        if self.fading.is_empty() {
            return None;
        }
        if let Some(sample) = self.ready.next() {
            return Some(sample);
        }
        let mut block = self.block();
        let fading = block.split_off(BLOCK / 2);
        for (rising, fading) in block.iter_mut().flatten().zip(self.fading.iter().flatten()) {
            *rising += fading;
        }
        self.fading = fading;
        self.ready = block.into_iter();
        self.ready.next()
    }
}

#[cfg(test)]
mod tests {
    use axis_sim::Axis;

    use super::Colour;
    use crate::noise::steady::only;

    const PERIOD: f64 = 1e-4;
    const SAMPLES: usize = 200_000;

    /// White in [25, 37.5) Hz for the position, in [37.5, 84) Hz for the current.
    fn colour() -> Colour {
        let mut deviations = vec![[0.0; 4]; 3];
        (deviations[1][0], deviations[2][3]) = (2.0, 3.0);
        Colour {
            ends: vec![25.0, 37.5, 84.0],
            deviations,
        }
    }

    /// White noise of deviation σ has σ² (high − low) 2T of its variance in a band, T being the
    /// sampling period. In 20 s bands as wide as these have 250 and 930 complex values: their mean
    /// square is known to 6 and 3 %. What is cut off at both ends leaves a little elsewhere.
    #[test]
    fn each_sensor_has_the_noise_of_its_band_and_no_other() {
        let samples = colour().samples(3, PERIOD);
        let series: Vec<[f64; 5]> = samples.take(SAMPLES).collect();
        assert_eq!(series.len(), SAMPLES);
        let column = |place: usize| -> Vec<f64> { series.iter().map(|s| s[place]).collect() };
        let square = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>() / SAMPLES as f64;
        let near = |found: f64, deviation: f64, width: f64, within: f64| {
            let expected = deviation * deviation * width * 2.0 * PERIOD;
            assert!(
                (found / expected - 1.0).abs() < within,
                "{found} {expected}"
            );
        };
        near(square(&column(0)), 2.0, 12.5, 0.25);
        for q_or_d in [3, 4] {
            near(square(&column(q_or_d)), 3.0, 46.5, 0.13);
            let outside = only(&column(q_or_d), PERIOD, [100.0, 400.0]);
            assert!(square(&outside) < 1e-3 * square(&column(q_or_d)));
        }
        // Two currents, each with noise of its own.
        let pairs = series.iter().map(|s| s[3] * s[4]).sum::<f64>() / SAMPLES as f64;
        assert!(pairs.abs() < 0.25 * square(&column(3)));
        assert!(column(1).iter().chain(&column(2)).all(|v| *v == 0.0));
    }

    /// σ √(2 · width · period): of the current 3 A · √(2 · 46.5 Hz · 1e-4 s), at the control rate
    /// of this axis.
    #[test]
    fn one_note_gives_the_size_of_each_sensors_noise() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let machine = Axis::read(file.as_ref()).unwrap();
        let note = colour().note(&machine).unwrap();
        assert!(note.contains("1.0e-1 m RMS (most from 25 to 38 Hz), a current sensor with 2.9e-1 A RMS (most from 38 to 84 Hz)"), "{note}");
        assert_eq!(Colour::default().note(&machine), None);
    }

    #[test]
    fn white_noise_has_nothing_beside_it() {
        assert_eq!(Colour::default().samples(3, PERIOD).next(), None);
    }
}
