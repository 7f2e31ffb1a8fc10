//! Laws that hold for all numbers.

use axis_rating::preload::preloaded_n;
use axis_rating::{
    MeanLoad, MotorVoltage, PowerCourse, Regeneration, RollingElement, ScrewMounting,
    ScrewStrength, TorqueCurve, WindingModel, life,
};
use proptest::prelude::*;

const MOUNTINGS: [ScrewMounting; 4] = [
    ScrewMounting::FixedFree,
    ScrewMounting::SupportedSupported,
    ScrewMounting::FixedSupported,
    ScrewMounting::FixedFixed,
];

fn element() -> impl Strategy<Value = RollingElement> {
    prop_oneof![Just(RollingElement::Ball), Just(RollingElement::Roller)]
}

fn close(a: f64, b: f64, share: f64) -> bool {
    a == b || (a - b).abs() <= share * a.abs().max(b.abs())
}

proptest! {
    /// Speed goes with d/L², load with d⁴/L²; both rise with each step of the mounting.
    #[test]
    fn screws_scale(d in 5e-3..0.2_f64, l in 0.1..10.0_f64, by in 1.01..4.0_f64, i in 0..4_usize) {
        let screw = |d: f64, i: usize| ScrewStrength {
            root_diameter_m: d, youngs_modulus_pa: 2.06e11, density_kg_per_m3: 7850.0, mounting: MOUNTINGS[i],
        };
        let speed = |d: f64, l: f64, i: usize| screw(d, i).critical_speed_rad_per_s(l).unwrap();
        let load = |d: f64, l: f64, i: usize| screw(d, i).buckling_load_n(l).unwrap();
        prop_assert!(close(speed(by * d, by * l, i), speed(d, l, i) / by, 1e-12));
        prop_assert!(close(load(by * d, by * l, i), load(d, l, i) * by * by, 1e-12));
        if i > 0 {
            prop_assert!(speed(d, l, i) > speed(d, l, i - 1) && load(d, l, i) > load(d, l, i - 1));
        }
    }

    /// The mean lies between the loads, does not depend on order or on the unit of travel, and goes with the loads.
    #[test]
    fn mean_loads(
        parts in prop::collection::vec((1e-3..1e3_f64, 0.0..1e6_f64), 1..20), by in 1e-3..1e3_f64, element in element(),
    ) {
        let mean = |parts: &[(f64, f64)], travel: f64, load: f64| {
            let mut mean = MeanLoad::new(element.exponent());
            parts.iter().for_each(|(u, p)| mean.push(travel * u, load * p));
            mean.load_n()
        };
        let found = mean(&parts, 1.0, 1.0);
        let least = parts.iter().map(|part| part.1).fold(f64::INFINITY, f64::min);
        let most = parts.iter().map(|part| part.1).fold(0.0, f64::max);
        prop_assert!(found >= least * (1.0 - 1e-12) && found <= most * (1.0 + 1e-12));
        let weighted = parts.iter().map(|(u, p)| u * p).sum::<f64>() / parts.iter().map(|part| part.0).sum::<f64>();
        prop_assert!(found >= weighted * (1.0 - 1e-9));
        let mut other = parts.clone();
        other.reverse();
        prop_assert!(close(mean(&other, by, 1.0), found, 1e-9));
        prop_assert!(close(mean(&parts, 1.0, by), by * found, 1e-9));
    }

    /// Life falls with the load by its power; two contacts live shorter than either.
    #[test]
    fn lives(c in 1e2..1e6_f64, p in 1.0..1e6_f64, by in 1.01..10.0_f64, element in element()) {
        let life = |load: f64| life::nominal_life(1e6, c, load, element).unwrap();
        prop_assert!(close(life(p) / life(by * p), by.powf(element.exponent()), 1e-9));
        prop_assert!(close(life(c), 1e6, 1e-12));
        let joint = life::joint_life([life(p), life(by * p)], element).unwrap();
        prop_assert!(joint < life(by * p) && joint > 0.5 * life(by * p));
    }

    /// Both contacts balance the load; the loaded one has more than the load and than the preload; the sign swaps them.
    #[test]
    fn preloads(load in -1e5..1e5_f64, preload in 0.0..1e5_f64, element in element()) {
        let [a, b] = preloaded_n(load, preload, element).unwrap();
        prop_assert!((a - b - load).abs() <= 1e-9 * (load.abs() + preload));
        prop_assert!(a >= 0.0 && b >= 0.0);
        prop_assert!(a.max(b) >= load.abs() * (1.0 - 1e-12) && a.max(b) >= preload.min(a.max(b)));
        prop_assert_eq!(preloaded_n(-load, preload, element).unwrap(), [b, a]);
        let more = preloaded_n(1.001 * load, preload, element).unwrap();
        prop_assert!(more[0].max(more[1]) >= a.max(b) * (1.0 - 1e-12));
    }

    /// The temperature is at least that of the mean loss and at most that of the greatest; more loss warms more.
    #[test]
    fn windings(
        parts in prop::collection::vec((0.1..100.0_f64, 0.0..50.0_f64), 1..12), time in 1.0..1e4_f64, rise in 0.0..0.005_f64,
    ) {
        let model = WindingModel {
            thermal_resistance_k_per_w: 1.0, time_constant_s: time, ambient_deg_c: 20.0, reference_deg_c: 20.0,
            resistance_rise_per_k: rise,
        };
        let course = |by: f64| {
            let mut course = PowerCourse::default();
            parts.iter().for_each(|(t, p)| course.push(*t, by * p));
            course
        };
        let found = model.greatest_deg_c(&course(1.0)).unwrap() - 20.0;
        let steady = |p: f64| p / (1.0 - rise * p);
        let most = parts.iter().map(|part| part.1).fold(0.0, f64::max);
        prop_assert!(found <= steady(most) * (1.0 + 1e-9) + 1e-9);
        if rise == 0.0 || time > 1e3 {
            prop_assert!(found >= course(1.0).mean_w() * (1.0 - 1e-9));
        }
        prop_assert!(model.greatest_deg_c(&course(1.1)).unwrap() - 20.0 >= found);
    }

    /// The voltage suffices below the base speed and not above it.
    #[test]
    fn base_speeds(i in 0.0..30.0_f64, r in 0.0..5.0_f64, flux in 0.01..1.0_f64, l in 1e-4..0.1_f64) {
        let motor = MotorVoltage {
            resistance_ohm: r, inductance_d_h: l, inductance_q_h: l, flux_v_s: flux, electrical_per_motor: 3.0,
            dc_link_v: 540.0,
        };
        let speed = motor.base_speed_rad_per_s(i).unwrap();
        prop_assert!(motor.rating([0.0, i], 0.999 * speed).unwrap().holds());
        prop_assert!(!motor.rating([0.0, i], 1.001 * speed).unwrap().holds());
    }

    /// What is given back in all is split among capacitors and brake: more capacitance, less brake.
    #[test]
    fn brakes(parts in prop::collection::vec((1e-3..1.0_f64, -1e4..1e4_f64), 1..40), capacitor in 0.0..1e3_f64) {
        let run = |capacitor: f64| {
            let mut back = Regeneration::with_capacitor(capacitor);
            parts.iter().for_each(|(t, p)| back.push(*t, *p, 0.0));
            back
        };
        let (all, some) = (run(0.0), run(capacitor));
        let duration: f64 = parts.iter().map(|part| part.0).sum();
        let negative: f64 = parts.iter().map(|(t, p)| t * (-p).max(0.0)).sum();
        prop_assert!(close(all.mean_brake_power_w() * duration, negative, 1e-9));
        prop_assert!(some.mean_brake_power_w() <= all.mean_brake_power_w());
        prop_assert_eq!(some.greatest_energy_j(), all.greatest_energy_j());
    }

    /// A curve is between its neighbouring points, and no number panics.
    #[test]
    fn curves(
        points in prop::collection::vec((0.1..100.0_f64, 0.1..50.0_f64), 1..8), speed in prop::num::f64::ANY,
    ) {
        let mut at = 0.0;
        let points: Vec<[f64; 2]> = points.iter().map(|(step, torque)| { at += step; [at, *torque] }).collect();
        let curve = TorqueCurve::new(points.clone()).unwrap();
        let found = curve.at(speed);
        prop_assert!((0.0..=50.0).contains(&found));
        for [speed, torque] in points {
            prop_assert!(close(curve.at(-speed), torque, 1e-12));
        }
    }
}
