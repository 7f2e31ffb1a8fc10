//! Frequency responses that were measured on an axis: estimated from its logs, compared with its model.

mod beside_model;
mod compare;
mod compliance;
mod model_at;
mod record;
mod shapes;
mod traps;

use axis_log::Log;
use axis_sim::Axis;
use frequency_response::{
    Averaging, Estimator, FitSettings, FittedMode, FrequencyResponse, LoopLine, LoopMargins,
    ModalFit, Record,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::LoopError;
use crate::set::LoopSet;
use compliance::ToEffort;
use record::Recorded;

pub use crate::measured_plant::MeasuredPlant;
pub use compare::{ComparedMode, Comparison};
pub use compliance::{ComplianceLine, MeasuredCompliance, MeasuredShape};
use traps::Response;
pub use traps::Trap;

/// How a response is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureSettings {
    /// Distance of two lines, Hz, where the excitation is not periodic; none: 1.2 Hz, or a quarter of
    /// the excited time, whichever is coarser. A periodic one has lines of its own.
    pub step_hz: Option<f64>,
    /// Minimum coherence of a line that is used.
    pub coherence: f64,
    /// Most poles of the fit; a mode has two.
    pub most_poles: usize,
}

impl Default for MeasureSettings {
    fn default() -> Self {
        Self {
            step_hz: None,
            coherence: 0.9,
            most_poles: 10,
        }
    }
}

impl MeasureSettings {
    fn check(&self) -> Result<(), LoopError> {
        let refused = |name, value, valid| Err(LoopError::Setting { name, value, valid });
        if !(0.0..=1.0).contains(&self.coherence) {
            return refused("the coherence", self.coherence, "from 0 to 1");
        }
        if !(1..=16).contains(&self.most_poles) {
            let value = self.most_poles as f64;
            return refused("the number of poles", value, "from 1 to 16");
        }
        Ok(())
    }
}

/// One line of a response.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredLine {
    /// Hz.
    pub frequency_hz: f64,
    /// Real and imaginary part, in the output's unit per unit of the command.
    pub value: [f64; 2],
    /// Standard deviation of the error in each direction of the complex plane.
    pub deviation: f64,
    /// From 0 to 1.
    pub coherence: f64,
}

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct WithDeviation {
    /// The number.
    pub value: f64,
    /// Standard deviation of its error.
    pub deviation: f64,
}

impl From<frequency_response::Uncertain> for WithDeviation {
    fn from(of: frequency_response::Uncertain) -> Self {
        Self {
            value: of.value,
            deviation: of.deviation,
        }
    }
}

/// A mode in the response of the motor's speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredMode {
    /// Natural frequency, Hz.
    pub frequency_hz: WithDeviation,
    /// Damping ratio.
    pub damping: WithDeviation,
    /// Magnitude of its residue, motor speed per command and s.
    pub residue: f64,
    /// Standard deviation of the residue.
    pub residue_deviation: f64,
}

/// What was fitted to the response of the motor's speed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredModes {
    /// Pairs of poles with a damping below 0.5 and a frequency within the lines that is known to 5 %, from
    /// low to high frequency.
    pub modes: Vec<MeasuredMode>,
    /// Delay behind the hold of the command, s. It stands for lags that are faster than the lines too.
    pub delay_s: WithDeviation,
    /// Root mean square of the residual in deviations of the lines; 1 for a fit as good as they are.
    pub misfit: f64,
    /// Root mean square of the relative error over the lines.
    pub relative_error: f64,
    /// Lowest and highest line that was fitted, Hz.
    pub band_hz: [f64; 2],
}

/// Margins of the loop with the gains of the file, measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredMargins {
    /// Maximum sensitivity of the loop cut at the command, as the command answers to the excitation.
    pub sensitivity: WithDeviation,
    /// Its frequency, Hz.
    pub sensitivity_at_hz: f64,
    /// The same from the controller of the file and the measured response of what it controls.
    pub by_response: WithDeviation,
    /// The same of the model at this position.
    pub model: Option<f64>,
    /// Maximum sensitivity of the position loop, its speed loop closed.
    pub position: f64,
    /// Least phase margin of all crossings of gain 1, degrees, cut at the command.
    pub phase_deg: Option<f64>,
    /// Delay that the loop takes, s.
    pub delay_s: Option<f64>,
    /// Highest frequency at which the gain is 1, Hz.
    pub crossover_hz: Option<f64>,
}

/// Frequency responses of an axis at one place, measured.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredDrive {
    /// Of this form.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Its fingerprint.
    pub axis_fingerprint: String,
    /// Version of the program.
    pub version: String,
    /// Unit of the load's position: "m" or "rad".
    pub position_unit: String,
    /// Unit of the command.
    pub command_unit: String,
    /// Mean position of the load while it was excited, and the stretch, m or rad.
    pub position: f64,
    /// From there to there.
    pub stretch: [f64; 2],
    /// Mean speed of the load, m/s or rad/s.
    pub speed: f64,
    /// Excited time, s.
    pub excited_s: f64,
    /// How it was estimated, in words.
    pub method: String,
    /// Independent averages.
    pub averages: f64,
    /// Distance of two lines, Hz.
    pub step_hz: f64,
    /// Minimum coherence of a line that is used.
    pub coherence: f64,
    /// First and last line that counts, Hz; none where there is no such line.
    pub band_hz: Option<[f64; 2]>,
    /// From the command to the motor's measured speed, rad/s.
    pub motor_speed: Vec<MeasuredLine>,
    /// The model's, on the same lines.
    pub motor_speed_model: Vec<[f64; 2]>,
    /// From the command to the load's measured position.
    pub load: Vec<MeasuredLine>,
    /// What was fitted to the first; none where nothing could be, or the measurement is not usable.
    pub fit: Option<MeasuredModes>,
    /// Margins with the gains of the file; none without excitation.
    pub margins: Option<MeasuredMargins>,
    /// The compliance at the load with the gains of the file, from the responses alone.
    pub compliance: Option<MeasuredCompliance>,
    /// Why there is none, in words.
    pub compliance_missing: Option<String>,
    /// Against the model; none of a measurement that is not usable.
    pub comparison: Option<Comparison>,
    /// What is wrong with the measurement.
    pub traps: Vec<Trap>,
    /// What else is to be known, in words.
    pub notes: Vec<String>,
    /// For the search.
    #[serde(skip)]
    #[schemars(skip)]
    pub plant: MeasuredPlant,
}

impl MeasuredDrive {
    /// Number of this form.
    pub const SCHEMA: u32 = 1;

    /// From a log of this axis.
    ///
    /// # Errors
    /// [`LoopError`] where the axis has no loops, or the log no command and no response.
    pub fn of(axis: &Axis, log: &Log, settings: &MeasureSettings) -> Result<Self, LoopError> {
        settings.check()?;
        let recorded = Recorded::of(axis, log)?;
        let averaging = recorded.averaging(settings)?;
        let by = match recorded.is_excited() {
            true => Estimator::ThreeSignals,
            false => Estimator::H1,
        };
        let Estimated { angle, speed, load } = Estimated::of(&recorded, by, averaging)?;
        let at = model_at::ModelAt::new(axis, recorded.position)?;
        let plant = MeasuredPlant::new(
            &at,
            [angle.as_ref(), speed.as_ref(), Some(&load)],
            settings.coherence,
        );
        let shown = match (speed, &angle) {
            (Some(speed), _) => speed,
            (None, Some(angle)) => MeasuredPlant::speed_of(&at, angle, 0),
            (None, None) => MeasuredPlant::speed_of(&at, &load, 2),
        };
        let margins = match recorded.is_excited() && recorded.instead.is_none() {
            true => margins(&recorded, averaging, &at, &plant)?,
            false => None,
        };
        let response = Response {
            recorded: &recorded,
            shown: &shown,
            at: &at,
        };
        let traps = traps::traps(axis, &response, margins.as_ref(), settings)?;
        // A measurement that is refused is not compared with the model.
        let is_usable = refused(&traps) == 0;
        let fitted = fit_settings(settings, plant.band_hz());
        // Modes are those of the machine, whatever drives it.
        let shows_modes = is_usable || recorded.instead.is_some() && refused(&traps) == 1;
        let fit = match shows_modes {
            true => ModalFit::of(&shown, &fitted).ok(),
            false => None,
        };
        let comparison = match is_usable {
            true => compare::comparison(&at, &plant, fit.as_ref(), shown.step_hz),
            false => None,
        };
        let compliance = match is_usable {
            true => ToEffort::of(axis, &recorded, averaging, &at)
                .and_then(|measured| MeasuredCompliance::of(axis, &at, &plant, &measured, &fitted)),
            false => Err("the measurement is not usable".to_owned()),
        };
        let compliance_missing = compliance.as_ref().err().cloned();
        Ok(Self {
            schema: Self::SCHEMA,
            axis: axis.name.clone(),
            axis_fingerprint: axis.fingerprint.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            position_unit: axis.freedom().unit().to_owned(),
            command_unit: recorded.command_unit.to_owned(),
            position: recorded.position,
            stretch: recorded.stretch,
            speed: recorded.mean_speed,
            excited_s: recorded.seconds(),
            method: method(by, averaging, shown.period_s),
            averages: shown.averages,
            step_hz: shown.step_hz,
            coherence: settings.coherence,
            band_hz: plant.band_hz(),
            motor_speed: lines(&shown),
            motor_speed_model: at.speeds(&shown),
            load: lines(&load),
            fit: fit.map(|fit| modes(&fit, shown.step_hz)),
            margins,
            compliance: compliance.ok(),
            compliance_missing,
            comparison,
            traps,
            notes: recorded.notes.clone(),
            plant,
        })
    }

    /// Whether nothing is so wrong with it that gains must not be tuned on it.
    pub fn is_usable(&self) -> bool {
        self.traps.iter().all(|trap| !trap.refused)
    }
}

impl LoopSet {
    /// The set with measured responses in it: limits of the sensitivity hold for their loops too, and
    /// the delay that they show beside the model's is added to the model.
    ///
    /// # Errors
    /// [`LoopError::Measured`] where one of them must not be tuned on.
    pub fn with_measured(mut self, axis: &Axis, all: &[MeasuredDrive]) -> Result<Self, LoopError> {
        for (i, one) in all.iter().enumerate() {
            if let Some(trap) = one.traps.iter().find(|trap| trap.refused) {
                return Err(LoopError::Measured {
                    number: i + 1,
                    what: trap.what.clone(),
                });
            }
            self.measured.push(one.plant.clone());
        }
        let mut delays: Vec<f64> = all
            .iter()
            .filter_map(|one| one.comparison.as_ref().map(|c| c.delay_s.value))
            .collect();
        delays.sort_by(f64::total_cmp);
        // Late commands only: a response that comes sooner than the model's leaves the model as it is.
        if let Some(median) = delays.get(delays.len() / 2) {
            self.delay += median.max(0.0) / axis.period;
        }
        Ok(self)
    }
}

/// Responses to the command.
struct Estimated {
    /// Of the motor's angle and speed, as far as they were recorded.
    angle: Option<FrequencyResponse>,
    speed: Option<FrequencyResponse>,
    /// Of the load's position.
    load: FrequencyResponse,
}

impl Estimated {
    fn of(recorded: &Recorded<'_>, by: Estimator, averaging: Averaging) -> Result<Self, LoopError> {
        let estimate = |output: &[f64], differenced| {
            let all: Vec<Record<'_>> = recorded.records(output, differenced).collect();
            FrequencyResponse::of_all(&all, by, averaging)
        };
        let angle = recorded.angle.map(|angle| estimate(angle, true));
        let speed = recorded.speed.map(|speed| estimate(speed, false));
        Ok(Self {
            angle: angle.transpose()?,
            speed: speed.transpose()?,
            load: estimate(&recorded.load, true)?,
        })
    }
}

/// How many of them forbid to tune on the measurement.
fn refused(traps: &[Trap]) -> usize {
    traps.iter().filter(|trap| trap.refused).count()
}

fn fit_settings(settings: &MeasureSettings, band_hz: Option<[f64; 2]>) -> FitSettings {
    FitSettings {
        band_hz: band_hz.unwrap_or_default(),
        coherence: settings.coherence,
        most_poles: settings.most_poles,
        ..FitSettings::default()
    }
}

fn lines(of: &FrequencyResponse) -> Vec<MeasuredLine> {
    let line = |l: &frequency_response::ResponseLine| MeasuredLine {
        frequency_hz: l.frequency_hz,
        value: [l.value.re, l.value.im],
        deviation: l.deviation,
        coherence: l.coherence,
    };
    of.lines.iter().map(line).collect()
}

/// Margins with the gains of the file: by what the command makes of the excitation, and by the
/// controller with the measured responses.
fn margins(
    recorded: &Recorded<'_>,
    averaging: Averaging,
    at: &model_at::ModelAt,
    plant: &MeasuredPlant,
) -> Result<Option<MeasuredMargins>, LoopError> {
    // u = S F r: open loop from r to u, so H1 has no bias.
    let all: Vec<Record<'_>> = recorded.sensitivity_records().collect();
    let answered = FrequencyResponse::of_all(&all, Estimator::H1, averaging)?;
    let (mut peak, mut frequency) = (
        WithDeviation {
            value: 0.0,
            deviation: 0.0,
        },
        0.0,
    );
    // Above the band noise is in phase with itself from period to period, such as a scale's.
    let top = plant.band_hz().map_or(0.0, |[_, high]| high);
    for line in answered.trusted([0.0, top], 0.0) {
        let Some(passed) = at.passed(line.frequency_hz) else {
            continue;
        };
        let magnitude = line.value.norm() / passed;
        let deviation = line.deviation / passed;
        // The greatest of many noisy lines is too high: one that is uncertain says nothing.
        if deviation < CERTAIN * magnitude && magnitude > peak.value {
            peak = WithDeviation {
                value: magnitude,
                deviation,
            };
            frequency = line.frequency_hz;
        }
    }
    let [command, position] = plant.loops(at);
    if command.len() < 2 {
        return Ok(None);
    }
    let of = |lines: &[LoopLine]| LoopMargins::of(lines);
    let (found, outer) = (of(&command)?, of(&position)?);
    Ok(Some(MeasuredMargins {
        sensitivity: peak,
        sensitivity_at_hz: frequency,
        by_response: WithDeviation {
            value: found.sensitivity.value,
            deviation: found.sensitivity.deviation,
        },
        model: at.sensitivity(),
        position: outer.sensitivity.value,
        phase_deg: found.phase_deg(),
        delay_s: found.delay_s,
        crossover_hz: found.crossover_hz,
    }))
}

/// Deviation of a line of the sensitivity, as a share of it, from which on the line does not count.
const CERTAIN: f64 = 0.08;

fn method(by: Estimator, averaging: Averaging, period: f64) -> String {
    let how = match by {
        Estimator::ThreeSignals => "by the excitation, without bias in closed loop",
        _ => "from command and response alone (H1), biased in closed loop",
    };
    match averaging {
        Averaging::Welch { segment } => format!(
            "{how}; segments of {:.3} s under Hann's window, half over one another",
            segment as f64 * period
        ),
        Averaging::Periods { period: n, .. } => {
            format!("{how}; whole periods of {:.3} s", n as f64 * period)
        }
    }
}

/// Damping from which on a pair of poles is a lag of the drive, no mode of the machine.
const DAMPED: f64 = 0.5;
/// Lines below a mode that are needed to tell it from an error of the lowest ones.
const BELOW: f64 = 6.0;
/// Deviation of a frequency, as a share of it, from which on it is no mode.
const VAGUE: f64 = 0.05;

/// Whether a pair of poles is a mode of a machine, of a fit to lines `step_hz` apart.
fn is_of_machine(mode: &FittedMode, fit: &ModalFit, step_hz: f64) -> bool {
    let frequency = mode.frequency_hz;
    mode.damping.value.abs() < DAMPED
        && frequency.value > BELOW * step_hz
        && frequency.value < fit.band_hz[1]
        && frequency.deviation < VAGUE * frequency.value
}

/// Those that are.
fn machine_modes(fit: &ModalFit, step_hz: f64) -> impl Iterator<Item = &FittedMode> {
    let all = fit.modes.iter();
    all.filter(move |mode| is_of_machine(mode, fit, step_hz))
}

fn modes(fit: &ModalFit, step_hz: f64) -> MeasuredModes {
    let mode = |mode: &FittedMode| MeasuredMode {
        frequency_hz: mode.frequency_hz.into(),
        damping: mode.damping.into(),
        residue: mode.residue.norm(),
        residue_deviation: mode.residue_deviation,
    };
    MeasuredModes {
        modes: machine_modes(fit, step_hz).map(mode).collect(),
        delay_s: fit.delay_s.into(),
        misfit: fit.misfit,
        relative_error: fit.relative_error,
        band_hz: fit.band_hz,
    }
}
