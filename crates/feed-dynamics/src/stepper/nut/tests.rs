//! The contact's law, found for the end of a step.

use super::{Contact, NutErrors};
use crate::{DriveError, FeedDrive, Settled, TimeStepper};
use proptest::prelude::*;

/// What the documented law asks of the force at given δ and δ̇, least and most:
/// where δ is within `slack` of a flank's edge it may be anything between.
fn law(c: &Contact, delta: f64, rate: f64, slack: f64) -> [f64; 2] {
    let beyond = |e: f64| c.stiffness * e + c.damping * rate;
    let at = |delta: f64| {
        if delta > c.half_gap {
            beyond(delta - c.half_gap).max(0.0)
        } else if delta < -c.half_gap {
            beyond(delta + c.half_gap).min(0.0)
        } else {
            0.0
        }
    };
    let values = [at(delta - slack), at(delta), at(delta + slack)];
    let least = values.into_iter().fold(f64::INFINITY, f64::min);
    [least, values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

proptest! {
    #[test]
    fn the_force_obeys_its_law_on_the_end_values(
        stiffness in 6.0..9.0_f64,
        beta in 0.0..1e-3_f64,
        step in 1e-6..2e-4_f64,
        mass in 1.0..1000.0_f64,
        half_gap in 1e-9..1e-3_f64,
        part in -3.0..3.0_f64,
        rate in -0.5..0.5_f64,
    ) {
        let k = 10_f64.powf(stiffness);
        let contact = Contact {
            stiffness: k,
            damping: beta * k,
            travel: step * step / (6.0 * mass),
            speed: 0.5 * step / mass,
            half_gap,
        };
        let free = part * half_gap;
        let force = contact.force(free, rate);
        // What is left of compression and rate.
        let (delta, rate) = (free - contact.travel * force, rate - contact.speed * force);
        let slack = 1e-13 * (free.abs() + contact.travel * force.abs());
        let [least, most] = law(&contact, delta, rate, slack);
        let rounding = 1e-9 * force.abs() + 2.0 * k * slack;
        prop_assert!(
            (least - rounding..=most + rounding).contains(&force),
            "{force} not in {least}..{most}"
        );
        // It never pulls: a force only from the flank that touches.
        prop_assert!(force == 0.0 || (force > 0.0) == (free > 0.0));
        prop_assert!(force == 0.0 || free.abs() > half_gap);
    }

    #[test]
    fn without_a_gap_it_is_spring_and_damper_of_either_sign(
        delta in -1e-5..1e-5_f64, rate in -0.1..0.1_f64,
    ) {
        let contact = Contact {
            stiffness: 7.45e7,
            damping: 745.0,
            travel: 3e-12,
            speed: 1e-7,
            half_gap: 0.0,
        };
        let force = contact.force(delta, rate);
        let asked = 7.45e7 * (delta - 3e-12 * force) + 745.0 * (rate - 1e-7 * force);
        prop_assert!((force - asked).abs() <= 1e-13 * (745.0 + 74.5));
    }
}

#[test]
fn the_nut_is_strained_by_what_is_beyond_half_the_gap() {
    let errors = NutErrors::new(1.0, 7.0, 4.0).unwrap();
    let strains = [5.0, 1.5, 1.0, -1.0, -3.0, -5.0].map(|stretch| errors.strain(stretch));
    assert_eq!(strains, [4.0, 0.5, 0.0, 0.0, 0.0, -2.0]);
    assert!(errors.strain(f64::NAN).is_nan());
    // Without any it is the stretch, to the bit.
    assert_eq!(
        [0.3, -0.0].map(|d| NutErrors::default().strain(d)),
        [0.3, 0.0]
    );
}

#[test]
fn numbers_that_are_none_are_refused_or_handed_on() {
    let cases = [
        (f64::NAN, 0.0, 0.0, "offset"),
        (f64::INFINITY, 0.0, 0.0, "offset"),
        (0.0, f64::NAN, 0.0, "offset_rate"),
        (0.0, f64::NEG_INFINITY, 0.0, "offset_rate"),
        (0.0, 0.0, f64::NAN, "gap"),
        (0.0, 0.0, f64::INFINITY, "gap"),
        (0.0, 0.0, -1e-9, "gap"),
    ];
    for (offset, rate, gap, field) in cases {
        match NutErrors::new(offset, rate, gap).unwrap_err() {
            DriveError::Parameter { name, .. } => assert_eq!(name, field),
            other => panic!("{other}"),
        }
    }
    let valid = NutErrors::new(-1e-6, 2e-3, 4e-6).unwrap();
    assert_eq!(
        [valid.offset(), valid.offset_rate(), valid.gap()],
        [-1e-6, 2e-3, 4e-6]
    );
    assert_eq!(NutErrors::new(0.0, 0.0, 0.0).unwrap(), NutErrors::default());
    // A state that is no number gives no number, gap or not.
    for half_gap in [0.0, 1e-6] {
        let contact = Contact {
            stiffness: 1e7,
            damping: 10.0,
            travel: 1e-9,
            speed: 1e-6,
            half_gap,
        };
        assert!(contact.force(f64::NAN, 0.0).is_nan());
        assert!(contact.force(1e-3, f64::NAN).is_nan());
    }
}

/// Steps under torques at random through a gap: at the end of each the nut force
/// obeys its law on the compression and its rate there, which `compression`
/// reads from the state. Gives how often it was in the gap and on each flank.
pub(crate) fn obeys_its_law<S: TimeStepper>(
    drive: &FeedDrive,
    stepper: &S,
    torques: &[f64],
    gap: f64,
    compression: impl Fn(&S::State) -> [f64; 2],
) -> [usize; 3] {
    let p = drive.parameters();
    let contact = Contact {
        stiffness: p.nut_stiffness,
        damping: p.nut_stiffness * p.stiffness_damping,
        travel: f64::NAN,
        speed: f64::NAN,
        half_gap: 0.5 * gap,
    };
    let errors = NutErrors::new(3e-6, 2e-4, gap).unwrap();
    let mut state = stepper.settled(0.68, &Settled::default()).unwrap();
    let mut places = [0; 3];
    for torque in torques {
        let report = stepper.step_through(&mut state, *torque, &errors, |m| 2000.0 * m.speed);
        assert!(report.load.converged && report.on_screw);
        let [delta, rate] = compression(&state);
        let (delta, rate) = (delta + 3e-6, rate + 2e-4);
        let force = stepper.observe(&state).transmission_force;
        // Rounding of r θ − y, of angles and travels up to 10 rad and 20 mm.
        let [least, most] = law(&contact, delta, rate, 1e-16);
        let rounding = contact.damping * 1e-12 + contact.stiffness * 2e-16 + 1e-9 * force.abs();
        assert!(
            (least - rounding..=most + rounding).contains(&force),
            "{force} not in {least}..{most} at {delta:e}"
        );
        // It pushes from the flank that touches, or not at all.
        assert!(force * delta >= 0.0, "{force} at {delta:e}");
        places[if force == 0.0 {
            0
        } else {
            1 + usize::from(force > 0.0)
        }] += 1;
    }
    places
}

/// Torques of changing sign, each for some steps: 4000 of them.
pub(crate) fn torques(seed: u32) -> Vec<f64> {
    let part = |i: u32| (f64::from(i + 1 + 977 * seed) * 0.618_033_988_7).fract();
    (0..4000)
        .map(|i| 30.0 * (2.0 * part(i / 40) - 1.0))
        .collect()
}
