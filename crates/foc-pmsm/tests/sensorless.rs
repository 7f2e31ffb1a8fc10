//! The flux observer and the start without a sensor.

use crate::axis::{self, PERIOD, drawn_motor, motor};
use foc_pmsm::sensorless::{
    CurrentStart, CurrentStartParameters, CurrentStartState, FluxObserver, FluxObserverParameters,
};
use foc_pmsm::{AlphaBeta, Dq, FocError, Pmsm, Servo, ServoState};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn dq(d: f64, q: f64) -> Dq {
    Dq { d, q }
}

/// The angle without whole turns.
fn near(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// A motor turned at a constant electrical speed with constant currents; the observer
/// begins with errors of the angle and of the speed. The error of the angle over time.
fn errors(m: &Pmsm, i: Dq, omega: f64, first: (f64, f64), law: (f64, f64)) -> Vec<f64> {
    let (bandwidth, period) = law;
    let parameters = FluxObserverParameters::of(m, bandwidth, period);
    let observer = FluxObserver::new(*m, parameters).unwrap();
    let speed = omega / m.electrical_speed(1.0);
    let mut state = observer.begin(first.0, omega + first.1);
    state.flux = m.flux(i);
    let u = m.steady_voltage(i, speed);
    let mut angle = 0.0;
    (0..20_000)
        .map(|_| {
            let estimate = observer.estimate(&state, i.inverse_park(angle));
            // The mean of the period.
            let turn = omega * period;
            let shrink = (0.5 * turn).sin() / (0.5 * turn);
            let held = (u * shrink).inverse_park(angle + 0.5 * turn);
            observer.advance(&mut state, &estimate, held);
            let error = near(estimate.angle - angle);
            angle = near(angle + turn);
            error
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// From up to 30° of error of the angle and a tenth of the speed it settles on the
    /// rotor, for any motor at a speed at which the voltage is more than that of the
    /// resistance.
    #[test]
    fn it_finds_the_rotor(
        m in drawn_motor(), angle in -0.5..0.5, off in -0.1..0.1, d in -0.3..0.3, q in -0.3..0.3,
        backwards in any::<bool>(),
    ) {
        let p = *m.parameters();
        let own = p.resistance / p.inductance_d.min(p.inductance_q);
        let omega = if backwards { -3.0 * own } else { 3.0 * own };
        let most = p.flux_linkage / p.inductance_d.max(p.inductance_q);
        let period = 0.02 / omega.abs();
        let law = (0.3 * omega.abs(), period);
        let i = dq(d * most, q * most);
        let all = errors(&m, i, omega, (angle, off * omega), law);
        let last = all.last().unwrap().abs();
        // 2.6e-6 rad measured, of second order in the angle of a period, 0.02 rad.
        prop_assert!(last < 2e-5, "{}", last);
    }
}

/// A motor with a load of 2 N·m; only its currents are measured.
struct Drive {
    motor: Pmsm,
    current: Dq,
    /// Electrical, rad.
    angle: f64,
    /// Mechanical, rad/s.
    speed: f64,
}

impl Drive {
    fn currents(&self) -> AlphaBeta {
        self.current.inverse_park(self.angle)
    }

    /// A period with a voltage that stands in the stator.
    fn advance(&mut self, u: AlphaBeta) {
        let pairs = self.motor.electrical_speed(1.0);
        let middle = self.angle + 0.5 * pairs * self.speed * PERIOD;
        let next = self
            .motor
            .step(self.current, u.park(middle), self.speed, PERIOD);
        let torque = self.motor.torque((self.current + next) * 0.5);
        let load = if self.speed.abs() > 0.1 {
            2.0 * self.speed.signum()
        } else {
            20.0 * self.speed
        };
        let before = self.speed;
        self.speed += PERIOD * (torque - load - 0.02 * self.speed) / 0.01;
        self.angle += 0.5 * pairs * (before + self.speed) * PERIOD;
        self.current = next;
    }
}

/// From standstill at an unknown angle: aligned, turned up to 40 rad/s by the current, the
/// observer started half-way, then speed control on what it estimates, to 100 rad/s.
#[test]
fn a_drive_starts_without_sensor() {
    for first in [0.4, -1.3, 2.0] {
        let m = motor();
        let mut drive = Drive {
            motor: m,
            current: Dq::ZERO,
            angle: first,
            speed: 0.0,
        };
        let start = CurrentStart::new(CurrentStartParameters {
            current: 8.0,
            alignment: 0.5,
            acceleration: 300.0,
            speed: 160.0,
            period: PERIOD,
        })
        .unwrap();
        let law = FluxObserverParameters::of(&m, 100.0, PERIOD);
        let observer = FluxObserver::new(m, law).unwrap();
        let servo = Servo::new(axis::gains(), axis::limits(), PERIOD).unwrap();
        let (mut state, mut loops) = (CurrentStartState::default(), ServoState::default());
        let mut estimated = observer.begin(0.0, 0.0);
        let (mut handed, mut worst) = (None, 0.0_f64);
        for k in 0..30_000 {
            let now = observer.estimate(&estimated, drive.currents());
            let (angle, omega, reference) = if start.is_over(&state) {
                if handed.is_none() {
                    // The same current and voltage, in the other frame.
                    let from = start.reference_at(&state, now.angle);
                    let u = dq(loops.d.integral, loops.q.integral);
                    let u = u.inverse_park(state.angle).park(now.angle);
                    loops = ServoState::settled(from.q, u);
                    handed = Some(k);
                }
                let error = 100.0 - now.speed / m.electrical_speed(1.0);
                let (iq, _) = servo.speed_loop(&mut loops, error, 0.0);
                (now.angle, now.frame_speed, dq(0.0, iq))
            } else {
                (state.angle, state.speed, start.reference(&state))
            };
            let i = drive.currents().park(angle);
            let (u, _, _) = servo.current_loop(&mut loops, reference - i, Dq::ZERO);
            let voltage = u.inverse_park(angle + 0.5 * omega * PERIOD);
            observer.advance(&mut estimated, &now, voltage);
            if !start.is_over(&state) {
                start.advance(&mut state);
                if state.speed < 80.0 {
                    // From here on: a lag of the rotor is a first error of the angle.
                    estimated = observer.begin(state.angle, state.speed);
                    estimated.flux = m.flux(start.reference(&state));
                }
            }
            drive.advance(voltage);
            if handed.is_some_and(|at| k > at + 5_000) {
                worst = worst.max(near(estimated.angle - drive.angle).abs());
            }
        }
        // 0.030 rad measured half a second after the hand-over, while the speed settles.
        assert!(worst < 0.035, "{first}: {worst}");
        assert!(
            (drive.speed - 100.0).abs() < 1e-3,
            "{first}: {}",
            drive.speed
        );
        assert!(drive.current.d.abs() < 1e-3, "{:?}", drive.current);
    }
}

#[test]
fn the_start_ramps() {
    let parameters = CurrentStartParameters {
        current: 4.0_f64,
        alignment: 0.1,
        acceleration: 500.0,
        speed: -50.0,
        period: 1e-3,
    };
    let start = CurrentStart::new(parameters).unwrap();
    let mut state = CurrentStartState::default();
    assert_eq!(start.reference(&state), Dq::ZERO);
    for _ in 0..50 {
        start.advance(&mut state);
    }
    assert!((start.reference(&state).d - 2.0).abs() < 1e-9 && state.angle == 0.0);
    for _ in 0..101 {
        start.advance(&mut state);
    }
    assert_eq!(start.reference(&state), dq(4.0, 0.0));
    assert!(!start.is_over(&state) && (state.speed + 25.0).abs() < 1.0);
    let seen = start.reference_at(&state, state.angle + 0.5);
    assert!((seen.d - 4.0 * 0.5_f64.cos()).abs() < 1e-12);
    assert!((seen.q + 4.0 * 0.5_f64.sin()).abs() < 1e-12);
    for _ in 0..50 {
        start.advance(&mut state);
    }
    assert!(start.is_over(&state) && state.speed == -50.0);
    let before = state.angle;
    start.advance(&mut state);
    assert!((near(state.angle - before) + 0.05).abs() < 1e-12);
    for (bad, name) in [
        (
            CurrentStartParameters {
                current: 0.0,
                ..parameters
            },
            "current",
        ),
        (
            CurrentStartParameters {
                alignment: -1.0,
                ..parameters
            },
            "alignment",
        ),
        (
            CurrentStartParameters {
                acceleration: f64::NAN,
                ..parameters
            },
            "acceleration",
        ),
        (
            CurrentStartParameters {
                speed: 0.0,
                ..parameters
            },
            "speed",
        ),
        (
            CurrentStartParameters {
                period: f64::INFINITY,
                ..parameters
            },
            "period",
        ),
    ] {
        let error = CurrentStart::new(bad).unwrap_err();
        assert!(
            matches!(error, FocError::OutOfRange { field, .. } if field == name),
            "{error}"
        );
    }
}

/// A sample that is no number costs its own period only.
#[test]
fn no_number_stays() {
    let m = motor();
    let parameters = FluxObserverParameters::of(&m, 100.0, PERIOD);
    let observer = FluxObserver::new(m, parameters).unwrap();
    let before = observer.begin(7.0, 300.0);
    assert!((before.angle - near(7.0)).abs() < 1e-12);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut state = before;
        let lost = AlphaBeta {
            alpha: bad,
            beta: 0.0,
        };
        let sound = AlphaBeta {
            alpha: 1.0,
            beta: 2.0,
        };
        let estimate = observer.estimate(&state, lost);
        observer.advance(&mut state, &estimate, sound);
        assert_eq!(state, before);
        let estimate = observer.estimate(&state, sound);
        observer.advance(&mut state, &estimate, lost);
        assert_eq!(state, before);
        observer.advance(&mut state, &estimate, sound);
        assert!(state != before && state.flux.d.is_finite());
    }
    for (bad, name) in [
        (
            FluxObserverParameters {
                bandwidth: 0.0,
                ..parameters
            },
            "bandwidth",
        ),
        (
            FluxObserverParameters {
                damping: -1.0,
                ..parameters
            },
            "damping",
        ),
        (
            FluxObserverParameters {
                damping_ratio: f64::NAN,
                ..parameters
            },
            "damping_ratio",
        ),
        (
            FluxObserverParameters {
                period: 0.0,
                ..parameters
            },
            "period",
        ),
    ] {
        let error = FluxObserver::new(m, bad).unwrap_err();
        assert!(
            matches!(error, FocError::OutOfRange { field, .. } if field == name),
            "{error}"
        );
    }
    // Damping as motulator's: R (L_d + L_q)/(4 L_d L_q).
    assert!(
        (parameters.damping - 0.25 * 0.75 * (4.11e-3 + 13.2e-3) / (4.11e-3 * 13.2e-3)).abs()
            < 1e-11
    );
}
