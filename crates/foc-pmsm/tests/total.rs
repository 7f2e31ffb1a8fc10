//! Every public function takes every number: none panics, none hangs.

use crate::axis::{self, any_number};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm, sector};
use foc_pmsm::{
    AlphaBeta, AntiWindup, Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState,
    FocError, Measurement, MotorParameters, OperatingPoint, Phases, Pi, PiParameters, PiState,
    Pmsm, Servo, ServoCorrection, ServoGains, ServoInput, ServoLimits, ServoReference, ServoState,
};
use proptest::prelude::*;

type Six = [f64; 6];

fn six() -> impl Strategy<Value = Six> {
    prop::array::uniform6(any_number())
}

/// What validation lets through: any normal positive number.
fn accepted() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => prop::num::f64::POSITIVE | prop::num::f64::NORMAL,
        1 => 1e-3..1e3,
        1 => prop::sample::select(vec![f64::MIN_POSITIVE, f64::MAX]),
    ]
}

fn motor() -> impl Strategy<Value = Pmsm> {
    (any::<u32>(), prop::array::uniform4(accepted())).prop_map(|(pole_pairs, [r, d, q, psi])| {
        Pmsm::new(MotorParameters {
            pole_pairs: pole_pairs.max(1),
            resistance: r,
            inductance_d: d,
            inductance_q: q,
            flux_linkage: psi,
        })
        .unwrap()
    })
}

fn inverter() -> impl Strategy<Value = Inverter> {
    (accepted(), accepted(), 0.0..0.49).prop_map(|(voltage, period, share)| {
        Inverter::new(voltage, period, share * period).unwrap()
    })
}

fn in_range_or_nan(d: Duties) -> bool {
    [d.a(), d.b(), d.c()]
        .iter()
        .all(|x| x.is_nan() || (0.0..=1.0).contains(x))
}

proptest! {
    #[test]
    fn frames([a, b, c, d, q, angle] in six()) {
        let phases = Phases { a, b, c };
        let _ = (phases.zero_sequence(), phases.clarke().inverse_clarke());
        let _ = AlphaBeta { alpha: a, beta: b }.park(angle);
        let (i, u) = (Dq { d, q }, Dq { d: b, q: c });
        let _ = (i.inverse_park(angle), i.dot(u), i + u, i - u, i * a, -i);
    }

    #[test]
    fn motors(m in motor(), [a, b, c, d, e, f] in six(), pole_pairs in any::<u32>()) {
        let p = MotorParameters {
            pole_pairs, resistance: a, inductance_d: b, inductance_q: c, flux_linkage: d,
        };
        let _ = (Pmsm::new(p), p.from_torque_constant(e), m.q_current(f));
        let (i, u) = (Dq { d: a, q: b }, Dq { d: c, q: d });
        let _ = (m.torque(i), m.copper_loss(i), m.magnetic_energy(i), m.electrical_speed(e));
        let _ = (m.derivative(i, u, e), m.step(i, u, e, f), m.step_exact(i, u, e, f));
    }

    #[test]
    fn controllers([a, b, c, d, e, f] in six(), [g, h, k, l, m, n] in six()) {
        let mut state = PiState { integral: e };
        let p = PiParameters { kp: a.abs(), ki: b.abs(), limit: c.abs(), period: d.abs() };
        if let Ok(pi) = Pi::new(p) {
            let tracking = AntiWindup::BackCalculation { tracking_time: g };
            let pi = pi.with_anti_windup(tracking).unwrap_or(pi);
            let _ = pi.update(&mut state, f, h);
            let _ = pi.update_with_feed_forward(&mut state, k, l, m);
        }
        let gains = ServoGains {
            position: a.abs(), speed_p: b.abs(), speed_i: c.abs(),
            d_p: d.abs(), d_i: e.abs(), q_p: f.abs(), q_i: g.abs(),
        };
        let limits = ServoLimits { current: h.abs(), voltage: k.abs() };
        if let Ok(servo) = Servo::new(gains, limits, l.abs()) {
            let mut state = ServoState::settled(m, Dq { d: n, q: a });
            let now = Measurement { position: b, motor_speed: c, current: Dq { d: e, q: f } };
            let reference = ServoReference { position: g, motor_speed: h };
            let correction = ServoCorrection { position_offset: k, speed: l, iq: m };
            let _ = servo.cycle(&mut state, &ServoInput { measurement: now, reference, correction });
            let _ = servo.current_loop(&mut state, Dq { d: a, q: b }, Dq { d: c, q: d });
            let point = OperatingPoint { id_ref: n, voltage_limit: k };
            let _ = servo.cycle_with(&mut state, &ServoInput { measurement: now, reference, correction }, &point);
            let at = OperatingPoint::at_dc_voltage(l);
            let (i, u) = (Dq { d: a, q: b }, Dq { d: c, q: d });
            let _ = servo.current_loop_within(&mut state, i, u, at.voltage_limit);
            let _ = servo.speed_loop_within(&mut state, e, f, servo.q_current_limit(g));
        }
    }

    /// The d current reference keeps its range, whatever it is fed with.
    #[test]
    fn field_weakening([a, b, c, d, e, f] in six(), share in 0.01..0.99) {
        let p = FieldWeakeningParameters {
            voltage_share: share, ki: a.abs(), current: b.abs(), period: c.abs(),
        };
        if let Ok(law) = FieldWeakening::new(p) {
            let mut state = FieldWeakeningState { id_ref: d };
            let id = law.update(&mut state, Dq { d: e, q: f }, a);
            prop_assert!(id.is_nan() || (-p.current..=0.0).contains(&id));
        }
    }

    /// Duties stay duties, and are numbers where the phase voltages are.
    #[test]
    fn modulators(voltage in accepted(), [a, b, c, ..] in six(), nearest in any::<bool>()) {
        let _ = (Svpwm::new(a, Overmodulation::default()), Duties::new(a, b, c));
        let mode = if nearest {
            Overmodulation::MinimumMagnitudeError
        } else {
            Overmodulation::MinimumPhaseError
        };
        let modulator = Svpwm::new(voltage, mode).unwrap();
        let u = AlphaBeta { alpha: a, beta: b };
        let _ = (modulator.linear_limit(), modulator.six_step_limit());
        prop_assert!((1..=6).contains(&sector(u)));
        let phases = u.inverse_clarke();
        let finite = [phases.a, phases.b, phases.c].iter().all(|x| x.is_finite());
        for duties in [modulator.duties(u), modulator.six_step(u)] {
            prop_assert!(in_range_or_nan(duties));
            prop_assert!(!finite || duties == duties, "{:?}", duties);
            let _ = (modulator.voltage(duties), duties.voltage(c));
        }
    }

    /// A period lasts a period, and its integration ends.
    #[test]
    fn inverters(
        inverter in inverter(), m in motor(), duties in prop::array::uniform3(0.0..=1.0),
        [a, b, c, d, e, f] in six(),
    ) {
        let _ = Inverter::new(a, b, c);
        let currents = Phases { a, b, c };
        let duties = Duties::new(duties[0], duties[1], duties[2]).unwrap();
        let _ = (inverter.dead_time_voltage(currents), inverter.averaged(duties, currents));
        prop_assert!(in_range_or_nan(inverter.effective_duties(duties, currents)));
        let segments = inverter.switched(duties, currents);
        prop_assert!(segments.iter().all(|s| s.duration >= 0.0));
        let share: f64 = segments.iter().map(|s| s.duration / inverter.period()).sum();
        // 7 quotients and 6 sums of at most 1.
        prop_assert!((share - 1.0).abs() <= 8.0 * f64::EPSILON, "{}", share);
        let rotor = Rotor { electrical_angle: d, speed: e };
        let i0 = Dq { d: f, q: a };
        let _ = rotor.angle_after(&m, b);
        let _ = inverter.averaged_step(&m, i0, rotor, duties);
        let _ = inverter.switched_step(&m, i0, rotor, duties);
    }
}

/// A leg cannot be on for more than its period, nor for less than none of it.
#[test]
fn duties_outside_their_range_are_refused() {
    for bad in [f64::INFINITY, 1.0 + f64::EPSILON, -1e-9, f64::NAN] {
        for (place, name) in ["duty a", "duty b", "duty c"].into_iter().enumerate() {
            let mut legs = [0.5; 3];
            legs[place] = bad;
            let error = Duties::new(legs[0], legs[1], legs[2]).unwrap_err();
            let FocError::OutOfRange { field, value, .. } = error else {
                panic!("{error}");
            };
            assert_eq!((field, value.to_bits()), (name, bad.to_bits()));
        }
    }
    let ends = Duties::new(0.0, 1.0, -0.0).unwrap();
    assert_eq!((ends.a(), ends.b(), ends.c()), (0.0, 1.0, 0.0));
}

/// The shortest period that validation accepts is cut into as many pieces as
/// any other.
#[test]
fn the_shortest_period_ends() {
    assert!(Inverter::new(540.0, 5e-324, 0.0).is_err());
    let shortest = Inverter::new(540.0, f64::MIN_POSITIVE, 0.0).unwrap();
    let duties = Duties::new(1.0, 0.0, 0.5).unwrap();
    let i0 = Dq { d: 1.0, q: 2.0 };
    let end = shortest.switched_step(&axis::motor(), i0, Rotor::default(), duties);
    assert_eq!(end, i0);
}

/// A demand whose phases are finite but whose line voltage overflows still
/// turns the modulator to its angle.
#[test]
fn the_largest_demand_keeps_its_angle() {
    let modulator = Svpwm::new(540.0, Overmodulation::MinimumPhaseError).unwrap();
    let u = AlphaBeta {
        alpha: 1.7e308,
        beta: 0.0,
    };
    let d = modulator.duties(u);
    assert_eq!((d.a(), d.b(), d.c()), (1.0, 0.0, 0.0));
}
