//! Friction as the stage's file holds it.

use axis_pipeline::identification::{Identified, ParameterSource};
use axis_sim::friction::Friction as AxisFriction;
use lugre::Parameters;
use serde::{Deserialize, Serialize};

/// One parameter as found.
#[derive(Serialize, Deserialize)]
pub struct Found {
    /// Name, as in the axis file.
    pub name: String,
    /// Unit of the numbers below.
    pub unit: String,
    /// The value found.
    pub value: f64,
    /// Its standard error, where the logs tell the parameter.
    pub standard_error: Option<f64>,
    /// Interval that holds it in 95 % of such logs.
    pub interval_95: Option<[f64; 2]>,
    /// "logs"; "axis file", where the logs leave it open; "no fall with speed", where T_S is T_C; "not seen", where σ2 is 0.
    pub source: String,
    /// The value in the machine's axis file, where the logs are simulated.
    pub truth: Option<f64>,
}

/// A stretch of a log at one speed.
#[derive(Serialize, Deserialize)]
pub struct RunPoint {
    /// The log.
    pub log: String,
    /// Its first and last instant there, s.
    pub time_s: [f64; 2],
    /// In the friction law's coordinate: rad/s or m/s.
    pub speed: f64,
    /// N·m or N.
    pub torque: f64,
    /// Standard error of it, if known.
    pub standard_error: Option<f64>,
    /// Whether the speed is constant; else it changes slowly, and inertia was taken off.
    pub constant_speed: bool,
    /// Why it was left out, if it was.
    pub left_out: Option<String>,
}

/// A small motion about a standstill.
#[derive(Serialize, Deserialize)]
pub struct SmallMotionPoint {
    /// The log.
    pub log: String,
    /// Its first and last instant there, s.
    pub time_s: [f64; 2],
    /// σ0 and σ1 of it alone, each with its standard error.
    pub stiffness: Option<[f64; 2]>,
    /// As above.
    pub damping: Option<[f64; 2]>,
    /// Why it tells neither, if it does not.
    pub left_out: Option<String>,
}

/// Friction as identified.
#[derive(Serialize, Deserialize)]
pub struct Friction {
    /// Whether a simulated machine made the logs.
    pub simulated: bool,
    /// The parameters.
    pub parameters: Vec<Found>,
    /// What the logs leave open, and the run that would tell.
    pub open: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// The stretches that the curve was fitted to.
    pub runs: Vec<RunPoint>,
    /// The small motions.
    pub small_motions: Vec<SmallMotionPoint>,
    /// T_C, T_S, Ω_S, σ0, σ1, σ2 in SI units.
    pub law: [f64; 6],
}

impl Friction {
    /// Of what logs with these names told; `truth` of a simulated machine.
    pub(super) fn of(
        found: &Identified,
        names: &[String],
        axis: &AxisFriction,
        truth: Option<&Parameters>,
    ) -> Self {
        let units = axis.at.units();
        let log = |index: usize| names.get(index).cloned().unwrap_or_default();
        let parameter = |p: &axis_pipeline::identification::FoundParameter| {
            let unit = match p.name {
                "T_C" | "T_S" => units.force,
                "Ω_S" => units.speed,
                "σ0" => units.stiffness,
                _ => units.damping,
            };
            Found {
                name: p.name.to_owned(),
                unit: unit.to_owned(),
                value: p.value,
                standard_error: p.standard_error,
                interval_95: p.interval,
                source: match p.source {
                    ParameterSource::Logs => "logs",
                    ParameterSource::AxisFile => "axis file",
                    ParameterSource::NoFall => "no fall with speed",
                    ParameterSource::NotSeen => "not seen",
                }
                .to_owned(),
                truth: truth.map(|truth| of_name(truth, p.name)),
            }
        };
        let run = |run: &axis_pipeline::identification::SpeedRun| RunPoint {
            log: log(run.log),
            time_s: run.time,
            speed: run.run.speed,
            torque: run.run.torque,
            standard_error: run.run.torque_standard_error,
            constant_speed: run.steady,
            left_out: run.left_out.clone(),
        };
        let small = |motion: &axis_pipeline::identification::SmallMotion| {
            let fit = motion.fit.as_ref();
            let pair = |estimate: lugre::identify::ParameterEstimate| {
                [estimate.value, estimate.standard_error]
            };
            SmallMotionPoint {
                log: log(motion.log),
                time_s: motion.time,
                stiffness: fit.ok().map(|fit| pair(fit.stiffness)),
                damping: fit.ok().map(|fit| pair(fit.damping)),
                left_out: fit.err().cloned(),
            }
        };
        let law = &found.law;
        Self {
            simulated: truth.is_some(),
            parameters: found.parameters.iter().map(parameter).collect(),
            open: found.open.iter().map(ToString::to_string).collect(),
            notes: found.notes.clone(),
            runs: found.runs.iter().map(run).collect(),
            small_motions: found.small_motions.iter().map(small).collect(),
            law: [
                law.coulomb,
                law.stiction,
                law.stribeck_speed,
                law.stiffness,
                law.damping,
                law.viscous,
            ],
        }
    }

    /// The six numbers as a law's.
    pub fn parameters(&self) -> Parameters {
        let [
            coulomb,
            stiction,
            stribeck_speed,
            stiffness,
            damping,
            viscous,
        ] = self.law;
        Parameters {
            coulomb,
            stiction,
            stribeck_speed,
            stiffness,
            damping,
            viscous,
        }
    }
}

fn of_name(law: &Parameters, name: &str) -> f64 {
    match name {
        "T_C" => law.coulomb,
        "T_S" => law.stiction,
        "Ω_S" => law.stribeck_speed,
        "σ2" => law.viscous,
        "σ0" => law.stiffness,
        _ => law.damping,
    }
}
