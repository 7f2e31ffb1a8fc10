//! Currents, torques and voltages of five machines as comma-separated rows, to be compared
//! with another program (docs/peers/foc/run).
//!
//! `cargo run --release -p foc-pmsm --example operating_points`

use foc_pmsm::saturation::{AlgebraicSaturation, AlgebraicSaturationParameters, FluxMap};
use foc_pmsm::sensorless::{FluxObserver, FluxObserverParameters};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{AlphaBeta, Dq, FocError, MotorParameters, OperatingLimits, OperatingRegion, Pmsm};

/// Of the machines: salient with magnets (the 2.2 kW machine of motulator's examples),
/// the drive of Liu et al. 2025, a surface machine, one whose d inductance is the larger,
/// and a reluctance machine (motulator's 6.7 kW).
const MACHINES: [(&str, [f64; 5]); 5] = [
    ("salient", [3.0, 3.6, 0.036, 0.051, 0.545]),
    ("servo", [4.0, 0.75, 4.11e-3, 13.2e-3, 0.2735]),
    ("surface", [4.0, 0.75, 4.11e-3, 4.11e-3, 0.2735]),
    ("inverse", [2.0, 0.54, 37e-3, 6.2e-3, 0.3]),
    ("reluctance", [2.0, 0.54, 37e-3, 6.2e-3, 0.0]),
];

fn machine([pairs, resistance, d, q, flux]: [f64; 5]) -> Result<Pmsm, FocError> {
    let parameters = MotorParameters {
        pole_pairs: pairs as u32,
        resistance,
        inductance_d: d,
        inductance_q: q,
        flux_linkage: flux,
    };
    if flux > 0.0 {
        Pmsm::new(parameters)
    } else {
        Pmsm::reluctance(parameters)
    }
}

fn row(kind: &str, name: &str, values: &[f64]) {
    print!("{kind},{name}");
    for value in values {
        print!(",{value:e}");
    }
    println!();
}

/// Loci of most torque per ampere and per volt, voltages of the steady state.
fn loci(name: &str, m: &Pmsm) {
    for current in [0.5, 2.0, 5.0, 10.0, 20.0, 50.0] {
        let i = m.mtpa(current);
        row("mtpa", name, &[current, i.d, i.q, m.torque(i)]);
        let flux = current * m.parameters().inductance_d;
        let v = m.mtpv(flux);
        row("mtpv", name, &[flux, v.d, v.q, m.torque(v)]);
        for speed in [-200.0, 0.0, 150.0] {
            let i = Dq {
                d: -0.4 * current,
                q: current,
            };
            let u = m.steady_voltage(i, speed);
            row("voltage", name, &[i.d, i.q, speed, u.d, u.q, m.torque(i)]);
        }
    }
}

/// The most torque within the limits, without resistance, as the other program has it.
fn most(name: &str, m: &Pmsm) -> Result<(), FocError> {
    let mut p = *m.parameters();
    p.resistance = 0.0;
    let free = if p.flux_linkage > 0.0 {
        Pmsm::new(p)?
    } else {
        Pmsm::reluctance(p)?
    };
    let limits = OperatingLimits {
        current: 15.0,
        voltage: 300.0,
    };
    for speed in [100.0, 200.0, 300.0, 400.0, 600.0, 900.0] {
        let found = free.operating_currents(1e3, speed, &limits);
        if found.region != OperatingRegion::Unreachable {
            let flux = limits.voltage / free.electrical_speed(speed);
            row("most", name, &[limits.current, flux, found.torque]);
        }
    }
    Ok(())
}

/// The saturated reluctance machine of motulator's example.
fn saturated() -> Result<(), FocError> {
    let model = AlgebraicSaturation::new(AlgebraicSaturationParameters {
        self_d: [17.4, 373.0],
        self_q: [52.1, 658.0],
        cross: 1120.0,
        exponents_self: [5, 1],
        exponents_cross: [1, 0],
        magnets: 0.0,
    })?;
    for d in [-0.6, 0.1, 0.4, 0.8] {
        for q in [-0.3, 0.0, 0.2, 0.5] {
            let i = model.current(Dq { d, q });
            let back = model.flux(i);
            row("saturated", "reluctance", &[d, q, i.d, i.q, back.d, back.q]);
        }
    }
    Ok(())
}

/// The flux observer with constant currents at a constant speed, from a wrong angle and
/// speed; with so short a period that the rule of integration hardly matters.
fn observer(name: &str, m: &Pmsm) -> Result<(), FocError> {
    const PERIOD: f64 = 1e-6;
    let (i, omega, bandwidth) = (Dq { d: 2.0, q: 4.0 }, 300.0, 80.0);
    let parameters = FluxObserverParameters::of(m, bandwidth, PERIOD);
    let law = FluxObserver::new(*m, parameters)?;
    let mut state = law.begin(0.3, 0.9 * omega);
    let u = m.steady_voltage(i, omega / m.electrical_speed(1.0));
    for step in 0..=40_000 {
        let angle = omega * PERIOD * f64::from(step);
        let estimate = law.estimate(&state, i.inverse_park(angle));
        if step % 10_000 == 0 && step > 0 {
            let (sin, cos) = f64::sin_cos(estimate.angle);
            let Dq { d, q } = estimate.flux;
            let inputs = [i.d, i.q, omega, bandwidth, PERIOD, f64::from(step)];
            let outputs = [sin, cos, d, q, estimate.speed];
            row("observer", name, &[&inputs[..], &outputs[..]].concat());
        }
        let middle = angle + 0.5 * omega * PERIOD;
        law.advance(&mut state, &estimate, u.inverse_park(middle));
    }
    Ok(())
}

/// Duty cycles around the circle, up to and beyond what can be made.
fn duties() -> Result<(), FocError> {
    for (name, mode) in [
        ("MPE", Overmodulation::MinimumPhaseError),
        ("MME", Overmodulation::MinimumMagnitudeError),
        ("six_step", Overmodulation::SixStep),
    ] {
        let modulator = Svpwm::new(540.0, mode)?;
        for length in [200.0, 311.0, 330.0, 350.0, 380.0] {
            for step in 0..24 {
                let (sin, cos) = f64::sin_cos(0.1 + f64::from(step) * 0.2618);
                let u = AlphaBeta {
                    alpha: length * cos,
                    beta: length * sin,
                };
                let d = modulator.duties(u);
                row("duties", name, &[u.alpha, u.beta, d.a(), d.b(), d.c()]);
            }
        }
    }
    Ok(())
}

fn main() -> Result<(), FocError> {
    for (name, numbers) in MACHINES {
        let m = machine(numbers)?;
        row("machine", name, &numbers);
        loci(name, &m);
        most(name, &m)?;
        observer(name, &m)?;
    }
    saturated()?;
    duties()
}
