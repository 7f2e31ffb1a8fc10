//! Resonance, antiresonance and receptance of the elastic drive against an
//! eigenvalue problem and a system of equations solved by nalgebra.

use feed_dynamics::{
    BeltStrands, DriveError, ElasticDrive, ElasticDriveParameters, ElasticStepper, Mounting,
    ScrewShaft, Settled, Side, Stiffness, TimeStepper,
};
use nalgebra::{Complex, Matrix2, SymmetricEigen, Vector2};
use proptest::prelude::*;
use std::sync::Arc;

use crate::relative;

/// J, m, r, k and β.
type Numbers = [f64; 5];

fn drive([motor, load, ratio, stiffness, beta]: Numbers) -> ElasticDrive {
    made(motor, load, ratio, Arc::new(stiffness), beta).unwrap()
}

fn made(
    motor_inertia: f64,
    load_inertia: f64,
    travel_per_radian: f64,
    stiffness: Arc<dyn Stiffness>,
    stiffness_damping: f64,
) -> Result<ElasticDrive, DriveError> {
    ElasticDrive::new(ElasticDriveParameters {
        motor_inertia,
        load_inertia,
        travel_per_radian,
        stiffness,
        stiffness_damping,
    })
}

/// Belt carriage, robot joint, rack.
const DRIVES: [Numbers; 3] = [
    [2e-4, 12.0, 0.02, 1e6, 0.0],
    [1e-4, 5.0, 0.01, 5e4, 0.0],
    [0.03, 900.0, 0.004, 8e7, 0.0],
];

/// K on the motor's angle and the load's displacement.
fn stiffness_matrix([_, _, r, k, _]: Numbers) -> Matrix2<f64> {
    Matrix2::new(r * r * k, -r * k, -r * k, k)
}

#[test]
fn resonance_and_antiresonance_are_eigenvalues() {
    for numbers in DRIVES {
        let [motor, load, ..] = numbers;
        let eigenvalues = |motor: f64| {
            let scale =
                Matrix2::from_diagonal(&Vector2::new(1.0 / motor.sqrt(), 1.0 / load.sqrt()));
            let values = SymmetricEigen::new(scale * stiffness_matrix(numbers) * scale).eigenvalues;
            values.max().sqrt()
        };
        let drive = drive(numbers);
        assert!(relative(drive.resonance(0.3), eigenvalues(motor)) < 1e-14);
        // A motor that does not move, as it has 1e12 times the inertia.
        let held = eigenvalues(motor * 1e12);
        assert!(relative(drive.antiresonance(0.3), held) < 1e-10);
    }
}

/// Where a function that changes its sign between `low` and `high` does so.
fn crossing(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let below = f(low) < 0.0;
    assert_ne!(below, f(high) < 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) < 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn the_motor_has_a_pole_and_a_zero_there() {
    for numbers in DRIVES {
        let drive = drive(numbers);
        let (pole, zero) = (drive.resonance(0.0), drive.antiresonance(0.0));
        // Without damping there is no value on the pole itself.
        let inverse = |w| {
            let response = drive.receptance(0.0, [Side::Motor, Side::Motor], &[w]);
            response.map_or(0.0, |h| 1.0 / h[0].re)
        };
        let found = crossing(0.9 * zero, 0.5 * (zero + pole), |w| 1.0 / inverse(w));
        assert!(relative(found, zero) < 1e-13, "{found} {zero}");
        let found = crossing(0.5 * (zero + pole), 1.1 * pole, inverse);
        assert!(relative(found, pole) < 1e-13, "{found} {pole}");
    }
}

proptest! {
    #[test]
    fn receptance_solves_the_equations(
        motor in 1e-6..1.0_f64, load in 0.1..1e4_f64, ratio in 1e-4..1.0_f64,
        stiffness in 1e3..1e9_f64, beta in 0.0..1e-3_f64, part in 0.01..100.0_f64,
    ) {
        let numbers = [motor, load, ratio, stiffness, beta];
        let drive = drive(numbers);
        let w = part * drive.resonance(0.0);
        let dynamic = stiffness_matrix(numbers).map(|k| Complex::new(k, w * beta * k))
            - Matrix2::from_diagonal(&Vector2::new(motor, load)).map(|m| Complex::from(w * w * m));
        let inverse = dynamic.try_inverse().unwrap();
        // What its determinant loses where the rigid motion is all there is.
        let rounding = 1e-14 * (1.0 + 1.0 / (part * part))
            * (1.0 + stiffness * ratio * ratio / motor / (w * w))
            * (1.0 + stiffness / load / (w * w)) * (1.0 + w * beta).powi(2);
        for (i, input) in [Side::Motor, Side::Load].into_iter().enumerate() {
            for (o, output) in [Side::Motor, Side::Load].into_iter().enumerate() {
                let h = drive.receptance(0.0, [input, output], &[w]).unwrap()[0];
                let off = (h - inverse[(o, i)]).norm() / h.norm();
                prop_assert!(off < rounding, "{off:e} of {rounding:e}");
            }
        }
    }
}

#[test]
fn the_response_follows_the_stiffness_along_the_way() {
    let belt = Arc::new(BeltStrands::new(3e5, 0.15, 1.2).unwrap());
    let drive = made(2e-4, 12.0, 0.02, belt, 1e-5).unwrap();
    for x in [0.0, 0.3, 0.45, 0.9] {
        let there = DRIVES[0];
        let k = 3e5 * (1.0 / (0.15 + x) + 1.0 / (1.05 - x));
        let fixed = self::drive([there[0], there[1], there[2], k, 1e-5]);
        assert!(relative(drive.resonance(x), fixed.resonance(0.0)) < 1e-15);
        let at = |d: &ElasticDrive| {
            d.receptance(x, [Side::Motor, Side::Load], &[1500.0])
                .unwrap()[0]
        };
        assert!((at(&drive) - at(&fixed)).norm() < 1e-13 * at(&fixed).norm());
    }
}

#[test]
fn parameters_and_positions_are_checked_by_name() {
    let good = DRIVES[0];
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        for (i, field) in [
            "motor_inertia",
            "load_inertia",
            "travel_per_radian",
            "stiffness",
            "stiffness_damping",
        ]
        .into_iter()
        .enumerate()
        {
            let mut numbers = good;
            numbers[i] = bad;
            let [motor, load, ratio, stiffness, beta] = numbers;
            let made = made(motor, load, ratio, Arc::new(stiffness), beta);
            if field == "stiffness_damping" && bad == 0.0 {
                assert!(made.is_ok());
                continue;
            }
            let text = made.unwrap_err().to_string();
            assert!(text.starts_with(&format!("{field} = {bad}")), "{text}");
        }
        let step = ElasticStepper::new(&drive(good), bad)
            .unwrap_err()
            .to_string();
        assert!(step.starts_with("step = "), "{step}");
    }
    let stepper = ElasticStepper::new(&drive(good), 1e-4).unwrap();
    for x in [f64::NAN, f64::INFINITY] {
        let text = stepper
            .settled(x, &Settled::default())
            .unwrap_err()
            .to_string();
        assert!(text.starts_with("position = "), "{text}");
        assert!(
            drive(good)
                .receptance(x, [Side::Motor, Side::Load], &[1.0])
                .is_err()
        );
    }
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let error = drive(good).receptance(0.0, [Side::Motor, Side::Load], &[bad]);
        let text = error.unwrap_err().to_string();
        assert!(text.starts_with("angular frequency = "), "{text}");
    }
    let shaft = ScrewShaft::new(2.6e8, 1.5, Mounting::FixedFree).unwrap();
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(drive(good).resonance(x).is_nan() && drive(good).antiresonance(x).is_nan());
        assert!(!x.is_nan() || shaft.at(x).is_nan());
    }
    let fast = Settled {
        speed: f64::NAN,
        ..Settled::default()
    };
    assert!(stepper.settled(0.0, &fast).is_err());
    assert!(stepper.settled(-1e3, &Settled::default()).is_ok());
    let free = drive(good).receptance(0.0, [Side::Motor, Side::Motor], &[0.0]);
    assert!(matches!(free, Err(DriveError::Singular { .. })));
}

#[test]
fn a_stiffness_that_fails_on_the_way_is_reported() {
    /// Valid up to 0.1 m.
    #[derive(Debug)]
    struct Short;
    impl Stiffness for Short {
        fn at(&self, x: f64) -> f64 {
            if x < 0.1 { 1e6 } else { f64::NAN }
        }
    }
    let drive = made(2e-4, 12.0, 0.02, Arc::new(Short), 0.0).unwrap();
    let stepper = ElasticStepper::new(&drive, 1e-3).unwrap();
    assert!(stepper.settled(0.2, &Settled::default()).is_err());
    let motion = Settled {
        speed: 1.0,
        ..Settled::default()
    };
    let mut state = stepper.settled(0.0, &motion).unwrap();
    for i in 0..200 {
        // From 0.1 m on.
        assert_eq!(
            stepper.step(&mut state, 0.0, |_| 0.0).load.converged,
            i < 99,
            "{i}"
        );
    }
}
