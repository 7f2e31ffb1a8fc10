//! The fast stepper: exact propagation of the chain's modes.
//!
//! The chain of motor, sensor and screw has constant matrices, so with
//! `θ = Φη` its equations fall apart into single oscillators
//!
//! ```text
//! η̈ + βω² η̇ + ω² η = φ_m T − r F w(x),      w(x) = N₁ φ_e + N₂ φ_{e+1}
//! ```
//!
//! whose propagator over a step with linearly changing load is known in closed
//! form (the exponential of an augmented 4 × 4 matrix). What is left is the
//! nut force F at the end of the step: it depends linearly on the end state,
//! and that on F, so one scalar equation gives it. Second order in the step,
//! whatever the stiffness of the screw.

use nalgebra::Matrix4;

use super::nut::Contact;
use super::{
    NutErrors, Observation, Settled, StepReport, TableMotion, TimeStepper, check_step, find_load,
};
use crate::matrices::{NutCoupling, NutSeat, dense};
use crate::{DriveError, FeedDrive};

/// Modes are handled four at a time, so that the compiler can use vectors.
const LANES: usize = 4;
type Lane = [f64; LANES];

/// Propagator of four modes over one step: `η₁ = p·[η, η̇, f₀, f₁]`,
/// `η̇₁ = s·[η, η̇, f₀, f₁]`, f being the modal load at the ends of the step.
#[derive(Clone, Debug, Default)]
struct Propagator {
    p: [Lane; 4],
    s: [Lane; 4],
    /// Mode shape at the motor.
    motor: Lane,
}

/// The drive in modal coordinates, for steps of one length.
/// Nut coupling: shape functions on the fixed mesh.
#[derive(Clone, Debug)]
pub struct ModalStepper {
    drive: FeedDrive,
    step: f64,
    /// Rotation of the nut (rad) to table travel (m).
    r: f64,
    elements_per_metre: f64,
    table: TableCompliance,
    propagators: Vec<Propagator>,
    /// ω² of each mode, padded with ones.
    stiffness: Vec<Lane>,
    /// Mode shapes at the screw's nodes, node by node.
    nodes: Vec<Vec<Lane>>,
    /// Response at node i at the end of a step to a unit torque that has grown
    /// from zero at node j = i and j = i + 1: [rad, rad/s] per N·m.
    flexibility: Vec<[[f64; 2]; 2]>,
}

/// What a newton on the table that grows over a step gives at its end.
#[derive(Clone, Copy, Debug)]
struct TableCompliance {
    /// m/N
    travel: f64,
    /// (m/s)/N
    speed: f64,
}

/// Four modes at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Modes {
    /// η.
    coordinate: Lane,
    /// η̇.
    rate: Lane,
    /// The modal load.
    load: Lane,
    /// Mode shape at the nut.
    nut: Lane,
}

/// State of a [`ModalStepper`].
#[derive(Clone, Debug)]
pub struct ModalState {
    modes: Vec<Modes>,
    /// Motor angle and speed.
    motor: [f64; 2],
    origin: f64,
    displacement: f64,
    speed: f64,
    nut_force: f64,
    load: f64,
    load_before: f64,
    /// Of the nut, at the end of the last step.
    errors: NutErrors,
}

impl ModalStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the step is not positive and finite.
    pub fn new(drive: &FeedDrive, step: f64) -> Result<Self, DriveError> {
        check_step(step)?;
        let p = drive.parameters();
        let chain = drive.chain(0.5 * p.screw_length, NutCoupling::ShapeFunctions)?;
        let size = chain.mass.diagonal.len();
        let modes =
            beam_fem::natural_modes(&dense(&chain.mass, size), &dense(&chain.stiffness, size))?;

        let lanes = size.div_ceil(LANES);
        let mut propagators = vec![Propagator::default(); lanes];
        let mut stiffness = vec![[1.0; LANES]; lanes];
        let mut shapes = vec![vec![[0.0; LANES]; lanes]; size];
        for (mode, &w) in modes.frequencies_rad_s.iter().enumerate() {
            let (lane, slot) = (mode / LANES, mode % LANES);
            let (p_row, s_row) = propagate(w * w, p.stiffness_damping * w * w, step);
            for c in 0..4 {
                propagators[lane].p[c][slot] = p_row[c];
                propagators[lane].s[c][slot] = s_row[c];
            }
            propagators[lane].motor[slot] = modes.shapes[(0, mode)];
            stiffness[lane][slot] = w * w;
            for (row, shape) in shapes.iter_mut().enumerate() {
                shape[lane][slot] = modes.shapes[(row, mode)];
            }
        }
        let nodes = shapes.split_off(2);
        let flexibility = flexibility(&propagators, &nodes);
        Ok(Self {
            step,
            r: drive.travel_per_radian(),
            elements_per_metre: p.elements as f64 / p.screw_length,
            table: TableCompliance {
                travel: step * step / (6.0 * p.table_mass),
                speed: 0.5 * step / p.table_mass,
            },
            propagators,
            stiffness,
            nodes,
            flexibility,
            drive: drive.clone(),
        })
    }

    fn seat(&self, x: f64) -> NutSeat {
        let last = self.nodes.len() - 2;
        let along = (x * self.elements_per_metre).clamp(0.0, (last + 1) as f64);
        let node = (along as usize).min(last);
        let xi = along - node as f64;
        NutSeat {
            node,
            weights: [1.0 - xi, xi],
        }
    }

    /// [rad, rad/s] that a unit nut torque at the end of a step brings at the nut.
    fn nut_flexibility(&self, seat: &NutSeat) -> [f64; 2] {
        let ([n1, n2], at) = (seat.weights, seat.node);
        let (own, next) = (&self.flexibility[at], &self.flexibility[at + 1]);
        [0, 1].map(|i| n1 * n1 * own[0][i] + 2.0 * n1 * n2 * own[1][i] + n2 * n2 * next[0][i])
    }
}

impl TimeStepper for ModalStepper {
    type State = ModalState;

    fn step_length(&self) -> f64 {
        self.step
    }

    fn of_length(&self, step: f64) -> Result<Self, DriveError> {
        Self::new(&self.drive, step)
    }

    fn travel_per_radian(&self) -> f64 {
        self.r
    }

    fn settled_torque(&self, _: f64, motion: &Settled) -> f64 {
        motion.motor_torque(&self.drive)
    }

    fn settled(&self, x: f64, motion: &Settled) -> Result<ModalState, DriveError> {
        self.drive.check_position(x)?;
        motion.check()?;
        let seat = self.seat(x);
        let nut_force = motion.nut_force(&self.drive);
        let torque = motion.motor_torque(&self.drive);
        let mut modes = vec![Modes::default(); self.propagators.len()];
        self.place_nut(&mut modes, &seat);
        for ((m, q), k) in modes.iter_mut().zip(&self.propagators).zip(&self.stiffness) {
            for (i, k) in k.iter().enumerate() {
                m.load[i] = q.motor[i] * torque - self.r * nut_force * m.nut[i];
                m.coordinate[i] = m.load[i] / k;
            }
        }
        // The rigid mode carries the speed, and turns the chain until the nut
        // is compressed just as its force asks.
        modes[0].coordinate[0] = 0.0;
        let rigid = modes[0].nut[0];
        modes[0].rate[0] = motion.speed / self.r / rigid;
        let wanted = nut_force / self.drive.contact_stiffness(x) / self.r;
        let elastic = nut_rotation(&modes)[0];
        modes[0].coordinate[0] = (wanted - elastic) / rigid;
        Ok(ModalState {
            motor: self.motor_rotation(&modes),
            modes,
            origin: x,
            displacement: 0.0,
            speed: motion.speed,
            nut_force,
            load: motion.load,
            load_before: motion.load,
            errors: NutErrors::default(),
        })
    }

    fn step_through(
        &self,
        state: &mut ModalState,
        torque: f64,
        errors: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) -> StepReport {
        let (h, r) = (self.step, self.r);
        let p = self.drive.parameters();

        // Chain, without the nut force at the step's end.
        let x = state.origin + state.displacement + h * state.speed;
        let seat = self.seat(x);
        self.propagate_free(&mut state.modes, torque);
        self.place_nut(&mut state.modes, &seat);
        let [rotation, rate] = nut_rotation(&state.modes);
        let [soft, soft_rate] = self.nut_flexibility(&seat);

        // Table, without the forces at the step's end: linear acceleration.
        let start = (state.nut_force - state.load) / p.table_mass;
        let free = TableMotion {
            displacement: state.displacement + h * (state.speed + h * start / 3.0),
            speed: state.speed + 0.5 * h * start,
        };
        let (give, give_speed) = (self.table.travel, self.table.speed);

        // The nut's law on the end values, which are linear in its force and in
        // the load.
        let stiffness = self.drive.contact_stiffness(x);
        let contact = Contact {
            stiffness,
            damping: stiffness * p.stiffness_damping,
            travel: r * r * soft + give,
            speed: r * r * soft_rate + give_speed,
            half_gap: 0.5 * errors.gap(),
        };
        let compression = r * rotation + errors.offset() - free.displacement;
        let closing = r * rate + errors.offset_rate() - free.speed;
        let nut = |load: f64| contact.force(compression + give * load, closing + give_speed * load);
        let motion = |load: f64| {
            let force = nut(load) - load;
            TableMotion {
                displacement: free.displacement + give * force,
                speed: free.speed + give_speed * force,
            }
        };
        let guess = 2.0 * state.load - state.load_before;
        let (end_load, found) = find_load(guess, give_speed, motion, load);
        let end = motion(end_load);
        let nut_force = nut(end_load);

        state.motor = self.add_nut(&mut state.modes, nut_force);
        state.displacement = end.displacement;
        state.speed = end.speed;
        state.nut_force = nut_force;
        state.load_before = state.load;
        state.load = end_load;
        state.errors = *errors;
        StepReport {
            load: found,
            on_screw: self.drive.has(state.origin + state.displacement),
        }
    }

    fn observe(&self, state: &ModalState) -> Observation {
        Observation {
            motor_angle: state.motor[0],
            motor_speed: state.motor[1],
            displacement: state.displacement,
            speed: state.speed,
            transmission_force: state.nut_force,
        }
    }

    fn energy(&self, state: &ModalState) -> f64 {
        let mut sum = 0.5 * self.drive.parameters().table_mass * state.speed * state.speed;
        for (m, k) in state.modes.iter().zip(&self.stiffness) {
            for (i, k) in k.iter().enumerate() {
                sum += 0.5 * (m.rate[i] * m.rate[i] + k * m.coordinate[i] * m.coordinate[i]);
            }
        }
        let stretch = self.r * nut_rotation(&state.modes)[0] - state.displacement;
        let strain = state.errors.strain(stretch);
        let stiffness = self
            .drive
            .contact_stiffness(state.origin + state.displacement);
        sum + 0.5 * stiffness * strain * strain
    }
}

impl ModalStepper {
    /// Propagates every mode under the loads at the step's start and the motor
    /// torque at its end.
    fn propagate_free(&self, modes: &mut [Modes], torque: f64) {
        for (m, q) in modes.iter_mut().zip(&self.propagators) {
            for i in 0..LANES {
                let (eta, rate) = (m.coordinate[i], m.rate[i]);
                let (f0, f1) = (m.load[i], q.motor[i] * torque);
                m.coordinate[i] =
                    q.p[0][i] * eta + q.p[1][i] * rate + q.p[2][i] * f0 + q.p[3][i] * f1;
                m.rate[i] = q.s[0][i] * eta + q.s[1][i] * rate + q.s[2][i] * f0 + q.s[3][i] * f1;
                m.load[i] = f1;
            }
        }
    }

    /// Mode shapes at the nut.
    fn place_nut(&self, modes: &mut [Modes], seat: &NutSeat) {
        let [n1, n2] = seat.weights;
        let nodes = self.nodes[seat.node].iter().zip(&self.nodes[seat.node + 1]);
        for (m, (a, b)) in modes.iter_mut().zip(nodes) {
            for i in 0..LANES {
                m.nut[i] = n1 * a[i] + n2 * b[i];
            }
        }
    }

    /// Adds what the nut force at the step's end does to the modes, and gives
    /// motor angle and speed.
    fn add_nut(&self, modes: &mut [Modes], nut_force: f64) -> [f64; 2] {
        let torque = -self.r * nut_force;
        for (m, q) in modes.iter_mut().zip(&self.propagators) {
            for i in 0..LANES {
                let f1 = torque * m.nut[i];
                m.coordinate[i] += q.p[3][i] * f1;
                m.rate[i] += q.s[3][i] * f1;
                m.load[i] += f1;
            }
        }
        self.motor_rotation(modes)
    }

    /// Angle and speed of the motor.
    fn motor_rotation(&self, modes: &[Modes]) -> [f64; 2] {
        let motor = self.propagators.iter().map(|q| &q.motor);
        rotation(modes.iter().zip(motor))
    }
}

/// Rotation of the screw at the nut, and its rate.
fn nut_rotation(modes: &[Modes]) -> [f64; 2] {
    rotation(modes.iter().map(|m| (m, &m.nut)))
}

/// Rotation and its rate where the modes have the given shapes.
#[inline(always)]
fn rotation<'a>(modes: impl Iterator<Item = (&'a Modes, &'a Lane)>) -> [f64; 2] {
    let mut sums = [[0.0; LANES]; 2];
    for (m, shape) in modes {
        for i in 0..LANES {
            sums[0][i] += shape[i] * m.coordinate[i];
            sums[1][i] += shape[i] * m.rate[i];
        }
    }
    sums.map(add_lanes)
}

/// Both rows of the propagator of `η̈ + c η̇ + k η = f₀ + (f₁ − f₀) t/h`.
///
/// The exponential of the system augmented by the load and its slope gives
/// them to rounding for any k, zero (rigid motion) included.
fn propagate(k: f64, c: f64, h: f64) -> ([f64; 4], [f64; 4]) {
    #[rustfmt::skip]
    let system = Matrix4::new(
        0.0,    h,      0.0, 0.0,
        -k * h, -c * h, h,   0.0,
        0.0,    0.0,    0.0, 1.0,
        0.0,    0.0,    0.0, 0.0,
    );
    let e = system.exp();
    // Third column: constant load; fourth: load growing from 0 to 1.
    let row = |i: usize| [e[(i, 0)], e[(i, 1)], e[(i, 2)] - e[(i, 3)], e[(i, 3)]];
    (row(0), row(1))
}

fn flexibility(propagators: &[Propagator], nodes: &[Vec<Lane>]) -> Vec<[[f64; 2]; 2]> {
    let response = |a: &[Lane], b: &[Lane]| {
        let mut sum = [0.0; 2];
        for ((q, a), b) in propagators.iter().zip(a).zip(b) {
            for i in 0..LANES {
                sum[0] += q.p[3][i] * a[i] * b[i];
                sum[1] += q.s[3][i] * a[i] * b[i];
            }
        }
        sum
    };
    let next = |i: usize| nodes.get(i + 1).unwrap_or(&nodes[i]);
    (0..nodes.len())
        .map(|i| [response(&nodes[i], &nodes[i]), response(&nodes[i], next(i))])
        .collect()
}

fn add_lanes(lane: Lane) -> f64 {
    (lane[0] + lane[2]) + (lane[1] + lane[3])
}

#[cfg(test)]
mod energy_tests;
