//! `identify`: friction on the machine, transfer function from the model.

use std::fmt;

use axis_pipeline::identification::{IdentificationPlan, Identified, identify};
use axis_pipeline::measured::{TrainingRms, ValidationRms};
use axis_pipeline::transfer::{TransferPlan, identify_transfer};
use axis_sim::friction::FrictionUnits;
use compensator::TransferFunctionModel;
use lugre::identify::ParameterEstimate;
use lugre::{LuGre, Parameters};
use miette::{IntoDiagnostic, Result};
use serde::{Deserialize, Serialize};

use crate::context::{Common, Context};
use crate::output::print;
use crate::progress::bar;
use crate::store::Stage;

const FRICTION: &str = "friction.json";
pub(super) const TRANSFER: &str = "transfer_functions.json";

/// One parameter as found, with what it should be.
#[derive(Serialize, Deserialize)]
pub struct Found {
    /// Name, as in the axis file.
    pub name: String,
    /// Unit of the numbers below.
    pub unit: String,
    /// The value found.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// The value in the machine's axis file.
    pub truth: f64,
}

/// One constant-speed run.
#[derive(Serialize, Deserialize)]
pub struct RunPoint {
    /// In the friction law's coordinate: rad/s or m/s.
    pub speed: f64,
    /// N·m or N.
    pub torque: f64,
    /// Why it was left out, if it was.
    pub left_out: Option<String>,
}

/// Friction as identified.
#[derive(Serialize, Deserialize)]
pub struct Friction {
    /// The parameters, with what they should be.
    pub parameters: Vec<Found>,
    /// The runs that they were fitted to.
    pub runs: Vec<RunPoint>,
    /// T_C, T_S, Ω_S, σ0, σ1, σ2 in SI units.
    pub law: [f64; 6],
}

/// The transfer function as identified.
#[derive(Serialize, Deserialize)]
pub struct Transfer {
    /// Control period, s.
    pub period: f64,
    /// Direct feed-through, s².
    pub direct: f64,
    /// Real poles, of z.
    pub poles: Vec<f64>,
    /// Coefficient of each pole, s².
    pub coefficients: Vec<f64>,
    /// RMS of what it misses on the motions it was fitted to.
    #[serde(flatten)]
    pub training_rms: TrainingRms<f64>,
    /// RMS of what it misses on other motions.
    #[serde(flatten)]
    pub validation_rms: ValidationRms<f64>,
    /// How many candidates were tried.
    pub candidates: usize,
}

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    let (friction, transfer) = plans(context);
    let machine = &context.machine.fingerprint;
    let settings = format!("{friction:?} {transfer:?} {machine}");
    Stage::new(context, "identify", &[FRICTION, TRANSFER], &settings, &[])
}

/// Runs the stage.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    stage.begin()?;
    let (friction, transfer) = plans(context);

    let progress = bar("friction", 2 * friction.speeds.len() as u64 + 1);
    let identified = identify(&context.machine, &friction, || progress.inc(1)).into_diagnostic()?;
    progress.finish_and_clear();
    let found = summarise(&identified, context);
    stage.write_json(FRICTION, &found)?;

    let progress = bar(
        "transfer",
        2 * (transfer.training + transfer.validation) as u64,
    );
    let unit = context.unit();
    let fit = |feedforward| {
        let fit = identify_transfer(&context.axis, &transfer, feedforward, || progress.inc(1))
            .into_diagnostic()?;
        Ok::<_, miette::Report>(Transfer {
            period: fit.model.period(),
            direct: fit.model.direct(),
            poles: fit.model.poles().to_vec(),
            coefficients: fit.model.coefficients().to_vec(),
            training_rms: TrainingRms::new(unit, 1e6 * fit.chosen.training_rms),
            validation_rms: ValidationRms::new(unit, 1e6 * fit.chosen.validation_rms),
            candidates: fit.trials.len(),
        })
    };
    let fits = [fit(false)?, fit(true)?];
    progress.finish_and_clear();
    stage.write_json(TRANSFER, &fits)?;
    stage.finish()?;
    let [transfer_function, transfer_function_beside_friction] = &fits;
    let told = Told {
        units: context.machine.friction.at.units(),
        friction: &found,
        transfer_function,
        transfer_function_beside_friction,
    };
    print("identify", &told)
}

/// What was identified.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(skip)]
    units: FrictionUnits,
    friction: &'a Friction,
    transfer_function: &'a Transfer,
    transfer_function_beside_friction: &'a Transfer,
}

impl fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [
            coulomb,
            stiction,
            stribeck_speed,
            stiffness_of,
            damping_of,
            viscous,
        ] = self.friction.law;
        let units = &self.units;
        let (force, speed, damping, stiffness) =
            (units.force, units.speed, units.damping, units.stiffness);
        write!(
            f,
            "identify: T_C {coulomb:.4} {force}, T_S {stiction:.4} {force}, Ω_S {stribeck_speed:.4} {speed}, σ2 {viscous:.5} {damping}, σ0 {stiffness_of:.3} {stiffness}, σ1 {damping_of:.3} {damping}; transfer functions of order {} and {}",
            self.transfer_function.poles.len(),
            self.transfer_function_beside_friction.poles.len()
        )
    }
}

/// The friction of a finished stage.
pub fn load_friction(context: &Context) -> Result<(Friction, LuGre)> {
    let friction: Friction = stage(context).read_json(FRICTION)?;
    let [
        coulomb,
        stiction,
        stribeck_speed,
        stiffness,
        damping,
        viscous,
    ] = friction.law;
    let law = LuGre::new(Parameters {
        coulomb,
        stiction,
        stribeck_speed,
        stiffness,
        damping,
        viscous,
    })
    .into_diagnostic()?;
    Ok((friction, law))
}

/// The transfer functions of a finished stage, without and with friction feed-forward.
pub fn load_transfer(context: &Context) -> Result<([Transfer; 2], [TransferFunctionModel; 2])> {
    let fits: [Transfer; 2] = stage(context).read_json(TRANSFER)?;
    let model = |t: &Transfer| {
        TransferFunctionModel::new(t.period, t.direct, &t.poles, &t.coefficients).into_diagnostic()
    };
    let models = [model(&fits[0])?, model(&fits[1])?];
    Ok((fits, models))
}

fn summarise(identified: &Identified, context: &Context) -> Friction {
    let truth = context.machine.friction.law.parameters();
    let units = context.machine.friction.at.units();
    let (statics, presliding) = (&identified.statics, &identified.presliding);
    let found = |name: &str, unit: &str, estimate: ParameterEstimate, truth: f64| Found {
        name: name.to_owned(),
        unit: unit.to_owned(),
        value: estimate.value,
        standard_error: estimate.standard_error,
        truth,
    };
    let point = |(index, run): (usize, &lugre::identify::ConstantSpeedRun)| RunPoint {
        speed: run.speed,
        torque: run.torque,
        left_out: (statics.left_out.iter())
            .find(|left| left.run == index)
            .map(|left| left.reason.to_string()),
    };
    let p = &identified.parameters;
    Friction {
        parameters: vec![
            found("T_C", units.force, statics.coulomb, truth.coulomb),
            found("T_S", units.force, statics.stiction, truth.stiction),
            found(
                "Ω_S",
                units.speed,
                statics.stribeck_speed,
                truth.stribeck_speed,
            ),
            found("σ2", units.damping, statics.viscous, truth.viscous),
            found("σ0", units.stiffness, presliding.stiffness, truth.stiffness),
            found("σ1", units.damping, presliding.damping, truth.damping),
        ],
        runs: identified.runs.iter().enumerate().map(point).collect(),
        law: [
            p.coulomb,
            p.stiction,
            p.stribeck_speed,
            p.stiffness,
            p.damping,
            p.viscous,
        ],
    }
}

fn plans(context: &Context) -> (IdentificationPlan, TransferPlan) {
    let mut friction = IdentificationPlan {
        seed: context.seed,
        ..IdentificationPlan::of(&context.machine)
    };
    let mut transfer = TransferPlan {
        seed: context.seed,
        ..TransferPlan::default()
    };
    if context.quick {
        friction.record_time = 0.4;
        transfer.training = 3;
        transfer.validation = 2;
    }
    (friction, transfer)
}
