//! Dead-time compensation against the inverter that has the dead time.

use crate::axis::{self, DC_VOLTAGE, PERIOD, motor};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm};
use foc_pmsm::{DeadTimeCompensation, Dq, FocError, Phases, Servo, ServoGains, ServoState};
use proptest::prelude::*;

fn legs(d: Duties) -> [f64; 3] {
    [d.a(), d.b(), d.c()]
}

proptest! {
    /// What arrives is what was asked for, wherever the leg can still give it and the
    /// current has left the linear zone; the voltage form is the same.
    #[test]
    fn what_is_asked_for_arrives(
        share in 0.0..0.1, zone in 0.0..2.0,
        asked in prop::array::uniform3(0.1..0.9), currents in prop::array::uniform3(-20.0..20.0),
    ) {
        let inverter = Inverter::new(DC_VOLTAGE, PERIOD, share * PERIOD).unwrap();
        let law = DeadTimeCompensation::new(share * PERIOD, PERIOD, zone).unwrap();
        let duties = Duties::new(asked[0], asked[1], asked[2]).unwrap();
        let [a, b, c] = currents;
        let i = Phases { a, b, c };
        let commanded = law.duties(duties, i);
        let arrived = legs(inverter.effective_duties(commanded, i));
        for k in 0..3 {
            let reach = (currents[k].abs() / zone).min(1.0);
            let left = share * (1.0 - reach);
            prop_assert!((arrived[k] - asked[k]).abs() < left + 1e-15, "{:?}", arrived);
        }
        let added = law.voltage(DC_VOLTAGE, i);
        let by_duties = commanded.voltage(DC_VOLTAGE);
        let before = duties.voltage(DC_VOLTAGE);
        let apart = (by_duties.alpha - before.alpha - added.alpha)
            .hypot(by_duties.beta - before.beta - added.beta);
        prop_assert!(apart < 1e-12 * DC_VOLTAGE, "{}", apart);
    }
}

/// Largest distance, A, between the q step of 5 A at `speed` with and without dead time.
fn largest_error(speed: f64, zone: Option<f64>) -> f64 {
    let (ideal, dead) = (step(speed, 0.0, None), step(speed, 2e-6, zone));
    let apart = ideal
        .iter()
        .zip(&dead)
        .map(|(&a, &b)| (a - b).dot(a - b).sqrt());
    apart.fold(0.0, f64::max)
}

fn step(speed: f64, dead_time: f64, zone: Option<f64>) -> Vec<Dq> {
    let m = motor();
    let gains = ServoGains {
        position: 0.0,
        speed_p: 0.0,
        speed_i: 0.0,
        ..axis::gains()
    };
    let servo = Servo::new(gains, axis::limits(), PERIOD).unwrap();
    let modulator = Svpwm::new(DC_VOLTAGE, Overmodulation::default()).unwrap();
    let inverter = Inverter::new(DC_VOLTAGE, PERIOD, dead_time).unwrap();
    let law = zone.map(|zone| DeadTimeCompensation::new(dead_time, PERIOD, zone).unwrap());
    let mut state = ServoState::settled(0.0, m.steady_voltage(Dq::ZERO, speed));
    let mut i = Dq::ZERO;
    let mut rotor = Rotor {
        electrical_angle: 0.0,
        speed,
    };
    (0..200)
        .map(|_| {
            let (u, _, _) = servo.current_loop(&mut state, Dq { d: 0.0, q: 5.0 } - i, Dq::ZERO);
            let middle = rotor.angle_after(&m, PERIOD / 2.0);
            let asked = modulator.duties(u.inverse_park(middle));
            let phases = i.inverse_park(rotor.electrical_angle).inverse_clarke();
            let duties = law.map_or(asked, |law| law.duties(asked, phases));
            i = inverter.switched_step(&m, i, rotor, duties);
            rotor.electrical_angle = rotor.angle_after(&m, PERIOD);
            i
        })
        .collect()
}

/// Of the currents' error of 2 µs of dead time (of 100 µs), what remains: next to nothing
/// by the exact sign of the sampled current, a fifth by a linear zone of 0.5 A, which does
/// less than it should there.
#[test]
fn little_remains_of_the_error_of_a_step() {
    for (speed, errors) in [
        (62.8, [2.3010, 4.9e-4, 0.5988]),
        (100.0, [2.9290, 6.5e-4, 0.4146]),
    ] {
        for (zone, expected) in [None, Some(0.0), Some(0.5)].into_iter().zip(errors) {
            let error = largest_error(speed, zone);
            assert!((error - expected).abs() < 1e-4, "{speed} {zone:?}: {error}");
        }
    }
}

#[test]
fn what_is_refused_and_every_number() {
    for (t, period, zone, name) in [
        (5e-5, 1e-4, 0.1, "dead_time"),
        (-1e-9, 1e-4, 0.1, "dead_time"),
        (f64::NAN, 1e-4, 0.1, "dead_time"),
        (1e-6, 0.0, 0.1, "period"),
        (1e-6, 1e-4, -0.1, "zone"),
        (1e-6, 1e-4, f64::NAN, "zone"),
    ] {
        let error = DeadTimeCompensation::new(t, period, zone).unwrap_err();
        assert!(
            matches!(error, FocError::OutOfRange { field, .. } if field == name),
            "{error}"
        );
    }
    let half = Duties::new(0.5, 0.5, 0.0).unwrap();
    for zone in [0.0, 1e-310, 0.3, 1e300] {
        let law = DeadTimeCompensation::new(2e-6, 1e-4, zone).unwrap();
        for i in [f64::MAX, f64::MIN, f64::INFINITY, 5e-324, -0.0, 0.0, 1.0] {
            let d = law.duties(half, Phases { a: i, b: -i, c: i });
            assert!((d.a() - 0.5).abs() < 0.02 + 1e-15 && (d.b() + d.a() - 1.0).abs() < 1e-15);
            assert_eq!(d.c(), 0.0);
        }
        let lost = law.duties(
            half,
            Phases {
                a: f64::NAN,
                b: 0.0,
                c: 0.0,
            },
        );
        assert!(lost.a().is_nan() && lost.b() == 0.5);
    }
}
