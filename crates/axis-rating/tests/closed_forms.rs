//! Closed forms and plain integrations.

use std::f64::consts::PI;

use axis_rating::preload::preloaded_n;
use axis_rating::{
    DcLink, MeanLoad, MotorDuty, MotorVoltage, PowerCourse, Regeneration, RollingElement,
    ScrewMounting, TorqueCurve, WindingModel, life, motor,
};

use crate::near;

/// The modes are roots of the beam's frequency equations.
#[test]
fn modes_solve_the_equations_of_the_beam() {
    let zero = |value: f64| assert!(value.abs() < 1e-12, "{value}");
    let mode = ScrewMounting::FixedFixed.mode();
    zero(mode.cos() - 1.0 / mode.cosh());
    let mode = ScrewMounting::FixedSupported.mode();
    zero(mode.tan() - mode.tanh());
    zero(ScrewMounting::SupportedSupported.mode().sin());
    let mode = ScrewMounting::FixedFree.mode();
    zero(mode.cos() + 1.0 / mode.cosh());
}

/// Euler's factor is (π/s)², s the effective length; the exact one of a clamped and supported column is (z/π)² with tan z = z,
/// of which makers' 2 is 2.2 % short.
#[test]
fn buckling_factors_are_eulers() {
    let mut z = 4.5_f64;
    for _ in 0..50 {
        z = PI + z.atan();
    }
    let exact = (z / PI).powi(2);
    let factor = ScrewMounting::FixedSupported.buckling();
    assert!(factor < exact && factor > 0.977 * exact, "{exact}");
    for (mounting, effective) in [
        (ScrewMounting::FixedFixed, 0.5),
        (ScrewMounting::SupportedSupported, 1.0),
        (ScrewMounting::FixedFree, 2.0),
    ] {
        near(mounting.buckling(), 1.0 / (effective * effective), 1e-15);
    }
}

/// A trapezoid of speed: acceleration, constant speed, deceleration and standstill.
#[test]
fn motor_duty_of_a_trapezoid() {
    let mut duty = MotorDuty::default();
    let steps = 1000;
    for k in 0..steps {
        let share = (f64::from(k) + 0.5) / f64::from(steps);
        duty.push(0.1 / f64::from(steps), 8.0, 200.0 * share);
        duty.push(0.1 / f64::from(steps), -5.0, 200.0 * (1.0 - share));
    }
    duty.push(0.3, 1.5, 200.0);
    duty.push(0.5, 0.0, 0.0);
    near(duty.duration_s(), 1.0, 1e-12);
    near(
        duty.rms_torque_n_m(),
        (6.4_f64 + 2.5 + 0.3 * 2.25).sqrt(),
        1e-12,
    );
    near(duty.mean_speed_rad_per_s(), 10.0 + 10.0 + 60.0, 1e-12);
    near(duty.peak_torque_n_m(), 8.0, 1e-15);
    let curve = TorqueCurve::new(vec![[0.0, 5.0], [100.0, 4.0], [300.0, 2.0]]).unwrap();
    let rating = duty.continuous(&curve, "N·m");
    near(rating.limit, 4.2, 1e-12);
    assert!(rating.holds());
    for (speed, torque) in [
        (0.0, 5.0),
        (-50.0, 4.5),
        (200.0, 3.0),
        (300.0, 2.0),
        (301.0, 0.0),
    ] {
        near(curve.at(speed), torque, 1e-15);
    }
    let first = motor::peak(-3.0, 200.0, &curve, "N·m");
    let second = motor::peak(4.5, 10.0, &curve, "N·m");
    near(first.margin(), 1.0, 1e-15);
    assert_eq!(first.worse(second), first);
}

const MOTOR: MotorVoltage = MotorVoltage {
    resistance_ohm: 0.75,
    inductance_d_h: 4.11e-3,
    inductance_q_h: 13.2e-3,
    flux_v_s: 0.2735,
    electrical_per_motor: 4.0,
    dc_link_v: 540.0,
};

/// At the base speed the voltage that is needed is the one that there is; with the whole weakening current and no load,
/// without a resistance, too.
#[test]
fn speeds_where_the_voltage_is_just_enough() {
    for current in [0.0, 3.0, 15.0, 60.0] {
        let speed = MOTOR.base_speed_rad_per_s(current).unwrap();
        let rating = MOTOR.rating([0.0, current], speed).unwrap();
        near(rating.margin(), 1.0, 1e-12);
    }
    let ideal = MotorVoltage {
        resistance_ohm: 0.0,
        ..MOTOR
    };
    let speed = ideal.weakened_speed_rad_per_s(20.0).unwrap();
    near(
        ideal.needed_v([-20.0, 0.0], speed),
        ideal.available_v(),
        1e-12,
    );
    assert!(speed > ideal.base_speed_rad_per_s(0.0).unwrap());
    assert!(ideal.weakened_speed_rad_per_s(70.0).unwrap().is_infinite());
    let starved = MotorVoltage {
        dc_link_v: 10.0,
        ..MOTOR
    };
    assert_eq!(starved.base_speed_rad_per_s(20.0).unwrap(), 0.0);
}

fn winding(rise: f64) -> WindingModel {
    WindingModel {
        thermal_resistance_k_per_w: 0.6,
        time_constant_s: 1500.0,
        ambient_deg_c: 35.0,
        reference_deg_c: 20.0,
        resistance_rise_per_k: rise,
    }
}

/// Constant loss: θ = R P (1 + α (T_a − T_r))/(1 − α R P). On and off: the closed form of a switched first-order system.
#[test]
fn winding_under_constant_and_switched_loss() {
    let mut constant = PowerCourse::default();
    constant.push(20.0, 100.0);
    near(
        winding(0.0).greatest_deg_c(&constant).unwrap(),
        35.0 + 60.0,
        1e-12,
    );
    let hot = 60.0 * (1.0 + 0.00393 * 15.0) / (1.0 - 0.00393 * 60.0);
    near(
        winding(0.00393).greatest_deg_c(&constant).unwrap(),
        35.0 + hot,
        1e-12,
    );
    let mut switched = PowerCourse::default();
    switched.push(600.0, 200.0);
    switched.push(900.0, 0.0);
    let peak = 120.0 * (1.0 - (-0.4_f64).exp()) / (1.0 - (-1.0_f64).exp());
    near(
        winding(0.0).greatest_deg_c(&switched).unwrap(),
        35.0 + peak,
        1e-12,
    );
    let mut too_much = PowerCourse::default();
    too_much.push(10.0, 1.01 / (0.00393 * 0.6));
    assert!(
        winding(0.00393)
            .greatest_deg_c(&too_much)
            .unwrap()
            .is_infinite()
    );
    let rating = winding(0.0).rise(&constant, 155.0).unwrap();
    near(rating.margin(), 2.0, 1e-12);
    assert_eq!(
        winding(0.0)
            .greatest_deg_c(&PowerCourse::default())
            .unwrap(),
        35.0
    );
}

/// By explicit Euler steps until the temperature repeats itself.
#[test]
fn winding_against_a_plain_integration() {
    let model = WindingModel {
        time_constant_s: 40.0,
        ..winding(0.00393)
    };
    let stretches = [[3.0, 150.0], [5.0, 20.0], [2.0, 400.0], [9.0, 0.0]];
    let mut course = PowerCourse::default();
    stretches
        .iter()
        .for_each(|[duration, power]| course.push(*duration, *power));
    let (step, mut rise, mut most) = (1e-4, 0.0_f64, 0.0_f64);
    for round in 0..60 {
        for [duration, power] in stretches {
            for _ in 0..(duration / step).round() as u32 {
                let heat = 0.6 * power * (1.0 + 0.00393 * (15.0 + rise));
                rise += step * (heat - rise) / 40.0;
                most = if round == 59 { most.max(rise) } else { 0.0 };
            }
        }
    }
    near(model.greatest_deg_c(&course).unwrap() - 35.0, most, 2e-5);
}

/// Joined stretches keep energy and duration.
#[test]
fn a_long_course_keeps_its_energy() {
    let mut course = PowerCourse::default();
    let (mut energy, mut duration) = (0.0, 0.0);
    for k in 0..200_001_u32 {
        let (time, power) = (1e-3 + 1e-6 * f64::from(k % 7), f64::from(k % 11));
        course.push(time, power);
        energy += time * power;
        duration += time;
    }
    assert!(course.stretches().count() <= 1 << 15);
    near(course.duration_s(), duration, 1e-10);
    near(course.mean_w(), energy / duration, 1e-10);
}

/// A stop from ω with constant torque gives back ½ J ω² less its losses, once per stretch.
#[test]
fn regeneration_of_a_stop() {
    let (inertia, fast, time, loss) = (0.02, 300.0, 0.1, 40.0);
    let link = DcLink {
        capacitance_f: 1e-3,
        voltage_v: 540.0,
        brake_on_v: 700.0,
    };
    let capacitor = link.capacitor_energy_j().unwrap();
    near(capacitor, 0.5e-3 * (490_000.0 - 291_600.0), 1e-12);
    let mut back = Regeneration::with_capacitor(capacitor);
    let steps = 20_000;
    for _ in 0..2 {
        for k in 0..steps {
            let speed = fast * (1.0 - (f64::from(k) + 0.5) / f64::from(steps));
            back.push(
                time / f64::from(steps),
                -inertia * fast / time * speed,
                loss,
            );
        }
        back.push(0.9, 50.0, 5.0);
    }
    // Regeneration ends where torque times speed is the loss: at 40/18000 of the time before the end.
    let peak = inertia * fast * fast / time;
    let energy = 0.5 * peak * time * (1.0 - loss / peak).powi(2);
    near(back.greatest_energy_j(), energy, 1e-6);
    near(back.peak_power_w(), peak - loss, 1e-4);
    near(back.mean_brake_power_w(), energy - capacitor, 1e-6);
    near(
        back.energy(1000.0).unwrap().limit,
        capacitor + 1000.0,
        1e-12,
    );
    assert!(!back.energy(100.0).unwrap().holds());
    near(back.peak_power(700.0, 20.0).unwrap().limit, 24_500.0, 1e-12);
    assert!(!back.mean_power(500.0).unwrap().holds());
}

/// Two loads: the cubic mean by travel, in any unit of it.
#[test]
fn mean_load_of_two() {
    let mut mean = MeanLoad::new(3.0);
    mean.push(-30.0, 1000.0);
    mean.push(10.0, -3000.0);
    near(
        mean.load_n(),
        ((30.0 * 1e9 + 10.0 * 27e9) / 40.0_f64).cbrt(),
        1e-14,
    );
    near(mean.travel(), 40.0, 1e-15);
    let mut huge = MeanLoad::new(10.0 / 3.0);
    huge.push(1.0, 1e200);
    huge.push(1.0, 1e-200);
    near(huge.load_n(), 1e200 * 0.5_f64.powf(0.3), 1e-14);
}

/// Hertz's contacts by bisection.
#[test]
fn preload_against_hertz() {
    let exact = |load: f64| {
        let (mut low, mut high) = (load, load + 1.0);
        for _ in 0..100 {
            let more = 0.5 * (low + high);
            let sum = more.powf(2.0 / 3.0) + (more - load).powf(2.0 / 3.0);
            match sum < 2.0 {
                true => low = more,
                false => high = more,
            }
        }
        low
    };
    for k in 0..=28284 {
        let load = 1e-4 * f64::from(k);
        let [more, less] = preloaded_n(load, 1.0, RollingElement::Ball).unwrap();
        assert!((more - less - load).abs() < 1e-14, "{load}");
        near(more, exact(load), 1e-13);
    }
    let lift = 8.0_f64.sqrt();
    let [more, less] = preloaded_n(-lift * 200.0, 200.0, RollingElement::Ball).unwrap();
    assert!(more == 0.0);
    near(less, lift * 200.0, 1e-15);
    let [more, less] = preloaded_n(100.0, 100.0, RollingElement::Roller).unwrap();
    near(more, 150.0, 1e-15);
    near(less, 50.0, 1e-15);
}

/// Two equal lives: 2^(−9/10) of one. One contact that never fails leaves the other's.
#[test]
fn life_of_two_contacts() {
    near(
        life::joint_life([500.0, 500.0], RollingElement::Ball).unwrap(),
        500.0 * 2.0_f64.powf(-0.9),
        1e-14,
    );
    near(
        life::joint_life([500.0, 500.0], RollingElement::Roller).unwrap(),
        500.0 * 2.0_f64.powf(-8.0 / 9.0),
        1e-14,
    );
    assert_eq!(
        life::joint_life([f64::INFINITY, 7.0], RollingElement::Ball).unwrap(),
        7.0
    );
    assert!(
        life::joint_life([f64::INFINITY; 2], RollingElement::Ball)
            .unwrap()
            .is_infinite()
    );
}
