//! A step of 5 A in the q current at 600 rpm, with the inverter averaged and
//! switched: currents at the sampling instants, and what dead time does.
//!
//! `cargo run --release -p foc-pmsm --example current_step`

use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{Dq, FocError, MotorParameters, Pmsm, Servo, ServoGains, ServoLimits, ServoState};

const DC_VOLTAGE: f64 = 540.0;
const PERIOD: f64 = 1e-4;
const SPEED: f64 = 62.8;
const STEP: Dq = Dq { d: 0.0, q: 5.0 };

/// The motor of Liu et al. 2025, Table 2.
fn motor() -> Result<Pmsm, FocError> {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: 0.75,
        inductance_d: 4.11e-3,
        inductance_q: 13.2e-3,
        flux_linkage: 0.0,
    };
    Pmsm::new(parameters.from_torque_constant(1.641))
}

/// Its current controllers, Table 4; position and speed loop are not used.
fn servo() -> Result<Servo, FocError> {
    let gains = ServoGains {
        position: 0.0,
        speed_p: 0.0,
        speed_i: 0.0,
        d_p: 2.776,
        d_i: 626.2,
        q_p: 8.805,
        q_i: 1003.3,
    };
    let limits = ServoLimits {
        current: 15.0,
        voltage: DC_VOLTAGE / 3f64.sqrt(),
    };
    Servo::new(gains, limits, PERIOD)
}

/// Currents at the sampling instants, A.
fn run(switched: bool, dead_time: f64, periods: usize) -> Result<Vec<Dq>, FocError> {
    let (motor, servo) = (motor()?, servo()?);
    let modulator = Svpwm::new(DC_VOLTAGE, Overmodulation::default())?;
    let inverter = Inverter::new(DC_VOLTAGE, PERIOD, dead_time)?;
    let mut state = ServoState::settled(0.0, motor.steady_voltage(Dq::ZERO, SPEED));
    let mut i = Dq::ZERO;
    let mut rotor = Rotor {
        electrical_angle: 0.0,
        speed: SPEED,
    };
    let mut samples = vec![i];
    for _ in 0..periods {
        let (u, _, _) = servo.current_loop(&mut state, STEP - i, Dq::ZERO);
        let middle = rotor.angle_after(&motor, PERIOD / 2.0);
        let duties = modulator.duties(u.inverse_park(middle));
        i = if switched {
            inverter.switched_step(&motor, i, rotor, duties)
        } else {
            inverter.averaged_step(&motor, i, rotor, duties)
        };
        rotor.electrical_angle = rotor.angle_after(&motor, PERIOD);
        samples.push(i);
    }
    Ok(samples)
}

fn main() -> Result<(), FocError> {
    let averaged = run(false, 0.0, 200)?;
    let switched = run(true, 0.0, 200)?;
    let dead = run(true, 2e-6, 200)?;
    println!("time   averaged i_d, i_q   switched i_d, i_q   switched, 2 µs dead time");
    println!("ms              A                   A                   A");
    for k in (0..=20).chain([50, 100, 200]) {
        let (a, s, t) = (averaged[k], switched[k], dead[k]);
        println!(
            "{:4.1}  {:8.4} {:8.4}   {:8.4} {:8.4}   {:8.4} {:8.4}",
            k as f64 * PERIOD * 1e3,
            a.d,
            a.q,
            s.d,
            s.q,
            t.d,
            t.q
        );
    }
    let difference = averaged
        .iter()
        .zip(&switched)
        .map(|(&a, &s)| (a - s).dot(a - s).sqrt())
        .fold(0.0, f64::max);
    println!("largest difference of the two ideal inverters: {difference:.1e} A");
    Ok(())
}
