//! Signal injection, on a salient motor simulated by code of its own: classical Runge–Kutta in the stator's frame of flux
//! linkages, iron that the magnets saturate along d.

use crate::axis::{self, PERIOD};
use axis_scalar::Scalar;
use foc_pmsm::sensorless::{
    SignalEstimate, SignalInjection, SignalInjectionParameters, SignalInjectionState,
};
use foc_pmsm::{AlphaBeta, Dq, FocError, MotorParameters, Pmsm};
use std::f64::consts::{PI, TAU};

const STEPS: usize = 20;
const INERTIA: f64 = 9.6e-3;
const FRICTION: f64 = 0.01;
const VOLTAGE: f64 = 60.0;

/// The motor of `axis::motor`, whose inductance along d falls by `saturation` (1/A) per ampere.
#[derive(Clone, Copy)]
struct Machine {
    resistance: f64,
    inductance: [f64; 2],
    magnets: f64,
    pairs: f64,
    saturation: f64,
    /// Flux linkages α, β; electrical angle; mechanical speed.
    flux: [f64; 2],
    angle: f64,
    speed: f64,
    load: f64,
    is_locked: bool,
}

impl Machine {
    fn at(angle: f64, saturation: f64) -> Self {
        let p = *axis::motor().parameters();
        Self {
            resistance: p.resistance,
            inductance: [p.inductance_d, p.inductance_q],
            magnets: p.flux_linkage,
            pairs: f64::from(p.pole_pairs),
            saturation,
            flux: [p.flux_linkage * angle.cos(), p.flux_linkage * angle.sin()],
            angle,
            speed: 0.0,
            load: 0.0,
            is_locked: true,
        }
    }

    /// Currents α, β of a state.
    fn current(&self, [a, b, angle, _]: [f64; 4]) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        let (d, q) = (a * cos + b * sin - self.magnets, b * cos - a * sin);
        // λ_d − ψ = L (i − s i²/2).
        let x = d / self.inductance[0];
        let id = match self.saturation > 0.0 {
            true => (1.0 - (1.0 - 2.0 * self.saturation * x).sqrt()) / self.saturation,
            false => x,
        };
        let iq = q / self.inductance[1];
        [id * cos - iq * sin, id * sin + iq * cos]
    }

    fn rates(&self, state: [f64; 4], u: [f64; 2]) -> [f64; 4] {
        let i = self.current(state);
        let torque = 1.5 * self.pairs * (state[0] * i[1] - state[1] * i[0]);
        let moving = match self.is_locked {
            true => 0.0,
            false => (torque - self.load - FRICTION * state[3]) / INERTIA,
        };
        [
            u[0] - self.resistance * i[0],
            u[1] - self.resistance * i[1],
            self.pairs * state[3],
            moving,
        ]
    }

    fn run(&mut self, u: [f64; 2]) {
        let h = PERIOD / STEPS as f64;
        let mut x = [self.flux[0], self.flux[1], self.angle, self.speed];
        for _ in 0..STEPS {
            let along = |k: [f64; 4], by: f64| [0, 1, 2, 3].map(|j| x[j] + by * k[j]);
            let a = self.rates(x, u);
            let b = self.rates(along(a, 0.5 * h), u);
            let c = self.rates(along(b, 0.5 * h), u);
            let d = self.rates(along(c, h), u);
            x = [0, 1, 2, 3].map(|j| x[j] + h * (a[j] + 2.0 * (b[j] + c[j]) + d[j]) / 6.0);
        }
        (self.flux, self.angle, self.speed) = ([x[0], x[1]], x[2], x[3]);
    }

    fn read(&self) -> AlphaBeta {
        let [a, b] = self.current([self.flux[0], self.flux[1], self.angle, self.speed]);
        AlphaBeta { alpha: a, beta: b }
    }
}

/// The angle without whole turns.
fn near(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

fn law(bandwidth: f64, late: bool) -> SignalInjection {
    let parameters = SignalInjectionParameters {
        voltage: VOLTAGE,
        bandwidth,
        period: PERIOD,
        late,
    };
    SignalInjection::new(&axis::motor(), parameters).unwrap()
}

/// A drive: current controllers of 200 Hz in the estimated frame, its voltage late where the law says so.
struct Drive {
    law: SignalInjection,
    state: SignalInjectionState,
    sums: [f64; 2],
    waiting: [f64; 2],
}

impl Drive {
    fn new(law: SignalInjection, angle: f64) -> Self {
        Self {
            state: law.begin(angle, 0.0),
            law,
            sums: [0.0; 2],
            waiting: [0.0; 2],
        }
    }

    /// A cycle on a machine with current references; gives what was known.
    fn cycle(&mut self, machine: &mut Machine, wanted: Dq) -> SignalEstimate {
        let current = machine.read();
        let known = self.law.estimate(&self.state, current);
        let [ld, lq] = machine.inductance;
        let band = TAU * 200.0;
        let mut u = [0.0; 2];
        let errors = [wanted.d - known.current.d, wanted.q - known.current.q];
        for (j, (error, l)) in errors.into_iter().zip([ld, lq]).enumerate() {
            self.sums[j] += band * machine.resistance * error * PERIOD;
            u[j] = band * l * error + self.sums[j];
        }
        let u = Dq { d: u[0], q: u[1] } + known.voltage;
        let u = u.inverse_park(known.angle);
        let now = [u.alpha, u.beta];
        let acts = match self.law.parameters().late {
            true => std::mem::replace(&mut self.waiting, now),
            false => now,
        };
        self.law.advance(&mut self.state, &known, current);
        machine.run(acts);
        known
    }
}

/// ½ sin 2θ̃ at any error, whether the voltage is late or not; a bandwidth of nearly 0 holds the error.
#[test]
fn the_error_is_half_the_sine_of_twice_the_angle() {
    for late in [false, true] {
        for off in [-1.2, -0.6, -0.1, 0.0, 0.1, 0.4, 0.7, 1.3] {
            let mut machine = Machine::at(0.9, 0.0);
            let mut drive = Drive::new(law(1e-9, late), 0.9 - off);
            let mut last = 0.0;
            for _ in 0..2000 {
                last = drive.cycle(&mut machine, Dq::ZERO).error;
            }
            let expected = 0.5 * (2.0 * off).sin();
            // Found: 0.004 at most, by the resistance and the controllers.
            assert!(
                (last - expected).abs() < 0.01,
                "{late} {off}: {last} {expected}"
            );
        }
    }
}

/// A rotor at rest that carries a current: from 40° off to within half a degree, and opposite from 140°.
#[test]
fn it_finds_the_rotor_at_standstill() {
    for late in [false, true] {
        for (off, end) in [(0.7, 0.0), (-0.7, 0.0), (2.44, PI)] {
            for q in [0.0, 5.0] {
                let mut machine = Machine::at(-2.0, 0.0);
                let mut drive = Drive::new(law(120.0, late), -2.0 - off);
                let mut known = drive.cycle(&mut machine, Dq::ZERO);
                for _ in 0..3000 {
                    known = drive.cycle(&mut machine, Dq { d: 0.0, q });
                }
                let error = near(machine.angle - known.angle - end);
                assert!(
                    error.abs() < 0.5_f64.to_radians(),
                    "{late} {off} {q}: {error}"
                );
                assert!(known.speed.abs() < 0.5, "{}", known.speed);
                // The ripple is not in the current that controllers see.
                assert!((known.current.q - q).abs() < 0.05, "{:?}", known.current);
            }
        }
    }
}

/// Position and speed controlled without a sensor, a load step of 6 N·m at standstill; angles are electrical.
#[test]
fn a_position_is_held_under_load_without_sensor() {
    let mut machine = Machine::at(0.3, 0.0);
    let mut drive = Drive::new(law(200.0, true), 0.0);
    machine.is_locked = false;
    let (mut sum, mut wanted, mut turned, mut last) = (0.0, Dq::ZERO, 0.0, None);
    let (mut most_error, mut furthest, mut end) = (0.0_f64, 0.0_f64, 0.0);
    let home = machine.angle;
    for k in 0..20_000 {
        machine.load = if k > 5000 { 6.0 } else { 0.0 };
        let known = drive.cycle(&mut machine, wanted);
        let before = last.replace(known.angle).unwrap_or(known.angle);
        if k < 1000 {
            continue;
        }
        turned += near(known.angle - before);
        let error = -15.0 * turned - known.speed;
        // 10 Hz of speed at 1.641 N·m/A and four pole pairs.
        let gain = INERTIA * 63.0 / 1.641 / 4.0;
        sum += gain * 16.0 * error * PERIOD;
        wanted.q = (gain * error + sum).clamp(-12.0, 12.0);
        most_error = most_error.max(near(machine.angle - known.angle).abs());
        furthest = furthest.max((machine.angle - home).abs());
        end = machine.angle - home;
    }
    // Found: 0.051 rad of error at most, 1.2 rad turned by the step, 0.006 rad off in the end.
    assert!(most_error < 4.0_f64.to_radians(), "{most_error}");
    assert!(end.abs() < 2.0_f64.to_radians(), "{end}");
    assert!(furthest > 0.05, "the load moved nothing: {furthest}");
}

/// Saturation tells the magnets' direction: with a current along the true d axis the ripple is larger.
#[test]
fn the_ripple_tells_which_way_the_magnets_point() {
    let ripple = |start: f64, d: f64| {
        let mut machine = Machine::at(0.5, 0.02);
        let mut drive = Drive::new(law(120.0, true), start);
        let mut sum = 0.0;
        for k in 0..4000 {
            let known = drive.cycle(&mut machine, Dq { d, q: 0.0 });
            sum += if k >= 3000 { known.ripple.d } else { 0.0 };
        }
        sum / 1000.0
    };
    for (start, right) in [(0.4, true), (0.4 - PI, false)] {
        let [up, down] = [4.0, -4.0].map(|d| ripple(start, d));
        assert!(up > 0.0 && down > 0.0, "{up} {down}");
        // 1/(1 − 0.02·4) against 1/(1 + 0.02·4): 17 %.
        let ratio = up / down;
        let expected = if right { 1.08 / 0.92 } else { 0.92 / 1.08 };
        assert!((ratio / expected - 1.0).abs() < 0.02, "{ratio} {expected}");
    }
    let own = law(120.0, true);
    let state = own.begin(0.25, 3.0);
    assert!((own.turned(&state).angle + PI - 0.25).abs() < 1e-12);
}

fn is_total<T: Scalar>(motor: Pmsm<T>) {
    let of = |voltage: f64, bandwidth: f64, period: f64| {
        let parameters = SignalInjectionParameters {
            voltage: T::of(voltage),
            bandwidth: T::of(bandwidth),
            period: T::of(period),
            late: true,
        };
        SignalInjection::new(&motor, parameters)
    };
    for (voltage, bandwidth, period) in [
        (0.0, 1.0, 1e-4),
        (-1.0, 1.0, 1e-4),
        (1.0, f64::NAN, 1e-4),
        (1.0, 1.0, 0.0),
        (f64::INFINITY, 1.0, 1e-4),
    ] {
        assert!(of(voltage, bandwidth, period).is_err());
    }
    let own = of(60.0, 120.0, 1e-4).unwrap();
    let mut state = own.begin(T::of(0.3), T::ZERO);
    let sample = |x: f64| AlphaBeta {
        alpha: T::of(x),
        beta: T::of(-x),
    };
    for x in [
        1.0,
        f64::NAN,
        2.0,
        f64::INFINITY,
        1e300,
        -1e300,
        0.5,
        0.5,
        0.5,
    ] {
        let known = own.estimate(&state, sample(x));
        own.advance(&mut state, &known, sample(x));
        assert!(state.angle.is_finite() && state.speed.is_finite(), "{x}");
    }
    assert!(own.estimate(&state, sample(0.5)).error.is_finite());
}

#[test]
fn nothing_bad_stays_in_either_scalar() {
    let own = axis::motor();
    is_total::<f64>(own);
    let p = own.parameters();
    let single = Pmsm::new(MotorParameters {
        pole_pairs: p.pole_pairs,
        resistance: p.resistance as f32,
        inductance_d: p.inductance_d as f32,
        inductance_q: p.inductance_q as f32,
        flux_linkage: p.flux_linkage as f32,
    });
    is_total::<f32>(single.unwrap());
    let round = MotorParameters {
        inductance_q: p.inductance_d,
        ..*p
    };
    let parameters = SignalInjectionParameters {
        voltage: 60.0,
        bandwidth: 120.0,
        period: 1e-4,
        late: true,
    };
    let refused = SignalInjection::new(&Pmsm::new(round).unwrap(), parameters);
    let Err(FocError::OutOfRange { field, .. }) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(field, "saliency");
}
