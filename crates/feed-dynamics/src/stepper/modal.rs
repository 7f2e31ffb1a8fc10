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

use super::{NutErrors, Observation, Settled, TableMotion, TimeStepper, settle_load};
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
    element_length: f64,
    propagators: Vec<Propagator>,
    /// ω² of each mode, padded with ones.
    stiffness: Vec<Lane>,
    /// Mode shapes at the screw's nodes, node by node.
    nodes: Vec<Vec<Lane>>,
    /// Response at node i at the end of a step to a unit torque that has grown
    /// from zero at node j = i and j = i + 1: [rad, rad/s] per N·m.
    flexibility: Vec<[[f64; 2]; 2]>,
}

/// State of a [`ModalStepper`].
#[derive(Clone, Debug)]
pub struct ModalState {
    modal: Vec<[Lane; 2]>,
    origin: f64,
    displacement: f64,
    speed: f64,
    torque: f64,
    nut_force: f64,
    load: f64,
    load_before: f64,
    seat: NutSeat,
}

impl ModalStepper {
    /// Prepares steps of `step` seconds.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] where the step is not positive and finite.
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
            element_length: p.screw_length / p.elements as f64,
            propagators,
            stiffness,
            nodes,
            flexibility,
            drive: drive.clone(),
        })
    }

    fn seat(&self, x: f64) -> NutSeat {
        let last = self.nodes.len() - 2;
        let along = (x / self.element_length).clamp(0.0, (last + 1) as f64);
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

    /// Rotation and its rate at the nut.
    fn nut_rotation(&self, modal: &[[Lane; 2]], seat: &NutSeat) -> [f64; 2] {
        let [n1, n2] = seat.weights;
        let (first, second) = (&self.nodes[seat.node], &self.nodes[seat.node + 1]);
        let mut sums = [[0.0; LANES]; 2];
        for ((m, a), b) in modal.iter().zip(first).zip(second) {
            for i in 0..LANES {
                let w = n1 * a[i] + n2 * b[i];
                sums[0][i] += w * m[0][i];
                sums[1][i] += w * m[1][i];
            }
        }
        sums.map(add_lanes)
    }
}

impl TimeStepper for ModalStepper {
    type State = ModalState;

    fn step_length(&self) -> f64 {
        self.step
    }

    fn settled(&self, x: f64, motion: &Settled) -> ModalState {
        let seat = self.seat(x);
        let nut_force = motion.nut_force(&self.drive);
        let torque = motion.motor_torque(&self.drive);
        let [n1, n2] = seat.weights;
        let (first, second) = (&self.nodes[seat.node], &self.nodes[seat.node + 1]);
        let mut modal = vec![[[0.0; LANES]; 2]; self.nodes[0].len()];
        for (lane, m) in modal.iter_mut().enumerate() {
            for i in 0..LANES {
                let w = n1 * first[lane][i] + n2 * second[lane][i];
                let force = self.propagators[lane].motor[i] * torque - self.r * nut_force * w;
                m[0][i] = force / self.stiffness[lane][i];
            }
        }
        // The rigid mode carries the speed, and turns the chain until the nut
        // is compressed just as its force asks.
        modal[0][0][0] = 0.0;
        let rigid = self.nodes[0][0][0];
        modal[0][1][0] = motion.speed / self.r / rigid;
        let wanted = nut_force / self.drive.parameters().nut_stiffness / self.r;
        let elastic = self.nut_rotation(&modal, &seat)[0];
        modal[0][0][0] = (wanted - elastic) / rigid;
        ModalState {
            modal,
            origin: x,
            displacement: 0.0,
            speed: motion.speed,
            torque,
            nut_force,
            load: motion.load,
            load_before: motion.load,
            seat,
        }
    }

    fn step_through(
        &self,
        state: &mut ModalState,
        torque: f64,
        errors: &NutErrors,
        load: impl FnMut(TableMotion) -> f64,
    ) {
        let (h, r) = (self.step, self.r);
        let p = self.drive.parameters();
        let (k, c, mass) = (
            p.nut_stiffness,
            p.nut_stiffness * p.stiffness_damping,
            p.table_mass,
        );

        // Chain, without the nut force at the step's end.
        self.propagate_free(state, torque);
        let seat = self.seat(state.origin + state.displacement + h * state.speed);
        let [rotation, rate] = self.nut_rotation(&state.modal, &seat);
        let [soft, soft_rate] = self.nut_flexibility(&seat);

        // Table, without the forces at the step's end: linear acceleration.
        let start = (state.nut_force - state.load) / mass;
        let free = TableMotion {
            displacement: state.displacement + h * (state.speed + h * start / 3.0),
            speed: state.speed + 0.5 * h * start,
        };
        let (give, give_speed) = (h * h / (6.0 * mass), 0.5 * h / mass);

        // F = k (rθ − y) + βk (rθ̇ − v), all at the end, is linear in F and the
        // load; with a gap, F times its stiffness falls short by that of half
        // the gap, and is nothing where it does not reach so far.
        let stiff = 1.0 + k * (r * r * soft + give) + c * (r * r * soft_rate + give_speed);
        let turned = [r * rotation + errors.offset, r * rate + errors.offset_rate];
        let unloaded = k * (turned[0] - free.displacement) + c * (turned[1] - free.speed);
        let slack = 0.5 * k * errors.gap;
        let nut = |load: f64| {
            let pressed = unloaded + (k * give + c * give_speed) * load;
            (pressed - pressed.clamp(-slack, slack)) / stiff
        };
        let motion = |load: f64| {
            let force = nut(load) - load;
            TableMotion {
                displacement: free.displacement + give * force,
                speed: free.speed + give_speed * force,
            }
        };
        let guess = 2.0 * state.load - state.load_before;
        let end_load = settle_load(guess, give_speed, motion, load);
        let end = motion(end_load);
        let nut_force = nut(end_load);

        self.add_nut(state, &seat, nut_force);
        state.displacement = end.displacement;
        state.speed = end.speed;
        state.torque = torque;
        state.nut_force = nut_force;
        state.load_before = state.load;
        state.load = end_load;
        state.seat = seat;
    }

    fn observe(&self, state: &ModalState) -> Observation {
        let mut sums = [[0.0; LANES]; 2];
        for (m, p) in state.modal.iter().zip(&self.propagators) {
            for i in 0..LANES {
                sums[0][i] += p.motor[i] * m[0][i];
                sums[1][i] += p.motor[i] * m[1][i];
            }
        }
        Observation {
            motor_angle: add_lanes(sums[0]),
            motor_speed: add_lanes(sums[1]),
            displacement: state.displacement,
            speed: state.speed,
            nut_force: state.nut_force,
        }
    }
}

impl ModalStepper {
    /// Propagates every mode under the loads at the step's start and the motor
    /// torque at its end.
    fn propagate_free(&self, state: &mut ModalState, torque: f64) {
        let [n1, n2] = state.seat.weights.map(|n| -self.r * state.nut_force * n);
        let at = state.seat.node;
        let nodes = self.nodes[at].iter().zip(&self.nodes[at + 1]);
        for ((m, q), (a, b)) in state.modal.iter_mut().zip(&self.propagators).zip(nodes) {
            for i in 0..LANES {
                let f0 = q.motor[i] * state.torque + n1 * a[i] + n2 * b[i];
                let f1 = q.motor[i] * torque;
                let [eta, rate] = [m[0][i], m[1][i]];
                m[0][i] = q.p[0][i] * eta + q.p[1][i] * rate + q.p[2][i] * f0 + q.p[3][i] * f1;
                m[1][i] = q.s[0][i] * eta + q.s[1][i] * rate + q.s[2][i] * f0 + q.s[3][i] * f1;
            }
        }
    }

    /// Adds what the nut force at the step's end does to the modes.
    fn add_nut(&self, state: &mut ModalState, seat: &NutSeat, nut_force: f64) {
        let [n1, n2] = seat.weights.map(|n| -self.r * nut_force * n);
        let nodes = self.nodes[seat.node].iter().zip(&self.nodes[seat.node + 1]);
        for ((m, q), (a, b)) in state.modal.iter_mut().zip(&self.propagators).zip(nodes) {
            for i in 0..LANES {
                let f1 = n1 * a[i] + n2 * b[i];
                m[0][i] += q.p[3][i] * f1;
                m[1][i] += q.s[3][i] * f1;
            }
        }
    }
}

pub(super) fn check_step(step: f64) -> Result<(), DriveError> {
    if step.is_finite() && step > 0.0 {
        return Ok(());
    }
    Err(DriveError::Parameter {
        name: "step",
        value: step,
        valid: "finite and above zero",
    })
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
