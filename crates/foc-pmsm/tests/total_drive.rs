//! As `total`, of gains, operating points, saturation, modulation and sensorless control:
//! every public function takes every number, in both scalars. None panics or hangs.

use crate::axis::any_number;
use axis_scalar::Scalar;
use foc_pmsm::inverter::Inverter;
use foc_pmsm::saturation::{
    AlgebraicSaturation, AlgebraicSaturationParameters, FluxMap, FluxTable, FluxTableParts,
    SaturatedMotor,
};
use foc_pmsm::sensorless::{
    CurrentStart, CurrentStartParameters, CurrentStartState, FluxObserver, FluxObserverParameters,
    FluxObserverState,
};
use foc_pmsm::svpwm::{DiscontinuousPwm, Duties, Overmodulation, Svpwm};
use foc_pmsm::{
    AlphaBeta, CurrentGains, DeadTimeCompensation, Decoupling, DecouplingCurrent, Dq, LinearMotor,
    LinearMotorParameters, Measurement, MotorParameters, OperatingLimits, OperatingPoint, Phases,
    Pmsm, Servo, ServoGains, ServoInput, ServoLimits, ServoReference, ServoState, VoltageDelay,
};
use proptest::prelude::*;

fn numbers() -> impl Strategy<Value = [f64; 9]> {
    prop::array::uniform9(any_number())
}

/// A motor of any valid numbers; without magnets where `psi` is 0.
fn motor<T: Scalar>(pairs: u32, [r, d, q, psi]: [T; 4]) -> Option<Pmsm<T>> {
    let parameters = MotorParameters {
        pole_pairs: pairs,
        resistance: r.abs(),
        inductance_d: d.abs(),
        inductance_q: q.abs(),
        flux_linkage: psi.abs(),
    };
    Pmsm::new(parameters)
        .or_else(|_| Pmsm::reluctance(parameters))
        .ok()
}

fn within<T: Scalar>(d: Duties<T>) -> bool {
    let inside = |x: T| x.is_nan() || (T::ZERO..=T::ONE).contains(&x);
    inside(d.a()) && inside(d.b()) && inside(d.c())
}

fn drives<T: Scalar>(m: Pmsm<T>, n: [T; 9]) {
    let [a, b, c, d, e, f, g, h, k] = n;
    let (i, u) = (Dq { d: a, q: b }, Dq { d: c, q: d });
    let _ = (
        m.mtpa(a),
        m.mtpa_for_torque(b),
        m.mtpv(c),
        m.flux(i),
        m.current_of_flux(u),
    );
    let limits = OperatingLimits {
        current: d,
        voltage: e,
    };
    let found = m.operating_currents(f, g, &limits);
    let numbers = [d, e, f, g].iter().all(|x| !x.is_nan());
    if numbers && d.is_finite() && found.current.d.is_finite() && found.current.q.is_finite() {
        // Whatever is found keeps the current limit, but for the rounding of subnormals.
        let most = d.max(T::ZERO) * (T::ONE + T::of(8.0) * T::EPSILON) + T::MIN_POSITIVE;
        assert!(
            found.current.d.abs() <= most && found.current.q.abs() <= most,
            "{found:?}"
        );
    }
    let one = CurrentGains::pole_zero(&m, a.abs());
    let two = CurrentGains::two_degrees_of_freedom(&m, b.abs());
    let _ = CurrentGains::bandwidth(c, d);
    let law = Decoupling::new(m, DecouplingCurrent::Reference);
    for gains in [one, two].into_iter().flatten() {
        let law = law
            .with_active_resistance(gains.active_resistance)
            .unwrap_or(law);
        let _ = law.voltage(i, u, e);
        let gains = ServoGains {
            position: a.abs(),
            speed_p: b.abs(),
            speed_i: c.abs(),
            d_p: d.abs(),
            d_i: e.abs(),
            q_p: f.abs(),
            q_i: g.abs(),
        }
        .with_current(&gains);
        let limits = ServoLimits {
            current: h.abs(),
            voltage: k.abs(),
        };
        let Ok(servo) = Servo::new(gains, limits, T::of(1e-4)) else {
            continue;
        };
        let mut state = ServoState::settled(a, u);
        let input = ServoInput {
            measurement: Measurement {
                position: b,
                motor_speed: c,
                current: i,
            },
            reference: ServoReference {
                position: d,
                motor_speed: e,
            },
            ..ServoInput::default()
        };
        let point = OperatingPoint {
            id_ref: f,
            voltage_limit: g,
        };
        let _ = servo.cycle_decoupled(&mut state, &input, &point, &law);
    }
    if let Ok(delay) = VoltageDelay::new(a.abs(), b.abs()) {
        let _ = (
            delay.total(),
            delay.magnitude(c),
            delay.inverse_park(u, d, e),
        );
    }
    sensorless(m, n);
}

fn sensorless<T: Scalar>(m: Pmsm<T>, [a, b, c, d, e, f, g, h, k]: [T; 9]) {
    let parameters = FluxObserverParameters::of(&m, a.abs(), b.abs());
    if let Ok(observer) = FluxObserver::new(m, parameters) {
        let mut state = observer.begin(c, d);
        let (i, u) = (
            AlphaBeta { alpha: e, beta: f },
            AlphaBeta { alpha: g, beta: h },
        );
        let estimate = observer.estimate(&state, i);
        observer.advance(&mut state, &estimate, u);
        let flux = Dq { d: g, q: k };
        let mut state = FluxObserverState {
            flux,
            angle: h,
            speed: c,
        };
        let estimate = observer.estimate(&state, u);
        observer.advance(&mut state, &estimate, i);
    }
    let parameters = CurrentStartParameters {
        current: a.abs(),
        alignment: b.abs(),
        acceleration: c.abs(),
        speed: d,
        period: e.abs(),
    };
    if let Ok(start) = CurrentStart::new(parameters) {
        let mut state = CurrentStartState {
            aligned: f,
            angle: g,
            speed: h,
        };
        start.advance(&mut state);
        let _ = (start.reference_at(&state, k), start.is_over(&state));
    }
}

fn modulation<T: Scalar>([a, b, c, d, e, f, ..]: [T; 9], legs: [T; 3]) {
    let u = AlphaBeta { alpha: a, beta: b };
    if let Ok(modulator) = Svpwm::new(c.abs(), Overmodulation::SixStep) {
        assert!(within(modulator.duties(u)));
        for pwm in [
            DiscontinuousPwm::Dpwm0,
            DiscontinuousPwm::Dpwm1,
            DiscontinuousPwm::Dpwm2,
            DiscontinuousPwm::Max,
            DiscontinuousPwm::Min,
        ] {
            assert!(within(modulator.discontinuous_duties(u, pwm)));
        }
    }
    let period = T::of(1e-4);
    if let Ok(law) = DeadTimeCompensation::new(d.abs(), period, e.abs()) {
        let duties = Duties::new(legs[0], legs[1], legs[2]).unwrap();
        let currents = Phases { a, b, c: f };
        assert!(within(law.duties(duties, currents)));
        let _ = law.voltage(c, currents);
    }
    let _ = Inverter::new(a, b, c);
}

fn machines<T: Scalar>(pairs: u32, [a, b, c, d, e, f, g, h, k]: [T; 9], powers: [u8; 4]) {
    let x = Dq { d: f, q: g };
    let [s, t, u, v] = powers;
    let model = AlgebraicSaturation::new(AlgebraicSaturationParameters {
        self_d: [a.abs(), b.abs()],
        self_q: [c.abs(), d.abs()],
        cross: e.abs(),
        exponents_self: [s, t],
        exponents_cross: [u, v],
        magnets: k,
    });
    if let Ok(model) = model {
        let _ = (model.flux(x), model.current(x), model.inductances(x));
        if let Ok(m) = SaturatedMotor::new(pairs, h.abs(), model) {
            let _ = (m.torque(x), m.torque_at_flux(x), m.steady_voltage(x, a));
            let _ = m.step(x, Dq { d: a, q: b }, c, d);
        }
    }
    let parts = FluxTableParts {
        id: &[a, b],
        iq: &[c, d],
        flux_d: &[e, f, g, h],
        flux_q: &[k, a, b, c],
    };
    if let Ok(table) = FluxTable::new(parts) {
        let _ = (table.flux(x), table.current(x), table.inductances(x));
    }
    let (one, two) = (T::ONE, T::TWO);
    let (grid, first, second) = ([-one, one], [one, one, two, two], [-one, one, -one, one]);
    let parts = FluxTableParts {
        id: &grid,
        iq: &grid,
        flux_d: &first,
        flux_q: &second,
    };
    let sound = FluxTable::new(parts).unwrap();
    let _ = (sound.flux(x), sound.current(x), sound.inductances(x));
    let linear = LinearMotor::new(LinearMotorParameters {
        pole_pitch: a.abs(),
        resistance: b.abs(),
        inductance_d: c.abs(),
        inductance_q: d.abs(),
        flux_linkage: e.abs(),
    });
    if let Ok(m) = linear {
        let limits = OperatingLimits {
            current: h,
            voltage: k,
        };
        let _ = (
            m.electrical_angle(f),
            m.force(x),
            m.q_current(g),
            m.step(x, x, h, k),
        );
        let _ = m.operating_currents(f, g, &limits);
    }
}

proptest! {
    #[test]
    fn drives_in_both_scalars(pairs in 1u32.., first in numbers(), second in numbers()) {
        let [r, d, q, psi, ..] = first;
        if let Some(m) = motor(pairs, [r, d, q, psi]) {
            drives(m, second);
        }
        if let Some(m) = motor(pairs, [r, d, q, psi].map(|x| x as f32)) {
            drives(m, second.map(|x| x as f32));
        }
    }

    #[test]
    fn modulation_in_both_scalars(n in numbers(), legs in prop::array::uniform3(0.0..=1.0)) {
        modulation(n, legs);
        modulation(n.map(|x| x as f32), legs.map(|x| x as f32));
    }

    #[test]
    fn machines_in_both_scalars(
        pairs in any::<u32>(), n in numbers(), powers in prop::array::uniform4(0u8..=20),
    ) {
        machines(pairs, n, powers);
        machines(pairs, n.map(|x| x as f32), powers);
    }
}
