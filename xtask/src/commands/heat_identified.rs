//! Thermal models fitted to another machine, on hours that were not fitted; and the same set right by a probe.

use axis_thermal::{
    Duty, DutySample, GrowthFit, GrowthLog, GrowthOf, GrowthPredictor, GrowthStretch, ThermalModel,
    ThermalParameters, ThermalUnknown,
};
use independent_axis::{HeatHours, HeatedScrew, Motion, Parameters, Random, there_and_back};
use miette::{IntoDiagnostic, Result};
use serde::{Deserialize, Serialize};

/// A model on hours that were not fitted.
#[derive(Clone, Deserialize, Serialize)]
pub struct Identified {
    pub log: String,
    pub greatest_um: f64,
    pub rms_um: f64,
    /// Greatest growth.
    pub of_um: f64,
}

const PLACES: [f64; 5] = [0.2, 0.5, 0.8, 1.1, 1.4];
const FIVE_MINUTES: f64 = 300.0;
/// Two slow strokes there and back of 0.3 m, s.
const SLOW_STROKES: f64 = 60.0;

/// A log: at which places growth is found, every how many five minutes, with which noise (m), and with which noise
/// (as a share) the friction's power.
struct Log {
    name: &'static str,
    places: &'static [f64],
    every: usize,
    noise: f64,
    friction: Option<f64>,
    slow: bool,
}

const LOGS: [Log; 5] = [
    Log {
        name: "each 5 min, 5 places, noise 0.5 µm",
        places: &PLACES,
        every: 1,
        noise: 0.5e-6,
        friction: None,
        slow: false,
    },
    Log {
        name: "each 10 min, 2 places, noise 0.5 µm",
        places: &TWO,
        every: 2,
        noise: 0.5e-6,
        friction: None,
        slow: false,
    },
    Log {
        name: "each 15 min, 1 place, noise 1 µm",
        places: &[1.1],
        every: 3,
        noise: 1e-6,
        friction: None,
        slow: false,
    },
    Log {
        name: "each 10 min, 2 places, noise 0.5 µm, and friction's power with noise of 0.5 %",
        places: &TWO,
        every: 2,
        noise: 0.5e-6,
        friction: Some(0.005),
        slow: false,
    },
    Log {
        name: "each 10 min, 2 places, noise 0.5 µm, and friction's power with noise of 0.5 %, a minute of it at 20 mm/s",
        places: &TWO,
        every: 2,
        noise: 0.5e-6,
        friction: Some(0.005),
        slow: true,
    },
];

const TWO: [f64; 2] = [0.5, 1.1];

/// How a model is set right: minutes between two probings at [`TWO`], with a noise of 0.5 µm.
const PROBINGS: [(usize, u32); 3] = [(1, 60), (0, 60), (0, 20)];

/// A name and a fitted model, or the guess.
pub type Fitted = (String, ThermalParameters);

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
    let air = hours.air;
    let cold = air(0.0);
    let mut machine = HeatedScrew::other(cold);
    let mut random = Random::new(7, 3);
    let (mut stretches, mut truth) = (Vec::new(), Vec::new());
    for (motion, count) in &hours.duties {
        let slow = there_and_back(0.55, 0.85, 0.02, 0.0);
        for number in 1..=*count {
            let is_slow = log.slow && number % 2 == 0;
            let mut parts = vec![(motion.as_ref(), FIVE_MINUTES)];
            if is_slow {
                parts = vec![
                    (motion.as_ref(), FIVE_MINUTES - SLOW_STROKES),
                    (Some(&slow), SLOW_STROKES),
                ];
            }
            let last = parts.len() - 1;
            let probed = (truth.len() + 1) % log.every == 0;
            for (part, (motion, seconds)) in parts.into_iter().enumerate() {
                let (from, spent) = (machine.time, machine.friction_heat);
                machine.run(motion, seconds, air);
                let probe = |x: &f64| [*x, machine.growth(cold, *x) + log.noise * random.normal()];
                stretches.push(GrowthStretch {
                    duty: duty(model, motion),
                    duration: seconds,
                    air: [air(from), air(machine.time)],
                    found: match probed && part == last {
                        true => log.places.iter().map(probe).collect(),
                        false => Vec::new(),
                    },
                    friction: log.friction.map(|noise| {
                        let power = (machine.friction_heat - spent) / seconds;
                        power * (1.0 + noise * random.normal())
                    }),
                    temperatures: Vec::new(),
                });
            }
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
    let none = Log {
        name: "",
        places: &[],
        every: 1,
        noise: 0.0,
        friction: None,
        slow: false,
    };
    let (check, truth) = logged(&HeatHours::to_check(), &coarse, &none);
    let mut fitted: Vec<Fitted> = vec![("the assumed numbers".to_owned(), assumed.clone())];
    for log in &LOGS {
        let (stretches, _) = logged(&HeatHours::to_fit(), &coarse, log);
        let logs = [GrowthLog {
            stretches,
            ..GrowthLog::default()
        }];
        let fit = assumed.fit(&logs, &ThermalUnknown::ALL, &GrowthFit::default());
        fitted.push((log.name.to_owned(), fit.into_diagnostic()?.parameters));
    }
    let row = |(log, parameters): &Fitted| checked(log, parameters, &check, &truth, None);
    let mut rows: Vec<Identified> = fitted.iter().map(row).collect::<Result<_>>()?;
    for (model, minutes) in PROBINGS {
        let (name, parameters) = &fitted[model];
        let name = format!("{name}; and 2 places probed each {minutes} min");
        rows.push(checked(&name, parameters, &check, &truth, Some(minutes))?);
    }
    Ok((rows, fitted))
}

fn checked(
    log: &str,
    parameters: &ThermalParameters,
    check: &[GrowthStretch],
    truth: &[[f64; 5]],
    probed: Option<u32>,
) -> Result<Identified> {
    let model = ThermalModel::new(parameters.clone()).into_diagnostic()?;
    let first = check.first().map_or(20.0, |stretch| stretch.air[0]);
    let mut predictor = GrowthPredictor::new(model, first, 60.0).into_diagnostic()?;
    let mut random = Random::new(11, 3);
    let (mut worst, mut squares, mut most, mut count) = (0.0_f64, 0.0, 0.0_f64, 0.0);
    for (number, (stretch, truth)) in check.iter().zip(truth).enumerate() {
        let (begun, [from, to]) = (predictor.state().time, stretch.air);
        let air = |t: f64| from + (to - from) * (t - begun) / stretch.duration;
        let advanced = predictor.advance(&stretch.duty, stretch.duration, air);
        advanced.into_diagnostic()?;
        // Before it is probed: the longest since the last probing.
        for (x, growth) in PLACES.iter().zip(truth) {
            let error = 1e6 * (predictor.growth_at_end(*x).screw - growth);
            worst = worst.max(error.abs());
            squares += error * error;
            count += 1.0;
            most = most.max(1e6 * growth);
        }
        let now = 5 * (number as u32 + 1);
        if probed.is_some_and(|each| now.is_multiple_of(each)) {
            let read = [1, 3].map(|i| [PLACES[i], truth[i] + 0.5e-6 * random.normal()]);
            let set = predictor.probed(GrowthOf::Screw, &read);
            set.into_diagnostic()?;
        }
    }
    Ok(Identified {
        log: log.to_owned(),
        greatest_um: worst,
        rms_um: f64::sqrt(squares / count),
        of_um: most,
    })
}
