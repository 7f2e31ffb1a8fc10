//! Against a simulator that shares no code: the screw as a rod of 5 mm cells, the nut where it is at each
//! instant, losses of each instant, steps of 40 ms (`independent_axis::HeatedScrew`).

use axis_thermal::{
    Duty, DutySample, HeatNode, ThermalModel, ThermalParameters, ThermalState, WindingLoss,
};
use independent_axis::{HeatedScrew, Motion, Parameters, there_and_back};

/// The defaults, with the winding of the paper's motor.
pub(crate) fn model() -> ThermalModel {
    let p = Parameters::paper_with_measured_viscosity();
    let winding = WindingLoss {
        per_torque_squared: 1.5 * p.resistance / p.torque_constant.powi(2),
        ..WindingLoss::default()
    };
    let parameters = ThermalParameters {
        winding,
        ..ThermalParameters::default()
    };
    ThermalModel::new(parameters).unwrap()
}

/// Losses of a motion from its reference, or of a standstill.
pub(crate) fn duty(model: &ThermalModel, motion: Option<&Motion>) -> Duty {
    let p = Parameters::paper_with_measured_viscosity();
    let mut duty = model.duty();
    let Some(motion) = motion else {
        duty.push(&DutySample {
            duration: 1.0,
            position: 0.75,
            ..DutySample::default()
        });
        return duty;
    };
    let inertia = p.inertia();
    let count = (motion.duration() / 1e-3).round();
    let step = motion.duration() / count;
    for k in 0..count as u32 {
        let t = f64::from(k) * step;
        let (from, to) = (motion.at(t), motion.at(t + step));
        let middle = motion.at(t + 0.5 * step);
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
            torque: [inertia * acceleration / p.travel(), dry, p.viscous * w],
        });
    }
    duty
}

/// Where growth is compared, m.
const PLACES: [f64; 5] = [0.2, 0.45, 0.8, 0.95, 1.4];

/// Both through the same stretches: a motion, or a standstill, and minutes. Greatest difference of
/// growth (µm) and of the nut's temperature (K), and the greatest growth (µm).
fn compared(stretches: &[(Option<Motion>, u32)]) -> [f64; 3] {
    let model = model();
    let cold = model.at_rest(20.0);
    let mut state = cold.clone();
    let mut brute = HeatedScrew::assumed(20.0);
    let mut worst = [0.0_f64; 3];
    for (motion, minutes) in stretches {
        let at_work = model.under(&duty(&model, motion.as_ref())).unwrap();
        for _ in 0..*minutes {
            at_work.run(&mut state, 20.0, 60.0).unwrap();
            brute.run(motion.as_ref(), 60.0, |_| 20.0);
            let found = difference(&model, [&cold, &state], &brute);
            worst = [0, 1, 2].map(|i| worst[i].max(found[i]));
        }
    }
    worst
}

fn difference(
    model: &ThermalModel,
    [cold, now]: [&ThermalState; 2],
    brute: &HeatedScrew,
) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for x in PLACES {
        let (ours, theirs) = (model.growth(cold, now, x).screw, brute.growth(20.0, x));
        worst[0] = worst[0].max(1e6 * (ours - theirs).abs());
        worst[2] = worst[2].max(1e6 * theirs);
    }
    worst[1] = (now.of(HeatNode::Nut) - brute.bodies[4]).abs();
    worst
}

#[test]
fn an_hour_of_one_duty() {
    let [growth, nut, most] = compared(&[(Some(there_and_back(0.45, 0.95, 0.2, 1.0)), 60)]);
    // Measured: 0.22 µm, 0.03 K; within a duty the brute force's nut swings by about that much.
    assert!(
        growth < 0.3 && nut < 0.04 && most > 150.0,
        "{growth} {nut} {most}"
    );
}

/// Other places and speeds, a standstill, slow motion: the screw's air and the nut's place change.
#[test]
fn two_hours_of_several_duties() {
    let [growth, nut, most] = compared(&[
        (Some(there_and_back(0.1, 0.7, 0.3, 0.5)), 20),
        (None, 20),
        (Some(there_and_back(0.8, 1.45, 0.05, 2.0)), 40),
        (Some(there_and_back(0.3, 1.2, 0.25, 0.2)), 40),
    ]);
    // Measured: 0.56 µm, 0.04 K.
    assert!(
        growth < 0.7 && nut < 0.06 && most > 290.0,
        "{growth} {nut} {most}"
    );
}
