//! In `f64` every result keeps its bits, on every platform and with every
//! change of the code: sums over drawn inputs.

use crate::axis::{DC_VOLTAGE, PERIOD, gains, limits, motor, servo};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm, sector};
use foc_pmsm::{
    AlphaBeta, AntiWindup, Dq, Measurement, MotorParameters, Phases, Pmsm, Servo, ServoCorrection,
    ServoInput, ServoReference, ServoState,
};

/// Numbers drawn without a library, and the FNV-1a sum of what is made of them.
struct Bits {
    seed: u64,
    sum: u64,
}

impl Bits {
    fn new() -> Self {
        Self {
            seed: 1,
            sum: 0xcbf2_9ce4_8422_2325,
        }
    }

    /// Uniform from `low` to `high`: Knuth's linear congruential generator.
    fn draw(&mut self, low: f64, high: f64) -> f64 {
        self.seed = self.seed.wrapping_mul(6_364_136_223_846_793_005);
        self.seed = self.seed.wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.seed >> 11) as f64 / (1u64 << 53) as f64)
    }

    fn dq(&mut self, size: f64) -> Dq {
        Dq {
            d: self.draw(-size, size),
            q: self.draw(-size, size),
        }
    }

    fn add(&mut self, values: &[f64]) {
        for byte in values.iter().flat_map(|x| x.to_bits().to_le_bytes()) {
            self.sum = (self.sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn add_dq(&mut self, x: Dq) {
        self.add(&[x.d, x.q]);
    }

    fn add_duties(&mut self, x: Duties) {
        self.add(&[x.a(), x.b(), x.c()]);
    }

    fn motor(&mut self) -> Pmsm {
        let p = MotorParameters {
            pole_pairs: 1 + self.draw(0.0, 8.0) as u32,
            resistance: self.draw(0.0, 5.0),
            inductance_d: self.draw(1e-4, 1e-2),
            inductance_q: self.draw(1e-4, 2e-2),
            flux_linkage: 0.0,
        };
        Pmsm::new(p.from_torque_constant(self.draw(0.05, 3.0))).unwrap()
    }
}

#[test]
fn frames() {
    let mut bits = Bits::new();
    for _ in 0..2000 {
        let phases = Phases {
            a: bits.draw(-9.0, 9.0),
            b: bits.draw(-9.0, 9.0),
            c: bits.draw(-9.0, 9.0),
        };
        let angle = bits.draw(-500.0, 500.0);
        let i = phases.clarke().park(angle);
        let back = (i * angle - -i).inverse_park(angle).inverse_clarke();
        bits.add(&[phases.zero_sequence(), back.a, back.b, back.c, i.dot(i + i)]);
        bits.add_dq(i);
    }
    assert_eq!(bits.sum, 0xc1a7_38e1_e2f6_2252, "{:#x}", bits.sum);
}

#[test]
fn motors() {
    let mut bits = Bits::new();
    for _ in 0..2000 {
        let m = bits.motor();
        let (i, u) = (bits.dq(20.0), bits.dq(300.0));
        let (speed, h) = (bits.draw(-300.0, 300.0), bits.draw(1e-6, 1e-3));
        let torque = m.torque(i);
        bits.add(&[torque, m.q_current(torque), m.electrical_speed(speed)]);
        bits.add(&[m.copper_loss(i), m.magnetic_energy(i)]);
        bits.add_dq(m.steady_voltage(i, speed));
        bits.add_dq(m.derivative(i, u, speed));
        bits.add_dq(m.step(i, u, speed, h));
        bits.add_dq(m.step_exact(i, u, speed, h));
    }
    assert_eq!(bits.sum, 0xb878_8964_1376_35f4, "{:#x}", bits.sum);
}

/// The current of the motor, and limits that are often reached.
fn run(bits: &mut Bits, servo: &Servo) {
    let mut state = ServoState::default();
    let mut current = Dq::ZERO;
    for _ in 0..5000 {
        let m = Measurement {
            position: bits.draw(0.599_9, 0.600_1),
            motor_speed: bits.draw(-5.0, 5.0),
            current,
        };
        let r = ServoReference {
            position: 0.6,
            motor_speed: bits.draw(-5.0, 5.0),
        };
        let c = ServoCorrection {
            position_offset: bits.draw(-1e-6, 1e-6),
            speed: bits.draw(-0.1, 0.1),
            iq: bits.draw(-2.0, 2.0),
        };
        let command = servo.cycle(
            &mut state,
            &ServoInput {
                measurement: m,
                reference: r,
                correction: c,
            },
        );
        current = motor().step(current, command.voltage, m.motor_speed, PERIOD);
        bits.add(&[command.speed_ref, command.iq_ref]);
        bits.add_dq(command.voltage);
        bits.add_dq(current);
        let saturated = command.saturated;
        for flag in [saturated.current, saturated.voltage_d, saturated.voltage_q] {
            bits.add(&[f64::from(u8::from(flag))]);
        }
        bits.add(&[state.speed.integral, state.d.integral, state.q.integral]);
    }
}

#[test]
fn cascades() {
    let mut bits = Bits::new();
    run(&mut bits, &servo());
    let tracking = AntiWindup::BackCalculation {
        tracking_time: 2e-3,
    };
    run(&mut bits, &servo().with_anti_windup(tracking).unwrap());
    let low = foc_pmsm::ServoLimits {
        voltage: 20.0,
        ..limits()
    };
    run(&mut bits, &Servo::new(gains(), low, PERIOD).unwrap());
    assert_eq!(bits.sum, 0x5d66_76ef_821f_f640, "{:#x}", bits.sum);
}

#[test]
fn inverters() {
    let mut bits = Bits::new();
    for k in 0..2000 {
        let mode = match k % 2 {
            0 => Overmodulation::MinimumPhaseError,
            _ => Overmodulation::MinimumMagnitudeError,
        };
        let modulator = Svpwm::new(bits.draw(12.0, 800.0), mode).unwrap();
        let u = AlphaBeta {
            alpha: bits.draw(-400.0, 400.0),
            beta: bits.draw(-400.0, 400.0),
        };
        let duties = modulator.duties(u);
        bits.add_duties(duties);
        bits.add_duties(modulator.six_step(u));
        bits.add(&[modulator.linear_limit(), modulator.six_step_limit()]);
        bits.add(&[f64::from(sector(u))]);

        let dead_time = bits.draw(0.0, 5e-6);
        let inverter = Inverter::new(DC_VOLTAGE, PERIOD, dead_time).unwrap();
        let (m, i) = (bits.motor(), bits.dq(20.0));
        let rotor = Rotor {
            electrical_angle: bits.draw(-30.0, 30.0),
            speed: bits.draw(-300.0, 300.0),
        };
        let currents = i.inverse_park(rotor.electrical_angle).inverse_clarke();
        let lost = inverter.dead_time_voltage(currents);
        bits.add(&[lost.alpha, lost.beta, rotor.angle_after(&m, PERIOD)]);
        for s in inverter.switched(duties, currents) {
            bits.add(&[s.duration, s.voltage.alpha, s.voltage.beta]);
        }
        bits.add_dq(inverter.averaged_step(&m, i, rotor, duties));
        bits.add_dq(inverter.switched_step(&m, i, rotor, duties));
    }
    assert_eq!(bits.sum, 0x235f_e048_0630_8a58, "{:#x}", bits.sum);
}
