//! The rigid drive against closed forms.

use feed_dynamics::{ForceCourse, NutErrors, RigidDrive, RigidStepper, Settled, TimeStepper};

fn stepper(step: f64) -> RigidStepper {
    RigidStepper::new(&RigidDrive::new(95.0, 0.002).unwrap(), step).unwrap()
}

#[test]
fn a_constant_force_accelerates_evenly() {
    let s = stepper(1e-3);
    let mut state = s.settled(0.7, &Settled::default()).unwrap();
    let (mut off, mut speed, mut way) = ([0.0_f64; 4], 0.0_f64, 0.0_f64);
    for i in 1..=3000 {
        let report = s.step(&mut state, 0.3, |_| 55.0);
        assert!(report.load.converged && report.on_screw);
        let (o, t) = (s.observe(&state), 1e-3 * f64::from(i));
        // 150 N of the motor less 55 N on 95 kg.
        let found = [
            o.speed / t,
            o.displacement / (0.5 * t * t),
            s.energy(&state) / (47.5 * t * t),
            o.motor_angle * 0.002 / o.displacement,
        ];
        for (off, found) in off.iter_mut().zip(found) {
            *off = off.max((found - 1.0).abs());
        }
        assert_eq!(
            [o.transmission_force, o.motor_speed],
            [150.0, o.speed / 0.002]
        );
        // The documented law, to the bit.
        let before = speed;
        speed = before + 1e-3 * (0.3 / 0.002 - 55.0) / 95.0;
        way += 0.5 * 1e-3 * (before + speed);
        assert_eq!([o.speed, o.displacement], [speed, way]);
    }
    println!("constant force {off:?}");
    // 7.3e-14, 4.8e-14, 1.5e-13 and 2.2e-16: 3000 roundings.
    assert!(off[0] < 5e-13 && off[1] < 4e-13, "{off:?}");
    assert!(off[2] < 1e-12 && off[3] < 1e-15, "{off:?}");
}

#[test]
fn a_viscous_load_takes_its_part_of_the_speed_in_each_step() {
    // Backward: v₁ = (v₀ + h F/m) / (1 + h d/m), towards F/d; and so of first order
    // to F/d (1 − exp(−t d/m)).
    let drag = 190.0;
    let off = [1e-3, 5e-4].map(|h| {
        let s = stepper(h);
        let mut state = s.settled(0.0, &Settled::default()).unwrap();
        let (mut speed, mut way) = (0.0, 0.0);
        let mut off = 0.0_f64;
        for i in 1..=(2.0 / h) as u32 {
            assert!(
                s.step(&mut state, 0.3, |table| drag * table.speed)
                    .load
                    .converged
            );
            let after = (speed + h * 150.0 / 95.0) / (1.0 + h * drag / 95.0);
            way += 0.5 * h * (speed + after);
            speed = after;
            let o = s.observe(&state);
            // The speed of each step is found to 1e-11 m/s.
            assert!((o.speed - speed).abs() < 5e-11, "{o:?} {speed}");
            assert!((o.displacement - way).abs() < 1e-10, "{o:?} {way}");
            let exact = 150.0 / drag * (1.0 - (-2.0 * h * f64::from(i)).exp());
            off = off.max((o.speed - exact).abs());
        }
        off
    });
    println!("viscous load: {off:?}");
    assert!(off[0] < 1e-3, "{off:?}");
    assert!((off[0] / off[1] - 2.0).abs() < 0.01, "{off:?}");
}

#[test]
fn settled_motion_goes_on_and_errors_of_a_transmission_do_nothing() {
    let s = stepper(1e-3);
    let motion = Settled {
        speed: 0.2,
        acceleration: -0.1,
        load: 40.0,
    };
    let torque = s.settled_torque(0.0, &motion);
    assert!((torque - 0.002 * (40.0 - 9.5)).abs() < 1e-16);
    assert_eq!([s.travel_per_radian(), s.step_length()], [0.002, 1e-3]);
    let start = s.settled(-4.0, &motion).unwrap();
    assert!((s.observe(&start).transmission_force - 30.5).abs() < 1e-13);
    let (mut plain, mut erring) = (start, start);
    let errors = NutErrors::new(1e-3, 0.2, 1e-3).unwrap();
    for i in 1..=1000 {
        let _ = s.step(&mut plain, torque, |_| 40.0);
        let _ = s.step_through(&mut erring, torque, &errors, |_| 40.0);
        let speed = 0.2 - 1e-4 * f64::from(i);
        assert!((s.observe(&plain).speed - speed).abs() < 1e-14);
        assert_eq!(s.observe(&plain), s.observe(&erring));
    }
}

#[test]
fn bad_numbers_are_refused_or_reported() {
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        for (made, field) in [
            (RigidDrive::new(bad, 1.0), "inertia"),
            (RigidDrive::new(1.0, bad), "travel_per_radian"),
        ] {
            let text = made.unwrap_err().to_string();
            assert!(text.starts_with(&format!("{field} = {bad}")), "{text}");
        }
        let drive = RigidDrive::new(1.0, 1.0).unwrap();
        assert_eq!([drive.inertia(), drive.travel_per_radian()], [1.0, 1.0]);
        assert!(RigidStepper::new(&drive, bad).is_err());
    }
    let s = stepper(1e-3);
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(s.settled(bad, &Settled::default()).is_err());
        let mut state = s.settled(0.0, &Settled::default()).unwrap();
        assert!(!s.step(&mut state, 0.0, |_| bad).load.converged);
        let mut state = s.settled(0.0, &Settled::default()).unwrap();
        assert!(!s.step(&mut state, bad, |_| 0.0).load.converged);
    }
}

#[test]
fn a_force_that_goes_linearly_is_of_second_order() {
    // T = T₁ sin ωt against a viscous load d ẏ, from rest:
    // v = F/(m ω) (e^(−at) + b sin ωt − cos ωt) / (1 + b²), a = d/m, b = a/ω.
    let (drag, omega, force) = (190.0, 40.0, 150.0);
    let off = [1e-3, 5e-4].map(|h| {
        let s = stepper(h).with_course(ForceCourse::Linear);
        let mut state = s.settled(0.0, &Settled::default()).unwrap();
        let mut off = 0.0_f64;
        for i in 1..=(1.0 / h) as u32 {
            let t = h * f64::from(i);
            let torque = 0.002 * force * (omega * t).sin();
            assert!(
                s.step(&mut state, torque, |table| drag * table.speed)
                    .load
                    .converged
            );
            let (a, b) = (drag / 95.0, drag / 95.0 / omega);
            let (sin, cos) = (omega * t).sin_cos();
            let exact = force / (95.0 * omega) * ((-a * t).exp() + b * sin - cos) / (1.0 + b * b);
            off = off.max((s.observe(&state).speed - exact).abs());
        }
        off
    });
    println!("linear course: {off:?}");
    // 1.1e-5 and 2.6e-6 m/s of 0.079.
    assert!(off[0] < 3e-5, "{off:?}");
    assert!((off[0] / off[1] - 4.0).abs() < 0.1, "{off:?}");
}
