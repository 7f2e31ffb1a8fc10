//! `f32` against `f64`: the same laws, apart by the rounding of `f32`.

use crate::axis::rigid::{RADIUS, Rigid};
use crate::axis::{
    self, PERIOD, cast, drawn_current_loop, drawn_dc_voltage, drawn_motor, gains, limits,
    log_uniform, motor,
};
use axis_scalar::Scalar;
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{AlphaBeta, Dq, Pmsm, ServoInput, ServoReference, ServoState};
use proptest::prelude::*;

const EPSILON: f64 = f32::EPSILON as f64;

/// Sine and cosine as the Park transform has them.
fn sin_cos(angle: f32) -> (f64, f64) {
    let at = AlphaBeta {
        alpha: 1.0,
        beta: 0.0,
    }
    .park(angle);
    (f64::from(-at.q), f64::from(at.d))
}

/// What `angle` in `f32` is off by, as a length.
fn angle_error(angle: f32) -> f64 {
    let ((sin, cos), (s, c)) = (sin_cos(angle), f64::from(angle).sin_cos());
    (sin - s).hypot(cos - c)
}

#[test]
fn angles_within_a_thousand_turns() {
    let worst = (-1_000_000..=1_000_000)
        .map(|k| angle_error(k as f32 * 6.3e-3))
        .fold(0.0, f64::max);
    // 0.78 ε measured.
    assert!(worst < 2.0 * EPSILON, "{} ε", worst / EPSILON);
    // The quarters themselves, where the quadrant changes.
    for k in -2000..=2000 {
        let angle = (f64::from(k) * core::f64::consts::FRAC_PI_2) as f32;
        for angle in [angle.next_down(), angle, angle.next_up()] {
            assert!(angle_error(angle) < 2.0 * EPSILON, "{angle}");
        }
    }
}

/// Beyond, the error is that of the angle's own last place, and the vector
/// keeps its length.
#[test]
fn angles_beyond() {
    let mut angle = 1.0_f32;
    while angle.is_finite() {
        for angle in [angle, -angle] {
            let (sin, cos) = sin_cos(angle);
            assert!((sin.hypot(cos) - 1.0).abs() < 2.0 * EPSILON, "{angle}");
            let last_place = EPSILON * f64::from(angle.abs());
            let error = angle_error(angle);
            // 0.42 ε and 0.47 last places measured.
            assert!(error < 2.0 * EPSILON + 2.0 * last_place, "{angle} {error}");
        }
        angle *= 1.037;
    }
    assert!(sin_cos(f32::INFINITY).0.is_nan() && sin_cos(f32::NAN).1.is_nan());
}

/// What a run of the cascade shows at one sampling instant.
struct Sample {
    current: Dq,
    voltage: Dq,
}

const STROKE: f64 = 0.5;
const DURATION: f64 = 6.0;

/// There and back: half a cosine each way, at most 131 mm/s and 0.07 g.
fn reference<T: Scalar>(t: f64) -> ServoReference<T> {
    let turn = core::f64::consts::TAU / DURATION;
    let velocity = 0.5 * STROKE * turn * (turn * t).sin();
    ServoReference {
        position: T::of(0.5 * STROKE * (1.0 - (turn * t).cos())),
        motor_speed: T::of(velocity / RADIUS),
    }
}

/// The paper's drive along the move, against a load of 5 N·m.
fn run<T: Scalar>() -> Vec<Sample> {
    let servo = cast::servo::<T>(&gains(), &limits(), PERIOD).unwrap();
    let mut drive = Rigid::table(cast::motor::<T>(&motor()));
    let mut state = ServoState::default();
    let cycles = (DURATION / PERIOD) as u32;
    let sample = |k| {
        let (m, r) = (drive.measure(), reference(f64::from(k) * PERIOD));
        let command = servo.cycle(
            &mut state,
            &ServoInput {
                measurement: m,
                reference: r,
                ..ServoInput::default()
            },
        );
        let current = cast::widened(drive.current);
        drive.advance(command.voltage, 5.0, PERIOD);
        Sample {
            current,
            voltage: cast::widened(command.voltage),
        }
    };
    (0..cycles).map(sample).collect()
}

/// What rounds is the position, seen through the position and the speed gain,
/// the speed, and the current itself; all of it reaches the voltage through
/// the gain of the current.
#[test]
fn a_move_in_either_scalar() {
    let (single, double) = (run::<f32>(), run::<f64>());
    let g = gains();
    let largest = |f: fn(&Sample) -> Dq| double.iter().map(f).map(length).fold(0.0, f64::max);
    let speed = 0.5 * STROKE * core::f64::consts::TAU / DURATION / RADIUS;
    let current = g.speed_p * (g.position * STROKE + speed) + largest(|s| s.current);
    let voltage = g.q_p * current + largest(|s| s.voltage);

    let apart = |f: fn(&Sample) -> Dq| {
        let pairs = single.iter().zip(&double);
        pairs.map(|(a, b)| length(f(a) - f(b))).fold(0.0, f64::max) / EPSILON
    };
    let (i, u) = (
        apart(|s| s.current) / current,
        apart(|s| s.voltage) / voltage,
    );
    // 0.27 and 0.58 measured: 3.1e-4 A and 5.9e-3 V.
    assert!(
        i < 2.0 && u < 2.0,
        "{i} ε of {current} A, {u} ε of {voltage} V"
    );
}

fn length(x: Dq) -> f64 {
    x.dot(x).sqrt()
}

/// The currents (A) of a step, and the largest voltage (V) that it took.
fn step<T: Scalar>(plant: &axis::CurrentLoop, speed: f64, periods: usize) -> (Vec<Dq>, f64) {
    let (motor, servo) = (
        cast::motor::<T>(&plant.motor),
        cast::current_loop::<T>(plant),
    );
    let (speed, mut i, mut most) = (T::of(speed), Dq::ZERO, 0.0_f64);
    let mut state = ServoState::settled(T::ZERO, motor.steady_voltage(i, speed));
    let reference = cast::dq(plant.reference);
    let currents = (0..periods)
        .map(|_| {
            let (u, _, _) = servo.current_loop(&mut state, reference - i, Dq::ZERO);
            i = motor.step(i, u, speed, servo.period());
            most = most.max(length(cast::widened(u)));
            cast::widened(i)
        })
        .collect();
    (currents, most)
}

proptest! {
    /// Any motor, any stable loop. An integral moves by k_i e T_s in a period,
    /// and not at all where that is below half its last place: the currents of
    /// a step are apart by ε U/(2 k_i T_s), and by their own rounding.
    #[test]
    fn current_loops_agree(plant in drawn_current_loop(), turn in 0.0..0.25) {
        let speed = turn * plant.bandwidth / plant.motor.electrical_speed(1.0);
        let periods = (20.0 / (plant.bandwidth * plant.period)) as usize;
        let (single, _) = step::<f32>(&plant, speed, periods);
        let (double, voltage) = step::<f64>(&plant, speed, periods);
        let gain = 2.0 * plant.gains.d_i.min(plant.gains.q_i) * plant.period;
        let scale = voltage / gain + double.iter().copied().map(length).fold(0.0, f64::max);
        let pairs = single.iter().zip(&double);
        let apart = pairs.map(|(&a, &b)| length(a - b)).fold(0.0, f64::max);
        // 0.93 measured.
        prop_assert!(apart < 4.0 * EPSILON * scale, "{} ε", apart / EPSILON / scale);
    }

    /// Duties, and the voltage that they make.
    #[test]
    fn duties_agree(voltage in drawn_dc_voltage(), d in -1.0..1.0, q in -1.0..1.0, which in 0..2) {
        let mode = match which {
            0 => Overmodulation::MinimumPhaseError,
            _ => Overmodulation::MinimumMagnitudeError,
        };
        let double = Svpwm::new(voltage, mode).unwrap();
        let single = Svpwm::new(voltage as f32, mode).unwrap();
        let (alpha, beta) = (d * voltage, q * voltage);
        let a = double.duties(AlphaBeta { alpha, beta });
        let b = single.duties(AlphaBeta { alpha: alpha as f32, beta: beta as f32 });
        for (a, b) in [(a.a(), b.a()), (a.b(), b.b()), (a.c(), b.c())] {
            // 0.97 ε measured.
            prop_assert!((a - f64::from(b)).abs() < 4.0 * EPSILON, "{}", (a - f64::from(b)) / EPSILON);
        }
    }

    /// Over a midpoint step, supplied = loss + stored + mechanical, to the
    /// rounding of either scalar.
    #[test]
    fn the_energy_balance_closes(
        m in drawn_motor(), i0 in drawn_dq(200.0), u in drawn_dq(1000.0),
        electrical in -5000.0..5000.0, h in log_uniform(1e-6, 1e-2),
    ) {
        let speed = electrical / f64::from(m.parameters().pole_pairs);
        // Measured: 1.2 and 1.1 of the last place.
        let single = imbalance::<f32>(&m, i0, u, speed, h);
        prop_assert!(single < 9.0 * f64::from(f32::EPSILON), "{}", single);
        let double = imbalance::<f64>(&m, i0, u, speed, h);
        prop_assert!(double < 9.0 * f64::EPSILON, "{}", double);
    }

    /// To the rotor's frame and back.
    #[test]
    fn round_trips(x in drawn_dq(1000.0), angle in -100.0..100.0f32) {
        let phases = cast::dq::<f32>(x).inverse_park(angle).inverse_clarke();
        let back = cast::widened(phases.clarke().park(angle));
        // 2.5 ε measured.
        prop_assert!(length(back - x) < 8.0 * EPSILON * length(x), "{}", length(back - x));
    }
}

fn drawn_dq(size: f64) -> impl Strategy<Value = Dq> {
    (-size..size, -size..size).prop_map(|(d, q)| Dq { d, q })
}

/// What a step leaves of the energy balance, of the energies turned over in it.
fn imbalance<T: Scalar>(m: &Pmsm, i0: Dq, u: Dq, speed: f64, h: f64) -> f64 {
    let m = cast::motor::<T>(m);
    let (i0, u) = (cast::dq(i0), cast::dq(u));
    let (speed, h) = (T::of(speed), T::of(h));
    let i1 = m.step(i0, u, speed, h);
    let mean = (i0 + i1) * T::HALF;
    let power = T::of(1.5) * u.dot(mean) - m.copper_loss(mean) - m.torque(mean) * speed;
    let stored = m.magnetic_energy(i1) - m.magnetic_energy(i0);
    let p = m.parameters();
    let turnover = |i: Dq<T>| {
        let flux = p.inductance_d * i.d.abs() + p.inductance_q * i.q.abs() + p.flux_linkage;
        let currents = i.d.abs() + i.q.abs();
        let induced = m.electrical_speed(speed).abs() * flux;
        let voltage = u.d.abs() + u.q.abs() + p.resistance * currents + induced;
        m.magnetic_energy(i) + h * T::of(1.5) * currents * voltage
    };
    ((h * power - stored) / (turnover(i0) + turnover(i1)))
        .to_f64()
        .abs()
}
