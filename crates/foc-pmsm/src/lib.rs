//! Field-oriented control of synchronous motors, with magnets or without, rotating or
//! linear.
//!
//! # The problem
//! A motor with p pole pairs turns at ω (mechanical, rad/s). Its currents
//! i = (i_d, i_q) ∈ ℝ² (A) in the rotor's frame answer to the voltage
//! u = (u_d, u_q) (V):
//!
//! ```text
//! L_d di_d/dt = u_d − R i_d + p ω L_q i_q                       (1)
//! L_q di_q/dt = u_q − R i_q − p ω (L_d i_d + ψ)                 (2)
//! T = 1.5 p (ψ i_q + (L_d − L_q) i_d i_q)            [N·m]      (3)
//! ```
//!
//! Once in a period T_s a controller samples the load's position S (m), ω
//! and i, and finds the voltage to hold until the next sample:
//!
//! ```text
//! ω_ref = P_Sw (S_ref − S) + ω_ff                               (4)
//! I_ω  += I_ωR (ω_ref − ω) T_s
//! i_ref = P_ωR (ω_ref − ω) + I_ω,  |i_ref| ≤ i_max              (5)
//! I_x  += I_ix e_x T_s,  u_x = P_ix e_x + I_x,  x = d, q        (6)
//!         e_d = 0 − i_d,  e_q = i_ref − i_q,  |u| ≤ U_dc/√3
//! ```
//!
//! An inverter makes that voltage from its DC link U_dc by switching three
//! legs, with duty cycles D ∈ \[0, 1\]³ per period.
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | p, R, L_d, L_q | pole pairs, resistance of a phase, inductances along and across the magnets | 1, Ω, H |
//! | ψ | flux linkage of the magnets, peak | V·s |
//! | i, u, e | currents, voltages, errors of the currents; amplitudes of a phase | A, V, A |
//! | T, ω | torque, mechanical speed | N·m, rad/s |
//! | S, S_ref, ω_ff | position of the load, its reference, speed that is fed forward | m, m, rad/s |
//! | P_Sw | gain of the position controller | (rad/s)/m |
//! | P_ωR, I_ωR | gains of the speed controller, whose integral is I_ω | A·s/rad, A/rad |
//! | P_ix, I_ix | gains of the current controllers, whose integrals are I_x | V/A, V/(A·s) |
//! | T_s, U_dc | control period, voltage of the DC link | s, V |
//!
//! [`ServoGains`] has the gains, [`MotorParameters`] the motor.
//!
//! # What is here
//! - [`Phases`], [`AlphaBeta`], [`Dq`]: Clarke and Park, amplitude-invariant.
//! - [`Pmsm`]: equations (1) to (3), one implicit step, one exact step.
//! - [`Pi`]: a sampled PI with two kinds of anti-windup.
//! - [`Servo`]: the cascade (4) to (6) with i_d = 0; with [`OperatingPoint`]
//!   it takes a d current reference and the DC link of each cycle.
//! - [`FieldWeakening`]: the d current reference above base speed, from the voltage.
//! - [`svpwm`]: duty cycles, linear range, overmodulation, six-step, discontinuous.
//! - [`inverter`]: averaged and switched, with dead time; [`DeadTimeCompensation`].
//!
//! For the programmer of a drive, none of it used by the cascade unasked:
//! - [`CurrentGains`]: of the current controllers, from R, L and a bandwidth.
//! - [`VoltageDelay`]: the angle at which a voltage arrives.
//! - [`Decoupling`]: what a cycle adds so that the axes do not disturb each other.
//! - [`Pmsm::mtpa`], [`Pmsm::mtpv`], [`Pmsm::operating_currents`]: the currents of a torque.
//! - [`saturation`]: flux maps, and the motor with them.
//! - [`LinearMotor`]: metres and newtons.
//! - [`sensorless`]: flux observer, start by a turning current, signal injection at standstill.
//!
//! Laws are immutable and validated once; states are plain structs of the
//! caller's. After construction nothing fails, panics or allocates. A NaN passes
//! through to the outputs of its cycle; controllers do not keep it, so that the next
//! sound sample has a sound output (a motor's currents, being computed, do).
//!
//! All types are generic over [`axis_scalar::Scalar`], `f64` unless said otherwise.
//! In `f32` nothing is computed in `f64`, which many controllers have in
//! software only; nor do sine and cosine of the Park transform, those of axis-scalar.
//!
//! # Example
//! A step of 5 A in the q current, with the motor held:
//! ```
//! use foc_pmsm::{Dq, MotorParameters, Pmsm, Servo, ServoGains, ServoLimits, ServoState};
//!
//! let motor = Pmsm::new(
//!     MotorParameters {
//!         pole_pairs: 4,
//!         resistance: 0.75,
//!         inductance_d: 4.11e-3,
//!         inductance_q: 13.2e-3,
//!         flux_linkage: 0.0,
//!     }
//!     .from_torque_constant(1.641),
//! )?;
//! let gains = ServoGains {
//!     position: 29_342.0, speed_p: 0.6474, speed_i: 6.801,
//!     d_p: 2.776, d_i: 626.2, q_p: 8.805, q_i: 1003.3,
//! };
//! let limits = ServoLimits { current: 15.0, voltage: 540.0 / 3.0_f64.sqrt() };
//! let servo = Servo::new(gains, limits, 1e-4)?;
//!
//! let mut state = ServoState::default();
//! let mut i = Dq::ZERO;
//! for _ in 0..100 {
//!     let error = Dq { d: 0.0, q: 5.0 } - i;
//!     let (u, _, _) = servo.current_loop(&mut state, error, Dq::ZERO);
//!     i = motor.step(i, u, 0.0, servo.period());
//! }
//! assert!((i.q - 5.0).abs() < 0.2 && i.d == 0.0);
//! assert!((motor.torque(i) - 1.641 * i.q).abs() < 1e-12);
//! # Ok::<(), foc_pmsm::FocError>(())
//! ```
//!
//! The current controllers of a drive in `f32`, on the DC link measured in
//! this cycle, the currents from two phases:
//! ```
//! use foc_pmsm::svpwm::{Overmodulation, Svpwm};
//! use foc_pmsm::{Dq, OperatingPoint, Phases, Servo, ServoGains, ServoLimits, ServoState};
//!
//! let gains = ServoGains {
//!     position: 0.0_f32, speed_p: 0.6474, speed_i: 6.801,
//!     d_p: 2.776, d_i: 626.2, q_p: 8.805, q_i: 1003.3,
//! };
//! let limits = ServoLimits { current: 15.0, voltage: f32::INFINITY };
//! let servo = Servo::new(gains, limits, 1e-4)?;
//! let mut state = ServoState::default();
//!
//! let (a, b, angle, dc_voltage) = (1.2_f32, -0.3, 0.7, 531.0);
//! let i = Phases { a, b, c: -a - b }.clarke().park(angle);
//! let error = Dq { d: 0.0, q: 5.0 } - i;
//! let limit = OperatingPoint::at_dc_voltage(dc_voltage).voltage_limit;
//! let (u, _, _) = servo.current_loop_within(&mut state, error, Dq::ZERO, limit);
//! let modulator = Svpwm::new(dc_voltage, Overmodulation::default())?;
//! let duties = modulator.duties(u.inverse_park(angle));
//! assert!((0.0..=1.0).contains(&duties.a()));
//! # Ok::<(), foc_pmsm::FocError>(())
//! ```
//!
//! # What it knows nothing of
//! Mechanics (inertia, friction, screws), trajectories, how a compensation
//! finds its correction, the resolution and noise of sensors, files and
//! units other than SI. It leaves out iron loss and cogging; [`Pmsm`], [`Servo`] and the
//! operating points leave out saturation, and the delay of a real controller is the
//! caller's.
//!
//! # Features
//! `std` (default) changes nothing: with and without it the crate needs
//! neither `std` nor `alloc`, and has the same results.
#![no_std]

mod current_gains;
mod dead_time;
mod decoupling;
mod delay;
mod error;
mod field_weakening;
mod frames;
mod gains;
pub mod inverter;
mod linear_motor;
mod math;
mod matrix_exponential;
mod motor;
mod operating;
mod pi;
pub mod saturation;
pub mod sensorless;
mod servo;
mod signals;
#[cfg(feature = "serde")]
mod stored;
pub mod svpwm;

pub use current_gains::CurrentGains;
pub use dead_time::DeadTimeCompensation;
pub use decoupling::{Decoupling, DecouplingCurrent};
pub use delay::VoltageDelay;
pub use error::FocError;
pub use field_weakening::{FieldWeakening, FieldWeakeningParameters, FieldWeakeningState};
pub use frames::{AlphaBeta, Dq, Phases};
pub use gains::{ServoGains, ServoLimits};
pub use linear_motor::{LinearMotor, LinearMotorParameters, LinearOperatingCurrents};
pub use motor::{MotorParameters, Pmsm};
pub use operating::{OperatingCurrents, OperatingLimits, OperatingRegion};
pub use pi::{AntiWindup, Pi, PiOutput, PiParameters, PiState};
pub use servo::Servo;
pub use signals::{
    Measurement, OperatingPoint, Saturated, ServoCommand, ServoCorrection, ServoInput,
    ServoReference, ServoState,
};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
