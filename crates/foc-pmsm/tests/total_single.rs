//! Every public function takes every `f32`: none panics, none hangs.

use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm, sector};
use foc_pmsm::{
    AlphaBeta, AntiWindup, Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState,
    Measurement, MotorParameters, OperatingPoint, Phases, Pi, PiParameters, PiState, Pmsm, Servo,
    ServoCorrection, ServoGains, ServoInput, ServoLimits, ServoReference, ServoState,
};
use proptest::prelude::*;

fn any_number() -> impl Strategy<Value = f32> {
    let special = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        1e-45,
        -0.0,
        0.0,
        1.0,
    ];
    prop_oneof![
        3 => prop::num::f32::ANY,
        3 => -1e3..1e3f32,
        1 => prop::sample::select(special.to_vec()),
    ]
}

/// What validation lets through.
fn accepted() -> impl Strategy<Value = f32> {
    prop_oneof![
        1 => prop::num::f32::POSITIVE | prop::num::f32::NORMAL,
        1 => 1e-3..1e3f32,
        1 => prop::sample::select(vec![f32::MIN_POSITIVE, f32::MAX]),
    ]
}

fn six() -> impl Strategy<Value = [f32; 6]> {
    prop::array::uniform6(any_number())
}

fn motor() -> impl Strategy<Value = Pmsm<f32>> {
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

proptest! {
    #[test]
    fn frames_and_motors(m in motor(), [a, b, c, d, e, f] in six()) {
        let _ = (Phases { a, b, c }.clarke().inverse_clarke(), Phases { a, b, c }.zero_sequence());
        let (i, u) = (Dq { d: a, q: b }, Dq { d: c, q: d });
        let _ = (i.inverse_park(e).park(f), i.dot(u), (i + u) * e - -i);
        let _ = (m.torque(i), m.copper_loss(i), m.magnetic_energy(i), m.q_current(f));
        let _ = (m.derivative(i, u, e), m.step(i, u, e, f), m.step_exact(i, u, e, f));
    }

    /// Sine and cosine are on the circle for every angle that is finite.
    #[test]
    fn angles(angle in any_number()) {
        let at = AlphaBeta { alpha: 1.0, beta: 0.0 }.park(angle);
        let on_circle = (at.d.hypot(at.q) - 1.0).abs() < 2.0 * f32::EPSILON;
        prop_assert!(on_circle || !angle.is_finite(), "{:?}", at);
    }

    #[test]
    fn controllers([a, b, c, d, e, f] in six(), [g, h, k, l, m, n] in six()) {
        let p = PiParameters { kp: a.abs(), ki: b.abs(), limit: c.abs(), period: d.abs() };
        if let Ok(pi) = Pi::new(p) {
            let tracking = AntiWindup::BackCalculation { tracking_time: g };
            let pi = pi.with_anti_windup(tracking).unwrap_or(pi);
            let out = pi.update_with_feed_forward(&mut PiState { integral: e }, k, l, m);
            prop_assert!(out.value.is_nan() || out.value.abs() <= p.limit);
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
            let point = OperatingPoint { id_ref: n, ..OperatingPoint::at_dc_voltage(k) };
            let _ = servo.cycle_with(&mut state, &ServoInput { measurement: now, reference, correction }, &point);
        }
        let p = FieldWeakeningParameters {
            voltage_share: a, ki: b.abs(), current: c.abs(), period: d.abs(),
        };
        if let Ok(law) = FieldWeakening::new(p) {
            let id = law.update(&mut FieldWeakeningState { id_ref: e }, Dq { d: f, q: g }, h);
            prop_assert!(id.is_nan() || (-p.current..=0.0).contains(&id));
        }
    }

    #[test]
    fn modulation_and_inverter(
        voltage in accepted(), period in accepted(), share in 0.0..0.49f32, m in motor(),
        [a, b, c, d, e, f] in six(), nearest in any::<bool>(),
    ) {
        let mode = if nearest {
            Overmodulation::MinimumMagnitudeError
        } else {
            Overmodulation::MinimumPhaseError
        };
        let (modulator, u) = (Svpwm::new(voltage, mode).unwrap(), AlphaBeta { alpha: a, beta: b });
        prop_assert!((1..=6).contains(&sector(u)));
        let _ = (modulator.six_step(u), Duties::new(a, b, c));
        let duties = modulator.duties(u);
        for x in [duties.a(), duties.b(), duties.c()] {
            prop_assert!(x.is_nan() || (0.0..=1.0).contains(&x));
        }
        let inverter = Inverter::new(voltage, period, share * period).unwrap();
        let segments = inverter.switched(duties, Phases { a: c, b: d, c: e });
        prop_assert!(segments.iter().all(|s| s.duration >= 0.0 || s.duration.is_nan()));
        let rotor = Rotor { electrical_angle: d, speed: e };
        let _ = inverter.averaged_step(&m, Dq { d: f, q: a }, rotor, duties);
        let _ = inverter.switched_step(&m, Dq { d: f, q: a }, rotor, duties);
    }
}
