//! Shapes of the modes: how far each moves motor and load, from a fit of the motor's response and the load's lines.

use std::f64::consts::TAU;

use axis_sim::Axis;
use frequency_response::{FitSettings, FittedMode, FrequencyResponse, ModalFit, ResponseLine};
use nalgebra::{DMatrix, DVector};

use super::WithDeviation;
use crate::plant::Number;

/// Error of a line that its deviation does not know of, as a share of it: that of fits.
const FLOOR: f64 = 2e-3;
/// Rate (1/s) below which a real pole is the rigid motion's.
const SLOW: f64 = 60.0;
/// Deviations by which a mode must stand out of its error at the motor to be used.
const SEEN: f64 = 3.0;
/// Greatest relative error (RMS) of the load's response with the motor's modes.
const FITS: f64 = 0.2;
const ONE: Number = Number::new(1.0, 0.0);
const J: Number = Number::new(0.0, 1.0);

/// A mode: Q = s² + c s + k, φ_m² and ρ = φ_l/φ_m, each with a deviation; k is 0 for the rigid motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// c, k, φ_m², ρ.
    pub values: [f64; 4],
    pub deviations: [f64; 4],
}

/// A term of the fit, at an angular frequency.
enum Term {
    Pair { pole: Number, residue: Number },
    Real { rate: f64, residue: f64 },
}

impl Term {
    fn at(&self, s: Number) -> Number {
        match self {
            Self::Pair { pole, residue } => {
                residue / (s - pole) + residue.conj() / (s - pole.conj())
            }
            Self::Real { rate, residue } => ONE * *residue / (s + *rate),
        }
    }
}

/// The rigid motion, then the elastic modes that motor and load both show; and notes on modes that are left out.
pub(super) fn modes_of(
    axis: &Axis,
    fit: &ModalFit,
    load: &FrequencyResponse,
    settings: &FitSettings,
    step_hz: f64,
) -> Result<(Vec<Mode>, Vec<String>), String> {
    let torque = axis.torque_constant();
    let slow = |i: &usize| fit.poles[*i].rate.value.abs() < SLOW;
    let rigid = (0..fit.poles.len())
        .filter(slow)
        .max_by(|a, b| {
            let of = |i: &usize| fit.poles[*i].residue.value;
            of(a).total_cmp(&of(b))
        })
        .filter(|i| fit.poles[*i].residue.value > 0.0)
        .ok_or("the fit of the motor's response shows no rigid motion (a pole near 0): excite lower frequencies, or record longer")?;
    let mut terms: Vec<Term> = Vec::new();
    for pole in &fit.poles {
        terms.push(Term::Real {
            rate: pole.rate.value,
            residue: pole.residue.value,
        });
    }
    for mode in &fit.modes {
        terms.push(Term::Pair {
            pole: pole_of(mode),
            residue: mode.residue,
        });
    }
    let ratios = ratios(&terms, fit.delay_s.value, load, settings)?;
    let own = &fit.poles[rigid];
    let mut modes = vec![Mode {
        values: [
            own.rate.value.max(0.0),
            0.0,
            own.residue.value / torque,
            ratios[rigid].value,
        ],
        deviations: [
            own.rate.deviation,
            0.0,
            own.residue.deviation / torque,
            ratios[rigid].deviation,
        ],
    }];
    let mut notes = Vec::new();
    for (i, mode) in fit.modes.iter().enumerate() {
        if !super::is_of_machine(mode, fit, step_hz) {
            continue;
        }
        let pole = pole_of(mode);
        // The residue of K s φ²/Q at its pole p: K φ² p/(2j Im p).
        let by = J * (2.0 * pole.im) / pole / torque;
        let square = (mode.residue * by).re;
        let deviation = mode.residue_deviation * by.norm();
        let hz = mode.frequency_hz.value;
        let is_seen = square >= SEEN * deviation;
        if !is_seen {
            notes.push(format!(
                "the fit of the responses to the actual current, torque or force, of which the compliance is made and the modes above are not, has a pole pair at {hz:.1} Hz that does not stand out of its error; it is left out of the compliance"
            ));
            continue;
        }
        let w = TAU * hz;
        let ratio = ratios[fit.poles.len() + i];
        modes.push(Mode {
            values: [2.0 * mode.damping.value * w, w * w, square, ratio.value],
            deviations: [
                2.0 * mode.damping.deviation * w,
                2.0 * w * TAU * mode.frequency_hz.deviation,
                deviation,
                ratio.deviation,
            ],
        });
    }
    notes.push(format!(
        "modes above {:.0} Hz and modes that the motor does not move are not in it; forces are in the unit that the file's torque constant gives",
        fit.band_hz[1]
    ));
    Ok((modes, notes))
}

fn pole_of(mode: &FittedMode) -> Number {
    let (w, damping) = (TAU * mode.frequency_hz.value, mode.damping.value);
    let across = (1.0 - damping * damping).max(0.0).sqrt();
    Number::new(-damping * w, across * w)
}

/// Real ratios of the load's terms to the motor's: weighted linear least squares, their deviations widened where
/// the residual is more than the lines' own, and by what neighbouring lines have in common.
fn ratios(
    terms: &[Term],
    delay: f64,
    load: &FrequencyResponse,
    settings: &FitSettings,
) -> Result<Vec<WithDeviation>, String> {
    let n = terms.len();
    let used: Vec<&ResponseLine> = load
        .trusted(settings.band_hz, settings.coherence)
        .filter(|line| line.frequency_hz > 0.0)
        .collect();
    if used.len() < n + 8 {
        return Err(format!(
            "only {} lines of the load's response have the coherence; valid: {} at least",
            used.len(),
            n + 8
        ));
    }
    let row = |line: &ResponseLine| -> Vec<Number> {
        let s = J * (TAU * line.frequency_hz);
        let late = (-s * delay).exp();
        terms.iter().map(|term| late * term.at(s)).collect()
    };
    let weight = |line: &ResponseLine| {
        let floor = FLOOR * line.value.norm();
        1.0 / (line.deviation * line.deviation + floor * floor)
    };
    let (mut matrix, mut vector) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
    for line in &used {
        let (row, w) = (row(line), weight(line));
        for i in 0..n {
            vector[i] += w * (row[i].conj() * line.value).re;
            for j in 0..n {
                matrix[(i, j)] += w * (row[i].conj() * row[j]).re;
            }
        }
    }
    // Terms differ by orders of magnitude: scaled to a diagonal of 1.
    let scale: Vec<f64> = (0..n).map(|i| matrix[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (scale[i] * scale[j]));
    let cannot = "the load's response does not tell the modes apart";
    let inverse = scaled.cholesky().ok_or(cannot)?.inverse();
    let found: Vec<f64> = (0..n)
        .map(|i| {
            let of = |j: usize| inverse[(i, j)] * vector[j] / scale[j];
            (0..n).map(of).sum::<f64>() / scale[i]
        })
        .collect();
    let (mut squares, mut relative) = (0.0, 0.0);
    for line in &used {
        let fitted: Number = row(line).iter().zip(&found).map(|(b, x)| b * *x).sum();
        let error = (fitted - line.value).norm_sqr();
        squares += error * weight(line);
        relative += error / line.value.norm_sqr();
    }
    let relative = (relative / used.len() as f64).sqrt();
    if relative > FITS {
        return Err(format!(
            "the load does not move as the modes at the motor say: {:.0} % off (RMS); valid: below {:.0} %, with motor and load sampled at the same instants",
            100.0 * relative,
            100.0 * FITS
        ));
    }
    let widened = (squares / (2 * used.len() - n) as f64).max(1.0) * load.correlation;
    let all = found
        .into_iter()
        .enumerate()
        .map(|(i, value)| WithDeviation {
            value,
            deviation: (inverse[(i, i)] * widened).sqrt() / scale[i],
        });
    Ok(all.collect())
}
