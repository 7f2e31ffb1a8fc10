//! The compliance at the load from measured responses, no model of the machine between.
//!
//! With i the drive's actual effort (current, torque, force), K its torque, and the modes of the machine
//!
//! ```text
//! ω/i = K Σ s φ_m²/Q        ẏ/i = K Σ s φ_m φ_l/Q        Q = s² + 2ζω_0 s + ω_0²; of the rigid motion s² + b s
//! ```
//!
//! both have the same poles. The first is fitted with poles and residues, which gives Q and φ_m². The second is
//! then Σ ρ times the terms of the first with one real ρ = φ_l/φ_m for each mode, by linear least squares: the
//! residues φ_m φ_l and φ_m² give φ_l². With the effort held, a force on the load moves load and motor by
//! D_y = Σ φ_l²/Q and D_θ = Σ φ_m φ_l/Q (Maxwell–Betti; D. J. Ewins, Modal Testing, 2nd ed., Research Studies
//! Press 2000, 2.6), a unit of the effort by G_θ and G_y. A controller C sees γ s θ + P (α θ + β y); the
//! winding answers the motor's speed by the current −E s θ, so that the measured H = i/u is H_0/(1 + E s G_θ).
//! Closed:
//!
//! ```text
//! i = −κ θ − λ y          κ = H_0 C (γ s + α P) + E s          λ = H_0 C β P
//! y/F = (D_y + κ Δ)/(1 + κ G_θ + λ G_y)                        Δ = G_θ D_y − G_y D_θ
//! 1 + κ G_θ + λ G_y = (1 + E s G_θ)(1 + L)
//! Δ = K Σ_{i<j} (φ_m,i φ_l,j − φ_m,j φ_l,i)²/(Q_i Q_j)
//! ```
//!
//! H and L are measured too. In Δ (Cauchy–Binet) what the rigid motion is in both products has cancelled, which
//! at low frequencies is all but a thousandth of them. E is the back-EMF over the winding's impedance and its
//! current controller's, from the file; it counts below the bandwidth of that.

use std::f64::consts::TAU;

use axis_sim::Axis;
use compensator::Drive;
use frequency_response::{
    Averaging, Estimator, FitSettings, FrequencyResponse, ModalFit, Record, ResponseError,
};
use schemars::JsonSchema;
use serde::Serialize;

use super::WithDeviation;
use super::model_at::ModelAt;
use super::record::Recorded;
use super::shapes::{Mode, modes_of};
use crate::law::LoopAt;
use crate::margins::COMPLIANCE;
use crate::measured_plant::MeasuredPlant;
use crate::plant::{LoopModel, Number, PlantAt};

/// Distances of two lines below which drift and what the friction remembers are in a line: at 2 lines 20 % off,
/// at 4 less than 3 % (`cargo test -p drive-loop compliance -- --nocapture`).
const LOWEST: f64 = 4.0;
/// How far beyond the compliance's band lines are fitted: a mode above it bends the lines below.
const BEYOND: f64 = 1.5;
/// Poles of the rigid motion and of one mode, with one to spare.
const LEAST_POLES: usize = 4;
const ZERO: Number = Number::new(0.0, 0.0);
const ONE: Number = Number::new(1.0, 0.0);
const J: Number = Number::new(0.0, 1.0);

/// The compliance at the load, from measured responses.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredCompliance {
    /// All that moves, at the motor, kg·m² or kg: torque constant of the file over the residue of the rigid motion.
    pub inertia: WithDeviation,
    /// Travel of the load per angle of the motor in the rigid motion, m/rad or rad/rad.
    pub travel: WithDeviation,
    /// Elastic modes that are in it.
    pub modes: Vec<MeasuredShape>,
    /// Motion of the load per force in its direction with the gains of the file, m/N or rad/(N·m), line by line.
    pub lines: Vec<ComplianceLine>,
    /// Greatest magnitude of the lines from 1 to 300 Hz.
    pub peak: WithDeviation,
    /// Its frequency, Hz.
    pub peak_at_hz: f64,
    /// Root mean square over the logarithm of the frequency, of the lines up to 300 Hz.
    pub rms: WithDeviation,
    /// From which to which line that is, Hz.
    pub rms_band_hz: [f64; 2],
    /// The model's greatest magnitude and root mean square over the lines of `rms`.
    pub model: [f64; 2],
    /// What is not in it, in words.
    pub notes: Vec<String>,
}

/// How a mode moves motor and load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeasuredShape {
    /// Hz.
    pub frequency_hz: f64,
    /// Travel of the load per angle of the motor, m/rad or rad/rad; below 0 where they move against one another.
    pub load_per_motor: WithDeviation,
}

/// The compliance on one line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ComplianceLine {
    /// Hz.
    pub frequency_hz: f64,
    /// Real and imaginary part.
    pub value: [f64; 2],
    /// Standard deviation of the error in each direction of the complex plane.
    pub deviation: f64,
    /// The model's, real and imaginary part.
    pub model: [f64; 2],
}

/// Responses to the actual effort: of the motor's angle or speed, and of the load's position; and that of the
/// actual effort to the command.
pub(crate) struct ToEffort {
    pub motor: FrequencyResponse,
    /// Whether it is the angle's.
    pub is_angle: bool,
    /// Whether the motor is on the load and read by its sensor: `motor` is the load's position then.
    pub is_one_body: bool,
    pub load: FrequencyResponse,
    pub effort: FrequencyResponse,
}

impl ToEffort {
    /// Responses to what the drive really exerts, or why there are none.
    pub fn of(
        axis: &Axis,
        recorded: &Recorded<'_>,
        averaging: Averaging,
        at: &ModelAt,
    ) -> Result<Self, String> {
        let sensing = &at.model.sensing;
        if sensing.load_from_motor {
            return Err("the axis has no sensor at the load".to_owned());
        }
        // A motor on the load itself: one sensor shows both.
        let is_one_body = sensing.motor_from_load && !axis.mechanism.has_motor_encoder();
        let motor = match sensing.motor_from_load {
            false => recorded.angle.or(recorded.speed),
            true => Some(&*recorded.load).filter(|_| is_one_body),
        };
        let motor = motor.ok_or("the log has no sensor of the motor beside that of the load (motor_angle_rad or motor_speed_rad_s)")?;
        let effort = recorded.effort.ok_or_else(|| match recorded.command_unit {
            "V" => "the command is a voltage: what the motor exerts is not in the log".to_owned(),
            unit => format!(
                "the log does not have both the command and the actual current, torque or force ({unit})"
            ),
        })?;
        let is_angle = is_one_body || recorded.angle.is_some();
        let estimate = |input: &[f64], output: &[f64], differenced: bool| {
            let all: Vec<Record<'_>> = recorded.records_from(input, output, differenced).collect();
            let found = FrequencyResponse::of_all(&all, Estimator::ThreeSignals, averaging);
            found.map_err(|error| error.to_string())
        };
        Ok(Self {
            motor: estimate(effort, motor, is_angle)?,
            is_angle,
            is_one_body,
            load: estimate(effort, &recorded.load, true)?,
            effort: estimate(recorded.command, effort, false)?,
        })
    }
}

impl MeasuredCompliance {
    /// From responses to the effort, where the loop was measured too; or why not, in words.
    pub(crate) fn of(
        axis: &Axis,
        at: &ModelAt,
        plant: &MeasuredPlant,
        measured: &ToEffort,
        fit: &FitSettings,
    ) -> Result<Self, String> {
        let (motor, load) = true_responses(at, measured);
        let settings = FitSettings {
            band_hz: [fit.band_hz[0], fit.band_hz[1].min(BEYOND * COMPLIANCE[1])],
            held: false,
            most_delay_s: 1e-3,
            ..*fit
        };
        let fitted = fewest(&motor, &settings)
            .map_err(|error| format!("the motor's response has no fit: {error}"))?;
        let (modes, mut notes) = modes_of(axis, &fitted, &load, &settings, motor.step_hz)?;
        if measured.is_one_body {
            notes.push("one sensor shows motor and load, which are one body by the axis file: the force is one where the motor's acts".to_owned());
        }
        let mut lines = lines(axis, at, plant, &modes, &measured.effort);
        // Beyond the fitted band nothing is known of modes.
        lines.retain(|line| line.frequency_hz <= settings.band_hz[1]);
        let inside =
            |l: &&ComplianceLine| (COMPLIANCE[0]..=COMPLIANCE[1]).contains(&l.frequency_hz);
        let counted: Vec<ComplianceLine> = lines.iter().filter(inside).copied().collect();
        if counted.len() < 8 {
            return Err("fewer than 8 lines from 1 to 300 Hz count".to_owned());
        }
        let size = |l: &ComplianceLine| l.value[0].hypot(l.value[1]);
        let own = |l: &ComplianceLine| l.model[0].hypot(l.model[1]);
        let peak = counted.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let peak = peak.copied().unwrap_or(counted[0]);
        let rms = mean_square(&counted, size).sqrt();
        // Errors of shapes go together from line to line: the deviation is that of a line, in the mean.
        let deviation = mean_square(&counted, |l| l.deviation).sqrt();
        let rigid = modes[0];
        let of = |i: usize| WithDeviation {
            value: rigid.values[i],
            deviation: rigid.deviations[i],
        };
        let ratio = |mode: &Mode| MeasuredShape {
            frequency_hz: mode.values[1].sqrt() / TAU,
            load_per_motor: WithDeviation {
                value: mode.values[3],
                deviation: mode.deviations[3],
            },
        };
        Ok(Self {
            inertia: WithDeviation {
                value: 1.0 / of(2).value,
                deviation: of(2).deviation / (of(2).value * of(2).value),
            },
            travel: of(3),
            modes: modes[1..].iter().map(ratio).collect(),
            peak: WithDeviation {
                value: size(&peak),
                deviation: peak.deviation,
            },
            peak_at_hz: peak.frequency_hz,
            rms: WithDeviation {
                value: rms,
                deviation,
            },
            rms_band_hz: [
                counted[0].frequency_hz,
                counted[counted.len() - 1].frequency_hz,
            ],
            model: [
                counted.iter().map(own).fold(0.0, f64::max),
                mean_square(&counted, own).sqrt(),
            ],
            lines,
            notes,
        })
    }
}

/// The fit with at most so many poles; with fewer where those are so many that they are not told apart.
fn fewest(motor: &FrequencyResponse, settings: &FitSettings) -> Result<ModalFit, ResponseError> {
    let mut settings = *settings;
    loop {
        let fitted = ModalFit::of(motor, &settings);
        if !matches!(fitted, Err(ResponseError::NoFit)) || settings.most_poles <= LEAST_POLES {
            return fitted;
        }
        settings.most_poles -= 1;
    }
}

/// Mean square over the logarithm of the frequency.
fn mean_square(lines: &[ComplianceLine], of: impl Fn(&ComplianceLine) -> f64) -> f64 {
    let (mut sum, mut length) = (0.0, 0.0);
    for pair in lines.windows(2) {
        let over = (pair[1].frequency_hz / pair[0].frequency_hz).ln();
        let [a, b] = [of(&pair[0]), of(&pair[1])];
        sum += 0.5 * (a * a + b * b) * over;
        length += over;
    }
    sum / length
}

/// Of the motor's speed and the load's as they are, without what the sensors do.
fn true_responses(at: &ModelAt, measured: &ToEffort) -> (FrequencyResponse, FrequencyResponse) {
    let changed = |of: &FrequencyResponse, by: &dyn Fn(f64) -> Number| {
        let mut of = of.clone();
        for line in &mut of.lines {
            let by = by(line.frequency_hz);
            line.value *= by;
            line.deviation *= by.norm();
        }
        of
    };
    // What the sensors show of a unit of angle, and of the load.
    let shown = |hz: f64, command: [Number; 3]| {
        let plant = PlantAt {
            frequency: TAU * hz,
            command,
            force: [ZERO; 3],
        };
        crate::law::shown(&at.model, &plant)
    };
    let s = |hz: f64| J * (TAU * hz);
    let of_load = |hz: f64| s(hz) / shown(hz, [ZERO, ZERO, ONE])[2];
    let load = changed(&measured.load, &of_load);
    if measured.is_one_body {
        let travel = at.model.model.travel;
        return (changed(&measured.motor, &|hz| of_load(hz) / travel), load);
    }
    let motor = changed(&measured.motor, &|hz| {
        let [angle, speed, _] = shown(hz, [ONE, s(hz), ZERO]);
        s(hz) / if measured.is_angle { angle } else { speed }
    });
    (motor, load)
}

/// What a unit of torque and of force does with the effort held.
struct Answers {
    /// Angle per torque, Σ φ_m²/Q.
    angle: Number,
    /// Load per force, D_y.
    load: Number,
    /// Δ/K.
    apart: Number,
}

fn answers(modes: &[Mode], s: Number) -> Answers {
    let q = |m: &Mode| s * s + s * m.values[0] + m.values[1];
    let mut all = Answers {
        angle: ZERO,
        load: ZERO,
        apart: ZERO,
    };
    for (i, a) in modes.iter().enumerate() {
        let [_, _, square, ratio] = a.values;
        all.angle += ONE * square / q(a);
        all.load += ONE * (square * ratio * ratio) / q(a);
        for b in &modes[i + 1..] {
            let apart = b.values[3] - ratio;
            all.apart += ONE * (square * b.values[2] * apart * apart) / (q(a) * q(b));
        }
    }
    all
}

/// E: current by which the winding answers the motor's speed against it, at s = jω: p ψ over R + s L_q and the q
/// controller, whose voltage comes late and is held over a period (i_d = 0).
fn by_speed(model: &LoopModel, s: Number) -> Number {
    match &model.model.drive {
        Drive::Lag { .. } => ZERO,
        Drive::FieldOriented {
            motor,
            gear,
            q,
            late,
            ..
        } => {
            let (p, period) = (motor.parameters(), model.period());
            let integral = ONE * period / (ONE - (-s * period).exp());
            let controller = (integral * q[1] + q[0]) * (-s * (period * (late + 0.5))).exp();
            let back = f64::from(p.pole_pairs) * p.flux_linkage * gear;
            ONE * back / (s * p.inductance_q + p.resistance + controller)
        }
    }
}

fn lines(
    axis: &Axis,
    at: &ModelAt,
    plant: &MeasuredPlant,
    modes: &[Mode],
    effort: &FrequencyResponse,
) -> Vec<ComplianceLine> {
    let [command, _] = plant.loops(at);
    let torque = axis.torque_constant();
    let low = LOWEST * effort.step_hz;
    let counted = command
        .iter()
        .filter(|line| line.frequency_hz > 0.999 * low);
    let one = |measured: &frequency_response::LoopLine| {
        let hz = measured.frequency_hz;
        let s = J * (TAU * hz);
        let (followed, uncertain) = effort.at(hz)?;
        let known = PlantAt {
            frequency: TAU * hz,
            command: [ONE, s, ZERO],
            force: [ZERO; 3],
        };
        // C (γ s + α P), the filters of the command and its hold included, per unit of angle.
        let [inner, outer] = LoopAt::new(&at.model, &known).answered(&at.gains);
        let winding = by_speed(&at.model, s) * s;
        let closed = |modes: &[Mode], followed: Number, cut: Number| {
            let Answers { angle, load, apart } = answers(modes, s);
            let slowed = winding * angle * torque + 1.0;
            let kappa = followed * slowed * (inner + outer) + winding;
            (load + kappa * apart * torque) / (slowed * (cut + 1.0))
        };
        let value = closed(modes, followed, measured.value);
        let moved = |modes: &[Mode]| closed(modes, followed, measured.value) - value;
        let mut square = 0.0;
        for i in 0..modes.len() {
            for which in 0..4 {
                let mut other = modes.to_vec();
                other[i].values[which] += other[i].deviations[which];
                square += moved(&other).norm_sqr();
            }
        }
        square += (closed(modes, followed + uncertain, measured.value) - value).norm_sqr();
        square += (closed(modes, followed, measured.value + measured.deviation) - value).norm_sqr();
        // The model's force is against the load.
        let model = -LoopAt::new(&at.model, &at.plant(hz)?).compliance(&at.gains);
        Some(ComplianceLine {
            frequency_hz: hz,
            value: [value.re, value.im],
            deviation: square.sqrt(),
            model: [model.re, model.im],
        })
    };
    counted.filter_map(one).collect()
}
