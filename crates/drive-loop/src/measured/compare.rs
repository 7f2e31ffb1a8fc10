//! How a measured response and the model at its place differ.

use std::f64::consts::TAU;

use frequency_response::ModalFit;
use schemars::JsonSchema;
use serde::Serialize;

use super::WithDeviation;
use super::model_at::ModelAt;
use crate::measured_plant::{MeasuredPlant, PlantLine};
use crate::plant::Number;

/// Frequencies that may be those of one mode, as a ratio.
const SAME: f64 = 1.25;
/// Delays that are tried, as shares of a control cycle, before the best is refined.
const TRIED: usize = 200;
/// Share of the distance that delay and factor must leave at most to be said.
const EXPLAINED: f64 = 0.6;
/// Greatest delay that is looked for, s.
const MOST_DELAY: f64 = 5e-3;

/// How a measured response differs from the model's, the load sliding at the same place.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Comparison {
    /// Time by which the measured response comes later than the model's, s: the delay τ of the best
    /// g e^{−jωτ} between the two.
    pub delay_s: WithDeviation,
    /// The factor g of that.
    pub gain: f64,
    /// Median over the lines of the relative distance of the two responses as they are.
    pub distance: f64,
    /// The same with that delay and factor.
    pub distance_corrected: f64,
    /// Modes that the fit shows, each beside the model's that is next to it.
    pub modes: Vec<ComparedMode>,
    /// Modes of the model within the band that the fit does not show, Hz.
    pub missing_hz: Vec<f64>,
    /// What follows from that, in words.
    pub said: Vec<String>,
}

/// A mode of the fit beside the model's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ComparedMode {
    /// Measured, Hz.
    pub measured_hz: WithDeviation,
    /// Of the model, Hz; none where it has none within a quarter of that.
    pub model_hz: Option<f64>,
}

/// Of a measured plant with the model at its place; none without lines that count.
pub(crate) fn comparison(
    at: &ModelAt,
    plant: &MeasuredPlant,
    fit: Option<&ModalFit>,
    step_hz: f64,
) -> Option<Comparison> {
    let speed = |line: &PlantLine| {
        let model = at.shown(line.frequency_hz)?[1];
        let ratio = line.command[1] / model;
        let deviation = line.deviation[1] / model.norm();
        (ratio.re.is_finite() && ratio.im.is_finite()).then_some((
            line.frequency_hz,
            ratio,
            deviation,
        ))
    };
    let ratios: Vec<(f64, Number, f64)> = plant.lines.iter().filter_map(speed).collect();
    if ratios.len() < 8 {
        return None;
    }
    let (delay, gain) = delay_and_gain(&ratios);
    let median = |of: &dyn Fn(&(f64, Number, f64)) -> f64| {
        let mut all: Vec<f64> = ratios.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let turned = |f: f64| Number::from_polar(gain, -TAU * f * delay.value);
    let mut found = Comparison {
        delay_s: delay,
        gain,
        distance: median(&|(_, ratio, _)| (ratio - 1.0).norm()),
        distance_corrected: median(&|(f, ratio, _)| (ratio / turned(*f) - 1.0).norm()),
        modes: Vec::new(),
        missing_hz: Vec::new(),
        said: Vec::new(),
    };
    if let Some(fit) = fit {
        compare_modes(at, fit, step_hz, &mut found);
    }
    say(&mut found, at.model.period());
    Some(found)
}

/// Weighted least squares of the ratio by g e^{−jωτ}: for each τ the best g is a mean. Lines count by
/// their deviation, none as more exact than 2 %: the model is not.
fn delay_and_gain(ratios: &[(f64, Number, f64)]) -> (WithDeviation, f64) {
    let weight = |(_, ratio, deviation): &(f64, Number, f64)| {
        1.0 / (deviation * deviation + 4e-4 * ratio.norm_sqr())
    };
    let at = |delay: f64| {
        let (mut product, mut power) = (0.0, 0.0);
        for line in ratios {
            let turned = line.1 * Number::from_polar(1.0, TAU * line.0 * delay);
            product += weight(line) * turned.re;
            power += weight(line);
        }
        product / power
    };
    let step = MOST_DELAY / TRIED as f64;
    // The greatest mean of the turned ratio has the least residual.
    let mut best = (0.0, f64::NEG_INFINITY);
    for i in -(TRIED as i64)..=TRIED as i64 {
        let delay = i as f64 * step;
        let height = at(delay);
        if height > best.1 {
            best = (delay, height);
        }
    }
    let mut size = 0.5 * step;
    for _ in 0..40 {
        for delay in [best.0 - size, best.0 + size] {
            let height = at(delay);
            if height > best.1 {
                best = (delay, height);
            }
        }
        size *= 0.7;
    }
    // Of the residual: σ²/Σ w ω² g², σ² its weighted mean square.
    let (delay, gain) = best;
    let (mut squares, mut slope) = (0.0, 0.0);
    for line in ratios {
        let angle = TAU * line.0;
        let error = line.1 * Number::from_polar(1.0, angle * delay) - gain;
        squares += weight(line) * error.norm_sqr();
        slope += weight(line) * (angle * gain) * (angle * gain);
    }
    let deviation = (squares / (2.0 * ratios.len() as f64) / slope).sqrt();
    (
        WithDeviation {
            value: delay,
            deviation,
        },
        gain,
    )
}

fn compare_modes(at: &ModelAt, fit: &ModalFit, step_hz: f64, found: &mut Comparison) {
    let [low, high] = fit.band_hz;
    let mut used = vec![false; at.modes_hz.len()];
    for mode in super::machine_modes(fit, step_hz) {
        let measured = mode.frequency_hz.value;
        let distance = |f: &f64| (f / measured).ln().abs();
        let nearest = (0..used.len())
            .filter(|i| !used[*i] && distance(&at.modes_hz[*i]) < SAME.ln())
            .min_by(|a, b| distance(&at.modes_hz[*a]).total_cmp(&distance(&at.modes_hz[*b])));
        if let Some(i) = nearest {
            used[i] = true;
        }
        found.modes.push(ComparedMode {
            measured_hz: mode.frequency_hz.into(),
            model_hz: nearest.map(|i| at.modes_hz[i]),
        });
    }
    let is_inside = |f: &f64| (low..high).contains(f);
    let unused = at
        .modes_hz
        .iter()
        .zip(&used)
        .filter(|(f, used)| !**used && is_inside(f));
    found.missing_hz = unused.map(|(f, _)| *f).collect();
}

fn say(found: &mut Comparison, period: f64) {
    let delay = found.delay_s;
    let is_sure = delay.value.abs() > 4.0 * delay.deviation;
    // Where neither explains the difference, both are what a missing mode makes of them.
    let explains = found.distance_corrected < EXPLAINED * found.distance;
    if is_sure && explains && delay.value.abs() > 0.2 * period {
        found.said.push(match delay.value > 0.0 {
            true => format!(
                "the response comes {:.3} ms later than the model's: a delay that the axis file does not have (command_delay, current_delay_periods, a filter of the drive); discover can name it",
                1e3 * delay.value
            ),
            false => format!(
                "the response comes {:.3} ms sooner than the model's: the axis file has a delay or a lag too many",
                -1e3 * delay.value
            ),
        });
    }
    if explains && (found.gain - 1.0).abs() > 0.05 {
        found.said.push(format!(
            "the response is {:.2} times the model's: another inertia, another torque constant, or a command in another unit",
            found.gain
        ));
    }
    for mode in &found.modes {
        match mode.model_hz {
            None => found.said.push(format!(
                "the model has no mode at {:.1} Hz: a body on the table or in the frame; discover can name it",
                mode.measured_hz.value
            )),
            Some(model) if (mode.measured_hz.value / model - 1.0).abs() > 0.03 => {
                found.said.push(format!(
                    "a mode is at {:.1} Hz and the model's at {model:.1} Hz: another mass or stiffness",
                    mode.measured_hz.value
                ));
            }
            Some(_) => {}
        }
    }
}
