//! A thermal model fitted to another machine, and the table's residual error with it.

use std::sync::Arc;

use axis_pipeline::strategies::{NONE, Predictors, STRATEGIES, StrategyKind};
use axis_sim::{Axis, ClosedLoop};
use axis_thermal::{
    Duty, DutySample, GrowthFit, GrowthPredictor, GrowthStretch, ThermalModel, ThermalParameters,
    ThermalUnknown,
};
use independent_axis::{HeatHours, HeatedScrew, Motion, Parameters, Random, there_and_back};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;
use trajectories::{Program, Step};

/// A fitted model on hours that were not fitted.
#[derive(Serialize)]
pub struct Identified {
    pub log: &'static str,
    pub greatest_um: f64,
    pub rms_um: f64,
    /// Greatest growth.
    pub of_um: f64,
}

/// Peak of the table's error on a stroke there and back after 0, 5, 20 and 60 minutes.
#[derive(Serialize)]
pub struct Compensated {
    pub what: &'static str,
    pub peaks_um: [f64; 4],
}

const PLACES: [f64; 5] = [0.2, 0.5, 0.8, 1.1, 1.4];
const FIVE_MINUTES: f64 = 300.0;

/// A log: its name, at which places growth is found, every how many five minutes, with which noise (m).
type Log = (&'static str, &'static [f64], usize, f64);
const LOGS: [Log; 3] = [
    ("each 5 min, 5 places, noise 0.5 µm", &PLACES, 1, 0.5e-6),
    (
        "each 10 min, 2 places, noise 0.5 µm",
        &[0.5, 1.1],
        2,
        0.5e-6,
    ),
    ("each 15 min, 1 place, noise 1 µm", &[1.1], 3, 1e-6),
];

/// A name and a fitted model, or the guess.
pub type Fitted = (&'static str, ThermalParameters);

/// Losses of a motion of the second simulator's axis from its reference, or of a standstill.
fn duty(model: &ThermalModel, motion: Option<&Motion>) -> Duty {
    let p = Parameters::paper_with_measured_viscosity();
    let mut duty = model.duty();
    let whole = motion.map_or(1.0, Motion::duration);
    let count = (whole / 1e-3).round();
    let step = whole / count;
    for k in 0..count as u32 {
        let at = |t: f64| motion.map(|m| m.at(t));
        let t = f64::from(k) * step;
        let (Some(from), Some(middle), Some(to)) = (at(t), at(t + 0.5 * step), at(t + step)) else {
            duty.push(&DutySample {
                duration: step,
                position: 0.5 * p.screw_length,
                ..DutySample::default()
            });
            continue;
        };
        let w = middle.velocity / p.travel();
        let ratio = w / p.stribeck_speed;
        let dry = p.coulomb + (p.stiction - p.coulomb) * (-ratio * ratio).exp();
        let dry = if w == 0.0 { 0.0 } else { dry.copysign(w) };
        let acceleration = (to.velocity - from.velocity) / step;
        duty.push(&DutySample {
            duration: step,
            position: middle.position,
            screw_speed: w,
            dry_power: dry * w,
            viscous_power: p.viscous * w * w,
            torque: [p.inertia() * acceleration / p.travel(), dry, p.viscous * w],
        });
    }
    duty
}

/// Stretches of five minutes with the growth found in them, and the truth after each.
fn logged(
    hours: &HeatHours,
    model: &ThermalModel,
    log: &Log,
) -> (Vec<GrowthStretch>, Vec<[f64; 5]>) {
    let (_, places, every, noise) = log;
    let air = hours.air;
    let cold = air(0.0);
    let mut machine = HeatedScrew::other(cold);
    let mut random = Random::new(7, 3);
    let (mut stretches, mut truth) = (Vec::new(), Vec::new());
    for (motion, count) in &hours.duties {
        let duty = duty(model, motion.as_ref());
        for _ in 0..*count {
            let from = machine.time;
            machine.run(motion.as_ref(), FIVE_MINUTES, air);
            let probed = (stretches.len() + 1) % every == 0;
            let probe = |x: &f64| [*x, machine.growth(cold, *x) + noise * random.normal()];
            stretches.push(GrowthStretch {
                duty: duty.clone(),
                duration: FIVE_MINUTES,
                air: [air(from), air(machine.time)],
                found: match probed {
                    true => places.iter().map(probe).collect(),
                    false => Vec::new(),
                },
            });
            truth.push(PLACES.map(|x| machine.growth(cold, x)));
        }
    }
    (stretches, truth)
}

/// Fits to each log, and predicts other hours; the models, the guess first.
pub fn identified(model: &ThermalModel) -> Result<(Vec<Identified>, Vec<Fitted>)> {
    let mut assumed = model.parameters().clone();
    if let Some(screw) = &mut assumed.screw {
        screw.segments = 30;
    }
    let coarse = ThermalModel::new(assumed.clone()).into_diagnostic()?;
    let none: Log = ("", &[], 1, 0.0);
    let (check, truth) = logged(&HeatHours::to_check(), &coarse, &none);
    let mut fitted: Vec<Fitted> = vec![("first guess", assumed.clone())];
    for log in &LOGS {
        let (stretches, _) = logged(&HeatHours::to_fit(), &coarse, log);
        let fit = assumed.fit(&stretches, &ThermalUnknown::ALL, &GrowthFit::default());
        fitted.push((log.0, fit.into_diagnostic()?.parameters));
    }
    let row = |(log, parameters): &Fitted| checked(log, parameters, &check, &truth);
    let rows: Result<_> = fitted.iter().map(row).collect();
    Ok((rows?, fitted))
}

fn checked(
    log: &'static str,
    parameters: &ThermalParameters,
    check: &[GrowthStretch],
    truth: &[[f64; 5]],
) -> Result<Identified> {
    let model = ThermalModel::new(parameters.clone()).into_diagnostic()?;
    let first = check.first().map_or(20.0, |stretch| stretch.air[0]);
    let mut predictor = GrowthPredictor::new(model, first, 60.0).into_diagnostic()?;
    let (mut worst, mut squares, mut most, mut count) = (0.0_f64, 0.0, 0.0_f64, 0.0);
    for (stretch, truth) in check.iter().zip(truth) {
        let (begun, [from, to]) = (predictor.state().time, stretch.air);
        let air = |t: f64| from + (to - from) * (t - begun) / stretch.duration;
        let advanced = predictor.advance(&stretch.duty, stretch.duration, air);
        advanced.into_diagnostic()?;
        for (x, growth) in PLACES.iter().zip(truth) {
            let error = 1e6 * (predictor.growth_at_end(*x).screw - growth);
            worst = worst.max(error.abs());
            squares += error * error;
            count += 1.0;
            most = most.max(1e6 * growth);
        }
    }
    Ok(Identified {
        log,
        greatest_um: worst,
        rms_um: f64::sqrt(squares / count),
        of_um: most,
    })
}

/// What a stroke is run with: the name, the strategy, whether growth is taken from the reference, and whether
/// the strategy's friction follows the temperature.
type Case = (&'static str, &'static StrategyKind, bool, bool);

/// Minutes of the duty before each stroke.
const AFTER: [f64; 4] = [0.0, 5.0, 20.0, 60.0];

/// The table's error after minutes of the duty, with the first guess and the fitted models.
pub fn compensated(axis: &Axis, fitted: &[Fitted]) -> Result<Vec<Compensated>> {
    let plan = STRATEGIES.iter().find(|kind| kind.name == "plan");
    let plan = *plan.ok_or_else(|| miette!("there is no strategy \"plan\""))?;
    let models = fitted.iter().map(|(name, p)| (*name, p));
    let best = fitted.get(1).or(fitted.first());
    let (_, best) = best.ok_or_else(|| miette!("there is no model"))?;
    let cases: [Case; 4] = [
        ("none", &NONE, false, false),
        ("plan alone", plan, false, false),
        ("growth alone", &NONE, true, false),
        ("both, friction of the cold axis", plan, true, false),
    ];
    let mut rows = Vec::new();
    for case in &cases {
        rows.push(one(axis, best, case, HeatedScrew::other(20.0))?);
    }
    for (name, model) in models {
        rows.push(one(
            axis,
            model,
            &(name, plan, true, true),
            HeatedScrew::other(20.0),
        )?);
    }
    // A machine of the model's own numbers and laws, by brute force.
    let own = axis.thermal_parameters();
    let case = ("exact numbers and laws", plan, true, true);
    rows.push(one(axis, &own, &case, HeatedScrew::assumed(20.0))?);
    Ok(rows)
}

fn one(
    axis: &Axis,
    parameters: &ThermalParameters,
    case: &Case,
    mut machine: HeatedScrew,
) -> Result<Compensated> {
    let (what, strategy, takes_growth, follows) = *case;
    let model = ThermalModel::new(parameters.clone()).into_diagnostic()?;
    let motion = there_and_back(0.45, 0.95, 0.2, 1.0);
    let duty = duty(&model, Some(&motion));
    let mut predictor = GrowthPredictor::new(model, 20.0, 60.0).into_diagnostic()?;
    let mut peaks_um = [0.0; 4];
    for (peak, minutes) in peaks_um.iter_mut().zip(AFTER) {
        let more = 60.0 * minutes - machine.time;
        if more > 0.0 {
            machine.run(Some(&motion), more, |_| 20.0);
            let advanced = predictor.advance(&duty, more, |_| 20.0);
            advanced.into_diagnostic()?;
        }
        let plant = warm(axis, machine.friction_factors(0.7))?;
        let assumed = match follows {
            true => warm(axis, predictor.friction_factors())?,
            false => axis.clone(),
        };
        let left = |x: f64| {
            let predicted = match takes_growth {
                true => predictor.growth_at_end(x).screw,
                false => 0.0,
            };
            predicted - machine.growth(20.0, x)
        };
        *peak = stroke(&plant, &assumed, strategy, left)?;
    }
    Ok(Compensated { what, peaks_um })
}

/// The axis with its dry and viscous friction times these factors.
fn warm(axis: &Axis, [dry, viscous]: [f64; 2]) -> Result<Axis> {
    let mut axis = axis.clone();
    let changed = axis.friction.change(|values| {
        for key in ["coulomb", "stiction"] {
            values.scale(key, dry);
        }
        values.scale("viscous", viscous);
    });
    changed.into_diagnostic()?;
    Ok(axis)
}

/// Peak of the table's error on the stroke there and back, µm: the loop's, and the growth that is `left` at each
/// position by superposition.
fn stroke(
    plant: &Axis,
    assumed: &Axis,
    strategy: &'static StrategyKind,
    left: impl Fn(f64) -> f64,
) -> Result<f64> {
    let spec = plant.trajectories.first();
    let spec = spec.ok_or_else(|| miette!("the axis file has no trajectory"))?;
    let start = plant.stroke.start;
    let to = |to: f64| Step::Move {
        to,
        limits: spec.limits,
    };
    let rest = Step::Dwell { duration: 1.0 };
    let steps = vec![to(start + spec.displacement), rest, to(start)];
    let motion = Arc::new(Program::new(start, steps).into_diagnostic()?);
    let law = strategy.compensator(&Predictors::of(assumed), motion.clone());
    let mut law = law.into_diagnostic()?;
    let mut peak = 0.0_f64;
    let closed_loop = ClosedLoop::new(plant).into_diagnostic()?;
    let outcome = closed_loop.run(&*motion, &mut *law, |cycle| {
        let error = cycle.error() + left(cycle.position);
        peak = peak.max(1e6 * error.abs());
    });
    outcome.completed().into_diagnostic()?;
    Ok(peak)
}
